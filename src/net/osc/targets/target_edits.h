// TargetEdits: changes of the targets while the show plays, by messages. They persist through resets and other scenes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"
#include "base/threads/bounded_queue.h"
#include "net/osc/options.h"

namespace limber::osc {

/// [net], unless noted otherwise.
class TargetEdits {
 public:
  static constexpr std::size_t kMaxTargets = 64;  ///< Maximum number of targets that messages add.

  struct Request {
    Message message;
    CommandOrigin origin;
    friend std::size_t weight_of(const Request& request) { return engine::weight_of(request.message); }
  };
  /// Validates a message and queues it. The error is about its text, or the queue is full. [any]
  Result<void> push(const Message& message, const CommandOrigin& origin);
  /// Returns the queued requests; valid until the next call.
  const std::vector<Request>& drain() {
    queue_.drain(batch_);
    return batch_;
  }

  /// Changes the list of edits by a message that push() has accepted. `current`: the targets with all earlier edits.
  Result<void> execute(const Message& message, const std::vector<StreamTarget>& current);
  /// Returns the targets with the edits.
  std::vector<StreamTarget> applied_to(std::vector<StreamTarget> targets) const;

 private:
  /// A target that was added or changed, or removed.
  struct Edit {
    StreamTarget target;
    bool removed = false;
  };
  static bool same_endpoint(const StreamTarget& a, const StreamTarget& b) {
    return a.host == b.host && a.port == b.port;
  }
  void set(Edit edit);

  BoundedQueue<Request> queue_{1024, std::size_t{1} << 20};
  std::vector<Request> batch_;
  std::vector<Edit> edits_;
};

/// Returns the targets, one per line, for display.
std::string targets_text(const std::vector<StreamTarget>& targets);

}  // namespace limber::osc
