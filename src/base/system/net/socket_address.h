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
      length_ = sizeof address_.v6;
      address_.v6.sin6_family = AF_INET6;
      address_.v6.sin6_port = htons(endpoint.port);
      address_.v6.sin6_scope_id = endpoint.ip.zone;
      for (unsigned i = 0; i < 8; i++) {
        address_.v6.sin6_addr.s6_addr[i] = static_cast<unsigned char>(endpoint.ip.high >> (56 - 8 * i));
        address_.v6.sin6_addr.s6_addr[8 + i] = static_cast<unsigned char>(endpoint.ip.low >> (56 - 8 * i));
      }
    } else {
      address_.v4.sin_family = AF_INET;
      address_.v4.sin_port = htons(endpoint.port);
      address_.v4.sin_addr.s_addr = htonl(static_cast<std::uint32_t>(endpoint.ip.low));
      length_ = sizeof address_.v4;
    }
  }
  /// A copy of an IPv4 or IPv6 address.
  explicit SocketAddress(const sockaddr& address) {
    length_ = address.sa_family == AF_INET6 ? sizeof address_.v6 : sizeof address_.v4;
    std::memcpy(&address_.v6, &address, length_);
  }

  /// 0.0.0.0 with port 0 if the address is of neither kind.
  Endpoint endpoint() const {
    if (address_.any.sa_family == AF_INET) return {ntohl(address_.v4.sin_addr.s_addr), ntohs(address_.v4.sin_port)};
    if (address_.any.sa_family != AF_INET6) return {};
    IpAddress ip(0, 0, address_.v6.sin6_scope_id);
    for (unsigned i = 0; i < 8; i++) {
      ip.high = ip.high << 8U | address_.v6.sin6_addr.s6_addr[i];
      ip.low = ip.low << 8U | address_.v6.sin6_addr.s6_addr[8 + i];
    }
    if (!ip.is_link_local()) ip.zone = 0;
    return {ip, ntohs(address_.v6.sin6_port)};
  }

  const in6_addr& ipv6() const { return address_.v6.sin6_addr; }
  int family() const { return address_.any.sa_family; }
  const sockaddr* get() const { return &address_.any; }
  sockaddr* get() { return &address_.any; }
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
    sockaddr_in6 v6{};
    sockaddr_in v4;
    sockaddr any;
  } address_;
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
