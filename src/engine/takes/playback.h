// TakePlayback: the take that is replayed, if there is one: by --replay, or inside a running show (/take/play). [sim,
// except where noted]
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/reload/scene_runner.h"
#include "engine/takes/take_input.h"

namespace limber::engine {

class TakePlayback {
 public:
  TakePlayback(ShowState& show, CommandExecutor& executor, Rewinder& rewinder, LiveInput& live, SceneRunner& scenes,
               TakeRecording& recording, RecoveryControl& recovery);

  /// Starts the replay of the take in the options, with its first tick.
  Result<void> start();
  /// See Engine::play_take(). [any but sim]
  Result<void> play(const std::string& file, std::optional<std::uint64_t> stops);
  /// Prepares the inputs of a pass, and ends a take that has no more of them or must end because of a panic. False if
  /// there are none, because the replay by --replay has ended.
  bool begin_pass();
  /// Ends the take if /take/stop has requested that.
  void end_if_requested();

  /// The player of the take; null if none is replayed.
  const TakePlayer* player() const { return input_ == nullptr ? nullptr : &input_->player(); }
  /// The state for TakeNode; nothing if no take is replayed.
  std::optional<TakeNode::Status> status() const;

 private:
  Result<void> check(TakePlayer& player);
  std::unique_ptr<Session> begin_in_show(std::unique_ptr<TakePlayer> player, const std::string& file,
                                         Presets::Bank& bank);
  Result<void> begin(std::unique_ptr<TakePlayer> player, const std::string& file, bool in_show);
  Result<void> run_start();
  void end();
  bool next_tick();
  void run_scene(const TakeSceneRun& run);
  void load_scene(const TakeSceneRun& run, const SceneRunner::Run& scene_run);

  ShowState& show_;
  CommandExecutor& executor_;
  Rewinder& rewinder_;
  LiveInput& live_;
  SceneRunner& scenes_;
  TakeRecording& recording_;
  RecoveryControl& recovery_;
  std::unique_ptr<TakeInput> input_;
  std::string name_;
  Presets::Bank presets_after_;                  // the presets to restore after a take that plays in the show
  std::optional<ReloadRequest> reload_request_;  // of the take
};

}  // namespace limber::engine
