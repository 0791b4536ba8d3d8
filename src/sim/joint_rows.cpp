// The joint's solver rows: locks, limits, motors, servos, springs, damping and friction, planned anew for each
// internal step. Every row reads rate + softness·impulse = velocity, its impulse kept within bounds.
#include <algorithm>
#include <cmath>

#include "sim/joint_constraint.h"

namespace limber {
namespace {

/// pull() rises by this part of the difference in each step, so that it ignores impacts.
constexpr float kPullRise = 0.125F;

constexpr btScalar kInfinity = SIMD_INFINITY;
/// A limit gets a row when it is nearer than this plus two steps' way: rad, m.
constexpr btScalar kAngularMargin = btScalar(0.05);
constexpr btScalar kLinearMargin = btScalar(0.005);
/// Fastest repair of a stiff lock's or limit's error, rad/s and m/s: a joint torn apart comes back without a bang.
constexpr btScalar kFastestRepair = btScalar(20);
/// The same of a limit, which contacts may have pushed the joint past: it presses against them meanwhile.
constexpr btScalar kFastestLimitRepair = btScalar(2);
/// Part of its error that a servo makes good in one step: with a speed limit, and without one.
constexpr double kServoGain = 0.9;
constexpr double kEagerServoGain = 0.25;
/// Relative: a target further than this beyond a limit is outside of it.
constexpr double kOutside = 1e-5;
/// A servo nearer than this to its limit stands there: rad, m.
constexpr double kAngularStop = 1e-3;
constexpr double kLinearStop = 1e-4;
/// Part of max_force that braking counts on; the rest is left to gravity and neighbours.
constexpr btScalar kBrakePart = btScalar(0.7);

/// Part of the last step's impulses that locks and motors start from. It is worth twice the iterations on long arms;
/// from 0.7 on, arms of six parts and more begin to swing.
constexpr btScalar kWarmStart = btScalar(0.5);

btScalar margin(int axis) { return axis < 3 ? kLinearMargin : kAngularMargin; }
double at_stop(int axis) { return axis < 3 ? kLinearStop : kAngularStop; }

// Compliance (per load, at rest) as softness (per impulse): the solver repairs erp/h of the error per second.
btScalar softness(const AxisSettings& s, btScalar h) { return s.stop_cfm * s.stop_erp / (h * h); }

}  // namespace

std::span<const JointConstraint::Row> JointConstraint::plan(Row* room) {
  rows_ = room;
  read_pose();
  plan_rows();
  return planned();
}

void JointConstraint::getInfo1(btConstraintInfo1* info) {
  std::array<Row, kMostRows> room;
  info->m_numConstraintRows = static_cast<int>(plan(room.data()).size());
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

void JointConstraint::take_impulses(const btSolverConstraint* rows, int count) {
  for (int r = 0; r < count && r < row_count_; ++r) {
    take_impulse(rows_[r], rows[r].m_appliedImpulse, rows[r].m_jacDiagABInv);
  }
  tick_time_ += h_;
}

void JointConstraint::take_impulses(std::span<const double> impulses) {
  for (std::size_t r = 0; r < impulses.size() && r < planned().size(); ++r) {
    const Row& row = rows_[r];
    btScalar step = 0;
    if (row.kind == RowKind::repair || row.kind == RowKind::motor) {
      const Jacobian j = jacobian(row.axis);
      const btScalar eases = mobility(m_rbA, m_rbB, j, j);
      step = eases > SIMD_EPSILON ? 1 / (eases + row.softness) : 0;
    }
    take_impulse(row, to_scalar(impulses[r]), step);
  }
  tick_time_ += h_;
}

// `step`: impulse per rate, of this row alone.
void JointConstraint::take_impulse(const Row& row, btScalar impulse, btScalar step) {
  // of a repair only what made the axis move: what bore a load is not taken back, or the limit would hold on to it
  if (row.kind == RowKind::repair) {
    repair_impulse_[row.axis] = std::min(std::fabs(impulse), std::fabs(row.velocity) * step);
  }
  if (row.kind == RowKind::motor || row.kind == RowKind::lock) last_impulse_[row.axis] = impulse;
  if (row.kind != RowKind::motor) return;
  motor_impulse_[row.axis] = impulse;
  const std::int8_t presses = presses_[row.axis];
  tick_impulse_[row.axis] += presses > 0 ? row.upper : (presses < 0 ? row.lower : impulse);
  if (row.softness == 0) pair_inertia_[row.axis] = step;
}

void JointConstraint::plan_rows() {
  row_count_ = 0;
  stiffness_applied_.fill(0);
  holds_spring_ = false;
  presses_.fill(0);
  outside_ = 0;
  // what may give comes first, what must hold comes last: the last row of a sweep is met exactly
  for (int axis = 0; axis < 6; ++axis) {
    if (!axes_[at(axis)].locked()) plan_motion(axis);
  }
  bounded_row_ = false;
  for (int axis = 0; axis < 6; ++axis) {
    const AxisSettings& s = axes_[at(axis)];
    if (s.locked() || s.drive == AxisDrive::off || s.drive == AxisDrive::spring) continue;
    plan_motor(axis);
    bounded_row_ = true;
  }
  const int moving = row_count_;
  for (int axis = 3; axis < 6; ++axis) {
    if (axes_[at(axis)].locked()) plan_lock(axis);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axes_[at(axis)].locked()) plan_lock(axis);
  }
  locked_rows_ = row_count_ - moving;
  // start the iteration from what held the joint in the step before
  const int start = moving - (bounded_row_ ? 1 : 0);
  for (int r = start; r < row_count_; ++r) {
    const Row& row = rows_[r];
    warm_[at(r - start)] = std::clamp(kWarmStart * last_impulse_[row.axis], row.lower, row.upper);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float last = last_impulse_[axis];
    if (last * pull_[axis] < 0) pull_[axis] = 0;
    const bool weaker = std::fabs(last) < std::fabs(pull_[axis]);
    pull_[axis] += (last - pull_[axis]) * (weaker ? 1 : kPullRise);
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
  if (soft == 0) repair = std::clamp(repair, -kFastestRepair, kFastestRepair);
  add_row(axis, repair, soft, -kInfinity, kInfinity, RowKind::lock);
}

void JointConstraint::plan_motion(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  if (s.drive == AxisDrive::spring) plan_spring(axis);
  if (damping_ > 0) add_row(axis, 0, 1 / std::max(damping_ * h_, btScalar(1e-18)), -kInfinity, kInfinity);
  if (s.friction > 0) {
    const btScalar most = s.friction * h_;
    add_row(axis, 0, 0, -most, most);
  }
  if (s.limited()) {
    plan_limit(axis, false);
    plan_limit(axis, true);
  }
}

// A row that lets the axis just reach the limit within the step; beyond it, one that brings it back.
void JointConstraint::plan_limit(int axis, bool upper) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar sign = upper ? btScalar(-1) : btScalar(1);
  const double limit = static_cast<double>(upper ? s.upper : s.lower);
  const btScalar room = sign * static_cast<btScalar>(value(axis) - limit);
  const btScalar speed = sign * rate_[at(axis)];  // negative: approaching
  if (room > margin(axis) + 2 * h_ * std::max(-speed, btScalar(0))) return;

  const btScalar soft = softness(s, h_);
  btScalar least = -room / h_;
  btScalar pull = 0;
  RowKind kind = RowKind::plain;
  if (room < 0) {
    least *= s.stop_erp;
    // a limit pushes only; but what it pushed to repair itself it takes back, else the repair would throw the axis off
    if (soft == 0) {
      least = std::min(least, kFastestLimitRepair);
      pull = repair_impulse_[at(axis)];
      kind = RowKind::repair;
    }
  }
  if (bounce_ > 0 && room + h_ * speed <= 0 && -bounce_ * speed > least) {
    least = -bounce_ * speed;
    kind = RowKind::plain;
  }
  if (upper) {
    add_row(axis, -least, soft, -kInfinity, pull, kind);
  } else {
    add_row(axis, least, soft, -pull, kInfinity, kind);
  }
}

void JointConstraint::plan_motor(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar most = s.max_force * h_;
  const btScalar velocity = s.drive == AxisDrive::servo ? servo_velocity(axis) : spin_velocity(axis);
  add_row(axis, velocity, 0, -most, most, RowKind::motor);
}

// A motor that meets a limit asks for no more than the limit allows: the motion is that of a motor that presses with
// its full force and of a limit that reacts, without the two large impulses that sweeps would have to balance. What it
// presses with is counted in take_impulse(). A limit that yields is left to the motor as far as its force bends it.
btScalar JointConstraint::spin_velocity(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  if (!s.limited()) return s.velocity;
  const btScalar to_upper = static_cast<btScalar>(static_cast<double>(s.upper) - value(axis)) / h_;
  const btScalar to_lower = static_cast<btScalar>(static_cast<double>(s.lower) - value(axis)) / h_;
  if (s.stop_cfm > 0 && s.velocity != 0) {
    const btScalar bend = s.stop_cfm * s.max_force / h_;
    return s.velocity > 0 ? std::min(s.velocity, std::max(to_upper + bend, btScalar(0)))
                          : std::max(s.velocity, std::min(to_lower - bend, btScalar(0)));
  }
  const btScalar up = to_upper < 0 ? to_upper * s.stop_erp : to_upper;
  const btScalar down = to_lower > 0 ? to_lower * s.stop_erp : to_lower;
  if (s.velocity > 0 && s.velocity > up) presses_[at(axis)] = 1;
  if (s.velocity < 0 && s.velocity < down) presses_[at(axis)] = -1;
  return std::clamp(s.velocity, down, up);
}

// The servo follows its target's way through the tick (AxisGoals): feed-forward of the target's velocity plus a part of
// the error. Of the velocity it trusts what the target had in the last tick, too; where the target may stop at once, it
// goes no faster than its force can brake.
btScalar JointConstraint::servo_velocity(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const double h = static_cast<double>(h_);
  const GoalStep step = goals_.advance(axis, s.target, h, steps_left_);
  double least = static_cast<double>(s.lower);
  double most = static_cast<double>(s.upper);
  if (s.limited()) {
    const bool above = s.target > most + kOutside * (1 + std::fabs(most));
    const bool below = s.target < least - kOutside * (1 + std::fabs(least));
    if (above || below) outside_ = static_cast<std::uint8_t>(outside_ | 1u << axis);
    const double room = above ? most - value(axis) : value(axis) - least;
    if (s.stop_cfm == 0 && (above || below) && room < at_stop(axis)) presses_[at(axis)] = above ? 1 : -1;
    // a limit that yields is bent as far as the force goes
    const double bend = static_cast<double>(s.stop_cfm) * static_cast<double>(s.max_force);
    least -= bend;
    most += bend;
  }
  const auto within = [&](double position) { return s.limited() ? std::clamp(position, least, most) : position; };
  const double goal = within(step.to);
  const double limit = std::fabs(static_cast<double>(s.velocity));
  const double gain = limit > 0 ? kServoGain : kEagerServoGain;

  const double rate = (goal - within(step.from)) / h;
  const double known = 2 * step.last_rate;
  double trusted = rate * known > 0 ? (std::fabs(rate) < std::fabs(known) ? rate : known) : 0;
  if (limit > 0) trusted = std::clamp(trusted, -limit, limit);
  // a jump of the target takes at least as many steps as its error would
  const double ahead = (rate - trusted) * std::min(1.0, gain * step_count_);
  const double error = goal - value(axis) - trusted * h;
  double beyond = ahead + gain * (error / h - ahead);
  const double end = within(step.end) - value(axis) - trusted * h * steps_left_;
  const double way = beyond > 0 ? std::max(error, end) : std::max(-error, -end);
  const double fastest = static_cast<double>(braking_speed(axis, static_cast<btScalar>(std::max(way, 0.0))));
  beyond = std::clamp(beyond, -fastest, fastest);
  const double velocity = trusted + beyond;
  return static_cast<btScalar>(limit > 0 ? std::clamp(velocity, -limit, limit) : velocity);
}

// Never faster than the force can brake within the way that is left after this step: v² = 2·a·(way - v·h).
btScalar JointConstraint::braking_speed(int axis, btScalar way) {
  learn_inertia(axis);
  const btScalar inertia = learnt_inertia_[at(axis)];
  const btScalar max_force = axes_[at(axis)].max_force;
  if (!(inertia > 0 && max_force > 0)) return SIMD_INFINITY;
  const btScalar slowing = kBrakePart * max_force / inertia * h_;
  const btScalar whole = 2 * way / h_;
  return slowing * whole / (slowing + std::sqrt(slowing * (slowing + whole)));
}

// What a motor moves is more than its two parts: a saturated motor's impulse and the speed it won tell.
void JointConstraint::learn_inertia(int axis) {
  const std::size_t i = at(axis);
  const float pair = pair_inertia_[i];
  const float impulse = motor_impulse_[i];
  const float gained = rate_[i] - previous_rate_[i];
  // what was learnt fades, in a second or so, but never on the way to a stop that was planned with it
  float inertia = std::max(learnt_inertia_[i] * (impulse * rate_[i] < 0 ? 1.0f : 0.995f), pair);
  const bool saturated = std::fabs(impulse) >= 0.98f * axes_[i].max_force * h_;
  if (saturated && impulse * gained > 0 && std::fabs(rate_[i]) > 1e-3f) {
    const float measured = std::min(impulse / gained, 2000 * pair);
    inertia = measured > inertia ? measured : 0.9f * inertia + 0.1f * std::max(measured, pair);
  }
  learnt_inertia_[i] = inertia;
}

// The pull is explicit (symplectic, keeps its energy), the damping implicit (stable for any value): one row does both.
void JointConstraint::plan_spring(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar stiffness = capped_stiffness(axis);
  stiffness_applied_[at(axis)] = stiffness;
  holds_spring_ = holds_spring_ || stiffness < btScalar(0.999) * s.stiffness;
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
  const btScalar wanted = axes_[at(axis)].stiffness;
  const btScalar h2 = 16 * h_ * h_;
  // two free parts move more easily than parts held together: where they allow it, the joint does
  const Jacobian j = jacobian(axis);
  if (wanted * h2 * mobility(m_rbA, m_rbB, j, j) <= 1) return wanted;
  return std::min(wanted, static_cast<btScalar>(effective_inertia(axis)) / h2);
}

}  // namespace limber
