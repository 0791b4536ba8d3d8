// CueRunner: the execution of cues.
#include "engine/cues/cue_runner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber::engine {

Outcome CueRunner::request(const CueRequest& request) {
  if (running_) return Outcome::rejected("a cue can't control the cue list; set follow to continue with the next cue");
  const CuePlayer& cues = show_.cues;
  if (request.kind == CueRequest::Kind::pause) {
    requested_pause_ = request.value.is_numeric() ? request.value.number != 0 : !cues.state().paused;
    return {};
  }
  const Result<std::size_t> index = cues.target(request);
  if (!index) return Outcome::rejected(index.error());
  requested_cue_ = *index;
  return {};
}

bool CueRunner::starts(const Message& message) {
  const CuePlayer& cues = show_.cues;
  const std::uint32_t next = cues.position();
  if (running_ || next >= cues.list()->size()) return false;
  const std::string& when = (*cues.list())[next].when;
  if (when.empty() || !same_address(message.address, when)) return false;
  const bool released = !message.args.empty() && message.args[0].is_numeric() && message.args[0].number == 0;
  if (!released) requested_cue_ = next;
  return true;
}

int CueRunner::run_requested(InputSource& source) {
  if (const std::optional<bool> pause = std::exchange(requested_pause_, std::nullopt)) {
    CueState state = show_.cues.state();
    state.paused = *pause;
    set_state(std::move(state), source);
  }
  const std::optional<std::size_t> cue = std::exchange(requested_cue_, std::nullopt);
  return cue ? start(*cue, source) : 0;
}

void CueRunner::run_due(bool may_step, EditScope& edit_scope, InputSource& source) {
  Session& session = *show_.session;
  const bool steps = may_step && (!session.transport.paused() || session.transport.steps() > 0);
  if (!steps || session.world.panic().on()) return;
  const std::uint32_t waiting = show_.cues.state().waiting;
  const bool waits = waiting > 0 && waiting <= show_.cues.list()->size();  // the file may have become shorter
  if (waits && beat_reached((*show_.cues.list())[waiting - 1].at)) {
    edit_scope.begin({CommandSource::script});
    run(waiting - 1, source);
  } else if (show_.cues.due() || show_.cues.begins(session.world.time())) {
    edit_scope.begin({CommandSource::script});
    start(show_.cues.position(), source);
  }
}

bool CueRunner::beat_reached(CueStart at) const {
  const sim::BeatClock& clock = show_.session->world.behaviors().clock();
  return at == CueStart::now || clock.reached(at == CueStart::beat ? 1 : clock.beats_per_bar());
}

// Runs a cue, or lets it wait for its beat; the second request for a cue that waits runs it at once.
int CueRunner::start(std::size_t index, InputSource& source) {
  const std::uint32_t number = static_cast<std::uint32_t>(index) + 1;
  if (beat_reached((*show_.cues.list())[index].at) || show_.cues.state().waiting == number) return run(index, source);
  CueState state = show_.cues.state();
  state.waiting = number;
  state.ticks.reset();
  set_state(std::move(state), source);
  return 1;
}

int CueRunner::run(std::size_t index, InputSource& source) {
  const Cue& cue = (*show_.cues.list())[index];
  CueState state{static_cast<std::uint32_t>(index) + 1, cue.name, {}, false};
  if (cue.follow) {
    const double ticks = std::round(*cue.follow / show_.session->world.timestep());
    state.ticks = static_cast<std::uint32_t>(std::clamp(ticks, 1.0, 1e9));
  }
  set_state(std::move(state), source);
  // not that of the request, whose sender doesn't know the values that the cue sets
  const CommandOrigin origin{CommandSource::script};
  running_ = true;
  int work = 1;
  for (Message& message : messages_of(cue)) work += 1 + executor_.execute(message, origin, source).work;
  running_ = false;
  return work;
}

// Sets the state, and records it as an input of the pass.
void CueRunner::set_state(CueState state, InputSource& source) {
  source.record(message_of(state), {}, false);
  show_.set_cue_state(std::move(state));
}

}  // namespace limber::engine
