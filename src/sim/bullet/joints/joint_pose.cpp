// JointPose: order of angles, unwrapped angles, rates, and effective inertia.
#include "sim/bullet/joints/joint_pose.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

constexpr double kTurn = 2 * kPi;
/// Angles that change by more than this in one substep are predicted before they are read, rad.
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

}  // namespace

void JointPose::set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child) {
  frame_a_ = frame_in_parent;
  frame_b_ = frame_in_child;
  read();
}

void JointPose::set_ranges(const JointAxes& axes) {
  const int middle = middle_;
  // smallest range wins; ties: y before x before z
  middle_ = 1;
  if (max_deviation(axes[3]) < max_deviation(axes[at(3 + middle_)])) middle_ = 0;
  if (max_deviation(axes[5]) < max_deviation(axes[at(3 + middle_)])) middle_ = 2;
  outer_ = middle_ == 2 ? 1 : 2;
  inner_ = 3 - middle_ - outer_;
  locked_ = 0;
  for (int axis = 0; axis < 6; ++axis) locked_ |= axes[at(axis)].locked() ? 1u << axis : 0;
  own_axis_turns_ = max_deviation(axes[5]) > kPi;
  read(middle != middle_);
}

void JointPose::turn_into(int axis, float lower, float upper) {
  double& angle = angle_[at(axis - 3)];
  if (angle >= static_cast<double>(lower) && angle <= static_cast<double>(upper)) return;
  const double center = 0.5 * (static_cast<double>(lower) + static_cast<double>(upper));
  angle -= kTurn * std::round((angle - center) / kTurn);
}

void JointPose::reset(const Vec3& near_angles) {
  angle_ = {near_angles.x, near_angles.y, near_angles.z};
  read(near_angles == Vec3(0));
}

void JointPose::read(bool principal) {
  const btTransform& part_a = parent_.getCenterOfMassTransform();
  const btTransform& part_b = child_.getCenterOfMassTransform();
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

double JointPose::unwrapped(int axis, double raw) const {
  return raw + kTurn * std::round((angle_[at(axis)] - raw) / kTurn);
}

void JointPose::predict_angles(btScalar h) {
  const btVector3 angular_velocity = this->angular_velocity();
  for (int i = 0; i < 3; ++i) {
    if (locked(3 + i)) continue;
    const double change = static_cast<double>(dual_[at(i)].dot(angular_velocity) * h);
    if (std::fabs(change) > kPredictedTurn) angle_[at(i)] += change;
  }
}

// R = R_outer(a)·R_middle(b)·R_inner(c), its element ij being axis_a[i] · axis_b[j].
void JointPose::read_angles(const btVector3* axes_b, bool principal) {
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
  if (!principal && !locked(3 + middle_)) {
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

void JointPose::read_rates() {
  const btVector3 angular_velocity = this->angular_velocity();
  const btVector3 linear_velocity = child_.getLinearVelocity() + child_.getAngularVelocity().cross(arm_b_) -
                                    parent_.getLinearVelocity() - parent_.getAngularVelocity().cross(arm_a_);
  for (int i = 0; i < 3; ++i) {
    rate_[at(i)] = axis_a_[at(i)].dot(linear_velocity);
    rate_[at(3 + i)] = dual_[at(i)].dot(angular_velocity);
  }
}

btMatrix3x3 JointPose::rotation_matrix() const {
  const btMatrix3x3 a = parent_.getCenterOfMassTransform().getBasis() * frame_a_.getBasis();
  return a.transposeTimes(child_.getCenterOfMassTransform().getBasis() * frame_b_.getBasis());
}

Quat JointPose::rotation() const {
  btQuaternion rotation;
  rotation_matrix().getRotation(rotation);
  return from_bt(rotation);
}

Vec3 JointPose::relrot() const {
  const btMatrix3x3 r = rotation_matrix();
  const auto element = [&r](int i, int j) { return static_cast<double>(r[i][j]); };
  Vec3 angles(fixed::atan2(element(2, 1), element(2, 2)),
              fixed::atan2(-element(2, 0), fixed::hypot(element(2, 1), element(2, 2))),
              fixed::atan2(element(1, 0), element(0, 0)));
  if (own_axis_turns_) angles.z = unwrapped(2, angles.z);
  return angles;
}

AxisJacobian JointPose::jacobian(int axis) const {
  if (axis >= 3) {
    const btVector3& d = dual_[at(axis - 3)];
    return {btVector3(0, 0, 0), -d, d};
  }
  const btVector3& d = axis_a_[at(axis)];
  return {d, -arm_a_.cross(d), arm_b_.cross(d)};
}

btScalar JointPose::mobility(const AxisJacobian& i, const AxisJacobian& j) const {
  return i.linear.dot(j.linear) * (parent_.getInvMass() + child_.getInvMass()) +
         i.angular_a.dot(parent_.getInvInertiaTensorWorld() * j.angular_a) +
         i.angular_b.dot(child_.getInvInertiaTensorWorld() * j.angular_b);
}

double JointPose::effective_inertia(int axis) const {
  // 1/m = j M^-1 j' - k' K^-1 k with K, k of the locked rows: row-wise Cholesky factorization with j as the last row
  const AxisJacobian own = jacobian(axis);
  std::array<AxisJacobian, 6> rows;
  int n = 0;
  for (int i = 0; i < 6; ++i) {
    if (i != axis && locked(i)) rows[at(n++)] = jacobian(i);
  }
  rows[at(n)] = own;
  double factor[6][6] = {};
  double remainder = 0;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double full = static_cast<double>(mobility(rows[at(i)], rows[at(j)]));
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

}  // namespace limber::sim::bullet
