// Engine: the main loop of the simulation thread. Each pass executes commands and scene callbacks and, unless simulated
// time is paused, a tick of physics; then it publishes a snapshot and waits for the next tick. It owns the running show
// (ShowState) and the parts of the engine that act on it; other threads use its EngineLink only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/cues/cue_loader.h"
#include "engine/engine_options.h"
#include "engine/input/live_input.h"
#include "engine/output/health_monitor.h"
#include "engine/reload/scene_runner.h"
#include "engine/saved_states.h"
#include "engine/takes/playback.h"
#include "engine/takes/recording.h"

namespace limber::engine {

class Engine {
 public:
  /// Work budget of the messages of one pass; see LiveInput.
  static constexpr int kPassWork = LiveInput::kPassWork;

  /// The link must outlive the engine. No thread may call its `wake_engine` during the destructor.
  Engine(EngineLink& link, EngineOptions options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Runs the scene file and applies the values of `--set` (EngineOptions::sets). An error names file and line. After a
  /// failed scene the world stays empty, and the first successful reload becomes the start. [sim]
  Result<void> start();
  /// Runs ticks until the end that the options specify, or until stop(). [sim]
  void run();
  /// Runs one pass with a tick now, regardless of the clock; while paused only commands and handlers. [sim]
  void tick() { run_pass(true); }
  /// Executes commands, handlers and requests without a time step. [sim]
  void idle() { run_pass(false); }
  /// Makes run() return soon. [any]
  void stop() { show_.pacer.stop(); }

  /// Runs the scene file detached from the show, compares the result with that of the last successful run, and applies
  /// the differences to the show between two ticks; returns when this is done. A script error is reported, and the show
  /// continues unchanged. `reuse_files`: runs the sources of the last successful run instead of the files on disk,
  /// because a parameter has changed. Returns false if it did nothing, because a take plays or the show has ended.
  /// [any but sim, during run()]
  bool reload(bool reuse_files = false) { return scenes_.reload(reuse_files); }
  /// Reloads at once, on the simulation thread. [sim]
  SceneReloader::ApplyResult reload_now(bool reuse_files = false) {
    return scenes_.run_now(TakeSceneRun::Kind::reload, reuse_files);
  }
  /// Runs another scene file detached from the show, then replaces the session with it between two ticks and drops all
  /// overrides. If the scene fails, returns the error, and the show continues. [any but sim, during run()]
  /// `panics`: EngineLink::panics at the time of the request; the request is discarded if there was a panic since.
  Result<void> change_scene(const std::string& file, std::optional<std::uint64_t> panics = {});
  /// Adds a model to the scene, as if the last line of its file loaded it: in a free place, with a unique name. The
  /// files of the last successful run are used, and all other objects stay as they are; resets and reloads keep the
  /// model, another scene drops it. `model`: that of the file `path`. Returns the name and place of its body, or an
  /// error, and the show continues. [any but sim, during run()]
  Result<AddedModel> add_model(const std::string& path, const model::BodyModel& model) {
    return scenes_.add_model(path, model);
  }
  /// Replaces the show with a take, which plays to its end or until /take/stop; from there the show continues under
  /// live control. If the take is invalid, returns the error, and the show continues. [any but sim, during run()]
  /// `stops`: EngineLink::take_stop_count() at the time of the request; the request is discarded if it has changed
  /// since.
  Result<void> play_take(const std::string& file, std::optional<std::uint64_t> stops = {}) {
    return playback_.play(file, stops);
  }
  /// The files to watch: a change of one of them calls for a reload, or of the cue file for reload_cues(). [any]
  std::vector<script::SourceFile> files() const;
  /// Path of the cue file, whether it exists or not; empty: none. [any]
  std::string cue_file() const { return cues_.file().path; }
  /// Reads the cue file again. If it has an error, this is reported, and the cues stay. Returns false if it did
  /// nothing, because a take plays or the show has ended. [any but sim, during run()]
  bool reload_cues() { return cues_.reload(); }
  /// Edits the cue file, see CueLoader. [any but sim]
  Result<void> edit_cues(const Message& request) { return cues_.edit(request); }

  sim::World& world() { return show_.session->world; }
  Store& store() { return show_.session->store; }
  /// The scene's run; null if there is no scene. [sim, or any after run()]
  script::Scene* scene() { return show_.session->scene.get(); }
  const PhaseTimes& times() const { return times_; }
  const History& history() const { return show_.history; }
  const Presets& presets() const { return show_.presets; }
  /// Blocks until presets and takes are written to disk. [any but sim]
  void finish_saving();
  /// Marks the show as properly ended, so that the next start does not offer a recovery. [any but sim, after run()]
  void end_recovery() { recovery_.end(); }
  /// Ends the recording of a take, if there is one. [sim]
  void end_take() { recording_.end(); }
  /// True while a take is replayed.
  bool is_replaying() const { return playback_.player() != nullptr; }
  /// The result of the replay so far. Requires is_replaying().
  ReplayResult replay_result() const { return playback_.player()->result(); }
  /// True when the replay has reached the end of the take. Requires is_replaying(). [sim]
  bool replay_finished() const { return playback_.player()->finished(); }
  /// Restores the newest checkpoint before this tick and discards everything since, except presets. Call it between two
  /// passes. It is not recorded in a take. Returns false, without a change, if there is no such checkpoint. [sim]
  bool restore_before(std::uint64_t tick) { return show_.restore_before(tick); }
  /// Copies of the state in memory, between two passes. [sim]
  SavedStates& saved_states() { return saved_states_; }
  /// Runs the scene from its start, with this seed or its own, as a reset does, and drops the edits of controllers. On
  /// error the show continues unchanged. Call it between two passes. [sim]
  bool restart(std::optional<std::uint64_t> seed);
  /// Hash of the world, the scene and the random number generators. [sim]
  std::uint64_t state_hash() const { return show_.state_hash(); }
  /// Number of script errors, rejected values and unstable bodies so far, for `--strict`. [sim]
  std::uint64_t faults() const { return show_.outputs.live().faults() + show_.session->world.stability().events(); }

 private:
  /// One iteration of the loop: commands, handlers, requests, publishing and, if `may_step` and not paused, a tick.
  void run_pass(bool may_step);
  void execute_reset_and_take_requests(bool running);
  void begin_recording();
  void publish();
  void make_value_snapshot();
  bool finished() const;

  ShowState show_;
  CommandExecutor executor_{show_};
  Simulator simulator_{show_};
  Rewinder rewinder_{show_, executor_, simulator_};
  TakeRecording recording_{show_};
  LiveInput live_input_{show_, executor_, rewinder_, recording_};
  RecoveryControl recovery_{show_};
  SceneRunner scenes_{show_, recording_, recovery_};
  CueLoader cues_{show_, scenes_};
  TakePlayback playback_{show_, executor_, rewinder_, live_input_, scenes_, recording_, recovery_};
  HealthMonitor health_{show_};
  SavedStates saved_states_{show_};
  PhaseTimes times_;
};

}  // namespace limber::engine
