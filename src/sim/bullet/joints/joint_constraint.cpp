// JointConstraint: plans the rows of locks, limits, damping and friction, and those of the drives in their order.
#include "sim/bullet/joints/joint_constraint.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

/// A limit gets a row if it is nearer than this plus the distance covered in two steps: rad, m.
constexpr btScalar kAngularMargin = btScalar(0.05);
constexpr btScalar kLinearMargin = btScalar(0.005);
/// Largest repair speed of a hard lock or limit, rad/s and m/s, so that a joint torn apart closes without an impact.
constexpr btScalar kMaxRepairSpeed = btScalar(20);
/// The same for a limit. It is lower because contacts may have pushed the joint past its limit, and the repair presses
/// against them.
constexpr btScalar kMaxLimitRepairSpeed = btScalar(2);

btScalar limit_margin(int axis) { return axis < 3 ? kLinearMargin : kAngularMargin; }

// Converts compliance (per load, at rest) to softness (per impulse): the solver repairs erp/h of the error per second.
btScalar softness(const AxisSettings& s, btScalar h) { return s.stop_cfm * s.stop_erp / (h * h); }

// Clamps to a range; NaN becomes the minimum.
template <class T>
T clamped(T v, T min_value, T max_value) {
  return v >= min_value ? std::min(v, max_value) : min_value;
}

AxisSettings clamped(AxisSettings s) {
  for (float* position : {&s.lower, &s.upper}) *position = clamped(*position, -1e6f, 1e6f);
  for (double* position : {&s.target, &s.rest}) *position = clamped(*position, -1e6, 1e6);
  for (float* size : {&s.max_force, &s.stiffness, &s.spring_damping, &s.friction, &s.armature, &s.no_load_speed})
    *size = clamped(*size, 0.0f, 1e12f);
  s.velocity = clamped(s.velocity, -1e5f, 1e5f);
  s.torque = clamped(s.torque, -1e12f, 1e12f);
  s.stop_erp = clamped(s.stop_erp, 0.0f, 1.0f);
  s.stop_cfm = clamped(s.stop_cfm, 0.0f, 1e6f);
  return s;
}

}  // namespace

JointConstraint::JointConstraint(btRigidBody& parent, btRigidBody& child, const btTransform& frame_in_parent,
                                 const btTransform& frame_in_child)
    : btTypedConstraint(kType, parent, child), pose_(parent, child, frame_in_parent, frame_in_child) {
  reset();
}

void JointConstraint::set_axis(int axis, const AxisSettings& settings) {
  AxisSettings& current = axes_[at(axis)];
  const AxisSettings before = current;
  current = clamped(settings);
  if (current.drive != before.drive || (before.locked() && !current.locked())) target_interpolator().restart(axis);
  if (current.lower == before.lower && current.upper == before.upper) return;
  pose_.set_ranges(axes_);
  // a free axis may have made many turns, which the new limits must not unwind
  if (axis >= 3 && current.limited()) pose_.turn_into(axis, current.lower, current.upper);
}

bool JointConstraint::set_target(int axis, double target, double rest, double velocity, double torque) {
  AxisSettings& current = axes_[at(axis)];
  const AxisSettings before = current;
  current.target = clamped(target, -1e6, 1e6);
  current.rest = clamped(rest, -1e6, 1e6);
  current.velocity = clamped(static_cast<float>(velocity), -1e5f, 1e5f);
  current.torque = clamped(static_cast<float>(torque), -1e12f, 1e12f);
  return !(current == before);
}

void JointConstraint::reset(const Vec3& near_angles) {
  pose_.reset(near_angles);
  drives_.reset(pose_);
  reaction_.reset();
  warm_start_.reset();
  repair_impulse_.fill(0);
}

void JointConstraint::end_tick() {
  drives_.end_tick();
  reaction_.end_tick();
  refresh();
}

