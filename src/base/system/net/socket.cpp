// Sockets of POSIX.
#include "base/system/net/socket.h"

#include <arpa/inet.h>
#include <netdb.h>

#include <array>
#include <memory>

#include <fmt/format.h>

#include "base/system/net/socket_address.h"
#include "base/system/open.h"

namespace limber::system {

std::string endpoint_text(const Endpoint& e) {
  return fmt::format("{}.{}.{}.{}:{}", e.ip >> 24, e.ip >> 16 & 255u, e.ip >> 8 & 255u, e.ip & 255u, e.port);
}

std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr number{};
  if (inet_pton(AF_INET, text.c_str(), &number) != 1) return std::nullopt;
  return ntohl(number.s_addr);
}

bool is_ip_address(const std::string& text) {
  std::array<unsigned char, 16> bytes;
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

Result<Endpoint> resolve(const std::string& host, std::uint16_t port) {
  if (const std::optional<std::uint32_t> ip = parse_ipv4(host)) return Endpoint{*ip, port};
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int fault = getaddrinfo(host.c_str(), nullptr, &hints, &found); fault != 0) {
    return Error{fmt::format("no IPv4 address for '{}' ({})", host, gai_strerror(fault))};
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  return Endpoint{ntohl(address->sin_addr.s_addr), port};
}

Endpoint local_endpoint(int fd) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) return {};
  return endpoint_of(address);
}

Descriptor connect_tcp(const Endpoint& to) {
  Descriptor socket = open_socket(AF_INET, SOCK_STREAM);
  if (!socket.is_open()) return socket;
  set_blocking(socket.fd());
  const sockaddr_in at = socket_address(to);
  if (connect(socket.fd(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) return {};
  return socket;
}

std::ptrdiff_t receive_bytes(int fd, char* to, std::size_t max_bytes) { return recv(fd, to, max_bytes, 0); }

std::ptrdiff_t send_bytes(int fd, std::string_view bytes) { return send(fd, bytes.data(), bytes.size(), kNoSignal); }

}  // namespace limber::system
