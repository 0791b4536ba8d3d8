// The networks that this machine is connected to.
#pragma once

#include <cstdint>
#include <vector>

namespace limber::system {

/// An IPv4 address of this machine, in host order, with the length of its network's prefix.
struct Subnet {
  std::uint32_t ip = 0;
  int bits = 0;
};

/// Of every interface that is up, loopback included. Empty when the system gives no list. [any]
std::vector<Subnet> connected_subnets();

}  // namespace limber::system
