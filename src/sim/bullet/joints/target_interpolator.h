// TargetInterpolator: interpolates the targets of a joint's servos and springs over the substeps of a tick, so that
// targets that change once per tick cause a smooth motion.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

/// Target of one substep: m or rad, m/s or rad/s.
struct TargetStep {
  double from;       ///< Target at the end of the previous step.
  double to;         ///< At the end of this step: on the straight line from the last tick's target to this tick's.
  double end;        ///< At the end of the tick.
  double last_rate;  ///< Speed of the target in the previous tick.
};

/// Targets of six axes. A target that was set since the last tick is reached at the end of this tick, at a constant
/// speed. A low-pass filter can smooth targets that arrive at irregular times. [sim]
class TargetInterpolator {
 public:
  /// Makes the next step of this axis start at its target, without interpolation; to be called after a change of drive
  /// or a teleport.
  void restart(int axis) { restart_ = static_cast<std::uint8_t>(restart_ | bit(axis)); }
  void restart() { restart_ = kAll; }
  /// Sets the smoothing time, s; 0: no filter. Allocates on the first use, within the caller's BulletMemory::Scope.
  void set_smoothing(double time);
  double smoothing() const { return filter_ == nullptr ? 0 : filter_->time; }
  /// Call once in each substep of length h. `steps_left`: number of substeps to the end of the tick, this
  /// one included.
  TargetStep advance(int axis, double target, double h, int steps_left);
  /// To be called after end_tick(). True if a target moved in that tick: it was set, or the filter has not reached it
  /// yet.
  bool moving() const;
  /// Ends a tick. Axes that did not move in it start at their target when they move again.
  void end_tick() {
    restart_ = static_cast<std::uint8_t>(restart_ | (kAll & ~started_));
    started_ = 0;
  }

 private:
  static constexpr std::uint8_t kAll = 0x3f;
  static constexpr std::size_t kStages = 3;
  static unsigned bit(int axis) { return 1u << axis; }

  struct Target {
    double position = 0;  // target of the current step
    float rate = 0;       // in this tick
    float last_rate = 0;  // in the previous tick
  };
  /// Three equal first-order stages: they don't overshoot, and a ramp is only delayed.
  struct Filter {
    BT_DECLARE_ALIGNED_ALLOCATOR();
    double time = 0;
    std::array<std::array<double, kStages>, 6> stages{};
  };
  double filtered(std::size_t axis, double target, double tick);

  std::array<Target, 6> targets_{};
  std::unique_ptr<Filter> filter_;
  std::uint8_t restart_ = kAll;  // bit set of axes that start at their target
  std::uint8_t started_ = 0;     // bit set of axes that were advanced in this tick
};

}  // namespace limber::sim::bullet
