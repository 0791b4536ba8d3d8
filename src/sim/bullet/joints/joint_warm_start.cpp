// JointWarmStart: scales and filters the impulses of the previous step.
#include "sim/bullet/joints/joint_warm_start.h"

#include <algorithm>
#include <cmath>

#include "sim/bullet/joints/axis_settings.h"

namespace limber::sim::bullet {
namespace {

/// Warm-start factor of locks and motors. On long arms it has the effect of doubling the iterations; from 0.7 on, arms
/// of six parts and more begin to oscillate.
constexpr btScalar kBlockWarmStart = btScalar(0.5);
/// Low-pass factor per step with which lock_impulse() rises, so that it ignores impacts.
constexpr float kLockImpulseFilter = 0.125F;

}  // namespace

void JointWarmStart::reset() {
  last_impulse_.fill(0);
  lock_impulse_.fill(0);
  active_set_.fill(0);
  lock_energy_ = 0;
}

void JointWarmStart::begin_step(const JointRows& rows) {
  const int first = rows.first_of_block();
  for (int r = first; r < rows.size(); ++r) {
    const JointRow& row = rows[r];
    block_impulses_[at(r - first)] = std::clamp(kBlockWarmStart * last_impulse_[row.axis], row.lower, row.upper);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float last = last_impulse_[axis];
    if (last * lock_impulse_[axis] < 0) lock_impulse_[axis] = 0;
    const bool decreases = std::fabs(last) < std::fabs(lock_impulse_[axis]);
    lock_impulse_[axis] += (last - lock_impulse_[axis]) * (decreases ? 1 : kLockImpulseFilter);
  }
  last_impulse_.fill(0);
}

}  // namespace limber::sim::bullet
