// Threads of POSIX. Priorities apply to the whole process there, so they are not changed. A port to macOS, which has no
// pthread_getcpuclockid(), would use thread_info().
#include "base/system/thread.h"

#include <pthread.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>

#include <ctime>

namespace limber::system {

void name_this_thread([[maybe_unused]] const char* name) {
#if defined(__APPLE__)
  (void)pthread_setname_np(name);
#else
  (void)pthread_setname_np(pthread_self(), name);
#endif
}

std::uint64_t this_thread() {
  static_assert(sizeof(pthread_t) <= sizeof(std::uint64_t));
  return (std::uint64_t)pthread_self();  // a number or a pointer
}

void signal_thread(std::uint64_t thread, int signal) { (void)pthread_kill((pthread_t)thread, signal); }

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

void lower_thread_priority() {}

}  // namespace limber::system
