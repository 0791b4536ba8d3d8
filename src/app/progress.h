// Progress: a line now and then of work that takes its time: how much is done, how fast, how long it will take.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/output.h"
#include "base/system/clock.h"

namespace limber {

class Progress {
 public:
  /// `unit`: what is counted, "frame".
  Progress(std::string unit, std::uint64_t all) : unit_(std::move(unit)), all_(all) {}
  /// Says it on stderr where it is time to.
  void tell(std::uint64_t done) {
    const double now = system::clock_seconds();
    if (now - said_ < kSayEvery || done == 0) return;
    said_ = now;
    const double rate = static_cast<double>(done) / (now - begin_);
    print_notice("{} {} of {}, {:.1f} a second, {} left", unit_, done, all_, rate,
                 minutes(static_cast<double>(all_ > done ? all_ - done : 0) / rate));
  }

 private:
  static constexpr double kSayEvery = 2;  // s
  static std::string minutes(double seconds) {
    const long s = std::lround(seconds);
    return fmt::format("{}:{:02}", s / 60, s % 60);
  }

  std::string unit_;
  std::uint64_t all_;
  double begin_ = system::clock_seconds();
  double said_ = begin_;
};

}  // namespace limber
