// IPv4 endpoints, name resolution, TCP connections, and I/O on connected sockets.
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

/// An IPv4 address and port, both in host byte order.
struct Endpoint {
  std::uint32_t ip = 0;
  std::uint16_t port = 0;

  auto operator<=>(const Endpoint&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm of clang-tidy 14
};

/// Returns "127.0.0.1:9003". [any]
std::string endpoint_text(const Endpoint& endpoint);

/// Parses an address such as "192.168.1.7", to host byte order; nullopt if it is invalid. [any]
std::optional<std::uint32_t> parse_ipv4(const std::string& text);
/// True for an IPv4 or IPv6 address without brackets or port. [any]
bool is_ip_address(const std::string& text);

/// Resolves a host: an address immediately, a name with the system's resolver, which may take seconds. The result has
/// this port. [any]
Result<Endpoint> resolve(const std::string& host, std::uint16_t port);

/// Returns the endpoint that a socket is bound to. [any]
Endpoint local_endpoint(int fd);

/// Opens a blocking TCP connection. Returns a closed descriptor on error, with errno set. [any]
Descriptor connect_tcp(const Endpoint& to);

/// Receive from or send to a connected socket (a datagram socket: one datagram). Return the number of bytes, 0 if the
/// peer has closed, or -1 on error with errno set (EAGAIN: a non-blocking socket is not ready). [any]
std::ptrdiff_t receive_bytes(int fd, char* to, std::size_t max_bytes);
std::ptrdiff_t send_bytes(int fd, std::string_view bytes);

}  // namespace limber::system
