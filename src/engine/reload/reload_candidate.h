// ReloadCandidate: a new run of the scene, detached from the show in its own store and world, and its differences from
// the last successful run. It touches nothing live, so it can run on any thread and take any time. [any]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/presets/preset.h"
#include "engine/reload/scene_diff.h"
#include "engine/reload/scene_spec.h"
#include "script/scene/scene.h"
#include "script/scene/sources.h"

namespace limber::engine {

/// The input of a candidate, copied from the show between two ticks.
struct ReloadRequest {
  std::string file;
  script::SceneOptions options;
  script::RunInputs inputs;
  std::shared_ptr<const SceneSpec> base_spec;  ///< Of the last successful run.
};

class ReloadCandidate {
 public:
  /// Runs the file. `host` receives the output of its top level, on this thread.
  ReloadCandidate(ReloadRequest request, script::ScriptHost& host);
  ReloadCandidate(const ReloadCandidate&) = delete;
  ReloadCandidate& operator=(const ReloadCandidate&) = delete;

  const ReloadRequest& request() const { return request_; }
  /// The result of the run. After an error only fault() and files() are valid.
  const Result<void>& result() const { return result_; }
  const script::ScriptPlace& fault() const { return scene_->fault(); }

  const sim::World& world() const { return world_; }
  const std::shared_ptr<const SceneSpec>& spec() const { return spec_; }
  const SceneDiff& diff() const { return diff_; }
  std::vector<script::SourceFile> files() const;
  /// The values of all properties after the run.
  const std::shared_ptr<const Preset>& script_preset() const { return script_preset_; }

  /// The scene, to be swapped with the live one, which is then destroyed with the candidate.
  std::unique_ptr<script::Scene>& scene() { return scene_; }

 private:
  ReloadRequest request_;
  Store store_;
  sim::World world_{store_};
  std::unique_ptr<script::Scene> scene_;  // after world_: must be destroyed first
  Result<void> result_;
  std::shared_ptr<const SceneSpec> spec_;
  SceneDiff diff_;
  std::shared_ptr<const Preset> script_preset_;
};

}  // namespace limber::engine
