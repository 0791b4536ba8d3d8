// The loop of a worker process.
#include "app/experiments/worker.h"

#include <new>
#include <optional>
#include <string>
#include <variant>

#include "app/exit_code.h"
#include "app/experiments/evaluator.h"
#include "app/experiments/input_lines.h"
#include "base/log/output.h"
#include "base/system/signals.h"

namespace limber::app {

namespace {

using experiments::Answer;
using experiments::Evaluation;
using experiments::Outcome;
using experiments::Request;
using experiments::WorkerFault;
using experiments::WorkerSetup;

Answer answer(Evaluator& evaluator, const Request& request) {
  if (const auto* setup = std::get_if<WorkerSetup>(&request)) {
    Result<experiments::SceneInfo> scene = evaluator.set_up(*setup);
    if (!scene) return WorkerFault{scene.error()};
    return *scene;
  }
  const auto& evaluation = std::get<Evaluation>(request);
  try {
    return evaluator.evaluate(evaluation);
  } catch (const std::bad_alloc&) {
    return Outcome{evaluation.number, {}, 0, "not enough memory for the scene"};
  }
}

}  // namespace

int run_worker() {
  system::block_signals();
  start_output(OutputMode::batch);
  Evaluator evaluator;
  InputLines lines;
  while (const std::optional<std::string> line = lines.next()) {
    const std::optional<Request> request = experiments::decode_request(*line);
    if (!request) return fail(kUsageError, "not an evaluation");
    if (!write_result(experiments::encode(answer(evaluator, *request)) + "\n")) break;
  }
  return kSuccess;
}

}  // namespace limber::app
