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

int CueRunner::run_requested(const CommandOrigin& origin, InputSource& source) {
  if (const std::optional<bool> pause = std::exchange(requested_pause_, std::nullopt)) {
    CueState state = show_.cues.state();
    state.paused = *pause;
    set_state(std::move(state), source);
  }
  const std::optional<std::size_t> cue = std::exchange(requested_cue_, std::nullopt);
  return cue ? run(*cue, origin, source) : 0;
}

void CueRunner::run_due(bool may_step, EditScope& edit_scope, InputSource& source) {
  Session& session = *show_.session;
  const bool steps = may_step && (!session.transport.paused() || session.transport.steps() > 0);
  if (!show_.cues.due() || !steps || session.world.panic().on()) return;
  const CommandOrigin origin{CommandSource::script};
  edit_scope.begin(origin);
  run(show_.cues.position(), origin, source);
}

int CueRunner::run(std::size_t index, CommandOrigin origin, InputSource& source) {
  const Cue& cue = (*show_.cues.list())[index];
  CueState state{static_cast<std::uint32_t>(index) + 1, cue.name, {}, false};
  if (cue.follow) {
    const double ticks = std::round(*cue.follow / show_.session->world.timestep());
    state.ticks = static_cast<std::uint32_t>(std::clamp(ticks, 1.0, 1e9));
  }
  set_state(std::move(state), source);
  origin.is_subscriber = false;  // its sender doesn't know the values that the cue sets, so it must receive them
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
