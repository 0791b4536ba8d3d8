// Threads of Linux have their own ids and priorities.
#include "base/system/thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

namespace limber::system {

void name_this_thread(const char* name) { (void)pthread_setname_np(pthread_self(), name); }

std::uint64_t this_thread() { return static_cast<std::uint64_t>(syscall(SYS_gettid)); }

void signal_thread(std::uint64_t thread, int signal) {
  syscall(SYS_tgkill, getpid(), static_cast<pid_t>(thread), signal);
}

std::int64_t this_thread_clock() {
  clockid_t clock{};
  pthread_getcpuclockid(pthread_self(), &clock);
  return clock;
}

std::int64_t cpu_nanoseconds(std::int64_t clock) {
  timespec time{};
  if (clock_gettime(static_cast<clockid_t>(clock), &time) != 0) return -1;
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

void lower_thread_priority() { (void)setpriority(PRIO_PROCESS, 0, 5); }

}  // namespace limber::system
