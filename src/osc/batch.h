// Sending many datagrams to one address with few system calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "osc/socket.h"

namespace limber {

/// What came of a batch.
struct BatchResult {
  std::size_t sent = 0;  ///< Datagrams.
  int error = 0;         ///< errno of the first that was not sent; the rest was not tried. 0: all were sent.
};

/// Sends datagrams of these sizes that stand one behind the other in `bytes`. Runs of equal size go to the kernel as
/// one piece that it cuts (UDP segmentation), as long as `segmentation` is true; it is made false where the route
/// can't. [net]
BatchResult send_batch(int fd, const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                       bool& segmentation);

}  // namespace limber
