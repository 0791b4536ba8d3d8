// Conversions between Endpoint and sockaddr. Private to base/system and tests.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>

#include "base/system/net/socket.h"

namespace limber::system {

/// An address as the system's calls take and return it.
class SocketAddress {
 public:
  /// An address to be received.
  SocketAddress() = default;
  explicit SocketAddress(const Endpoint& endpoint) {
    if (endpoint.ip.is_v6) {
      length_ = sizeof v6_;
      v6_.sin6_family = AF_INET6;
      v6_.sin6_port = htons(endpoint.port);
      v6_.sin6_scope_id = endpoint.ip.zone;
      for (unsigned i = 0; i < 8; i++) {
        v6_.sin6_addr.s6_addr[i] = static_cast<unsigned char>(endpoint.ip.high >> (56 - 8 * i));
        v6_.sin6_addr.s6_addr[8 + i] = static_cast<unsigned char>(endpoint.ip.low >> (56 - 8 * i));
      }
    } else {
      v4_.sin_family = AF_INET;
      v4_.sin_port = htons(endpoint.port);
      v4_.sin_addr.s_addr = htonl(static_cast<std::uint32_t>(endpoint.ip.low));
      length_ = sizeof v4_;
    }
  }
  /// A copy of an IPv4 or IPv6 address.
  explicit SocketAddress(const sockaddr& address) {
    length_ = address.sa_family == AF_INET6 ? sizeof v6_ : sizeof v4_;
    std::memcpy(&v6_, &address, length_);
  }

  /// 0.0.0.0 with port 0 if the address is of neither kind.
  Endpoint endpoint() const {
    if (any_.sa_family == AF_INET) return {ntohl(v4_.sin_addr.s_addr), ntohs(v4_.sin_port)};
    if (any_.sa_family != AF_INET6) return {};
    IpAddress ip(0, 0, v6_.sin6_scope_id);
    for (unsigned i = 0; i < 8; i++) {
      ip.high = ip.high << 8U | v6_.sin6_addr.s6_addr[i];
      ip.low = ip.low << 8U | v6_.sin6_addr.s6_addr[8 + i];
    }
    if (!ip.is_link_local()) ip.zone = 0;
    return {ip, ntohs(v6_.sin6_port)};
  }

  const in6_addr& ipv6() const { return v6_.sin6_addr; }
  int family() const { return any_.sa_family; }
  const sockaddr* get() const { return &any_; }
  sockaddr* get() { return &any_; }
  socklen_t length() const { return length_; }
  static constexpr socklen_t kMaxLength = sizeof(sockaddr_in6);
  /// For a call that stores an address and its length.
  socklen_t* receive_length() {
    length_ = kMaxLength;
    return &length_;
  }

 private:
  // all begin with the family
  union {
    sockaddr_in6 v6_{};
    sockaddr_in v4_;
    sockaddr any_;
  };
  socklen_t length_ = 0;
};

/// Sets an option of a socket to 1.
inline void enable(int fd, int level, int option) {
  const int on = 1;
  setsockopt(fd, level, option, &on, sizeof on);
}

#if defined(MSG_NOSIGNAL)
constexpr int kNoSignal = MSG_NOSIGNAL;
#else
constexpr int kNoSignal = 0;  // a closed connection sends SIGPIPE, which block_signals() ignores
#endif

}  // namespace limber::system
