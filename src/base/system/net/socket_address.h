// Conversions between Endpoint and sockaddr_in. Private to base/system and tests.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include "base/system/net/socket.h"

namespace limber::system {

inline sockaddr_in socket_address(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(endpoint.ip);
  address.sin_port = htons(endpoint.port);
  return address;
}

inline Endpoint endpoint_of(const sockaddr_in& address) {
  return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

#if defined(MSG_NOSIGNAL)
constexpr int kNoSignal = MSG_NOSIGNAL;
#else
constexpr int kNoSignal = 0;  // a closed connection sends SIGPIPE, which block_signals() ignores
#endif

}  // namespace limber::system
