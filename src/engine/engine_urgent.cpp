// Engine: urgent requests, handlers (osc:on) with their time budget, and queries that wait for a /transport/step.
#include <algorithm>
#include <utility>

#include "engine/engine.h"

namespace limber {

// Executes urgent requests ahead of all queued commands.
void Engine::execute_urgent(EditScope& edit_scope) {
  link_.command_queue.drain_urgent(urgent_);
  link_.counters.discarded.fetch_add(link_.command_queue.fetch_discarded(), std::memory_order_relaxed);
  if (link_.panic_signal.exchange(false))
    urgent_.push_back({UrgentKind::panic,
                       {"/transport/panic", {}},
                       {CommandSource::command_line},
                       link_.command_queue.next_arrival()});
  for (UrgentRequest& request : urgent_) {
    urgent_precedence_.record(request);
    if (request.kind == UrgentKind::panic && !session_->world.panic().on()) link_.panics.fetch_add(1);
    if (request.kind == UrgentKind::take_stop) link_.take_stops.fetch_add(1);
    edit_scope.begin(request.origin);
    execute(request.message, request.origin);
  }
}

bool Engine::discard_if_overtaken(const Message& message, std::uint64_t arrival) {
  if (!urgent_precedence_.discards(message, arrival)) return false;
  link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
  return true;
}

// Postpones a /get after a /transport/step of the same sender until the ticks of the step are done.
bool Engine::postpone_query(const Message& message, const CommandOrigin& origin) {
  if (same_address(message.address, "/transport/step")) {
    const bool known = std::ranges::find(step_origins_, origin) != step_origins_.end();
    if (!known && step_origins_.size() < kMaxQueries) step_origins_.push_back(origin);
    return false;
  }
  if (step_origins_.empty() || session_->transport.steps() == 0 || !same_address(message.address, "/get")) return false;
  if (std::ranges::find(step_origins_, origin) == step_origins_.end()) return false;
  if (pending_queries_.size() >= kMaxQueries) return false;
  pending_queries_.push_back({message, origin});
  return true;
}

void Engine::answer_pending_queries(EditScope& edit_scope) {
  if (session_->transport.steps() > 0) return;
  step_origins_.clear();
  for (PendingQuery& query : std::exchange(pending_queries_, {})) {
    edit_scope.begin(query.origin);
    execute(query.message, query.origin);
  }
}

void Engine::record_event(const TakeEvent& event) {
  const Message message = message_of(event);
  if (recorder_ != nullptr) recorder_->record_message(message, {});
  history_.record_input(message, {});
}

// Executes an internal event that a take or a rewind has recorded as input. Returns false for an ordinary message.
bool Engine::execute_event(const Message& message) {
  const std::optional<TakeEvent> event = event_of(message);
  if (!event) return false;
  if (event->kind == TakeEvent::Kind::panic_settled) session_->world.panic().end_first_second();
  if (event->kind == TakeEvent::Kind::messages_handled) replayed_handler_calls_ = event->value;
  return true;
}

void Engine::call_handler() {
  HandlerQueue::Entry entry = handler_queue_.pop();
  const bool handled = session_->scene != nullptr && session_->scene->handle_message(entry.message, entry.origin);
  if (handled || !entry.unknown || resimulating_) return;
  link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
  send_error(entry.message.address, entry.origin, entry.error);
}

// Calls handlers until the queue is empty or the time budget is spent; the rest waits for the next pass. The number of
// calls depends on real time, so it is recorded as an input of the tick.
void Engine::call_handlers() {
  EditScope edit_scope(session_->world, presets_, undo_stack_, change_recorder_);
  const bool live = !is_replaying() && !resimulating_;
  const double now = options_.clock();
  if (live) {
    const double elapsed = std::max(now - std::exchange(handlers_time_, now), 0.0);
    handler_budget_ = std::min(handler_budget_ + kHandlerShare * elapsed, kHandlerSeconds);
  }
  const double until = now + handler_budget_;
  const auto may_continue = [&](std::uint64_t called) {
    if (!live) return !replayed_handler_calls_ || called < *replayed_handler_calls_;
    return options_.fast || options_.clock() < until;
  };
  std::uint64_t called = 0;
  while (!handler_queue_.empty() && may_continue(called)) {
    edit_scope.begin(handler_queue_.front().origin);
    call_handler();
    called++;
  }
  replayed_handler_calls_.reset();
  suppress_answers_ = false;
  if (!live) return;
  handler_budget_ -= options_.clock() - now;
  if (!handler_queue_.empty()) record_event({TakeEvent::Kind::messages_handled, called});
}

}  // namespace limber
