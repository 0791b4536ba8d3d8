// GearConstraint: couples the own axes of two joints with reaction: position_b = ratio·position_a + offset. One solver
// row that acts on up to four bodies.
#pragma once

#include <array>
#include <span>
#include <utility>

#include "sim/bullet/joints/joint_constraint.h"

namespace limber::sim::bullet {

struct GearSettings {
  double ratio = 1;      ///< Travel of b per travel of a.
  double offset = 0;     ///< Position of b where a is at 0.
  double max_force = 0;  ///< Largest force or torque on b's axis, N or N·m; 0: no limit.
  bool operator==(const GearSettings&) const = default;
};

/// Its two bodies for Bullet are a dynamic one of each joint, so that islands and sleeping include it like a joint. The
/// joints may be in one tree, in different trees or in different bodies, and may be revolute or prismatic. They must be
/// in the world whenever the gear is, and outlive it. [sim]
class GearConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  GearConstraint(JointConstraint& joint_a, int axis_a, JointConstraint& joint_b, int axis_b);

  void set(const GearSettings& settings) { settings_ = settings; }
  const GearSettings& settings() const { return settings_; }
  JointConstraint& joint_a() const { return *joint_a_; }
  JointConstraint& joint_b() const { return *joint_b_; }
  int axis_a() const { return axis_a_; }
  int axis_b() const { return axis_b_; }

  /// Position error: ratio·position_a + offset - position_b, rad or m.
  double error() const;
  /// Mean force or torque on b's axis in the last tick; a's axis gets -ratio times this.
  double applied() const { return static_cast<double>(applied_); }
  /// True if the position error has exceeded kSlipThreshold for more than kSlipTime of simulated time.
  bool is_slipping() const { return slip_time_ > kSlipTime; }
  /// Returns true on the first call only: slip is reported once.
  bool report_slip() { return !std::exchange(slip_reported_, true); }
  static constexpr double kSlipThreshold = 0.01;  ///< rad or m
  static constexpr float kSlipTime = 0.5f;        ///< s

  // For IslandSolver, DirectSolver and IslandWorld.
  /// Jacobian with respect to one body: impulse on the body per impulse of the row.
  struct BodyJacobian {
    btRigidBody* body = nullptr;
    btVector3 linear{0, 0, 0};
    btVector3 angular{0, 0, 0};
  };
  /// rate + softness·impulse = velocity, where rate = rate of b - ratio·rate of a, by the dynamic bodies' motion.
  struct Row {
    double velocity = 0;
    double softness = 0;
    double bound = 0;     ///< Largest impulse in either direction.
    double mobility = 0;  ///< Inverse effective mass: rate per impulse of the dynamic bodies without joints.
  };
  /// Plans the row of the next substep of length h; both joints must have been planned.
  void plan(btScalar h);
  const Row& row() const { return row_; }
  /// Dynamic bodies, each once.
  solver::IndexedSpan<const BodyJacobian> jacobians() const { return {jacobians_.data(), jacobian_count_}; }
  /// Warm-start impulse of the sweeps.
  double warm_impulse() const { return static_cast<double>(warm_impulse_); }
  /// Stores the impulse of the step, for warm starting and the mean force.
  void set_impulse(double impulse);
  void forget_impulses() { last_impulse_ = 0; }
  /// To be called after a part was teleported: resets impulses and the slip time.
  void reset() { last_impulse_ = applied_ = slip_time_ = 0; }
  /// Ends a tick: averages the applied force, updates the slip time.
  void end_tick();

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2*) override {}
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  static constexpr auto kType = static_cast<btTypedConstraintType>(MAX_CONSTRAINT_TYPE + 1);

 private:
  void add_jacobians(JointConstraint& joint, int axis, double factor);
  void add_jacobian(btRigidBody& body, const btVector3& linear, const btVector3& angular);

  JointConstraint* joint_a_;
  JointConstraint* joint_b_;
  int axis_a_;
  int axis_b_;
  GearSettings settings_;
  Row row_;
  std::array<BodyJacobian, 4> jacobians_;
  int jacobian_count_ = 0;
  double static_rate_ = 0;  // of the row, by the motion of static bodies
  btScalar h_ = 0;
  float last_impulse_ = 0;
  float warm_impulse_ = 0;
  float tick_impulse_ = 0;
  float tick_time_ = 0;
  float applied_ = 0;
  float slip_time_ = 0;
  bool slip_reported_ = false;
};

/// True if the constraint is a gear.
inline bool is_gear(const btTypedConstraint& constraint) {
  return constraint.getConstraintType() == GearConstraint::kType;
}

}  // namespace limber::sim::bullet
