// Sockets of POSIX.
#include "base/system/net/socket.h"

#include <netdb.h>

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/system/net/socket_address.h"
#include "base/system/open.h"
#include "base/text.h"

namespace limber::system {

std::string endpoint_text(const Endpoint& e) { return host_port_text(ip_text(e.ip), e.port); }

bool is_host_text(std::string_view text) {
  return !text.empty() && printable(text) == text && text.find_first_of(" \n\t") == std::string_view::npos;
}

Result<Endpoint> resolve(const std::string& host, std::uint16_t port, IpVersion preferred) {
  if (const std::optional<IpAddress> ip = parse_ip(host)) return Endpoint{*ip, port};
  if (is_ip_address(host))
    return Error{fmt::format("there is no network interface '{}'", host.substr(host.find('%') + 1))};
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int fault = getaddrinfo(host.c_str(), nullptr, &hints, &found); fault != 0) {
    return Error{fmt::format("no address for '{}' ({})", host, gai_strerror(fault))};
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  std::optional<IpAddress> chosen;
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
    if (each->ai_family != AF_INET && each->ai_family != AF_INET6) continue;
    const IpAddress ip = SocketAddress(*each->ai_addr).endpoint().ip;
    const bool fits = ip.is_v6 == (preferred == IpVersion::v6);
    if (!chosen || fits) chosen = ip;
    if (fits) break;
  }
  if (!chosen) return Error{fmt::format("no address for '{}'", host)};
  return Endpoint{*chosen, port};
}

Endpoint local_endpoint(int fd) {
  SocketAddress address;
  if (getsockname(fd, address.get(), address.receive_length()) != 0) return {};
  return address.endpoint();
}

Descriptor connect_tcp(const Endpoint& to) {
  const SocketAddress at(to);
  Descriptor socket = open_socket(at.family(), SOCK_STREAM);
  if (!socket.is_open()) return socket;
  set_blocking(socket.fd());
  if (connect(socket.fd(), at.get(), at.length()) != 0) return {};
  return socket;
}

std::ptrdiff_t receive_bytes(int fd, char* to, std::size_t max_bytes) { return recv(fd, to, max_bytes, 0); }

std::ptrdiff_t send_bytes(int fd, std::string_view bytes) { return send(fd, bytes.data(), bytes.size(), kNoSignal); }

}  // namespace limber::system