bool JointConstraint::commands_motion() const {
  constexpr float kMinSpeedFraction = 0.25f;  // of the speed limit: a slower servo is blocked or has reached its target
  if (target_interpolator().moving()) return true;
  for (int axis = 0; axis < 6; ++axis) {
    const AxisSettings& s = axes_[at(axis)];
    if (s.locked() || s.max_force <= 0 || s.velocity == 0) continue;
    if (s.drive == AxisDrive::spin) return true;
    if (s.drive == AxisDrive::servo && std::fabs(pose_.rates()[at(axis)]) > kMinSpeedFraction * std::fabs(s.velocity))
      return true;
  }
  return false;
}

btVector3 JointConstraint::lock_impulse() const {
  const std::array<float, 3>& impulse = warm_start_.lock_impulse();
  return pose_.linear_axis(0) * impulse[0] + pose_.linear_axis(1) * impulse[1] + pose_.linear_axis(2) * impulse[2];
}

const JointRows& JointConstraint::plan(JointRow* memory) {
  rows_ = JointRows(memory);
  pose_.read();
  drives_.begin_step();
  for (int axis = 0; axis < 6; ++axis) {
    if (!axes_[at(axis)].locked()) plan_unlocked(axis);
  }
  plan_motors();
  for (const int axis : {3, 4, 5, 0, 1, 2}) {
    if (axes_[at(axis)].locked()) plan_lock(axis);
  }
  warm_start_.begin_step(rows_);
  drives_.end_plan(pose_);
  repair_impulse_.fill(0);
  return rows_;
}

void JointConstraint::plan_unlocked(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  if (s.drive == AxisDrive::spring || s.drive == AxisDrive::torque) drives_.plan(driven(axis), rows_);
  if (damping_ > 0)
    rows_.add(axis, 0, 1 / std::max(damping_ * step_.h, btScalar(1e-18)), -JointRow::kUnbounded, JointRow::kUnbounded);
  // the rotor resists a change of the rate with which the step begins: impulse = armature·(rate before - rate after)
  if (s.armature > 0) {
    rows_.add(axis, pose_.rates()[at(axis)], 1 / s.armature, -JointRow::kUnbounded, JointRow::kUnbounded);
  }
  if (s.friction > 0) {
    const btScalar max_impulse = s.friction * step_.h;
    rows_.add(axis, 0, 0, -max_impulse, max_impulse);
  }
  if (s.limited()) {
    plan_limit(axis, false);
    plan_limit(axis, true);
  }
}

// Adds a row that lets the axis just reach the limit within the step, or repairs a violated limit.
void JointConstraint::plan_limit(int axis, bool upper) {
  const AxisSettings& s = axes_[at(axis)];
  const btScalar h = step_.h;
  const btScalar sign = upper ? btScalar(-1) : btScalar(1);
  const double limit = static_cast<double>(upper ? s.upper : s.lower);
  const btScalar distance = sign * static_cast<btScalar>(value(axis) - limit);
  const btScalar speed = sign * pose_.rates()[at(axis)];  // negative: approaching
  if (distance > limit_margin(axis) + 2 * h * std::max(-speed, btScalar(0))) return;

  const btScalar soft = softness(s, h);
  btScalar min_speed = -distance / h;
  btScalar repair_impulse = 0;
  JointRow::Kind kind = JointRow::Kind::other;
  if (distance < 0) {
    min_speed *= s.stop_erp;
    // a limit only pushes, but may revert its repair impulse of the last step; else the axis would bounce off at the
    // repair speed
    if (soft == 0) {
      min_speed = std::min(min_speed, kMaxLimitRepairSpeed);
      repair_impulse = repair_impulse_[at(axis)];
      kind = JointRow::Kind::repair;
    }
  }
  if (bounce_ > 0 && distance + h * speed <= 0 && -bounce_ * speed > min_speed) {
    min_speed = -bounce_ * speed;
    kind = JointRow::Kind::other;
  }
  if (upper) {
    rows_.add(axis, -min_speed, soft, -JointRow::kUnbounded, repair_impulse, kind);
  } else {
    rows_.add(axis, min_speed, soft, -repair_impulse, JointRow::kUnbounded, kind);
  }
}

