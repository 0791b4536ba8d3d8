// UDP sockets that close themselves, and IPv4 addresses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "base/result.h"

struct sockaddr_in;

namespace limber {

/// An IPv4 address and port, both in host order.
struct Endpoint {
  std::uint32_t ip = 0;
  std::uint16_t port = 0;

  auto operator<=>(const Endpoint&) const = default;
};

/// "127.0.0.1:9003". [any]
std::string endpoint_text(const Endpoint& endpoint);
sockaddr_in socket_address(const Endpoint& endpoint);
Endpoint endpoint_of(const sockaddr_in& address);

/// "192.168.1.7" in host order; nothing for anything else. [any]
std::optional<std::uint32_t> parse_ipv4(const std::string& text);

/// Looks up a host: numbers at once, names by the system's resolver, which may take seconds. `port` is carried over.
Result<Endpoint> resolve(const std::string& host, std::uint16_t port);

/// A socket that closes itself.
class Socket : public Descriptor {
 public:
  using Descriptor::Descriptor;
  /// The local end: the port that the kernel chose, where it was asked to.
  Endpoint local() const;
};

/// A non-blocking UDP socket bound to `at` (port 0: the kernel chooses). The error says why not, nothing more.
Result<Socket> open_udp(const Endpoint& at);

}  // namespace limber
