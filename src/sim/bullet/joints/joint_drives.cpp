// JointDrives: target speeds of motors and servos, spring forces, and the inertia that a servo moves.
#include "sim/bullet/joints/joint_drives.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber::sim::bullet {
namespace {

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

double stop_tolerance(int axis) { return axis < 3 ? kLinearStopTolerance : kAngularStopTolerance; }

// The value nearer to 0 if both have the same sign; else 0.
double minmod(double a, double b) { return a * b > 0 ? (std::fabs(a) < std::fabs(b) ? a : b) : 0; }

// Limits the stiffness so that the explicit spring force is stable.
btScalar capped_stiffness(const JointDrives::Axis& axis) {
  const btScalar requested = axis.settings.stiffness;
  const btScalar h2 = 16 * axis.step.h * axis.step.h;
  // free parts are an upper bound of the mobility: if it permits the stiffness, the joint does
  const AxisJacobian j = axis.pose.jacobian(axis.index);
  if (requested * h2 * axis.pose.mobility(j, j) <= 1) return requested;
  const auto inertia = static_cast<btScalar>(axis.pose.effective_inertia(axis.index)) + axis.settings.armature;
  return std::min(requested, inertia / h2);
}

}  // namespace

void JointDrives::reset(const JointPose& pose) {
  impulse_.fill(0);
  tick_impulse_.fill(0);
  applied_.fill(0);
  inertia_estimate_.fill(0);
  pair_inertia_.fill(0);
  tick_time_ = 0;
  interpolator_.restart();
  previous_rate_ = pose.rates();
}

void JointDrives::begin_step() {
  stiffness_applied_.fill(0);
  spring_limited_ = false;
  pressing_.fill(0);
  targets_outside_ = 0;
}

void JointDrives::end_plan(const JointPose& pose) {
  impulse_.fill(0);
  previous_rate_ = pose.rates();
}

void JointDrives::store(const JointRow& row, btScalar impulse, btScalar inverse_mobility) {
  impulse_[row.axis] += impulse;
  const std::int8_t pressing = pressing_[row.axis];
  tick_impulse_[row.axis] += pressing > 0 ? row.upper : (pressing < 0 ? row.lower : impulse);
  if (row.softness == 0) pair_inertia_[row.axis] = inverse_mobility;
}

void JointDrives::end_tick() {
  const float per_time = tick_time_ > 0 ? 1.0f / tick_time_ : 0.0f;
  for (std::size_t i = 0; i < 6; ++i) applied_[i] = tick_impulse_[i] * per_time;
  tick_impulse_.fill(0);
  tick_time_ = 0;
  interpolator_.end_tick();
}

void JointDrives::plan(const Axis& axis, JointRows& rows) {
  const AxisSettings& s = axis.settings;
  if (s.drive == AxisDrive::spring) return plan_spring(axis, rows);
  if (s.drive == AxisDrive::torque) return plan_torque(axis, rows);
  plan_motor(axis, s.drive == AxisDrive::servo ? servo_velocity(axis) : spin_velocity(axis), rows);
}

// Spin and servo: a hard row with the largest force as bounds. If that depends on the speed, the impulse is a
// decreasing function of the rate with two slopes, from the largest impulse at rest to 0 at the no-load speed, which
// the row interrupts at its velocity: a soft row, which is the slope up to that velocity, and a hard one with the rest
// of the force. Against the motion the force is the full one. Both are implicit, hence stable.
void JointDrives::plan_motor(const Axis& axis, btScalar velocity, JointRows& rows) {
  const AxisSettings& s = axis.settings;
  const btScalar max_impulse = s.max_force * axis.step.h;
  if (!(s.no_load_speed > 0 && max_impulse > 0 && velocity != 0)) {
    rows.add(axis.index, velocity, 0, -max_impulse, max_impulse, JointRow::Kind::motor);
    return;
  }
  const btScalar sign = velocity > 0 ? btScalar(1) : btScalar(-1);
  const btScalar reached = std::min(std::fabs(velocity), s.no_load_speed);
  const btScalar slope = reached / s.no_load_speed * max_impulse;
  const btScalar softness = s.no_load_speed / max_impulse;
  rows.add(axis.index, sign * reached, softness, std::min(sign * slope, btScalar(0)),
           std::max(sign * slope, btScalar(0)), JointRow::Kind::motor);
  const btScalar rest = max_impulse - slope;
  rows.add(axis.index, velocity, 0, sign > 0 ? -max_impulse : -rest, sign > 0 ? rest : max_impulse,
           JointRow::Kind::motor);
}

