// Unix domain sockets of POSIX.
#include "base/system/net/local_socket.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "base/system/open.h"

namespace limber::system {

namespace {

constexpr int kBacklog = 16;

std::string error_message(int error_number) { return std::generic_category().message(error_number); }

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return Error{
        fmt::format("{} is too long for a socket's path ({} bytes at most)", path, sizeof address.sun_path - 1)};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

// Returns 0 or an errno.
int connect_to(const Descriptor& socket, const sockaddr_un& address) {
  return connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
}

}  // namespace

Listener find_listener(const std::string& path) {
  const Result<sockaddr_un> address = address_of(path);
  const Descriptor socket = open_socket(AF_UNIX, SOCK_STREAM);
  if (!address || !socket.is_open()) return Listener::unknown;
  const int error = connect_to(socket, *address);
  if (error == 0 || error == EAGAIN) return Listener::present;
  return error == ECONNREFUSED ? Listener::absent : Listener::unknown;
}

Result<Descriptor> connect_local(const std::string& path, int seconds) {
  const Result<sockaddr_un> address = address_of(path);
  if (!address) return Error{address.error()};
  Descriptor socket = open_socket(AF_UNIX, SOCK_STREAM);
  if (!socket.is_open()) return Error{error_message(errno)};
  set_blocking(socket.fd());
  const timeval timeout = {seconds, 0};
  setsockopt(socket.fd(), SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout);
  if (const int error = connect_to(socket, *address); error != 0)
    return Error{fmt::format("{}: {}", path, error_message(error))};
  set_nonblocking(socket.fd());
  return socket;
}

Result<Descriptor> listen_local(const std::string& path) {
  const std::string hidden = path + ".new";
  const Result<sockaddr_un> address = address_of(hidden);
  if (!address) return Error{address.error()};
  Descriptor socket = open_socket(AF_UNIX, SOCK_STREAM);
  if (!socket.is_open()) return Error{error_message(errno)};
  unlink(hidden.c_str());  // left over from a process that had the same id
  const bool listens = bind(socket.fd(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) == 0 &&
                       chmod(hidden.c_str(), 0600) == 0 && listen(socket.fd(), kBacklog) == 0 &&
                       rename(hidden.c_str(), path.c_str()) == 0;
  if (listens) return socket;
  const std::string fault = error_message(errno);
  unlink(hidden.c_str());
  return Error{fmt::format("{}: {}", path, fault)};
}

long peer_user(const Descriptor& connection) {
#if defined(SO_PEERCRED)
  ucred credentials{};
  socklen_t length = sizeof credentials;
  if (getsockopt(connection.fd(), SOL_SOCKET, SO_PEERCRED, &credentials, &length) != 0) return -1;
  return static_cast<long>(credentials.uid);
#else
  uid_t user = 0;
  gid_t group = 0;
  return getpeereid(connection.fd(), &user, &group) == 0 ? static_cast<long>(user) : -1;
#endif
}

}  // namespace limber::system
