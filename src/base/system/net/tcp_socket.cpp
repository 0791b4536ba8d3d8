// TCP sockets of POSIX.
#include "base/system/net/tcp_socket.h"

#include <netinet/tcp.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/system/net/local_socket.h"
#include "base/system/net/socket_address.h"
#include "base/system/open.h"

namespace limber::system {

namespace {

constexpr int kTcpBacklog = 64;

}  // namespace

Result<Descriptor> listen_tcp(const Endpoint& at) {
  const auto system_error = [] { return Error{std::generic_category().message(errno)}; };
  const SocketAddress address(at);
  Descriptor socket = open_socket(address.family(), SOCK_STREAM);
  if (!socket.is_open()) return system_error();
  if (at.ip.is_v6) enable(socket.fd(), IPPROTO_IPV6, IPV6_V6ONLY);
  enable(socket.fd(), SOL_SOCKET, SO_REUSEADDR);  // closed connections of an earlier run do not block the port
  if (bind(socket.fd(), address.get(), address.length()) != 0) return system_error();
  if (listen(socket.fd(), kTcpBacklog) != 0) return system_error();
  return socket;
}

TcpConnection accept_tcp(const Descriptor& listener) {
  TcpConnection connection{accept_connection(listener.fd()), {}};
  if (!connection.socket.is_open()) return connection;
  const int fd = connection.socket.fd();
  enable(fd, IPPROTO_TCP, TCP_NODELAY);
  enable(fd, SOL_SOCKET, SO_KEEPALIVE);
  SocketAddress address;
  if (getpeername(fd, address.get(), address.receive_length()) != 0) {
    errno = ECONNABORTED;  // the peer has closed already
    return {};
  }
  connection.peer = address.endpoint();
  return connection;
}

}  // namespace limber::system
