// UnreachableTargets: logs targets that the system reports as unreachable. Sending to them continues.
#pragma once

#include <cstdint>
#include <map>

#include "base/system/net/udp_socket.h"
#include "engine/commands/command.h"
#include "net/osc/endpoint.h"

namespace limber::osc {

/// Reads the failures that the system reports for one sender's datagrams. [net]
class UnreachableTargets {
 public:
  /// ns without failures after which a target is logged again.
  static constexpr std::int64_t kQuietPeriod = 60'000'000'000;
  static constexpr std::size_t kMaxTargets = 256;  ///< Maximum number of remembered targets.

  /// Handles the failures reported since the last call: counts each as unsent and logs each target once. `now` in ns.
  void poll(system::UdpSender& sender, engine::Counters& counters, std::int64_t now);

 private:
  void record(const Endpoint& target, int error, std::int64_t now);

  std::map<Endpoint, std::int64_t> last_failure_;
};

}  // namespace limber::osc
