// Waits with poll() and writes with write().
#include "base/system/standard_output.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace limber::system {

void prepare_standard_descriptors() {
  ::signal(SIGPIPE, SIG_IGN);
  for (int fd = 0; fd <= kStandardError; fd++) {
    if (fcntl(fd, F_GETFD) >= 0) continue;
    // The new descriptor is fd, the lowest free number. The opposite access mode makes its use fail as before.
    const int mode = fd == 0 ? O_WRONLY : O_RDONLY;
    if (open("/dev/null", mode) < 0) (void)!open("/", O_RDONLY);
  }
}

Written write_within(int fd, std::string_view bytes, std::chrono::nanoseconds limit) {
  constexpr std::size_t kMaxBytes = 4096;  // PIPE_BUF of Linux
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(limit).count();
  pollfd polled{fd, POLLOUT, 0};
  const int ready = poll(&polled, 1, static_cast<int>(std::clamp<long long>(ms, 0, 1'000'000)));
  if (ready == 0) return {0, EAGAIN};
  if (ready < 0) return {0, errno};
  const auto count = write(fd, bytes.data(), std::min(bytes.size(), kMaxBytes));
  if (count > 0) return {static_cast<std::size_t>(count), 0};
  return {0, count == 0 || errno == EWOULDBLOCK ? EAGAIN : errno};
}

void block_all_signals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

bool termination_is_pending() {
  sigset_t pending;
  if (sigpending(&pending) != 0) return false;
  return sigismember(&pending, SIGINT) == 1 || sigismember(&pending, SIGTERM) == 1 ||
         sigismember(&pending, SIGHUP) == 1;
}

}  // namespace limber::system
