// AxisGoals: carries the targets of a joint's servos and springs through the internal steps of a tick, so that targets
// that change from tick to tick make a steady motion.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "sim/bullet.h"

namespace limber {

/// One internal step of a target: m or rad, m/s or rad/s.
struct GoalStep {
  double from;       ///< Target in force at the end of the step before.
  double to;         ///< At the end of this step: on the straight line from the last tick's target to this tick's.
  double end;        ///< At the end of the tick.
  double last_rate;  ///< Speed of the target in the last tick.
};

/// Targets of six axes. A target that was set since the last tick is reached at the end of this tick, at a constant
/// speed. Optionally a low-pass filter smooths targets that arrive at irregular times. [sim]
class AxisGoals {
 public:
  /// The next step of this axis starts at the target that it finds: after a change of drive, or a teleport.
  void restart(int axis) { restart_ = static_cast<std::uint8_t>(restart_ | bit(axis)); }
  void restart() { restart_ = kAll; }
  /// Smoothing time, s; 0: none. Allocates on the first use, within the caller's BulletMemory::Scope.
  void set_smoothing(double time);
  double smoothing() const { return filter_ == nullptr ? 0 : filter_->time; }
  /// Call once in each internal step of length h. `left`: internal steps to the end of the tick, this one included.
  GoalStep advance(int axis, double target, double h, int left);
  /// After end_tick(): whether a target moved in that tick: it was set, or the filter has not reached it yet.
  bool moving() const;
  /// Axes that did not move in the tick start from their target when they move again.
  void end_tick() {
    restart_ = static_cast<std::uint8_t>(restart_ | (kAll & ~begun_));
    begun_ = 0;
  }

 private:
  static constexpr std::uint8_t kAll = 0x3f;
  static constexpr std::size_t kStages = 3;
  static unsigned bit(int axis) { return 1u << axis; }

  struct Goal {
    double position = 0;  // in force
    float rate = 0;       // in this tick
    float last_rate = 0;  // in the tick before
  };
  /// Three equal first-order stages: no overshoot, and a ramp comes out as the same ramp, later.
  struct Filter {
    BT_DECLARE_ALIGNED_ALLOCATOR();
    double time = 0;
    std::array<std::array<double, kStages>, 6> stages{};
  };
  double filtered(std::size_t axis, double target, double tick);

  std::array<Goal, 6> goals_{};
  std::unique_ptr<Filter> filter_;
  std::uint8_t restart_ = kAll;
  std::uint8_t begun_ = 0;  // axes that have begun this tick
};

}  // namespace limber
