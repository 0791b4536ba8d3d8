// At most ten /error messages a second to one sender, however fast it errs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "osc/endpoint.h"

namespace limber {

/// Counts per sender, for the last 256 senders. [net]
class ErrorLimit {
 public:
  static constexpr int kMost = 10;
  static constexpr std::int64_t kSecond = 1'000'000'000;
  static constexpr std::int64_t kEchoPause = 60 * kSecond;
  static constexpr std::size_t kSenders = 256;

  /// Whether one more may go to this sender; counts it when so. `now` in ns. In no span of a second that begins with
  /// an answer are there more than ten.
  bool allow(const Endpoint& sender, std::int64_t now);
  /// This sender has answered an /error, as far as its message shows. If one went there within the last second, it gets
  /// none for a minute from now on. True: that is new, and is to be reported.
  bool note_echo(const Endpoint& sender, std::int64_t now);

 private:
  struct Window {
    Endpoint sender;
    std::int64_t begin = 0;
    int count = 0;
    std::int64_t silent_until = 0;
    bool echoes = false;
  };
  std::vector<Window> windows_;
};

}  // namespace limber
