// UDP sockets of POSIX: single datagrams.
#include "base/system/net/udp_socket.h"

#include <net/if.h>

#include <cerrno>
#include <memory>
#include <system_error>

#include "base/system/net/socket_address.h"
#include "base/system/open.h"

namespace limber::system {

Endpoint UdpSocket::local() const { return local_endpoint(fd()); }

namespace {

Error system_error() { return Error{std::generic_category().message(errno)}; }

Result<UdpSocket> open_bound(const Endpoint& at, PortSharing sharing) {
  const SocketAddress address(at);
  UdpSocket socket(open_socket(address.family(), SOCK_DGRAM));
  if (!socket.is_open()) return system_error();
  if (at.ip.is_v6) enable(socket.fd(), IPPROTO_IPV6, IPV6_V6ONLY);
  if (sharing == PortSharing::shared) enable(socket.fd(), SOL_SOCKET, SO_REUSEADDR);
  if (bind(socket.fd(), address.get(), address.length()) != 0) return system_error();
  return socket;
}

// Both return true if the interface has joined, also earlier: it may have several addresses.
bool join(int fd, const IpAddress& group, const IpAddress& interface) {
  ip_mreq request{};
  request.imr_multiaddr.s_addr = htonl(static_cast<std::uint32_t>(group.low));
  request.imr_interface.s_addr = htonl(static_cast<std::uint32_t>(interface.low));
  return setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0 || errno == EADDRINUSE;
}

bool join(int fd, const ipv6_mreq& request) {
  return setsockopt(fd, IPPROTO_IPV6, IPV6_JOIN_GROUP, &request, sizeof request) == 0 || errno == EADDRINUSE;
}

bool join_ipv6(int fd, const IpAddress& group) {
  ipv6_mreq request{};
  request.ipv6mr_multiaddr = SocketAddress(Endpoint{group, 0}).ipv6();
  request.ipv6mr_interface = group.zone;
  if (group.zone != 0) return join(fd, request);
  const std::unique_ptr<struct if_nameindex[], decltype(&if_freenameindex)> list(if_nameindex(), &if_freenameindex);
  bool joined = false;
  for (std::size_t i = 0; list != nullptr && list[i].if_index != 0; i++) {
    request.ipv6mr_interface = list[i].if_index;
    joined = join(fd, request) || joined;
  }
  return joined;
}

}  // namespace

Result<UdpSocket> open_udp(const Endpoint& at, PortSharing sharing) {
  Result<UdpSocket> socket = open_bound(at, sharing);
  // else a shared port receives the groups that other sockets have joined
  [[maybe_unused]] const int off = 0;
#ifdef IP_MULTICAST_ALL
  if (socket && sharing == PortSharing::shared && !at.ip.is_v6)
    setsockopt(socket->fd(), IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off);
#endif
#ifdef IPV6_MULTICAST_ALL
  if (socket && sharing == PortSharing::shared && at.ip.is_v6)
    setsockopt(socket->fd(), IPPROTO_IPV6, IPV6_MULTICAST_ALL, &off, sizeof off);
#endif
  return socket;
}

Result<UdpSocket> open_multicast(const Endpoint& group, std::span<const IpAddress> interfaces) {
  Result<UdpSocket> socket = open_bound(group, PortSharing::shared);
  if (!socket) return socket;
  errno = ENODEV;
  bool joined = group.ip.is_v6 && join_ipv6(socket->fd(), group.ip);
  for (const IpAddress& interface : interfaces) {
    if (!group.ip.is_v6 && !interface.is_v6) joined = join(socket->fd(), group.ip, interface) || joined;
  }
  if (!joined) return system_error();
  return socket;
}

void set_send_buffer(int fd, int bytes) { setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes); }

void allow_broadcast(int fd) { enable(fd, SOL_SOCKET, SO_BROADCAST); }

void send_multicast_from(int fd, std::uint32_t ip) {
  const unsigned char routers = 8;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &routers, sizeof routers);
  in_addr address{};
  address.s_addr = htonl(ip);
  if (ip != 0) setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &address, sizeof address);
}

bool may_report_earlier_datagram(int error) {
  return error == ECONNREFUSED || error == EHOSTUNREACH || error == ENETUNREACH;
}

int send_datagram(int fd, const Endpoint& to, std::span<const char> packet) {
  const SocketAddress address(to);
  const auto send = [&] {
    return sendto(fd, packet.data(), packet.size(), MSG_DONTWAIT | kNoSignal, address.get(), address.length()) >= 0;
  };
  return send() || (may_report_earlier_datagram(errno) && send()) ? 0 : errno;
}

}  // namespace limber::system
