// Evaluator: evaluates Lua in the running scene like `limber console`. The simulation evaluates the text between two
// ticks and the result is available a frame later.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/threads/bounded_queue.h"
#include "engine/output/engine_link.h"

namespace limber::panel {

/// [main]
class Evaluator {
 public:
  struct Response {
    std::uint64_t id = 0;
    Evaluation result;
  };

  /// Requests an evaluation. Returns its id, or 0 if the simulation's queue is full.
  std::uint64_t request(engine::EngineLink& link, std::string text,
                        engine::EvaluationRequest::Action mode = engine::EvaluationRequest::Action::run);
  /// Returns the results since the last call.
  const std::vector<Response>& consume_responses();

 private:
  static constexpr std::size_t kMaxPending = 256;
  // shared with queued evaluations, which may complete after this object is destroyed
  std::shared_ptr<BoundedQueue<Response>> inbox_ = std::make_shared<BoundedQueue<Response>>(kMaxPending);
  std::vector<Response> responses_;
  std::uint64_t last_id_ = 0;
};

}  // namespace limber::panel
