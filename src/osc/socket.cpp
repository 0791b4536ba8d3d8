// Thin words over the kernel's.
#include "osc/socket.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <memory>
#include <system_error>

#include <fmt/format.h>

namespace limber {

namespace {

std::string why(int error_number) { return std::generic_category().message(error_number); }

}  // namespace

std::string endpoint_text(const Endpoint& e) {
  return fmt::format("{}.{}.{}.{}:{}", e.ip >> 24, e.ip >> 16 & 255u, e.ip >> 8 & 255u, e.ip & 255u, e.port);
}

sockaddr_in socket_address(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(endpoint.ip);
  address.sin_port = htons(endpoint.port);
  return address;
}

Endpoint endpoint_of(const sockaddr_in& address) { return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)}; }

std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr number{};
  if (inet_pton(AF_INET, text.c_str(), &number) != 1) return std::nullopt;
  return ntohl(number.s_addr);
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

Endpoint Socket::local() const {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (getsockname(fd(), reinterpret_cast<sockaddr*>(&address), &length) != 0) return {};
  return endpoint_of(address);
}

Result<Socket> open_udp(const Endpoint& at) {
  Socket socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.open()) return Error{why(errno)};
  const sockaddr_in address = socket_address(at);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return Error{why(errno)};
  return socket;
}

}  // namespace limber
