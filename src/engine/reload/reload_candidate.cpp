// ReloadCandidate: a run of the scene detached from the show.
#include "engine/reload/reload_candidate.h"

#include <utility>

#include "engine/presets/capturer.h"
#include "sim/gears/gear_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/state/rebuild.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::engine {

ReloadCandidate::ReloadCandidate(ReloadRequest request, script::ScriptHost& host)
    : request_(std::move(request)), scene_(std::make_unique<script::Scene>(world_, host, request_.options)) {
  result_ = scene_->run(request_.file, &request_.inputs);
  if (!result_) return;
  sim::flush_detached(world_);
  spec_ = std::make_shared<const SceneSpec>(describe(world_));
  diff_ = compare(*request_.base_spec, *spec_);
  script_preset_ = PresetCapturer::capture_script(store_);
  scene_->prepare();
}

std::vector<script::SourceFile> ReloadCandidate::files() const { return scene_->sources()->files(); }

}  // namespace limber::engine
