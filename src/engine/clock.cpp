// Tick schedule, speed measurement and detection of stalls.
#include "engine/clock.h"

#include <utility>

namespace limber::engine {

namespace {
using Seconds = std::chrono::duration<double>;

constexpr double kMaxLateness = 0.25;  // s

Clock::Time after(Clock::Time t, double seconds) {
  return t + std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(seconds));
}
}  // namespace

void Clock::restart(Time now) {
  next_tick_ = now;
  window_start_ = now;
  window_seconds_ = 0;
  started_ = true;
}

void Clock::tick(Time now, double tick_seconds, double speed) {
  if (!started_) restart(now);
  const double lateness = Seconds(now - next_tick_).count();
  lost_seconds_ = lateness > kMaxLateness ? lateness : 0;
  if (lost_seconds_ > 0) {
    next_tick_ = now;
    stalls_++;
  }
  next_tick_ = after(next_tick_, tick_seconds / speed);

  const double real = close_window(now, tick_seconds);
  if (real == 0) return;
  if (speed_reached_ < 0.95 * speed) {
    late_seconds_ += real;
    if (late_seconds_ >= 2 && !std::exchange(late_reported_, true)) late_ = true;
  } else {
    late_seconds_ = 0;
    late_reported_ = false;
  }
}

void Clock::measure_speed(Time now, double tick_seconds) {
  if (!started_) restart(now);
  next_tick_ = now;
  (void)close_window(now, tick_seconds);
}

// Returns the real length of the measurement window if it ends at `now` (0.5 s or more), else 0.
double Clock::close_window(Time now, double tick_seconds) {
  window_seconds_ += tick_seconds;
  const double real = Seconds(now - window_start_).count();
  if (real < 0.5) return 0;
  speed_reached_ = (window_seconds_ - tick_seconds) / real;
  window_start_ = now;
  window_seconds_ = tick_seconds;
  return real;
}

double Clock::lost_seconds(double suspended) {
  const double suspension = suspended - suspended_.value_or(suspended);
  suspended_ = suspended;
  if (suspension <= kMaxLateness) return lost_seconds_;
  stalls_++;
  return lost_seconds_ + suspension;
}

bool Clock::consume_late() { return std::exchange(late_, false); }

}  // namespace limber::engine