// A constant impulse, or the smaller one that the speed leaves.
void JointDrives::plan_torque(const Axis& axis, JointRows& rows) {
  const AxisSettings& s = axis.settings;
  const btScalar h = axis.step.h;
  const btScalar impulse = std::clamp(s.torque, -s.max_force, s.max_force) * h;
  if (impulse == 0) return;
  if (!(s.no_load_speed > 0)) {
    rows.add(axis.index, 0, 0, impulse, impulse, JointRow::Kind::motor);
    return;
  }
  const btScalar softness = s.no_load_speed / (s.max_force * h);
  rows.add(axis.index, std::copysign(s.no_load_speed, impulse), softness, std::min(impulse, btScalar(0)),
           std::max(impulse, btScalar(0)), JointRow::Kind::motor);
}

// The spring force is explicit (symplectic, conserves energy), the damping implicit (stable for any value): one row
// does both.
void JointDrives::plan_spring(const Axis& axis, JointRows& rows) {
  const AxisSettings& s = axis.settings;
  const btScalar h = axis.step.h;
  const btScalar stiffness = capped_stiffness(axis);
  stiffness_applied_[at(axis.index)] = stiffness;
  spring_limited_ = spring_limited_ || stiffness < btScalar(0.999) * s.stiffness;
  const TargetStep goal = interpolator_.advance(axis.index, s.rest, static_cast<double>(h), axis.step.left);
  const btScalar stretch = static_cast<btScalar>(goal.to - axis.value());
  const btScalar impulse = stiffness * stretch * h;
  if (s.spring_damping > 0) {
    const btScalar soft = 1 / std::max(s.spring_damping * h, btScalar(1e-18));
    rows.add(axis.index, impulse * soft, soft, -JointRow::kUnbounded, JointRow::kUnbounded, JointRow::Kind::motor);
  } else if (stiffness > 0) {
    rows.add(axis.index, 0, 0, impulse, impulse, JointRow::Kind::motor);
  }
}

// Limits the motor's speed at a hard limit: the motion is that of a motor that presses with its full force and a limit
// that reacts, without two large impulses that sweeps would have to balance. store() reports the pressing force. Into a
// compliant limit, the motor may move as far as its force deflects the limit.
btScalar JointDrives::spin_velocity(const Axis& axis) {
  const AxisSettings& s = axis.settings;
  if (!s.limited()) return s.velocity;
  const btScalar h = axis.step.h;
  const btScalar to_upper = static_cast<btScalar>(static_cast<double>(s.upper) - axis.value()) / h;
  const btScalar to_lower = static_cast<btScalar>(static_cast<double>(s.lower) - axis.value()) / h;
  if (s.stop_cfm > 0 && s.velocity != 0) {
    const btScalar deflection = s.stop_cfm * s.max_force / h;
    return s.velocity > 0 ? std::min(s.velocity, std::max(to_upper + deflection, btScalar(0)))
                          : std::max(s.velocity, std::min(to_lower - deflection, btScalar(0)));
  }
  const btScalar max_speed = to_upper < 0 ? to_upper * s.stop_erp : to_upper;
  const btScalar min_speed = to_lower > 0 ? to_lower * s.stop_erp : to_lower;
  if (s.velocity > 0 && s.velocity > max_speed) pressing_[at(axis.index)] = 1;
  if (s.velocity < 0 && s.velocity < min_speed) pressing_[at(axis.index)] = -1;
  return std::clamp(s.velocity, min_speed, max_speed);
}

