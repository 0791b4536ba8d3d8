// Opens descriptors, then sets their flags. A process started between the two calls inherits the descriptor.
#include "base/system/open.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "base/system/net/local_socket.h"

namespace limber::system {

namespace {

Descriptor not_inherited(int fd) {
  if (fd >= 0) (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
  return Descriptor(fd);
}

Descriptor nonblocking(Descriptor opened) {
  if (opened.is_open()) set_nonblocking(opened.fd());
  return opened;
}

}  // namespace

bool open_pipe(Descriptor& read_end, Descriptor& write_end) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return false;
  read_end = not_inherited(ends[0]);
  write_end = not_inherited(ends[1]);
  return true;
}

Descriptor open_socket(int family, int type) { return nonblocking(not_inherited(socket(family, type, 0))); }

Descriptor accept_connection(int listener) { return nonblocking(not_inherited(accept(listener, nullptr, nullptr))); }

void set_nonblocking(int fd) { (void)fcntl(fd, F_SETFL, O_NONBLOCK); }

void set_blocking(int fd) { (void)fcntl(fd, F_SETFL, 0); }

}  // namespace limber::system
