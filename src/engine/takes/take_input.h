// TakeInput: the inputs of a take that is replayed. Commands of controllers are rejected meanwhile. [sim]
#pragma once

#include <cstdint>
#include <memory>

#include "engine/input/live_input.h"
#include "engine/takes/player.h"

namespace limber::engine {

class TakeInput final : public RecordedInput {
 public:
  /// The error of commands that arrive during a replay.
  static constexpr const char* kReplayingError = "a take is being replayed; messages are rejected";

  /// `in_show`: the take plays in a running show, until its end, /take/stop or a panic.
  TakeInput(ShowState& show, CommandExecutor& executor, Rewinder& rewinder, LiveInput& live,
            std::unique_ptr<TakePlayer> player, bool in_show)
      : RecordedInput(show, executor),
        rewinder_(rewinder),
        live_(live),
        player_(std::move(player)),
        in_show_(in_show) {}

  TakePlayer& player() { return *player_; }
  const TakePlayer& player() const { return *player_; }
  bool in_show() const { return in_show_; }
  /// True if /take/stop was requested.
  bool stop_requested() const { return stop_requested_; }

  void execute_messages(bool may_step) override;
  bool advances_time(bool may_step) override;
  void end_handlers(std::uint64_t called) override;
  void record(const Message& message, const CommandOrigin& origin, bool evaluate) override;
  Outcome rewind(const Transport::RewindRequest& request, const CommandOrigin& origin) override;
  Outcome request_take(const Message&) override { return Outcome::answered(); }
  SceneFiles begin_run(TakeSceneRun::Kind kind) override;
  bool must_rerun() override;
  void end_pass() override;
  bool is_paced() const override { return !show().options.fast && player_->steps_next(); }
  bool finished() const override { return !in_show_ && player_->finished(); }
  Result<void> accepts_changes() const override;

 private:
  Rewinder& rewinder_;
  LiveInput& live_;
  const std::unique_ptr<TakePlayer> player_;
  const bool in_show_;
  bool stop_requested_ = false;
};

}  // namespace limber::engine
