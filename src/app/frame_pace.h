// FramePace: when the window draws its next picture: at the screen's rate, or seldom while nothing changes.
#pragma once

#include <algorithm>

namespace limber {

/// All times in seconds. [main]
class FramePace {
 public:
  static constexpr double kIdleAfter = 1;        ///< Without a change.
  static constexpr double kIdleEvery = 0.25;     ///< Between two pictures of an idle window.
  static constexpr double kIdleLook = 1.0 / 30;  ///< Between two looks for a change.

  /// Something that is seen has changed, or a hand has done something.
  void touch(double now) { touched_ = now; }
  bool idle(double now) const { return now - touched_ > kIdleAfter; }
  /// Whether a picture is due. `rate`: of the screen.
  bool due(double now, double rate) const { return now >= drawn_ + (idle(now) ? kIdleEvery : 0.9 / rate); }
  /// How long to wait for events before the next look.
  double rest(double now, double rate) const {
    return idle(now) ? std::min(kIdleLook, std::max(drawn_ + kIdleEvery - now, 0.001)) : drawn_ + 0.95 / rate - now;
  }
  /// A picture begins.
  void draw(double now) { drawn_ = now; }

 private:
  double touched_ = 0;
  double drawn_ = 0;
};

}  // namespace limber
