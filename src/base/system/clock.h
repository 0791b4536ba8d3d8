// Clocks that measure how long something takes, and the clock of file times. No run depends on their values. [any]
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace limber::system {

inline double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of this thread, s: time of other programs and of a suspended program does not count.
double thread_seconds();

/// Time since 1970 as file systems report it, ns.
std::int64_t file_clock_nanoseconds();

/// Seconds in which the system was suspended since its start; 0 where it does not tell.
double suspended_seconds();

/// The time of day here, for log lines: "2026-03-09 21:03:12.345+0100".
std::string local_time_text();

}  // namespace limber::system
