// GearConstraint: couples the own axes of two joints, with reaction: position_b = ratio·position_a + offset. One solver
// row that acts on up to four bodies.
#pragma once

#include <array>
#include <span>
#include <utility>

#include "sim/joint_constraint.h"

namespace limber {

struct GearSettings {
  double ratio = 1;      ///< Travel of b per travel of a.
  double offset = 0;     ///< Position of b where a is at 0.
  double max_force = 0;  ///< Largest force or torque on b's axis, N or N·m; 0: no limit.
  bool operator==(const GearSettings&) const = default;
};

/// Bullet's two bodies of it are a moving one of each joint, so that islands, and what sleeps, are found as for joints.
/// Joints may belong to one tree, to different trees or to different bodies, and may turn or slide. The joints must be
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

  /// Distance of b from its position by the gear, rad or m.
  double error() const;
  /// Force or torque on b's axis, mean over the last tick; a's axis gets -ratio times this.
  double applied() const { return static_cast<double>(applied_); }
  /// True when the joints have missed the gear by more than kMiss for kMissTime of simulated time.
  bool slips() const { return missed_for_ > kMissTime; }
  /// False after the first call: a gear that slips is reported once.
  bool report_slip() { return !std::exchange(slip_reported_, true); }
  static constexpr double kMiss = 0.01;
  static constexpr float kMissTime = 0.5f;

  // For IslandSolver, IslandDirect and IslandWorld.
  /// Velocity of one body per rate of the row; also the impulse on the body per impulse of the row.
  struct Side {
    btRigidBody* body = nullptr;
    btVector3 linear{0, 0, 0};
    btVector3 angular{0, 0, 0};
  };
  /// rate + softness·impulse = velocity, where rate = rate of b - ratio·rate of a.
  struct Row {
    double velocity = 0;
    double softness = 0;
    double bound = 0;     ///< Largest impulse either way.
    double mobility = 0;  ///< Rate per impulse of the moving bodies without joints.
  };
  /// Plans the row of the coming internal step of length h; both joints must have been planned.
  void plan(btScalar h);
  const Row& row() const { return row_; }
  /// Bodies that move, each once.
  std::span<const Side> sides() const { return {sides_.data(), static_cast<std::size_t>(side_count_)}; }
  /// Impulse that the sweeps start from.
  double warm_impulse() const { return static_cast<double>(warm_); }
  void take_impulse(double impulse);
  void forget_impulses() { last_impulse_ = 0; }
  /// Call after a part was moved by hand: forgets impulses and for how long the gear has slipped.
  void reset() { last_impulse_ = applied_ = missed_for_ = 0; }
  /// Ends a tick: averages the applied force, counts how long the gear has slipped.
  void end_tick();

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2*) override {}
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  static constexpr auto kType = static_cast<btTypedConstraintType>(MAX_CONSTRAINT_TYPE + 1);

 private:
  void add_sides(JointConstraint& joint, int axis, double factor);
  void add_side(btRigidBody& body, const btVector3& linear, const btVector3& angular);

  JointConstraint* joint_a_;
  JointConstraint* joint_b_;
  int axis_a_;
  int axis_b_;
  GearSettings settings_;
  Row row_;
  std::array<Side, 4> sides_;
  int side_count_ = 0;
  btScalar h_ = 0;
  float last_impulse_ = 0;
  float warm_ = 0;
  float tick_impulse_ = 0;
  float tick_time_ = 0;
  float applied_ = 0;
  float missed_for_ = 0;
  bool slip_reported_ = false;
};

/// True for constraints that the direct solver knows.
inline bool is_gear(const btTypedConstraint& constraint) {
  return constraint.getConstraintType() == GearConstraint::kType;
}

}  // namespace limber
