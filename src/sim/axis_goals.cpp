// Linear interpolation of targets within a tick, and the filter that smooths them from tick to tick.
#include "sim/axis_goals.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

/// The time constant of a filter stage is kStagePart times the smoothing time, plus kStageTicks ticks, since a tick
/// sees only the newest target. The speed of streams at 25 to 100 Hz with 5 ms of jitter then varies by at most 8 % at
/// a smoothing time of two stream periods (measured at 60 ticks a second; required: 10 %). A ramp is delayed by three
/// stages.
constexpr double kStagePart = 0.5;
constexpr double kStageTicks = 1.5;
/// Nearer than this to its target, m or rad, the filter is at rest.
constexpr double kArrived = 1e-7;

}  // namespace

void AxisGoals::set_smoothing(double time) {
  if (time == smoothing()) return;
  if (filter_ == nullptr) filter_ = std::make_unique<Filter>();
  // the filter continues from the targets in force
  if (filter_->time == 0) {
    for (std::size_t axis = 0; axis < goals_.size(); ++axis) filter_->stages[axis].fill(goals_[axis].position);
  }
  filter_->time = time;
}

double AxisGoals::filtered(std::size_t axis, double target, double tick) {
  const double stage_time = kStagePart * filter_->time + kStageTicks * std::min(filter_->time, tick);
  const double share = 1 - fixed::exp(-tick / stage_time);
  std::array<double, kStages>& stages = filter_->stages[axis];
  double input = target;
  double farthest = 0;
  for (double& stage : stages) {
    stage += share * (input - stage);
    input = stage;
    farthest = std::max(farthest, std::fabs(target - stage));
  }
  if (farthest < kArrived) stages.fill(target);
  return stages.back();
}

bool AxisGoals::moving() const {
  for (int axis = 0; axis < 6; ++axis) {
    if ((restart_ & bit(axis)) == 0 && goals_[static_cast<std::size_t>(axis)].rate != 0) return true;
  }
  return false;
}

GoalStep AxisGoals::advance(int axis, double target, double h, int left) {
  const auto i = static_cast<std::size_t>(axis);
  Goal& goal = goals_[i];
  const bool smooth = smoothing() > 0;
  if ((restart_ & bit(axis)) != 0) {
    restart_ = static_cast<std::uint8_t>(restart_ & ~bit(axis));
    begun_ = static_cast<std::uint8_t>(begun_ | bit(axis));
    goal = {target, 0, 0};
    if (smooth) filter_->stages[i].fill(target);
  }
  if ((begun_ & bit(axis)) == 0) {
    begun_ = static_cast<std::uint8_t>(begun_ | bit(axis));
    const double tick = h * left;
    const double end = smooth ? filtered(i, target, tick) : target;
    goal.last_rate = goal.rate;
    goal.rate = static_cast<float>((end - goal.position) / tick);
  }
  const double end = smooth ? filter_->stages[i].back() : target;
  const double from = goal.position;
  goal.position = left <= 1 ? end : from + (end - from) / left;
  return {from, goal.position, end, static_cast<double>(goal.last_rate)};
}

}  // namespace limber
