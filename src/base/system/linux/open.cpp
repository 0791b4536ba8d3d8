// Opens descriptors with their flags in one system call, so that a process started at the same time inherits none.
#include "base/system/open.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "base/system/net/local_socket.h"

namespace limber::system {

bool open_pipe(Descriptor& read_end, Descriptor& write_end) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return false;
  read_end = Descriptor(ends[0]);
  write_end = Descriptor(ends[1]);
  return true;
}

Descriptor open_socket(int family, int type) {
  return Descriptor(socket(family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

Descriptor accept_connection(int listener) {
  return Descriptor(accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

void set_nonblocking(int fd) { (void)fcntl(fd, F_SETFL, O_NONBLOCK); }

void set_blocking(int fd) { (void)fcntl(fd, F_SETFL, 0); }

}  // namespace limber::system
