// JointConstraint: its geometry: frames, order of angles, unwrapped angles, rates, and effective inertia.
#include "sim/bullet/joint_constraint.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

constexpr double kTurn = 2 * kPi;
/// Angles that change by more than this in one internal step are predicted before they are read, rad.
constexpr double kPredictedTurn = 0.5;
/// Least squared cosine of the middle angle: within 5.7 degrees of the singular pose, rates are underestimated.
constexpr btScalar kMinCosine2 = btScalar(0.01);

// -1 if outer, middle, inner is an odd permutation of x, y, z.
btScalar parity(int outer, int middle) { return btScalar((outer + 1) % 3 == middle ? 1 : -1); }

// Largest distance of an axis from 0; the axis with the smallest becomes the middle one.
double max_deviation(const AxisSettings& s) {
  if (s.free()) return kTurn * 1e3;
  return std::max(std::fabs(static_cast<double>(s.lower)), std::fabs(static_cast<double>(s.upper)));
}

// Clamps to a range; NaN becomes the minimum.
template <class T>
T clamped(T v, T min_value, T max_value) {
  return v >= min_value ? std::min(v, max_value) : min_value;
}

AxisSettings clamped(AxisSettings s) {
  for (float* position : {&s.lower, &s.upper}) *position = clamped(*position, -1e6f, 1e6f);
  for (double* position : {&s.target, &s.rest}) *position = clamped(*position, -1e6, 1e6);
  for (float* size : {&s.max_force, &s.stiffness, &s.spring_damping, &s.friction}) *size = clamped(*size, 0.0f, 1e12f);
  s.velocity = clamped(s.velocity, -1e5f, 1e5f);
  s.stop_erp = clamped(s.stop_erp, 0.0f, 1.0f);
  s.stop_cfm = clamped(s.stop_cfm, 0.0f, 1e6f);
  return s;
}

}  // namespace

JointConstraint::JointConstraint(btRigidBody& parent, btRigidBody& child, const btTransform& frame_in_parent,
                                 const btTransform& frame_in_child)
    : btTypedConstraint(kType, parent, child), frame_a_(frame_in_parent), frame_b_(frame_in_child) {
  reset();
}

void JointConstraint::set_axis(int axis, const AxisSettings& settings) {
  AxisSettings& current = axes_[at(axis)];
  const float lower = current.lower;
  const float upper = current.upper;
  const AxisDrive drive = current.drive;
  current = clamped(settings);
  if (current.drive != drive || (lower == upper && !current.locked())) goals_.restart(axis);
  if (current.lower == lower && current.upper == upper) return;
  const int middle = middle_;
  choose_order();
  read_pose(middle != middle_);

  // a free axis may have made many turns, which the new limits must not unwind: change its angle by full turns
  if (axis < 3 || !current.limited()) return;
  double& angle = angle_[at(axis - 3)];
  if (angle >= static_cast<double>(current.lower) && angle <= static_cast<double>(current.upper)) return;
  const double center = 0.5 * (static_cast<double>(current.lower) + static_cast<double>(current.upper));
  angle -= kTurn * std::round((angle - center) / kTurn);
}

bool JointConstraint::set_goal(int axis, double target, double rest, double velocity) {
  AxisSettings& current = axes_[at(axis)];
  const AxisSettings before = current;
  current.target = clamped(target, -1e6, 1e6);
  current.rest = clamped(rest, -1e6, 1e6);
  current.velocity = clamped(static_cast<float>(velocity), -1e5f, 1e5f);
  return !(current == before);
}

void JointConstraint::set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child) {
  frame_a_ = frame_in_parent;
  frame_b_ = frame_in_child;
  read_pose();
}

void JointConstraint::reset(const Vec3& near_angles) {
  angle_ = {near_angles.x, near_angles.y, near_angles.z};
  motor_impulse_.fill(0);
  repair_impulse_.fill(0);
  last_impulse_.fill(0);
  lock_impulse_.fill(0);
  active_set_memory_.fill(0);
  lock_energy_ = 0;
  tick_impulse_.fill(0);
  applied_.fill(0);
  inertia_estimate_.fill(0);
  pair_inertia_.fill(0);
  tick_time_ = 0;
  goals_.restart();
  read_pose(near_angles == Vec3(0));
  previous_rate_ = rate_;
}

void JointConstraint::refresh() { read_pose(); }

void JointConstraint::end_tick() {
  const float per_time = tick_time_ > 0 ? 1.0f / tick_time_ : 0.0f;
  for (std::size_t i = 0; i < 6; ++i) applied_[i] = tick_impulse_[i] * per_time;
  tick_impulse_.fill(0);
  tick_time_ = 0;
  goals_.end_tick();
  read_pose();
}

