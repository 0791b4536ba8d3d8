// The network interfaces of this machine.
#pragma once

#include <cstdint>
#include <vector>

namespace limber::system {

/// An IPv4 address of this machine, in host byte order, with the length of its network prefix.
struct Subnet {
  std::uint32_t ip = 0;
  int bits = 0;
};

/// Returns the addresses of all interfaces that are up, including loopback; empty on error. [any]
std::vector<Subnet> connected_subnets();

}  // namespace limber::system
