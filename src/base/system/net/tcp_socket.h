// TCP sockets that listen, and the connections that they accept.
#pragma once

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/net/socket.h"

namespace limber::system {

/// Opens a non-blocking socket that listens at `at` (port 0: the system chooses). The error is the system's message.
Result<Descriptor> listen_tcp(const Endpoint& at);

struct TcpConnection {
  Descriptor socket;  ///< Non-blocking, sends small packets at once, and detects that its peer has vanished.
  Endpoint peer;
};

/// Accepts a connection. Its socket is closed if there is none, with errno set.
TcpConnection accept_tcp(const Descriptor& listener);

}  // namespace limber::system
