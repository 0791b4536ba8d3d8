// Refusals: datagrams that came back because nobody listens where they went. Said, counted, and sent on all the same.
#pragma once

#include <cstdint>
#include <map>

#include "base/system/udp_socket.h"
#include "engine/command.h"
#include "osc/endpoint.h"

namespace limber {

/// Reads what the system reports about datagrams of one sender. [net]
class Refusals {
 public:
  static constexpr std::int64_t kPause = 60'000'000'000;  ///< ns; quiet so long, an end that refuses is said again.
  static constexpr std::size_t kMost = 256;               ///< Ends that are remembered.

  /// Takes what came back since the last call: counts it as unsent, says once who refuses. `now` in ns.
  void take(system::UdpSender& sender, Counters& counters, std::int64_t now);

 private:
  void note(const Endpoint& end, int error, std::int64_t now);

  std::map<Endpoint, std::int64_t> last_;
};

}  // namespace limber
