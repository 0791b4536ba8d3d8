// RecordedInput: messages, console texts and events of a pass.
#include "engine/input/recorded_input.h"

#include <utility>

namespace limber::engine {

void RecordedInput::execute(std::span<InputRecord> inputs) {
  EditScope edit_scope = show_.edit_scope();
  handler_calls_.reset();
  for (InputRecord& input : inputs) {
    if (!input.evaluate && execute_event(input.message)) {
      record(input.message, input.origin, false);
      continue;
    }
    edit_scope.begin(input.origin);
    if (input.evaluate) {
      EvaluationRequest request;
      request.text = std::move(input.message.address);
      executor_.evaluate(request, input.origin, *this);
    } else {
      executor_.execute(input.message, input.origin, *this);
    }
  }
}

// Executes an internal event. Returns false for an ordinary message.
bool RecordedInput::execute_event(const Message& message) {
  if (std::optional<CueState> cue = cue_state_of(message)) {
    show_.set_cue_state(std::move(*cue));
    return true;
  }
  const std::optional<TakeEvent> event = event_of(message);
  if (!event) return false;
  if (event->kind == TakeEvent::Kind::panic_settled) show_.session->world.panic().end_first_second();
  if (event->kind == TakeEvent::Kind::messages_handled) handler_calls_ = event->value;
  return true;
}

}  // namespace limber::engine
