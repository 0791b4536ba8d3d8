// JointConstraint: its solver rows: locks, limits, motors, servos, springs, damping and friction, planned in each
// internal step. Every row has the form rate + softness·impulse = velocity with a bounded impulse.
#include <algorithm>
#include <cmath>

#include "sim/bullet/joint_constraint.h"

namespace limber {
namespace {

/// Low-pass factor per step with which lock_impulse() rises, so that it ignores impacts.
constexpr float kLockImpulseFilter = 0.125F;

constexpr btScalar kInfinity = SIMD_INFINITY;
/// A limit gets a row if it is nearer than this plus the distance covered in two steps: rad, m.
constexpr btScalar kAngularMargin = btScalar(0.05);
constexpr btScalar kLinearMargin = btScalar(0.005);
/// Largest repair speed of a hard lock or limit, rad/s and m/s, so that a joint torn apart closes without an impact.
constexpr btScalar kMaxRepairSpeed = btScalar(20);
/// The same for a limit. It is lower because contacts may have pushed the joint past its limit, and the repair presses
/// against them.
constexpr btScalar kMaxLimitRepairSpeed = btScalar(2);
/// Part of its error that a servo corrects in one step: with a speed limit, and without one.
constexpr double kLimitedServoGain = 0.9;
constexpr double kUnlimitedServoGain = 0.25;
/// Relative: a target further than this beyond a limit counts as outside.
constexpr double kOutsideTolerance = 1e-5;
/// A servo nearer than this to its limit counts as pressing against it: rad, m.
constexpr double kAngularStopTolerance = 1e-3;
constexpr double kLinearStopTolerance = 1e-4;
/// Part of max_force that braking relies on; the rest is reserved for gravity and neighbors.
constexpr btScalar kBrakingForceFraction = btScalar(0.7);

/// Warm-start factor of locks and motors. On long arms it has the effect of doubling the iterations; from 0.7 on, arms
/// of six parts and more begin to oscillate.
constexpr btScalar kBlockWarmStart = btScalar(0.5);

btScalar limit_margin(int axis) { return axis < 3 ? kLinearMargin : kAngularMargin; }
double stop_tolerance(int axis) { return axis < 3 ? kLinearStopTolerance : kAngularStopTolerance; }

// Converts compliance (per load, at rest) to softness (per impulse): the solver repairs erp/h of the error per second.
btScalar softness(const AxisSettings& s, btScalar h) { return s.stop_cfm * s.stop_erp / (h * h); }

}  // namespace

IndexedSpan<const JointConstraint::Row> JointConstraint::plan(Row* rows) {
  rows_ = rows;
  read_pose();
  plan_rows();
  return planned();
}

void JointConstraint::getInfo1(btConstraintInfo1* info) {
  std::array<Row, kMaxRows> rows;
  info->m_numConstraintRows = static_cast<int>(plan(rows.data()).size());
  row_count_ = 0;
  info->nub = 0;
}

void JointConstraint::getInfo2(btConstraintInfo2* info) {
  const auto put = [](btScalar* to, const btVector3& v) {
    to[0] = v.x();
    to[1] = v.y();
    to[2] = v.z();
  };
  for (int r = 0; r < row_count_; ++r) {
    const Row& row = rows_[r];
    const Jacobian j = jacobian(row.axis);
    const int skip = r * info->rowskip;
    if (row.axis < 3) {
      put(info->m_J1linearAxis + skip, -j.linear);
      put(info->m_J2linearAxis + skip, j.linear);
    }
    put(info->m_J1angularAxis + skip, j.angular_a);
    put(info->m_J2angularAxis + skip, j.angular_b);
    info->m_constraintError[skip] = row.velocity;
    info->cfm[skip] = row.softness;
    info->m_lowerLimit[skip] = row.lower;
    info->m_upperLimit[skip] = row.upper;
  }
}

void JointConstraint::set_impulses(const btSolverConstraint* rows, int count) {
  for (int r = 0; r < count && r < row_count_; ++r) {
    set_impulse(rows_[r], rows[r].m_appliedImpulse, rows[r].m_jacDiagABInv);
  }
  tick_time_ += h_;
}

void JointConstraint::set_impulses(IndexedSpan<const double> impulses) {
  for (int r = 0; r < impulses.size() && r < planned().size(); ++r) {
    const Row& row = rows_[r];
    btScalar inverse_mobility = 0;
    if (row.kind == RowKind::repair || row.kind == RowKind::motor) {
      const Jacobian j = jacobian(row.axis);
      const btScalar row_mobility = mobility(m_rbA, m_rbB, j, j);
      inverse_mobility = row_mobility > SIMD_EPSILON ? 1 / (row_mobility + row.softness) : 0;
    }
    set_impulse(row, to_scalar(impulses[r]), inverse_mobility);
  }
  tick_time_ += h_;
}

// `step`: impulse per rate of this row alone.
void JointConstraint::set_impulse(const Row& row, btScalar impulse, btScalar inverse_mobility) {
  // of a repair, store only the impulse that moved the axis: if the limit reverted the part that supported a load, too,
  // it would pull
  if (row.kind == RowKind::repair) {
    repair_impulse_[row.axis] = std::min(std::fabs(impulse), std::fabs(row.velocity) * inverse_mobility);
  }
  if (row.kind == RowKind::motor || row.kind == RowKind::lock) last_impulse_[row.axis] = impulse;
  if (row.kind != RowKind::motor) return;
  motor_impulse_[row.axis] = impulse;
  const std::int8_t pressing = pressing_[row.axis];
  tick_impulse_[row.axis] += pressing > 0 ? row.upper : (pressing < 0 ? row.lower : impulse);
  if (row.softness == 0) pair_inertia_[row.axis] = inverse_mobility;
}

void JointConstraint::plan_rows() {
  row_count_ = 0;
  stiffness_applied_.fill(0);
  spring_limited_ = false;
  pressing_.fill(0);
  targets_outside_ = 0;
  // soft rows first, hard ones last: a Gauss-Seidel sweep satisfies its last row exactly
  for (int axis = 0; axis < 6; ++axis) {
    if (!axes_[at(axis)].locked()) plan_unlocked(axis);
  }
  bounded_row_ = false;
  for (int axis = 0; axis < 6; ++axis) {
    const AxisSettings& s = axes_[at(axis)];
    if (s.locked() || s.drive == AxisDrive::off || s.drive == AxisDrive::spring) continue;
    plan_motor(axis);
    bounded_row_ = true;
  }
  const int unlocked_rows = row_count_;
  for (int axis = 3; axis < 6; ++axis) {
    if (axes_[at(axis)].locked()) plan_lock(axis);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axes_[at(axis)].locked()) plan_lock(axis);
  }
  locked_rows_ = row_count_ - unlocked_rows;
  // warm start of motor and lock rows
  const int first = unlocked_rows - (bounded_row_ ? 1 : 0);
  for (int r = first; r < row_count_; ++r) {
    const Row& row = rows_[r];
    warm_impulses_[at(r - first)] = std::clamp(kBlockWarmStart * last_impulse_[row.axis], row.lower, row.upper);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float last = last_impulse_[axis];
    if (last * lock_impulse_[axis] < 0) lock_impulse_[axis] = 0;
    const bool decreases = std::fabs(last) < std::fabs(lock_impulse_[axis]);
    lock_impulse_[axis] += (last - lock_impulse_[axis]) * (decreases ? 1 : kLockImpulseFilter);
  }
  last_impulse_.fill(0);
  motor_impulse_.fill(0);
  repair_impulse_.fill(0);
  previous_rate_ = rate_;
}

