// Clock: schedules ticks in real time without busy waiting, and detects a machine that can't keep up. [sim]
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace limber::engine {

class Clock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Real time at which the next tick is due; the first tick is due immediately.
  Time next_tick() const { return next_tick_; }
  /// Starts a tick of `tick_seconds` of simulated time at real time `now` and schedules the next one `tick_seconds` /
  /// `speed` later. When the schedule is more than 0.25 s late, the lost time is dropped: no burst of ticks catches up.
  void tick(Time now, double tick_seconds, double speed);
  /// Starts a tick that doesn't wait for its due time (--fast): only updates speed_reached().
  void measure_speed(Time now, double tick_seconds);
  /// Resets the schedule, after a pause: the next tick is due at `now`.
  void restart(Time now);

  /// Simulated seconds per real second, over about the last half second.
  double speed_reached() const { return speed_reached_; }
  /// True once after two seconds below 0.95 of the requested speed; true again only after the speed has recovered.
  bool consume_late();
  /// Number of times that lost time was dropped.
  std::uint64_t stalls() const { return stalls_; }
  /// Returns the real seconds that were lost before the last tick(). `suspended`: total seconds for which the system
  /// has been suspended; steady_clock doesn't count them, so a suspension since the last call is added.
  double lost_seconds(double suspended);

 private:
  double close_window(Time now, double tick_seconds);

  Time next_tick_{};
  Time window_start_{};
  double window_seconds_ = 0;  // simulated time since window_start_
  double speed_reached_ = 1;
  double late_seconds_ = 0;
  std::uint64_t stalls_ = 0;
  double lost_seconds_ = 0;
  std::optional<double> suspended_;
  bool started_ = false;
  bool late_ = false;
  bool late_reported_ = false;
};

}  // namespace limber::engine
