// Endpoints, name resolution, TCP connections, and I/O on connected sockets.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/net/ip_address.h"

namespace limber::system {

/// An address and a port in host byte order.
struct Endpoint {
  IpAddress ip = {};
  std::uint16_t port = 0;

  auto operator<=>(const Endpoint&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm of clang-tidy 14
};

/// Returns "127.0.0.1:9003" or "[::1]:9003". [any]
std::string endpoint_text(const Endpoint& endpoint);

/// True if the text may be a host: it isn't empty, and has neither blanks nor control characters. [any]
bool is_host_text(std::string_view text);

/// The kind of address to prefer if a name has both.
enum class IpVersion : std::uint8_t { v4, v6 };

/// Resolves a host: an address immediately, a name with the system's resolver, which may take seconds. The result has
/// this port. [any]
Result<Endpoint> resolve(const std::string& host, std::uint16_t port, IpVersion preferred = IpVersion::v4);

/// Returns the endpoint that a socket is bound to. [any]
Endpoint local_endpoint(int fd);

/// Opens a blocking TCP connection. Returns a closed descriptor on error, with errno set. [any]
Descriptor connect_tcp(const Endpoint& to);

/// Receive from or send to a connected socket (a datagram socket: one datagram). Return the number of bytes, 0 if the
/// peer has closed, or -1 on error with errno set (EAGAIN: a non-blocking socket is not ready). [any]
std::ptrdiff_t receive_bytes(int fd, char* to, std::size_t max_bytes);
std::ptrdiff_t send_bytes(int fd, std::string_view bytes);

}  // namespace limber::system