void JointConstraint::add_row(int axis, btScalar velocity, btScalar soft, btScalar lower, btScalar upper,
                              RowKind kind) {
  rows_[row_count_++] = {velocity, soft, lower, upper, static_cast<std::uint8_t>(axis), kind};
}

void JointConstraint::plan_lock(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  double error = static_cast<double>(s.lower) - value(axis);
  if (axis >= 3) error = std::remainder(error, 2 * kPi);
  const btScalar soft = softness(s, h_);
  btScalar repair = static_cast<btScalar>(error) * s.stop_erp / h_;
  if (soft == 0) repair = std::clamp(repair, -kMaxRepairSpeed, kMaxRepairSpeed);
  add_row(axis, repair, soft, -kInfinity, kInfinity, RowKind::lock);
}

void JointConstraint::plan_unlocked(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  if (s.drive == AxisDrive::spring) plan_spring(axis);
  if (damping_ > 0) add_row(axis, 0, 1 / std::max(damping_ * h_, btScalar(1e-18)), -kInfinity, kInfinity);
  if (s.friction > 0) {
    const btScalar max_impulse = s.friction * h_;
    add_row(axis, 0, 0, -max_impulse, max_impulse);
  }
  if (s.limited()) {
    plan_limit(axis, false);
    plan_limit(axis, true);
  }
}