void JointConstraint::plan_motors() {
  bool any = false;
  for (int axis = 0; axis < 6; ++axis) {
    const AxisSettings& s = axes_[at(axis)];
    if (s.locked() || !s.has_motor()) continue;
    drives_.plan(driven(axis), rows_);
    any = true;
  }
  rows_.begin_locks(any);
}

void JointConstraint::plan_lock(int axis) {
  const AxisSettings& s = axes_[at(axis)];
  double error = static_cast<double>(s.lower) - value(axis);
  if (axis >= 3) error = std::remainder(error, 2 * kPi);
  const btScalar soft = softness(s, step_.h);
  btScalar repair = static_cast<btScalar>(error) * s.stop_erp / step_.h;
  if (soft == 0) repair = std::clamp(repair, -kMaxRepairSpeed, kMaxRepairSpeed);
  rows_.add(axis, repair, soft, -JointRow::kUnbounded, JointRow::kUnbounded, JointRow::Kind::lock);
}

void JointConstraint::set_impulses(const btSolverConstraint* rows, int count) {
  for (int r = 0; r < count && r < rows_.size(); ++r) {
    set_impulse(rows_[r], rows[r].m_appliedImpulse, rows[r].m_jacDiagABInv);
  }
  end_substep();
}

void JointConstraint::set_impulses(solver::IndexedSpan<const double> impulses) {
  for (int r = 0; r < impulses.size() && r < rows_.size(); ++r) {
    const JointRow& row = rows_[r];
    btScalar inverse_mobility = 0;
    if (row.kind == JointRow::Kind::repair || row.kind == JointRow::Kind::motor) {
      const AxisJacobian j = pose_.jacobian(row.axis);
      const btScalar mobility = pose_.mobility(j, j);
      inverse_mobility = mobility > SIMD_EPSILON ? 1 / (mobility + row.softness) : 0;
    }
    set_impulse(row, to_scalar(impulses[r]), inverse_mobility);
  }
  end_substep();
}

void JointConstraint::end_substep() {
  drives_.end_substep(step_.h);
  reaction_.end_substep(pose_, step_.h);
}

void JointConstraint::set_impulse(const JointRow& row, btScalar impulse, btScalar inverse_mobility) {
  // of a repair, store only the impulse that moved the axis: if the limit reverted the part that supported a load, too,
  // it would pull
  if (row.kind == JointRow::Kind::repair) {
    repair_impulse_[row.axis] = std::min(std::fabs(impulse), std::fabs(row.velocity) * inverse_mobility);
  }
  warm_start_.store(row, impulse);
  reaction_.add(row.axis, impulse);
  if (row.kind == JointRow::Kind::motor) drives_.store(row, impulse, inverse_mobility);
}

void JointConstraint::getInfo1(btConstraintInfo1* info) {
  std::array<JointRow, JointRows::kMax> memory;
  info->m_numConstraintRows = plan(memory.data()).size();
  rows_ = {};
  info->nub = 0;
}

void JointConstraint::getInfo2(btConstraintInfo2* info) {
  const auto put = [](btScalar* to, const btVector3& v) {
    to[0] = v.x();
    to[1] = v.y();
    to[2] = v.z();
  };
  for (int r = 0; r < rows_.size(); ++r) {
    const JointRow& row = rows_[r];
    const AxisJacobian j = pose_.jacobian(row.axis);
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

void JointConstraint::setParam(int parameter, btScalar value, int axis) {
  if (axis < 0 || axis > 5) return;
  if (parameter == BT_CONSTRAINT_STOP_ERP) axes_[at(axis)].stop_erp = value;
  if (parameter == BT_CONSTRAINT_STOP_CFM) axes_[at(axis)].stop_cfm = value;
}

btScalar JointConstraint::getParam(int parameter, int axis) const {
  if (axis < 0 || axis > 5) return 0;
  const AxisSettings& s = axes_[at(axis)];
  return parameter == BT_CONSTRAINT_STOP_CFM ? s.stop_cfm : s.stop_erp;
}

}  // namespace limber::sim::bullet
