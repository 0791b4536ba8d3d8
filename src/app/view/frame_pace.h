// FramePace: decides when the window draws its next frame: at the screen's rate, or rarely while nothing changes.
#pragma once

#include <algorithm>
#include <optional>

namespace limber::app {

/// All times in seconds. [main]
class FramePace {
 public:
  static constexpr double kIdleAfter = 1;                 ///< Time without a change.
  static constexpr double kIdleInterval = 0.25;           ///< Interval between frames of an idle window.
  static constexpr double kIdleCheckInterval = 1.0 / 30;  ///< Interval between checks for a change.

  /// Called when something visible has changed, or on user input.
  void note_activity(double now) { last_activity_ = now; }
  /// True if nothing has changed for kIdleAfter.
  bool idle(double now) const { return now - last_activity_ > kIdleAfter; }
  /// True if it is time to draw a frame. `rate`: refresh rate of the screen, 1/s.
  bool frame_due(double now, double rate) const {
    return now >= last_frame_ + (idle(now) ? kIdleInterval : 0.9 / rate);
  }
  /// Returns how long to wait for events before the next check.
  double wait_time(double now, double rate) const {
    return idle(now) ? std::min(kIdleCheckInterval, std::max(last_frame_ + kIdleInterval - now, 0.001))
                     : last_frame_ + 0.95 / rate - now;
  }
  /// Called at the start of a frame.
  void begin_frame(double now) { last_frame_ = now; }

 private:
  double last_activity_ = 0;
  double last_frame_ = 0;
};

/// Measures the rate of drawn frames once a second. [main]
class FrameCounter {
 public:
  /// Counts a frame. Returns the frames per second if a second has passed since the last result.
  std::optional<double> count(double now) {
    frames_++;
    if (now - since_ < 1) return std::nullopt;
    const double rate = frames_ / (now - since_);
    frames_ = 0;
    since_ = now;
    return rate;
  }

 private:
  double since_ = 0;
  int frames_ = 0;
};

}  // namespace limber::app