// Adds a row that lets the axis just reach the limit within the step, or repairs a violated limit.
void JointConstraint::plan_limit(int axis, bool upper) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar sign = upper ? btScalar(-1) : btScalar(1);
  const double limit = static_cast<double>(upper ? s.upper : s.lower);
  const btScalar distance = sign * static_cast<btScalar>(value(axis) - limit);
  const btScalar speed = sign * rate_[at(axis)];  // negative: approaching
  if (distance > limit_margin(axis) + 2 * h_ * std::max(-speed, btScalar(0))) return;

  const btScalar soft = softness(s, h_);
  btScalar min_speed = -distance / h_;
  btScalar repair_impulse = 0;
  RowKind kind = RowKind::other;
  if (distance < 0) {
    min_speed *= s.stop_erp;
    // a limit only pushes, but may revert its repair impulse of the last step; else the axis would bounce off at the
    // repair speed
    if (soft == 0) {
      min_speed = std::min(min_speed, kMaxLimitRepairSpeed);
      repair_impulse = repair_impulse_[at(axis)];
      kind = RowKind::repair;
    }
  }
  if (bounce_ > 0 && distance + h_ * speed <= 0 && -bounce_ * speed > min_speed) {
    min_speed = -bounce_ * speed;
    kind = RowKind::other;
  }
  if (upper) {
    add_row(axis, -min_speed, soft, -kInfinity, repair_impulse, kind);
  } else {
    add_row(axis, min_speed, soft, -repair_impulse, kInfinity, kind);
  }
}

void JointConstraint::plan_motor(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar max_impulse = s.max_force * h_;
  const btScalar velocity = s.drive == AxisDrive::servo ? servo_velocity(axis) : spin_velocity(axis);
  add_row(axis, velocity, 0, -max_impulse, max_impulse, RowKind::motor);
}

// Limits the motor's speed at a hard limit: the motion is that of a motor that presses with its full force and a limit
// that reacts, without two large impulses that sweeps would have to balance. set_impulse() reports the pressing force.
// Into a compliant limit, the motor may move as far as its force deflects the limit.
btScalar JointConstraint::spin_velocity(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  if (!s.limited()) return s.velocity;
  const btScalar to_upper = static_cast<btScalar>(static_cast<double>(s.upper) - value(axis)) / h_;
  const btScalar to_lower = static_cast<btScalar>(static_cast<double>(s.lower) - value(axis)) / h_;
  if (s.stop_cfm > 0 && s.velocity != 0) {
    const btScalar deflection = s.stop_cfm * s.max_force / h_;
    return s.velocity > 0 ? std::min(s.velocity, std::max(to_upper + deflection, btScalar(0)))
                          : std::max(s.velocity, std::min(to_lower - deflection, btScalar(0)));
  }
  const btScalar max_speed = to_upper < 0 ? to_upper * s.stop_erp : to_upper;
  const btScalar min_speed = to_lower > 0 ? to_lower * s.stop_erp : to_lower;
  if (s.velocity > 0 && s.velocity > max_speed) pressing_[at(axis)] = 1;
  if (s.velocity < 0 && s.velocity < min_speed) pressing_[at(axis)] = -1;
  return std::clamp(s.velocity, min_speed, max_speed);
}

// The servo follows the interpolated target of the tick (AxisGoals): feed-forward of the target's velocity plus a part
// of the error. The feed-forward is limited to twice the target's velocity in the last tick. The rest is corrected no
// faster than the force can brake, since the target may stop at once.
btScalar JointConstraint::servo_velocity(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const double h = static_cast<double>(h_);
  const GoalStep step = goals_.advance(axis, s.target, h, steps_left_);
  double lower = static_cast<double>(s.lower);
  double upper = static_cast<double>(s.upper);
  if (s.limited()) {
    const bool above = s.target > upper + kOutsideTolerance * (1 + std::fabs(upper));
    const bool below = s.target < lower - kOutsideTolerance * (1 + std::fabs(lower));
    if (above || below) targets_outside_ = static_cast<std::uint8_t>(targets_outside_ | 1u << axis);
    const double distance = above ? upper - value(axis) : value(axis) - lower;
    if (s.stop_cfm == 0 && (above || below) && distance < stop_tolerance(axis)) pressing_[at(axis)] = above ? 1 : -1;
    // a compliant limit is deflected as far as the force allows
    const double deflection = static_cast<double>(s.stop_cfm) * static_cast<double>(s.max_force);
    lower -= deflection;
    upper += deflection;
  }
  const auto clamp_to_limits = [&](double position) {
    return s.limited() ? std::clamp(position, lower, upper) : position;
  };
  const double goal = clamp_to_limits(step.to);
  const double limit = std::fabs(static_cast<double>(s.velocity));
  const double gain = limit > 0 ? kLimitedServoGain : kUnlimitedServoGain;

  const double rate = (goal - clamp_to_limits(step.from)) / h;
  const double max_trusted = 2 * step.last_rate;
  double trusted = rate * max_trusted > 0 ? (std::fabs(rate) < std::fabs(max_trusted) ? rate : max_trusted) : 0;
  if (limit > 0) trusted = std::clamp(trusted, -limit, limit);
  // a jump of the target takes at least as many steps as its error would
  const double untrusted = (rate - trusted) * std::min(1.0, gain * step_count_);
  const double error = goal - value(axis) - trusted * h;
  double correction = untrusted + gain * (error / h - untrusted);
  const double end = clamp_to_limits(step.end) - value(axis) - trusted * h * steps_left_;
  const double distance = correction > 0 ? std::max(error, end) : std::max(-error, -end);
  const double max_correction =
      static_cast<double>(braking_speed(axis, static_cast<btScalar>(std::max(distance, 0.0))));
  correction = std::clamp(correction, -max_correction, max_correction);
  const double velocity = trusted + correction;
  return static_cast<btScalar>(limit > 0 ? std::clamp(velocity, -limit, limit) : velocity);
}

