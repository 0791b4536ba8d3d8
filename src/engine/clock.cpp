// The clock's schedule.
#include "engine/clock.h"

#include <utility>

namespace limber {

namespace {
using Seconds = std::chrono::duration<double>;

constexpr double kMostBehind = 0.25;  // s

Clock::Time after(Clock::Time t, double seconds) {
  return t + std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(seconds));
}
}  // namespace

void Clock::restart(Time now) {
  due_ = now;
  window_start_ = now;
  window_seconds_ = 0;
  started_ = true;
}

void Clock::tick(Time now, double tick_seconds, double speed) {
  if (!started_) restart(now);
  const double behind = Seconds(now - due_).count();
  lost_ = behind > kMostBehind ? behind : 0;
  if (lost_ > 0) {
    due_ = now;
    let_go_++;
  }
  due_ = after(due_, tick_seconds / speed);

  const double real = close_window(now, tick_seconds);
  if (real == 0) return;
  if (reached_ < 0.95 * speed) {
    late_seconds_ += real;
    if (late_seconds_ >= 2 && !std::exchange(said_, true)) late_ = true;
  } else {
    late_seconds_ = 0;
    said_ = false;
  }
}

void Clock::measure(Time now, double tick_seconds) {
  if (!started_) restart(now);
  due_ = now;
  (void)close_window(now, tick_seconds);
}

// the length of the window that ends now, or 0 while it is open
double Clock::close_window(Time now, double tick_seconds) {
  window_seconds_ += tick_seconds;
  const double real = Seconds(now - window_start_).count();
  if (real < 0.5) return 0;
  reached_ = (window_seconds_ - tick_seconds) / real;
  window_start_ = now;
  window_seconds_ = tick_seconds;
  return real;
}

double Clock::lost(double suspended) {
  const double asleep = suspended - suspended_.value_or(suspended);
  suspended_ = suspended;
  if (asleep <= kMostBehind) return lost_;
  let_go_++;
  return lost_ + asleep;
}

bool Clock::take_late() { return std::exchange(late_, false); }

}  // namespace limber
