// CommandExecutor: the results of messages, and the evaluation of console texts.
#include "engine/commands/command_executor.h"

#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "engine/commands/console_params.h"

namespace limber::engine {

namespace {
// Costs in units of LiveInput::kPassWork: a rejection or an answer, a message to the scene's handlers.
constexpr int kTextWork = 7;
constexpr int kHandlerWork = 3;
constexpr std::size_t kArgumentsPerWork = 16;  // of a long message, such as a frame of motion capture
}  // namespace

CommandExecutor::Execution CommandExecutor::execute(Message& message, const CommandOrigin& origin,
                                                    InputSource& source) {
  Session& session = *show_.session;
  Outcome outcome = session.dispatcher.execute(message);
  const std::optional<Transport::RewindRequest> rewind_request = session.transport.consume_rewind();
  if (rewind_request) {
    outcome = source.rewind(*rewind_request, origin);
  } else {
    source.record(message, origin, false);
  }
  if (outcome.kind == Outcome::Kind::take_request) outcome = source.request_take(message);
  if (outcome.kind == Outcome::Kind::osc_request) outcome = source.request_osc(message, origin);
  if (outcome.kind == Outcome::Kind::midi_request) outcome = source.request_midi(message, origin);
  std::optional<CueRequest> cue_request = session.cue_node.consume_request();
  if (outcome.kind == Outcome::Kind::cue_request) cue_request = {CueRequest::Kind::jump, message.args.front()};
  if (cue_request) outcome = source.request_cue(*cue_request);
  if (source.starts_cue(message) && outcome.kind == Outcome::Kind::unknown) outcome = {};
  report(outcome, message, origin);
  const bool has_handlers = session.scene != nullptr && session.scene->has_handlers();
  const std::size_t work = session.dispatcher.writes().size() + message.args.size() / kArgumentsPerWork;
  Execution execution{static_cast<int>(work), rewind_request.has_value(), outcome.kind == Outcome::Kind::applied};
  if (outcome.kind != Outcome::Kind::applied) execution.work += kTextWork;
  if (has_handlers) execution.work += kHandlerWork;
  if (execution.rewound) return execution;
  if (has_handlers) {
    queue_for_handlers(outcome, message, origin);
  } else if (outcome.kind == Outcome::Kind::unknown) {
    show_.output().report_unknown(message, origin, outcome.error);
  }
  return execution;
}

void CommandExecutor::report(Outcome& outcome, const Message& message, const CommandOrigin& origin) {
  Output& output = show_.output();
  const MessageDispatcher& dispatcher = show_.session->dispatcher;
  if (outcome.kind == Outcome::Kind::scene_request && !output.accepts_scene_requests())
    outcome.kind = Outcome::Kind::rejected;
  if (outcome.clamped != nullptr) {
    output.count(&Counters::clamped);
    output.report_clamped(message, *outcome.clamped);
  }
  if (outcome.sets_override) show_.overrides.add(message);
  if (origin.is_subscriber && outcome.kind == Outcome::Kind::applied) {
    for (const MessageDispatcher::Write& write : dispatcher.writes())
      output.note_write(show_.session->store, origin, write.ref, write.ref.property == outcome.clamped);
  }
  if (!outcome.warning.empty()) output.warn_sender(message, origin, outcome.warning);
  for (Message& answer : outcome.answers) output.push({Outgoing::Destination::reply, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::rejected) output.report_rejected(message, origin, outcome.error);
  if (outcome.kind == Outcome::Kind::scene_request) output.request_scene(message, origin);
}

void CommandExecutor::queue_for_handlers(Outcome& outcome, Message& message, const CommandOrigin& origin) {
  const bool unknown = outcome.kind == Outcome::Kind::unknown;
  const bool fits = show_.handler_queue.push({std::move(message), origin, unknown, std::move(outcome.error)},
                                             !show_.rules.before_first_revision);
  if (!fits) show_.output().count(&Counters::unheard);
}

// Scene parameters that the text sets become overrides, except in replays of older takes.
Evaluation CommandExecutor::evaluate_text(std::string_view text) {
  script::Scene& scene = *show_.session->scene;
  const ConsoleParams console_params(show_.session->store, scene.params());
  Evaluation result = scene.evaluate(text);
  if (show_.rules.keeps_timers) console_params.add_to(show_.overrides);
  return result;
}

void CommandExecutor::evaluate(const EvaluationRequest& request, const CommandOrigin& origin, InputSource& source) {
  Evaluation result{Evaluation::Kind::error, "there is no scene to evaluate in"};
  const std::uint64_t before = log_newest();
  if (request.text.size() > kMaxEvaluatedBytes) {
    result.text = fmt::format("the text must have at most {} bytes, got {}", kMaxEvaluatedBytes, request.text.size());
  } else if (show_.session->scene != nullptr && request.action == EvaluationRequest::Action::run) {
    source.record({request.text, {}}, origin, true);
    result = evaluate_text(request.text);
  } else if (show_.session->scene != nullptr) {
    result = show_.session->scene->complete(request.text);
  }
  result.log_before = before;
  result.log_after = log_newest();
  request.on_result(std::move(result));
}

}  // namespace limber::engine