void JointConstraint::choose_order() {
  // smallest range wins; ties: y before x before z
  middle_ = 1;
  if (max_deviation(axes_[3]) < max_deviation(axes_[at(3 + middle_)])) middle_ = 0;
  if (max_deviation(axes_[5]) < max_deviation(axes_[at(3 + middle_)])) middle_ = 2;
  outer_ = middle_ == 2 ? 1 : 2;
  inner_ = 3 - middle_ - outer_;
}

void JointConstraint::read_pose(bool principal) {
  const btTransform& part_a = m_rbA.getCenterOfMassTransform();
  const btTransform& part_b = m_rbB.getCenterOfMassTransform();
  const btMatrix3x3 basis_a = part_a.getBasis() * frame_a_.getBasis();
  const btMatrix3x3 basis_b = part_b.getBasis() * frame_b_.getBasis();
  arm_b_ = part_b.getBasis() * frame_b_.getOrigin();
  const btVector3 pivot = part_b.getOrigin() + arm_b_;
  arm_a_ = pivot - part_a.getOrigin();
  const btVector3 gap = arm_a_ - part_a.getBasis() * frame_a_.getOrigin();
  btVector3 axes_b[3];
  for (int i = 0; i < 3; ++i) {
    axis_a_[at(i)] = basis_a.getColumn(i);
    axes_b[i] = basis_b.getColumn(i);
    offset_[at(i)] = axis_a_[at(i)].dot(gap);
  }
  read_angles(axes_b, principal);
  read_rates();
}

double JointConstraint::unwrapped(int axis, double raw) const {
  return raw + kTurn * std::round((angle_[at(axis)] - raw) / kTurn);
}

void JointConstraint::predict_angles(btScalar h) {
  const btVector3 angular_velocity = m_rbB.getAngularVelocity() - m_rbA.getAngularVelocity();
  for (int i = 0; i < 3; ++i) {
    if (axes_[at(3 + i)].locked()) continue;
    const double change = static_cast<double>(dual_[at(i)].dot(angular_velocity) * h);
    if (std::fabs(change) > kPredictedTurn) angle_[at(i)] += change;
  }
}

// R = R_outer(a)·R_middle(b)·R_inner(c), its element ij being axis_a[i] · axis_b[j].
void JointConstraint::read_angles(const btVector3* axes_b, bool principal) {
  const btScalar sign = parity(outer_, middle_);
  const btVector3& a_outer = axis_a_[at(outer_)];
  const btVector3& a_middle = axis_a_[at(middle_)];
  const btVector3& a_inner = axis_a_[at(inner_)];
  const btScalar sine = sign * a_outer.dot(axes_b[inner_]);
  const btScalar middle_inner = a_middle.dot(axes_b[inner_]);
  const btScalar inner_inner = a_inner.dot(axes_b[inner_]);
  btScalar cosine = std::sqrt(middle_inner * middle_inner + inner_inner * inner_inner);

  double outer = static_cast<double>(fixed::atan2f(-sign * middle_inner, inner_inner));
  double middle = static_cast<double>(fixed::atan2f(sine, cosine));
  double inner = static_cast<double>(fixed::atan2f(-sign * a_outer.dot(axes_b[middle_]), a_outer.dot(axes_b[outer_])));
  const double outer_near = unwrapped(outer_, outer);
  const double middle_near = principal ? middle : unwrapped(middle_, middle);
  const double inner_near = unwrapped(inner_, inner);
  const auto distance = [this](double o, double m, double i) {
    return std::fabs(o - angle_[at(outer_)]) + std::fabs(m - angle_[at(middle_)]) + std::fabs(i - angle_[at(inner_)]);
  };
  outer = outer_near;
  middle = middle_near;
  inner = inner_near;

  // three angles have a second solution, beyond the singular pose: choose the one nearer to the last angles
  if (!principal && !axes_[at(3 + middle_)].locked()) {
    const double outer_far = unwrapped(outer_, outer_near + kPi);
    const double middle_far = unwrapped(middle_, kPi - middle_near);
    const double inner_far = unwrapped(inner_, inner_near + kPi);
    if (distance(outer_far, middle_far, inner_far) < distance(outer_near, middle_near, inner_near)) {
      outer = outer_far;
      middle = middle_far;
      inner = inner_far;
      cosine = -cosine;
    }
  }
  angle_[at(outer_)] = outer;
  angle_[at(middle_)] = middle;
  angle_[at(inner_)] = inner;

  // the angular velocity is rate_outer·e_outer + rate_middle·e_middle + rate_inner·e_inner; these are the dual axes
  const btVector3& e_outer = a_outer;
  const btVector3& e_inner = axes_b[inner_];
  const btScalar cosine2 = std::max(cosine * cosine, kMinCosine2);
  const btScalar axes_product = sign * sine;
  dual_[at(outer_)] = (e_outer - axes_product * e_inner) / cosine2;
  dual_[at(inner_)] = (e_inner - axes_product * e_outer) / cosine2;
  const btScalar scale = sign / std::copysign(std::sqrt(cosine2), cosine);
  dual_[at(middle_)] = scale * e_inner.cross(e_outer);
}

