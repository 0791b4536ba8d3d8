// Lists the network interfaces with getifaddrs(), which is not in POSIX but in Linux, macOS and the BSDs.
#include "base/system/net/interfaces.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <bit>
#include <cstring>
#include <memory>

namespace limber::system {

namespace {

std::uint32_t address_of(const sockaddr& address) {
  sockaddr_in ipv4{};
  std::memcpy(&ipv4, &address, sizeof ipv4);
  return ntohl(ipv4.sin_addr.s_addr);
}

}  // namespace

std::vector<Subnet> connected_subnets() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, &freeifaddrs);
  std::vector<Subnet> subnets;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_netmask == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    if ((each->ifa_flags & static_cast<unsigned>(IFF_UP)) == 0) continue;
    subnets.push_back({address_of(*each->ifa_addr), std::popcount(address_of(*each->ifa_netmask))});
  }
  return subnets;
}

}  // namespace limber::system
