// A command with an answer.
#include "gui/evaluator.h"

#include <utility>

namespace limber {

std::uint64_t Evaluator::ask(EngineLink& link, std::string text, Evaluate::Wish wish) {
  auto evaluate = std::make_shared<Evaluate>();
  const std::uint64_t id = ++asked_;
  evaluate->wish = wish;
  evaluate->text = std::move(text);
  evaluate->answer = [id, inbox = inbox_](const Evaluation& said) { inbox->push({id, said}); };
  const bool pushed = link.inbox.push({{}, Origin{Hand::panel, 0, 0, false}, std::move(evaluate)});
  link.wake_engine();
  return pushed ? id : 0;
}

const std::vector<Evaluator::Answer>& Evaluator::answers() {
  inbox_->drain(heard_);
  return heard_;
}

}  // namespace limber
