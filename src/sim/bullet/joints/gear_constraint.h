// GearConstraint: couples the own axes of two joints with reaction: position_b = ratio·position_a + offset. Its row
// acts on up to four bodies.
#pragma once

#include <utility>

#include "sim/bullet/joints/coupled_constraint.h"
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
/// in the world whenever the gear is, and outlive it. Its rate is that of b - ratio·that of a. [sim]
class GearConstraint : public CoupledConstraint {
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
  /// True if the position error has exceeded kSlipThreshold for more than kSlipTime of simulated time.
  bool is_slipping() const { return slip_time_ > kSlipTime; }
  /// Returns true on the first call only: slip is reported once.
  bool report_slip() { return !std::exchange(slip_reported_, true); }
  static constexpr double kSlipThreshold = 0.01;  ///< rad or m
  static constexpr float kSlipTime = 0.5f;        ///< s

  void plan(btScalar h) override;
  void reset() override;
  void end_tick() override;

  static constexpr auto kType = CoupledConstraint::kFirstType;

 private:
  void add_jacobians(JointConstraint& joint, int axis, double factor);

  JointConstraint* joint_a_;
  JointConstraint* joint_b_;
  int axis_a_;
  int axis_b_;
  GearSettings settings_;
  float slip_time_ = 0;
  bool slip_reported_ = false;
};

/// True if the constraint is a gear.
inline bool is_gear(const btTypedConstraint& constraint) {
  return constraint.getConstraintType() == GearConstraint::kType;
}

}  // namespace limber::sim::bullet
