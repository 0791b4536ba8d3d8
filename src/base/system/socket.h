// IPv4 endpoints, and bytes through connected sockets.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

/// An IPv4 address and port, both in host order.
struct Endpoint {
  std::uint32_t ip = 0;
  std::uint16_t port = 0;

  auto operator<=>(const Endpoint&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm of clang-tidy 14
};

/// "127.0.0.1:9003". [any]
std::string endpoint_text(const Endpoint& endpoint);

/// "192.168.1.7" in host order; nothing for anything else. [any]
std::optional<std::uint32_t> parse_ipv4(const std::string& text);
/// Whether it is an IPv4 or IPv6 address, without brackets or port. [any]
bool is_ip_address(const std::string& text);

/// Looks up a host: numbers at once, names by the system's resolver, which may take seconds. `port` is carried over.
/// [any]
Result<Endpoint> resolve(const std::string& host, std::uint16_t port);

/// A blocking TCP connection; closed: errno says why there is none. [any]
Descriptor connect_tcp(const Endpoint& to);

/// Bytes received or sent through a connected socket, or one datagram; 0: the other end has closed; -1: errno says why
/// (EAGAIN: a socket that does not block takes or has none now). [any]
std::ptrdiff_t receive_bytes(int fd, char* to, std::size_t most);
std::ptrdiff_t send_bytes(int fd, std::string_view bytes);

}  // namespace limber::system
