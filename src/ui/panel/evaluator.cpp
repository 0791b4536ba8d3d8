// Sends an evaluation as a command with a callback for the result.
#include "ui/panel/evaluator.h"

#include <utility>

namespace limber::panel {

std::uint64_t Evaluator::request(engine::EngineLink& link, std::string text, engine::EvaluationRequest::Action mode) {
  auto evaluate = std::make_shared<engine::EvaluationRequest>();
  const std::uint64_t id = ++last_id_;
  evaluate->action = mode;
  evaluate->text = std::move(text);
  evaluate->on_result = [id, inbox = inbox_](const Evaluation& result) { inbox->push({id, result}); };
  const bool pushed =
      link.command_queue.push({{}, CommandOrigin{CommandSource::panel, 0, 0, false}, std::move(evaluate)});
  link.wake_engine();
  return pushed ? id : 0;
}

const std::vector<Evaluator::Response>& Evaluator::consume_responses() {
  inbox_->drain(responses_);
  return responses_;
}

}  // namespace limber::panel
