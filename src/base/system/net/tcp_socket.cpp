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

void enable(int fd, int level, int option) {
  const int on = 1;
  setsockopt(fd, level, option, &on, sizeof on);
}

}  // namespace

Result<Descriptor> listen_tcp(const Endpoint& at) {
  const auto system_error = [] { return Error{std::generic_category().message(errno)}; };
  Descriptor socket = open_socket(AF_INET, SOCK_STREAM);
  if (!socket.is_open()) return system_error();
  enable(socket.fd(), SOL_SOCKET, SO_REUSEADDR);  // closed connections of an earlier run do not block the port
  const sockaddr_in address = socket_address(at);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return system_error();
  if (listen(socket.fd(), kTcpBacklog) != 0) return system_error();
  return socket;
}

TcpConnection accept_tcp(const Descriptor& listener) {
  TcpConnection connection{accept_connection(listener.fd()), {}};
  if (!connection.socket.is_open()) return connection;
  const int fd = connection.socket.fd();
  enable(fd, IPPROTO_TCP, TCP_NODELAY);
  enable(fd, SOL_SOCKET, SO_KEEPALIVE);
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    errno = ECONNABORTED;  // the peer has closed already
    return {};
  }
  connection.peer = endpoint_of(address);
  return connection;
}

}  // namespace limber::system
