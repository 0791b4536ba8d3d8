// Evaluator: runs a scene with given parameters and a seed, as `limber play --fast` does, and computes its results.
// [one thread]
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "engine/engine_options.h"
#include "experiments/evaluation.h"

namespace limber::engine {
class Engine;
struct EngineLink;
}  // namespace limber::engine

namespace limber::app {

/// Takes the messages that a run has sent and returns the first script error among them; empty: there is none.
std::string script_error(engine::EngineLink& link);

class Evaluator {
 public:
  /// Runs the scene's file once to read its parameters and results. Fails with the scene's error if its script fails.
  Result<experiments::SceneInfo> set_up(experiments::WorkerSetup setup);
  /// Simulates. Requires a successful set_up(). The state hash is that of `limber play` with the same values.
  experiments::Outcome evaluate(const experiments::Evaluation& evaluation);
  /// Returns the options of an engine that plays an evaluation in real time, without an end. Requires a successful
  /// set_up().
  engine::EngineOptions options_to_play(const experiments::Evaluation& evaluation) const;

 private:
  engine::EngineOptions options_of(const experiments::Evaluation& evaluation) const;

  experiments::WorkerSetup setup_;
  experiments::SceneInfo scene_;
  std::vector<const experiments::ParameterInfo*> parameters_;  // of each value of an evaluation
};

}  // namespace limber::app
