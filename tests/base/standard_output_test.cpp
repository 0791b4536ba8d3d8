// Writes to descriptors that are full, closed, not read, or not ready have a time limit and fail without signals.
#include "base/system/standard_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <thread>

namespace limber::system {
namespace {

using namespace std::chrono_literals;

struct Pipe {
  Pipe() { EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0); }
  ~Pipe() {
    for (const int fd : ends) close(fd);
  }
  int ends[2] = {-1, -1};
};

TEST(StandardOutput, FullPipeTimesOut) {
  const Pipe pipe;
  std::size_t all = 0;
  const std::string bytes(100000, 'x');
  while (true) {
    const Written written = write_within(pipe.ends[1], bytes, 0ns);
    if (written.count == 0) {
      EXPECT_EQ(written.error, EAGAIN);
      break;
    }
    EXPECT_LE(written.count, 4096U);
    all += written.count;
  }
  EXPECT_EQ(all, static_cast<std::size_t>(fcntl(pipe.ends[1], F_GETPIPE_SZ)));
  EXPECT_EQ(write_within(pipe.ends[1], bytes, 1ms).error, EAGAIN);
  EXPECT_EQ(fcntl(pipe.ends[1], F_GETFL) & O_NONBLOCK, 0) << "other programs share the description";
}

TEST(StandardOutput, ErrorsRaiseNoSignal) {
  std::thread([] {
    block_all_signals();  // otherwise SIGPIPE would end the program
    const Pipe pipe;
    const int closed = dup(pipe.ends[1]);
    close(closed);
    EXPECT_EQ(write_within(closed, "x", 0ns).error, EBADF);
    const int read_end = pipe.ends[0];
    dup2(pipe.ends[1], read_end);  // nothing reads it anymore
    EXPECT_EQ(write_within(pipe.ends[1], "x", 0ns).error, EPIPE);
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    EXPECT_EQ(write_within(full, "x", 0ns).error, ENOSPC);
    close(full);
  }).join();
}

TEST(StandardOutput, ClosedDescriptorsGetPlaceholders) {
  const pid_t child = fork();
  if (child == 0) {
    for (int fd = 0; fd <= 2; fd++) close(fd);
    prepare_standard_descriptors();
    char byte = 0;
    const bool reserved = open("/dev/null", O_WRONLY) > 2;
    const bool fails = write_within(1, "x", 0ns).error == EBADF && write_within(2, "x", 0ns).error == EBADF &&
                       read(0, &byte, 1) < 0 && errno == EBADF;
    _exit(reserved && fails ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(StandardOutput, ReportsAPendingSignalWithoutConsumingIt) {
  const pid_t child = fork();
  if (child == 0) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGTERM);
    sigprocmask(SIG_BLOCK, &set, nullptr);
    const bool before = termination_is_pending();
    kill(getpid(), SIGTERM);
    const bool after = termination_is_pending() && termination_is_pending();
    _exit(!before && after ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace limber::system
