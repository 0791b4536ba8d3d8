// Clocks of POSIX.
#include "base/system/clock.h"

#include <array>
#include <ctime>

#include <fmt/format.h>

namespace limber::system {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::int64_t file_clock_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::string local_time_text() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  std::tm calendar{};
  localtime_r(&now.tv_sec, &calendar);
  std::array<char, 32> date{};
  std::array<char, 8> zone{};
  (void)std::strftime(date.data(), date.size(), "%F %T", &calendar);
  (void)std::strftime(zone.data(), zone.size(), "%z", &calendar);
  return fmt::format("{}.{:03}{}", date.data(), now.tv_nsec / 1'000'000, zone.data());
}

}  // namespace limber::system
