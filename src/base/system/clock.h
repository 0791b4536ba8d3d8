// Clocks for measurements and file times. The simulation never depends on their values. [any]
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace limber::system {

inline double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The time by the steady clock, in ns.
inline std::int64_t clock_nanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Measures intervals: lap() returns the seconds since the previous lap() or the construction.
class Stopwatch {
 public:
  double lap() {
    const double now = clock_seconds();
    return now - std::exchange(last_, now);
  }

 private:
  double last_ = clock_seconds();
};

/// Returns the processor time of this thread in seconds, without time of other programs or of suspension.
double thread_seconds();

/// Returns the time since 1970 in ns, by the clock of file times.
std::int64_t file_clock_nanoseconds();

/// Returns how long the system was suspended since it booted, in seconds; 0 if unknown.
double suspended_seconds();

/// Returns the local time for log lines: "2026-03-09 21:03:12.345+0100".
std::string local_time_text();

}  // namespace limber::system
