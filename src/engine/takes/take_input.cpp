// TakeInput: the decisions that the take contains, and the comparison with it.
#include "engine/takes/take_input.h"

namespace limber::engine {

namespace {

constexpr const char* kPlayingError = "a take plays; /take/stop ends it";

}  // namespace

void TakeInput::execute_messages(bool) {
  live_.reject_messages(in_show_ ? kPlayingError : kReplayingError, in_show_ ? &stop_requested_ : nullptr);
  show().outputs.live().mute_answers(true);
  execute(player_->messages());
}

// The take decides. Ticks requested by a recorded /transport/step are consumed as in the recorded session.
bool TakeInput::advances_time(bool) {
  const bool running = player_->tick().running;
  Transport& transport = show().session->transport;
  if (running && transport.paused()) (void)transport.consume_step();
  return running;
}

void TakeInput::end_handlers(std::uint64_t called) {
  RecordedInput::end_handlers(called);
  show().outputs.live().mute_answers(false);
}

void TakeInput::record(const Message& message, const CommandOrigin& origin, bool evaluate) {
  show().history.record_input(message, origin, evaluate);
}

Outcome TakeInput::rewind(const Transport::RewindRequest& request, const CommandOrigin&) {
  return rewinder_.rewind(request);
}

InputSource::SceneFiles TakeInput::begin_run(TakeSceneRun::Kind kind) {
  const TakeSceneRun* const recorded = player_->consume_run(kind);
  SceneFiles files;
  if (player_->current_scripts()) return files;
  files.fails = recorded == nullptr || !recorded->succeeded;
  if (!files.fails) files.sources = player_->sources(*recorded);
  return files;
}

// A run on another thread is in the take as an input of its own.
bool TakeInput::must_rerun() {
  return player_->current_scripts() ? live_.must_rerun() : player_->next_run_is(TakeSceneRun::Kind::rerun);
}

void TakeInput::end_pass() {
  player_->compare(show().session->world, show().call_log, [this] { return show().state_hash(); });
}

Result<void> TakeInput::accepts_changes() const { return Error{kPlayingError}; }

}  // namespace limber::engine
