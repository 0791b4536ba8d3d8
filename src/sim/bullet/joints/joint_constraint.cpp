// JointConstraint: plans the rows of locks, limits, damping and friction, and those of the drives in their order.
#include "sim/bullet/joints/joint_constraint.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

btScalar limit_margin(int axis) { return axis < 3 ? kLinearLimitMargin : kAngularLimitMargin; }

btScalar softness(const AxisSettings& s, btScalar h) { return stop_softness(s.stop_erp, s.stop_cfm, h); }

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
  ball_limits_.reset();
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
  ball_limits_.plan(pose_, {axes_[5].stop_erp, axes_[5].stop_cfm, bounce_}, step_.h);
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
  const LimitState state{sign * static_cast<btScalar>(value(axis) - limit),
                         sign * pose_.rates()[at(axis)],
                         limit_margin(axis),
                         s.stop_erp,
                         softness(s, h),
                         bounce_,
                         repair_impulse_[at(axis)]};
  if (!limit_is_near(state, h)) return;
  const LimitRow row = limit_row(state, h);
  if (upper) {
    rows_.add(axis, -row.min_speed, row.softness, -JointRow::kUnbounded, row.repair_impulse, row.kind);
  } else {
    rows_.add(axis, row.min_speed, row.softness, -row.repair_impulse, JointRow::kUnbounded, row.kind);
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
  if (soft == 0) repair = std::clamp(repair, -kMaxLockRepairSpeed, kMaxLockRepairSpeed);
  rows_.add(axis, repair, soft, -JointRow::kUnbounded, JointRow::kUnbounded, JointRow::Kind::lock);
}

void JointConstraint::set_impulses(const btSolverConstraint* rows, int count) {
  const int first = ball_limits_.count();
  for (int r = 0; r < count && r < first; ++r) set_ball_impulse(r, rows[r].m_appliedImpulse);
  for (int r = first; r < count && r < first + rows_.size(); ++r) {
    set_impulse(rows_[r - first], rows[r].m_appliedImpulse, rows[r].m_jacDiagABInv);
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

void JointConstraint::set_ball_impulse(int row, btScalar impulse) {
  const BallLimitRow& limit = ball_limits_[row];
  const btScalar mobility = pose_.mobility(limit.jacobian(), limit.jacobian());
  ball_limits_.set_impulse(row, impulse, mobility > SIMD_EPSILON ? 1 / (mobility + limit.row.softness) : 0);
  reaction_.add_angular(limit.axis * impulse);
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
  plan(memory.data());
  info->m_numConstraintRows = ball_limits_.count() + rows_.size();
  rows_ = {};
  info->nub = 0;
}

void JointConstraint::getInfo2(btConstraintInfo2* info) {
  const auto put = [](btScalar* to, const btVector3& v) {
    to[0] = v.x();
    to[1] = v.y();
    to[2] = v.z();
  };
  const int first = ball_limits_.count();
  for (int r = 0; r < first + rows_.size(); ++r) {
    const bool is_ball_limit = r < first;
    const JointRow& row = is_ball_limit ? ball_limits_[r].row : rows_[r - first];
    const AxisJacobian j = is_ball_limit ? ball_limits_[r].jacobian() : pose_.jacobian(row.axis);
    const int skip = r * info->rowskip;
    if (!is_ball_limit && row.axis < 3) {
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
