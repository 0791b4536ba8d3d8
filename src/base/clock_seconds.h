// The clocks that measure how long things take. Nothing that they say enters a run. [any]
#pragma once

#include <chrono>
#include <ctime>

namespace limber {

inline double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Seconds that this thread has had a processor: other programs' turns, and a suspended program, do not count.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace limber