void JointConstraint::read_rates() {
  const btVector3 angular_velocity = m_rbB.getAngularVelocity() - m_rbA.getAngularVelocity();
  const btVector3 linear_velocity = m_rbB.getLinearVelocity() + m_rbB.getAngularVelocity().cross(arm_b_) -
                                    m_rbA.getLinearVelocity() - m_rbA.getAngularVelocity().cross(arm_a_);
  for (int i = 0; i < 3; ++i) {
    rate_[at(i)] = axis_a_[at(i)].dot(linear_velocity);
    rate_[at(3 + i)] = dual_[at(i)].dot(angular_velocity);
  }
}

Vec3 JointConstraint::relrot() const {
  const btMatrix3x3 a = m_rbA.getCenterOfMassTransform().getBasis() * frame_a_.getBasis();
  const btMatrix3x3 r = a.transposeTimes(m_rbB.getCenterOfMassTransform().getBasis() * frame_b_.getBasis());
  const auto element = [&r](int i, int j) { return static_cast<double>(r[i][j]); };
  Vec3 angles(fixed::atan2(element(2, 1), element(2, 2)),
              fixed::atan2(-element(2, 0), fixed::hypot(element(2, 1), element(2, 2))),
              fixed::atan2(element(1, 0), element(0, 0)));
  const AxisSettings& own = axes_[5];
  if (own.free() || max_deviation(own) > kPi) angles.z = unwrapped(2, angles.z);
  return angles;
}

JointConstraint::Jacobian JointConstraint::jacobian(int axis) const {
  if (axis >= 3) {
    const btVector3& d = dual_[at(axis - 3)];
    return {btVector3(0, 0, 0), -d, d};
  }
  const btVector3& d = axis_a_[at(axis)];
  return {d, -arm_a_.cross(d), arm_b_.cross(d)};
}

btScalar JointConstraint::mobility(const btRigidBody& a, const btRigidBody& b, const Jacobian& i, const Jacobian& j) {
  return i.linear.dot(j.linear) * (a.getInvMass() + b.getInvMass()) +
         i.angular_a.dot(a.getInvInertiaTensorWorld() * j.angular_a) +
         i.angular_b.dot(b.getInvInertiaTensorWorld() * j.angular_b);
}

double JointConstraint::effective_inertia(int axis) const {
  // 1/m = j M^-1 j' - k' K^-1 k with K, k of the locked rows: row-wise Cholesky factorization with j as the last row
  const Jacobian own = jacobian(axis);
  std::array<Jacobian, 6> rows;
  int n = 0;
  for (int i = 0; i < 6; ++i) {
    if (i != axis && axes_[at(i)].locked()) rows[at(n++)] = jacobian(i);
  }
  rows[at(n)] = own;
  double factor[6][6] = {};
  double remainder = 0;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double full = static_cast<double>(mobility(m_rbA, m_rbB, rows[at(i)], rows[at(j)]));
      double sum = full;
      for (int k = 0; k < j; ++k) sum -= factor[i][k] * factor[j][k];
      if (j < i) {
        factor[i][j] = factor[j][j] > 0 ? sum / factor[j][j] : 0;
      } else {
        remainder = std::max(sum, 0.0);
        // a row that depends on the others adds nothing
        factor[i][i] = remainder > 1e-6 * full ? std::sqrt(remainder) : 0;
      }
    }
  }
  return remainder > 0 ? 1 / remainder : 0;
}

bool JointConstraint::commands_motion() const {
  constexpr float kMinSpeedFraction = 0.25f;  // of the speed limit: a slower servo is blocked or has reached its target
  if (goals_.moving()) return true;
  for (int axis = 0; axis < 6; ++axis) {
    const AxisSettings& s = axes_[at(axis)];
    if (s.locked() || s.max_force <= 0 || s.velocity == 0) continue;
    if (s.drive == AxisDrive::spin) return true;
    if (s.drive == AxisDrive::servo && std::fabs(rate_[at(axis)]) > kMinSpeedFraction * std::fabs(s.velocity))
      return true;
  }
  return false;
}

double JointConstraint::stiffness_applied(int axis) const { return static_cast<double>(stiffness_applied_[at(axis)]); }

double JointConstraint::damping_applied(int axis) const {
  const AxisSettings& s = axes_[at(axis)];
  return s.drive == AxisDrive::spring && !s.locked() ? static_cast<double>(s.spring_damping) : 0;
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

}  // namespace limber
