// Progress: prints the progress of a long operation every few seconds: count, rate and remaining time.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/log/output.h"
#include "base/system/clock.h"

namespace limber::app {

/// [one thread]
class Progress {
 public:
  /// `unit`: name of the counted thing, such as "frame".
  Progress(std::string unit, std::uint64_t total) : unit_(std::move(unit)), total_(total) {}
  /// Prints a line to stderr if the last one is at least two seconds old.
  void report(std::uint64_t done) {
    const double now = system::clock_seconds();
    if (now - last_report_ < kReportInterval || done == 0) return;
    last_report_ = now;
    const double rate = static_cast<double>(done) / (now - begin_);
    print_notice("{} {} of {}, {:.1f} a second, {} left", unit_, done, total_, rate,
                 minutes(static_cast<double>(total_ > done ? total_ - done : 0) / rate));
  }

 private:
  static constexpr double kReportInterval = 2;  // s
  static std::string minutes(double seconds) {
    const long s = std::lround(seconds);
    return fmt::format("{}:{:02}", s / 60, s % 60);
  }

  std::string unit_;
  std::uint64_t total_;
  double begin_ = system::clock_seconds();
  double last_report_ = begin_;
};

}  // namespace limber::app
