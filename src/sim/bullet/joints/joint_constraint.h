// JointConstraint: six-axis joint between two parts, with limits, motors, springs, damping and friction. It writes its
// own solver rows, so that all values are right-handed and of the child relative to the parent.
#pragma once

#include <algorithm>
#include <array>

#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/axis_settings.h"
#include "sim/bullet/joints/ball_limits.h"
#include "sim/bullet/joints/joint_drives.h"
#include "sim/bullet/joints/joint_pose.h"
#include "sim/bullet/joints/joint_reaction.h"
#include "sim/bullet/joints/joint_rows.h"
#include "sim/bullet/joints/joint_warm_start.h"

namespace limber::sim::bullet {

/// JointPose defines the axes and the order of the angles. Requires IslandSolver. [sim]
class JointConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Frames are given in each part's center-of-mass frame; z is the own axis. All axes start locked at 0.
  JointConstraint(btRigidBody& parent, btRigidBody& child, const btTransform& frame_in_parent,
                  const btTransform& frame_in_child);

  /// Sets an axis, from the next substep on. Values are clamped (positions to ±1e6, speeds to ±1e5, forces to
  /// 1e12). If a free angular axis becomes limited, its angle changes by full turns to be nearest to the limits'
  /// center.
  void set_axis(int axis, const AxisSettings& settings);
  /// Sets the limits of the rotation as a whole, from the next substep on. They use stop_erp and stop_cfm of axis 5.
  void set_ball_limits(const BallLimitSettings& settings) { ball_limits_.set(settings); }
  /// Sets only the goals of an axis: servo target, rest position of the spring, velocity, torque. A new target or rest
  /// position is interpolated linearly over the next tick (TargetInterpolator). Returns true if one of them changed.
  bool set_target(int axis, double target, double rest, double velocity, double torque = 0);
  /// True if a motor or spring is on.
  bool has_drive() const {
    return std::any_of(axes_.begin(), axes_.end(), [](const AxisSettings& s) { return s.drive != AxisDrive::off; });
  }
  const AxisSettings& axis(int axis) const { return axes_[at(axis)]; }
  /// Interpolation of targets and rest positions. Call set_smoothing() within the BulletMemory::Scope that the
  /// constraint was created in.
  TargetInterpolator& target_interpolator() { return drives_.target_interpolator(); }
  const TargetInterpolator& target_interpolator() const { return drives_.target_interpolator(); }
  /// Sets the joint's frames (in center-of-mass frames). Angles are read again, with the turns nearest to the present.
  void set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child) {
    pose_.set_frames(frame_in_parent, frame_in_child);
  }
  /// 0 .. 1: an axis that reaches a limit at speed w leaves it at -bounce·w.
  void set_bounce(double bounce) { bounce_ = to_scalar(std::clamp(bounce, 0.0, 1.0)); }
  btScalar bounce() const { return bounce_; }
  /// Passive damping of every axis that is not locked, with any drive: N·s/m and N·m·s/rad, >= 0; any value is stable.
  void set_damping(double damping) { damping_ = to_scalar(std::clamp(damping, 0.0, 1e12)); }
  btScalar damping() const { return damping_; }
  /// True if a motor spins, a target is moving, or a servo moves at a speed set by its limit, however slowly.
  bool commands_motion() const;

  /// Reads the pose with the turns nearest to `near` (rad, own order; 0: outer and inner angle within ±pi, middle
  /// within ±pi/2), and resets the servos' inertia estimates and the applied impulses. Call after a part was
  /// teleported.
  void reset(const Vec3& near_angles = Vec3(0));
  /// Reads angles, offsets and rates from the present poses; IslandWorld::step does this for every joint at its end.
  void refresh() { pose_.read(); }

  /// Readouts as of the last refresh.
  const JointPose& pose() const { return pose_; }
  /// Position of one axis, 0..5, m or rad, counting full turns; its rate, m/s or rad/s.
  double value(int axis) const { return pose_.value(axis); }
  double rate(int axis) const { return pose_.rate(axis); }
  /// Applied forces, and limits that motors and springs met.
  const JointDrives& drives() const { return drives_; }
  /// Mean force and torque that the joint exerted on the child in the last tick.
  const JointReaction& reaction() const { return reaction_; }

  // The following functions are for IslandSolver, DirectSolver and IslandWorld.

  /// Sets the substep that plan() plans.
  void set_step(const StepTiming& step) { step_ = step; }
  /// Reads the pose and plans the rows of the substep in `memory` (JointRows).
  const JointRows& plan(JointRow* memory);
  const JointRows& rows() const { return rows_; }
  /// Limits of the rotation as a whole. getInfo2 writes their rows before rows().
  const BallLimits& ball_limits() const { return ball_limits_; }
  /// Sets the impulse of a row of the ball limits, before set_impulses().
  void set_ball_impulse(int row, btScalar impulse);
  /// Sets the impulses of the planned rows, in their order, once the step is solved.
  void set_impulses(solver::IndexedSpan<const double> impulses);
  /// Sets the impulses of the rows just solved, in the order in which getInfo2 wrote them.
  void set_impulses(const btSolverConstraint* rows, int count);
  JointWarmStart& warm_start() { return warm_start_; }
  const JointWarmStart& warm_start() const { return warm_start_; }
  /// Filtered impulse of the linear locks on the child in a substep (JointWarmStart), N·s, world.
  btVector3 lock_impulse() const;
  /// Advances fast angles after the parts moved for `h` s (JointPose::predict_angles).
  void predict_angles(btScalar h) { pose_.predict_angles(h); }
  /// Ends a tick: averages applied forces, refreshes the readouts.
  void end_tick();

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  /// BT_CONSTRAINT_STOP_ERP and BT_CONSTRAINT_STOP_CFM of one axis.
  void setParam(int parameter, btScalar value, int axis = -1) override;
  btScalar getParam(int parameter, int axis = -1) const override;

  /// Distinguishes a JointConstraint from Bullet's own constraints.
  static constexpr btTypedConstraintType kType = MAX_CONSTRAINT_TYPE;

 private:
  void set_impulse(const JointRow& row, btScalar impulse, btScalar inverse_mobility);
  void end_substep();
  JointDrives::Axis driven(int axis) const { return {axis, axes_[at(axis)], pose_, step_}; }
  void plan_unlocked(int axis);
  void plan_limit(int axis, bool upper);
  void plan_motors();
  void plan_lock(int axis);

  JointPose pose_;
  JointAxes axes_{};
  JointDrives drives_;
  JointReaction reaction_;
  JointWarmStart warm_start_;
  std::array<float, 6> repair_impulse_{};  // of the last substep, on a limit that is exceeded
  StepTiming step_;
  JointRows rows_;
  BallLimits ball_limits_;
  btScalar bounce_ = 0;
  btScalar damping_ = 0;
};

}  // namespace limber::sim::bullet
