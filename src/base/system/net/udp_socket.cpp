// UDP sockets of POSIX: single datagrams.
#include "base/system/net/udp_socket.h"

#include <cerrno>
#include <system_error>

#include "base/system/net/socket_address.h"
#include "base/system/open.h"

namespace limber::system {

Endpoint UdpSocket::local() const { return local_endpoint(fd()); }

Result<UdpSocket> open_udp(const Endpoint& at) {
  const auto system_error = [] { return Error{std::generic_category().message(errno)}; };
  UdpSocket socket(open_socket(AF_INET, SOCK_DGRAM));
  if (!socket.is_open()) return system_error();
  const sockaddr_in address = socket_address(at);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return system_error();
  return socket;
}

Result<UdpSocket> open_multicast(const Endpoint& group, std::span<const std::uint32_t> interfaces) {
  const auto system_error = [] { return Error{std::generic_category().message(errno)}; };
  UdpSocket socket(open_socket(AF_INET, SOCK_DGRAM));
  if (!socket.is_open()) return system_error();
  const int on = 1;
  setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const sockaddr_in address = socket_address(group);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return system_error();
  errno = ENODEV;
  bool joined = false;
  for (const std::uint32_t interface : interfaces) {
    ip_mreq request{};
    request.imr_multiaddr = address.sin_addr;
    request.imr_interface.s_addr = htonl(interface);
    // an interface with several addresses has joined already
    const bool done = setsockopt(socket.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0;
    joined = joined || done || errno == EADDRINUSE;
  }
  if (!joined) return system_error();
  return socket;
}

void set_send_buffer(int fd, int bytes) { setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes); }

void allow_broadcast(int fd) {
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
}

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
  const sockaddr_in address = socket_address(to);
  const auto send = [&] {
    const auto* where = reinterpret_cast<const sockaddr*>(&address);
    return sendto(fd, packet.data(), packet.size(), MSG_DONTWAIT | kNoSignal, where, sizeof address) >= 0;
  };
  return send() || (may_report_earlier_datagram(errno) && send()) ? 0 : errno;
}

}  // namespace limber::system
