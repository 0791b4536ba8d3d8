// Lists the network interfaces with getifaddrs(), which is not in POSIX but in Linux, macOS and the BSDs.
#include "base/system/net/interfaces.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <bit>
#include <cstring>
#include <memory>

#include "base/system/net/socket_address.h"

namespace limber::system {

namespace {

// Number of leading bits of a mask.
int prefix_length(const sockaddr& mask, bool is_v6) {
  sockaddr_in6 copy{};
  if (!is_v6) {
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, &mask, sizeof ipv4);
    return std::popcount(ipv4.sin_addr.s_addr);
  }
  std::memcpy(&copy, &mask, sizeof copy);
  int bits = 0;
  for (const unsigned char byte : copy.sin6_addr.s6_addr) bits += std::popcount(byte);
  return bits;
}

}  // namespace

IpAddress Subnet::broadcast() const {
  if (ip.is_v6 || ip.is_loopback() || bits >= 31) return ip;
  return static_cast<std::uint32_t>(ip.low) | ~std::uint32_t{0} >> bits;
}

std::vector<Subnet> connected_subnets() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, &freeifaddrs);
  std::vector<Subnet> subnets;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_netmask == nullptr) continue;
    if ((each->ifa_flags & static_cast<unsigned>(IFF_UP)) == 0) continue;
    const int family = each->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    subnets.push_back(
        {SocketAddress(*each->ifa_addr).endpoint().ip, prefix_length(*each->ifa_netmask, family == AF_INET6)});
  }
  return subnets;
}

}  // namespace limber::system
