// JointPose: pose of a joint's child relative to its parent: angles that count full turns, offsets, their rates, and
// the Jacobians of the axes.
#pragma once

#include <array>

#include "base/vec.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/axis_settings.h"

namespace limber::sim::bullet {

/// Jacobian of an axis: its rate per velocity of the child (linear, angular_b) and of the parent (-linear, angular_a).
struct AxisJacobian {
  btVector3 linear;
  btVector3 angular_a;
  btVector3 angular_b;
};

/// Axes 0..2 are linear along the parent-side frame's axes, 3..5 are angular about x, y, z. The own axis is z (2 and
/// 5). Positive: the child moves or turns relative to the parent along or about +axis. All values are those of the last
/// read(). [sim]
///
/// Order of angles: R(child in parent) = R_outer·R_middle·R_inner. The middle axis, which alone is singular at ±pi/2,
/// is the one with the smallest range (a locked one if there is one); outer is z, or y if z is the middle. Free x, y,
/// z, or only z or x free: Rz·Ry·Rx. Only y, or y and z free: Rz·Rx·Ry. x and y: Ry·Rz·Rx.
class JointPose {
 public:
  /// Frames are given in each part's center-of-mass frame. All axes are locked at 0. Nothing is read yet.
  JointPose(const btRigidBody& parent, const btRigidBody& child, const btTransform& frame_in_parent,
            const btTransform& frame_in_child)
      : parent_(parent), child_(child), frame_a_(frame_in_parent), frame_b_(frame_in_child) {}

  /// Sets the frames and reads the pose, with the turns nearest to the present.
  void set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child);
  /// Chooses the order of the angles by the ranges of the axes, and reads the pose.
  void set_ranges(const JointAxes& axes);
  /// If the angle of an angular axis is outside [lower, upper], changes it by full turns to be nearest to their center.
  void turn_into(int axis, float lower, float upper);
  /// Reads the pose with the turns nearest to `near` (rad, own order; 0: outer and inner angle within ±pi, middle
  /// within ±pi/2).
  void reset(const Vec3& near_angles);
  /// Reads angles, offsets and rates from the bodies, with the turns nearest to the present.
  void read() { read(false); }
  /// Advances fast angles by their rates, because a pose is ambiguous by full turns and the next read chooses the turn
  /// nearest to the predicted angle. Call after the bodies moved for `h` s.
  void predict_angles(btScalar h);

  const btTransform& frame_in_parent() const { return frame_a_; }
  const btTransform& frame_in_child() const { return frame_b_; }
  /// World pose of the joint's frame on the parent, and on the child (which includes the joint's motion).
  Pose parent_frame() const { return from_bt(parent_.getCenterOfMassTransform() * frame_a_); }
  Pose child_frame() const { return from_bt(child_.getCenterOfMassTransform() * frame_b_); }
  /// Outer, middle, inner axis, each 0 (x) .. 2 (z).
  std::array<int, 3> order() const { return {outer_, middle_, inner_}; }

  /// Position of one axis, 0..5, m or rad; its rate, m/s or rad/s.
  double value(int axis) const { return axis < 3 ? static_cast<double>(offset_[at(axis)]) : angle_[at(axis - 3)]; }
  double rate(int axis) const { return static_cast<double>(rate_[at(axis)]); }
  const std::array<float, 6>& rates() const { return rate_; }
  Vec3 angles() const { return {angle_[0], angle_[1], angle_[2]}; }
  /// Rotation of the child's joint frame in the parent's.
  Quat rotation() const;
  /// Angular velocity of the child relative to the parent, world.
  btVector3 angular_velocity() const { return child_.getAngularVelocity() - parent_.getAngularVelocity(); }
  Vec3 offsets() const { return {offset_[0], offset_[1], offset_[2]}; }
  /// The present rotation as Rz(z)·Ry(y)·Rx(x), whatever the own order; z counts turns if axis 5 can exceed ±pi.
  Vec3 relrot() const;

  /// Vectors from the centers of mass of the parent (a) and the child (b) to the child's pivot, world.
  const btVector3& arm_a() const { return arm_a_; }
  const btVector3& arm_b() const { return arm_b_; }
  /// Axis i of the joint's frame on the parent, world.
  const btVector3& linear_axis(int i) const { return axis_a_[at(i)]; }
  /// Dual axis i, world: the rate of angle i is its dot product with the child's angular velocity relative to the
  /// parent.
  const btVector3& dual_axis(int i) const { return dual_[at(i)]; }
  AxisJacobian jacobian(int axis) const;
  /// Rate along `i` per impulse along `j`, if the joint has no other constraint.
  btScalar mobility(const AxisJacobian& i, const AxisJacobian& j) const;
  /// Inertia about this axis with all locked axes rigid: kg or kg·m². A spring is not limited if h <=
  /// sqrt(inertia/(16·stiffness)).
  double effective_inertia(int axis) const;

 private:
  btMatrix3x3 rotation_matrix() const;
  void read(bool principal);
  void read_angles(const btVector3* axes_b, bool principal);
  void read_rates();
  double unwrapped(int axis, double raw) const;
  bool locked(int axis) const { return (locked_ >> axis & 1) != 0; }

  const btRigidBody& parent_;
  const btRigidBody& child_;
  btTransform frame_a_;
  btTransform frame_b_;
  std::array<btVector3, 3> axis_a_;  // the parent-side frame's axes, world
  std::array<btVector3, 3> dual_;    // angular rate i = dual_[i] · (w_child - w_parent)
  btVector3 arm_a_;                  // from each center of mass to the child's pivot, world
  btVector3 arm_b_;
  std::array<double, 3> angle_{};
  std::array<float, 3> offset_{};
  std::array<float, 6> rate_{};
  int outer_ = 2;
  int middle_ = 1;
  int inner_ = 0;
  unsigned locked_ = 0x3f;       // bit set of axes
  bool own_axis_turns_ = false;  // the own angle can exceed ±pi
};

}  // namespace limber::sim::bullet