// Largest speed from which the force can brake within the distance left after this step: v² = 2·a·(distance - v·h).
btScalar JointConstraint::braking_speed(int axis, btScalar distance) {
  estimate_inertia(axis);
  const btScalar inertia = inertia_estimate_[at(axis)];
  const btScalar max_force = axes_[at(axis)].max_force;
  if (!(inertia > 0 && max_force > 0)) return SIMD_INFINITY;
  const btScalar deceleration = kBrakingForceFraction * max_force / inertia * h_;
  const btScalar max_average = 2 * distance / h_;
  return deceleration * max_average / (deceleration + std::sqrt(deceleration * (deceleration + max_average)));
}

// Estimates the inertia that a motor moves, which is more than its two parts, from the impulse of a saturated motor and
// the change of speed.
void JointConstraint::estimate_inertia(int axis) {
  const std::size_t i = at(axis);
  const float pair = pair_inertia_[i];
  const float impulse = motor_impulse_[i];
  const float speed_change = rate_[i] - previous_rate_[i];
  // the estimate decays within about a second, but not while the motor brakes, since that was planned with it
  float inertia = std::max(inertia_estimate_[i] * (impulse * rate_[i] < 0 ? 1.0f : 0.995f), pair);
  const bool saturated = std::fabs(impulse) >= 0.98f * axes_[i].max_force * h_;
  if (saturated && impulse * speed_change > 0 && std::fabs(rate_[i]) > 1e-3f) {
    const float measured = std::min(impulse / speed_change, 2000 * pair);
    inertia = measured > inertia ? measured : 0.9f * inertia + 0.1f * std::max(measured, pair);
  }
  inertia_estimate_[i] = inertia;
}

// The spring force is explicit (symplectic, conserves energy), the damping implicit (stable for any value): one row
// does both.
void JointConstraint::plan_spring(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar stiffness = capped_stiffness(axis);
  stiffness_applied_[at(axis)] = stiffness;
  spring_limited_ = spring_limited_ || stiffness < btScalar(0.999) * s.stiffness;
  const GoalStep step = goals_.advance(axis, s.rest, static_cast<double>(h_), steps_left_);
  const btScalar stretch = static_cast<btScalar>(step.to - value(axis));
  const btScalar impulse = stiffness * stretch * h_;
  if (s.spring_damping > 0) {
    const btScalar soft = 1 / std::max(s.spring_damping * h_, btScalar(1e-18));
    add_row(axis, impulse * soft, soft, -kInfinity, kInfinity, RowKind::motor);
  } else if (stiffness > 0) {
    add_row(axis, 0, 0, impulse, impulse, RowKind::motor);
  }
}

btScalar JointConstraint::capped_stiffness(int axis) const {
  const btScalar requested = axes_[at(axis)].stiffness;
  const btScalar h2 = 16 * h_ * h_;
  // free parts are an upper bound of the mobility: if it permits the stiffness, the joint does
  const Jacobian j = jacobian(axis);
  if (requested * h2 * mobility(m_rbA, m_rbB, j, j) <= 1) return requested;
  return std::min(requested, static_cast<btScalar>(effective_inertia(axis)) / h2);
}

}  // namespace limber
