// The network interfaces of this machine.
#pragma once

#include <vector>

#include "base/system/net/ip_address.h"

namespace limber::system {

/// An address of this machine, with the length of its network prefix.
struct Subnet {
  IpAddress ip = {};
  int bits = 0;

  /// The address that reaches all machines of an IPv4 network; that of the machine itself for IPv6 and loopback.
  IpAddress broadcast() const;
};

/// Returns the addresses of all interfaces that are up, including loopback; empty on error. [any]
std::vector<Subnet> connected_subnets();

}  // namespace limber::system