// Positions that a servo may move to: those within its limits, which it may deflect if they are compliant. Also finds
// out whether its target is outside of them, and whether it presses against one.
JointDrives::Range JointDrives::servo_range(const Axis& axis) {
  const AxisSettings& s = axis.settings;
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  if (!s.limited()) return {-kUnlimited, kUnlimited};
  const auto lower = static_cast<double>(s.lower);
  const auto upper = static_cast<double>(s.upper);
  const bool above = s.target > upper + kOutsideTolerance * (1 + std::fabs(upper));
  const bool below = s.target < lower - kOutsideTolerance * (1 + std::fabs(lower));
  if (above || below) {
    targets_outside_ = static_cast<std::uint8_t>(targets_outside_ | 1u << axis.index);
    const double distance = above ? upper - axis.value() : axis.value() - lower;
    if (s.stop_cfm == 0 && distance < stop_tolerance(axis.index)) pressing_[at(axis.index)] = above ? 1 : -1;
  }
  const double deflection = static_cast<double>(s.stop_cfm) * static_cast<double>(s.max_force);
  return {lower - deflection, upper + deflection};
}

// The servo follows the interpolated target of the tick (TargetInterpolator): feed-forward of the target's velocity
// plus a part of the error. The feed-forward is limited to twice the target's velocity in the last tick. The rest is
// corrected no faster than the force can brake, since the target may stop at once.
btScalar JointDrives::servo_velocity(const Axis& axis) {
  const AxisSettings& s = axis.settings;
  const double value = axis.value();
  const auto h = static_cast<double>(axis.step.h);
  const TargetStep step = interpolator_.advance(axis.index, s.target, h, axis.step.left);
  const Range range = servo_range(axis);
  const auto clamp_to_range = [&](double position) { return std::clamp(position, range.lower, range.upper); };
  const double goal = clamp_to_range(step.to);
  const double limit = std::fabs(static_cast<double>(s.velocity));
  const double gain = limit > 0 ? kLimitedServoGain : kUnlimitedServoGain;

  const double rate = (goal - clamp_to_range(step.from)) / h;
  double trusted = minmod(rate, 2 * step.last_rate);
  if (limit > 0) trusted = std::clamp(trusted, -limit, limit);
  // a jump of the target takes at least as many steps as its error would
  const double untrusted = (rate - trusted) * std::min(1.0, gain * axis.step.count);
  const double error = goal - value - trusted * h;
  double correction = untrusted + gain * (error / h - untrusted);
  const double end = clamp_to_range(step.end) - value - trusted * h * axis.step.left;
  const double distance = correction > 0 ? std::max(error, end) : std::max(-error, -end);
  const auto max_correction = static_cast<double>(braking_speed(axis, static_cast<btScalar>(std::max(distance, 0.0))));
  correction = std::clamp(correction, -max_correction, max_correction);
  const double velocity = trusted + correction;
  return static_cast<btScalar>(limit > 0 ? std::clamp(velocity, -limit, limit) : velocity);
}

// Largest speed from which the force can brake within the distance left after this step: v² = 2·a·(distance - v·h).
btScalar JointDrives::braking_speed(const Axis& axis, btScalar distance) {
  estimate_inertia(axis);
  const btScalar h = axis.step.h;
  const btScalar inertia = inertia_estimate_[at(axis.index)];
  const btScalar max_force = axis.settings.max_force;
  if (!(inertia > 0 && max_force > 0)) return SIMD_INFINITY;
  const btScalar deceleration = kBrakingForceFraction * max_force / inertia * h;
  const btScalar max_average = 2 * distance / h;
  return deceleration * max_average / (deceleration + std::sqrt(deceleration * (deceleration + max_average)));
}

// Estimates the inertia that a motor moves, which is more than its two parts, from the impulse of a saturated motor and
// the change of speed.
void JointDrives::estimate_inertia(const Axis& axis) {
  const std::size_t i = at(axis.index);
  const float pair = pair_inertia_[i] + axis.settings.armature;
  const float impulse = impulse_[i];
  const float rate = axis.rate();
  const float speed_change = rate - previous_rate_[i];
  // the estimate decays within about a second, but not while the motor brakes, since that was planned with it
  float inertia = std::max(inertia_estimate_[i] * (impulse * rate < 0 ? 1.0f : 0.995f), pair);
  const bool saturated = std::fabs(impulse) >= 0.98f * axis.settings.max_force * axis.step.h;
  if (saturated && impulse * speed_change > 0 && std::fabs(rate) > 1e-3f) {
    const float measured = std::min(impulse / speed_change, 2000 * pair);
    inertia = measured > inertia ? measured : 0.9f * inertia + 0.1f * std::max(measured, pair);
  }
  inertia_estimate_[i] = inertia;
}

}  // namespace limber::sim::bullet
