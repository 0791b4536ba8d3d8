// Clock: hands out ticks at the pace of real time, without spinning, and tells when the machine can't keep up. [sim]
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace limber {

class Clock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// When the next tick is due; the first one at once.
  Time due() const { return due_; }
  /// A tick of `tick_seconds` of simulated time begins at real time `now`, at `speed` × real time: the next is due so
  /// much later. More than a quarter of a second behind, what is lost is let go instead of being hurried after.
  void tick(Time now, double tick_seconds, double speed);
  /// A tick that waited for nothing: only the speed that was reached is measured.
  void measure(Time now, double tick_seconds);
  /// Forgets the schedule: after a pause the next tick is due at `now`.
  void restart(Time now);

  /// Simulated seconds per real second over the last half second or so.
  double speed_reached() const { return reached_; }
  /// True once after two seconds below 0.95 of the wanted speed; again only after it has kept up in between.
  bool take_late();
  /// How often time was let go.
  std::uint64_t let_go() const { return let_go_; }
  /// Real seconds that the last tick() let go; `suspended`: the seconds so far in which the system was suspended, which
  /// steady_clock leaves out.
  double lost(double suspended);

 private:
  double close_window(Time now, double tick_seconds);

  Time due_{};
  Time window_start_{};
  double window_seconds_ = 0;  // simulated time handed out since window_start_
  double reached_ = 1;
  double late_seconds_ = 0;
  std::uint64_t let_go_ = 0;
  double lost_ = 0;
  std::optional<double> suspended_;
  bool started_ = false;
  bool late_ = false;
  bool said_ = false;
};

}  // namespace limber
