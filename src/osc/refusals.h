// Refusals: datagrams that came back because nobody listens where they went. Said, counted, and sent on all the same.
#pragma once

#include <cstdint>
#include <map>

#include "engine/command.h"
#include "osc/socket.h"

namespace limber {

/// Reads what the kernel keeps about datagrams of one socket. [net]
class Refusals {
 public:
  static constexpr std::int64_t kPause = 60'000'000'000;  ///< ns; quiet so long, an end that refuses is said again.
  static constexpr std::size_t kMost = 256;               ///< Ends that are remembered.

  /// Asks the kernel to keep them.
  static void want(int fd);
  /// Whether an error of a send tells of an earlier datagram, perhaps to somebody else: another try sends.
  static bool tells_of_earlier(int error);

  /// Takes what came back since the last call: counts it as unsent, says once who refuses. `now` in ns.
  void take(int fd, Counters& counters, std::int64_t now);

 private:
  void note(const Endpoint& end, int error, std::int64_t now);

  std::map<Endpoint, std::int64_t> last_;
};

}  // namespace limber
