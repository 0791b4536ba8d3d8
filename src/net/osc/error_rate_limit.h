// Limits /error messages to ten per second and sender.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "net/osc/endpoint.h"

namespace limber::osc {

/// Counts per sender, for the last 256 senders. [net]
class ErrorRateLimit {
 public:
  static constexpr int kMaxPerSecond = 10;
  static constexpr std::int64_t kSecond = 1'000'000'000;  ///< ns
  /// How long a sender that answers /error messages gets none.
  static constexpr std::int64_t kAnswerPause = 60 * kSecond;
  static constexpr std::size_t kMaxSenders = 256;

  /// Counts an /error message for this sender and returns true if it may be sent. No second that begins with an /error
  /// contains more than ten. `now` in ns.
  bool allow(const Endpoint& sender, std::int64_t now);
  /// Records that this sender seems to have answered an /error. If one was sent there within the last second, it gets
  /// none for a minute. Returns true the first time, which is to be logged.
  bool record_answer(const Endpoint& sender, std::int64_t now);

 private:
  struct Window {
    Endpoint sender;
    std::int64_t begin = 0;
    int count = 0;
    std::int64_t silent_until = 0;
    bool answers_errors = false;
  };
  std::vector<Window> windows_;
};

}  // namespace limber::osc
