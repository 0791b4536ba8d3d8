// Engine: what may not wait (urgent requests), what may not make others wait (handlers), and questions that wait for a
// step.
#include <algorithm>
#include <utility>

#include "engine/engine.h"

namespace limber {

// ahead of all commands that wait
void Engine::execute_urgent(Hands& hands) {
  link_.inbox.drain_urgent(urgent_);
  link_.counters.discarded.fetch_add(link_.inbox.fetch_discarded(), std::memory_order_relaxed);
  if (link_.panic_signal.exchange(false))
    urgent_.push_back({UrgentKind::panic, {"/transport/panic", {}}, {Hand::command_line}, link_.inbox.arrive()});
  for (UrgentRequest& request : urgent_) {
    overtaken_.note(request);
    if (request.kind == UrgentKind::panic && !stage_->world.panic().on()) link_.panics.fetch_add(1);
    if (request.kind == UrgentKind::take_stop) link_.take_stops.fetch_add(1);
    hands.begin(request.origin);
    execute(request.message, request.origin);
  }
}

bool Engine::overtaken(const Message& message, std::uint64_t arrival) {
  if (!overtaken_.discards(message, arrival)) return false;
  link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
  return true;
}

// /get behind a step of the same sender is answered when the step's ticks are made
bool Engine::waits_for_steps(const Message& message, const Origin& origin) {
  if (same_address(message.address, "/transport/step")) {
    const bool known = std::ranges::find(step_origins_, origin) != step_origins_.end();
    if (!known && step_origins_.size() < kMostQuestions) step_origins_.push_back(origin);
    return false;
  }
  if (step_origins_.empty() || stage_->transport.steps() == 0 || !same_address(message.address, "/get")) return false;
  if (std::ranges::find(step_origins_, origin) == step_origins_.end()) return false;
  if (questions_.size() >= kMostQuestions) return false;
  questions_.push_back({message, origin});
  return true;
}

void Engine::answer_questions(Hands& hands) {
  if (stage_->transport.steps() > 0) return;
  step_origins_.clear();
  for (Question& question : std::exchange(questions_, {})) {
    hands.begin(question.origin);
    execute(question.message, question.origin);
  }
}

void Engine::note_event(const TakeEvent& event) {
  const Message message = message_of(event);
  if (recorder_ != nullptr) recorder_->message(message, {});
  history_.note(message, {});
}

// what a replay, or a rewind, has as an input; false: it is a message
bool Engine::carry_out_event(const Message& message) {
  const std::optional<TakeEvent> event = event_of(message);
  if (!event) return false;
  if (event->kind == TakeEvent::Kind::panic_settled) stage_->world.panic().settle();
  if (event->kind == TakeEvent::Kind::heard) hears_ = event->value;
  return true;
}

void Engine::call_handler() {
  HandlerQueue::Entry heard = heard_.pop();
  const bool handled = stage_->scene != nullptr && stage_->scene->message(heard.message, heard.origin);
  if (handled || !heard.unknown || again_) return;
  link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
  refuse(heard.message.address, heard.origin, heard.error);
}

// Messages that find no time in this tick wait, and the number of those that were heard is an input of the tick.
void Engine::call_handlers() {
  Hands hands(stage_->world, presets_, edits_, notes_);
  const bool live = !replays() && !again_;
  const double now = options_.clock();
  if (live) {
    const double passed = std::max(now - std::exchange(handlers_at_, now), 0.0);
    handler_seconds_ = std::min(handler_seconds_ + kHandlerShare * passed, kHandlerSeconds);
  }
  const double until = now + handler_seconds_;
  const auto goes_on = [&](std::uint64_t called) {
    if (!live) return !hears_ || called < *hears_;
    return options_.fast || options_.clock() < until;
  };
  std::uint64_t called = 0;
  while (!heard_.empty() && goes_on(called)) {
    hands.begin(heard_.front().origin);
    call_handler();
    called++;
  }
  hears_.reset();
  answers_taken_ = false;
  if (!live) return;
  handler_seconds_ -= options_.clock() - now;
  if (!heard_.empty()) note_event({TakeEvent::Kind::heard, called});
}

}  // namespace limber
