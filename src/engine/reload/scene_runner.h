// SceneRunner: runs the scene of the show: at the start, for a reset, a reload or a change to another scene. A run that
// fails leaves the show unchanged. [sim, except where noted]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/recovery/recovery_control.h"
#include "engine/reload/added_model.h"
#include "engine/reload/scene_host.h"
#include "engine/reload/scene_reloader.h"
#include "engine/sim_thread_executor.h"
#include "engine/takes/recording.h"

namespace limber::engine {

class SceneRunner {
 public:
  SceneRunner(ShowState& show, TakeRecording& recording, RecoveryControl& recovery)
      : show_(show), recording_(recording), recovery_(recovery), reloader_(show.options.scene, host_, show.overrides) {}

  /// Runs the scene for the first time and applies the values of the command line.
  Result<void> start();
  /// Runs the scene from its start and applies the overrides again. False if it failed.
  bool reset();
  /// Runs the scene again and applies the differences from its last run.
  SceneReloader::ApplyResult run_now(TakeSceneRun::Kind kind, bool reuse_files);
  /// Runs the scene again if a parameter with `rerun` has changed.
  void rerun_if_requested();

  /// See Engine::reload(). [any but sim]
  bool reload(bool reuse_files);
  /// See Engine::change_scene(). [any but sim]
  Result<void> change_scene(const std::string& file, std::optional<std::uint64_t> panics);
  /// See Engine::add_model(). [any but sim]
  Result<AddedModel> add_model(const std::string& path, const model::BodyModel& model);
  /// Runs `work` between two ticks. Error if a take plays, or if the show has ended. [any but sim]
  Result<void> run_between_ticks(const std::function<void()>& work);
  /// Loads the presets of a scene. May wait for the disk. [any]
  Presets::Bank read_presets(const std::string& scene);
  /// The source files of the scene. [any]
  std::vector<script::SourceFile> files() const { return reloader_.files(); }

  /// A run of the scene in a take that is recorded or replayed.
  struct Run {
    std::size_t index = 0;  ///< Its index in the recording.
    InputSource::SceneFiles files;
  };
  /// Begins a run: records it, and returns the files that it reads.
  Run begin_run(TakeSceneRun::Kind kind, bool reuse_files = false, const std::string& scene = "");
  /// Applies the differences of a candidate.
  SceneReloader::ApplyResult apply_candidate(ReloadCandidate& candidate);
  /// Replaces the show with a session that has run detached, and its presets. On return `fresh` and `bank` contain the
  /// previous ones, which must be destroyed on a thread that may wait.
  void play_scene(const std::string& file, std::unique_ptr<Session>& fresh, Presets::Bank& bank);
  /// Replaces the session and returns the previous one.
  std::unique_ptr<Session> swap_session(std::unique_ptr<Session> fresh);

  script::ScriptHost& host() { return host_; }
  SceneReloader& reloader() { return reloader_; }
  /// Work for other threads that waits for the end of a tick.
  SimThreadExecutor& requests() { return requests_; }

 private:
  void copy_session_value(Session& fresh, std::string_view name) const;
  std::unique_ptr<Session> install_session(std::unique_ptr<Session> fresh);
  void capture_run(Session& session, const script::SceneOptions& options, const std::string& file,
                   std::vector<script::SourceFile> failed_files = {});
  void reapply_overrides();
  Result<void> apply_initial_overrides();
  Result<void> apply_parameter(const Message& message);
  Result<void> apply_override(const Message& message, std::string_view option);
  void begin_show();
  void explain_pace() const;
  ReloadRequest request_with(const AddedModel& model);
  Result<void> apply_added(ReloadCandidate& candidate, const std::string& previous);

  ShowState& show_;
  TakeRecording& recording_;
  RecoveryControl& recovery_;
  SceneHost host_{show_, reloader_};
  SceneReloader reloader_;
  SimThreadExecutor requests_;
};

}  // namespace limber::engine
