// JointConstraint: the six-axis joint between two parts, with limits, motors, springs, damping and friction. It
// writes its own solver rows, so that all a user sees is right-handed, child relative to parent, mirrored nowhere.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/vec.h"
#include "sim/axis_goals.h"
#include "sim/bullet.h"
#include "sim/tree_rows.h"

namespace limber {

/// An axis (0, 1, 2 along, 3, 4, 5 about x, y, z) as an index.
inline std::size_t at(int axis) { return static_cast<std::size_t>(axis); }

/// What an axis's motor does. A motor on a locked axis does nothing.
enum class AxisDrive : std::uint8_t { off, spin, servo, spring };

/// Everything that may be set on one axis. Linear axes: m, N, m/s; angular axes: rad, N·m, rad/s.
struct AxisSettings {
  float lower = 0;        ///< lower == upper: locked there; lower > upper: free; else limited.
  float upper = 0;        ///< Angular limits may lie anywhere, also beyond ±pi, and may be wider than 2 pi.
  float stop_erp = 0.2f;  ///< 0 .. 1: part of a lock's or limit's error that one internal step repairs.
  /// Yield of a lock or limit per load, m/N or rad/(N·m), at rest, whatever the step; any value from 0 up is stable.
  /// Together with stop_erp it is a spring 1/stop_cfm with damping h·(1 - stop_erp)/(stop_erp·stop_cfm).
  float stop_cfm = 0;
  AxisDrive drive = AxisDrive::off;
  float velocity = 0;        ///< Spin: the speed to hold (0 brakes). Servo: its speed limit, sign ignored, 0: no limit.
  float max_force = 0;       ///< Of spin and servo, >= 0.
  double target = 0;         ///< Of the servo, full turns included: never wrapped. Beyond a limit, it presses there.
  double rest = 0;           ///< Of the spring, full turns included: never wrapped.
  float stiffness = 0;       ///< Of the spring, N/m or N·m/rad, capped for stability (see stiffness_applied).
  float spring_damping = 0;  ///< Of the spring, N·s/m or N·m·s/rad; implicit, so never capped.
  float friction = 0;        ///< Coulomb friction, N or N·m, in every mode.

  bool locked() const { return lower == upper; }
  bool free() const { return lower > upper; }
  bool limited() const { return lower < upper; }
  bool operator==(const AxisSettings&) const = default;
};

/// Axes 0..2 are linear along the parent-side frame's axes, 3..5 turn about x, y, z. The own axis is z (2 and 5).
/// Positive: child moves or turns relative to the parent along or about +axis. Needs IslandSolver. [sim]
///
/// Order of angles: R(child in parent) = R_outer·R_middle·R_inner. The middle axis, which alone cannot turn beyond
/// ±pi/2 without a singular pose, is the one with the least reach (a locked one when there is one); outer is z, or y
/// when z is the middle. Free x, y, z, or only z or x free: Rz·Ry·Rx. Only y, or y and z free: Rz·Rx·Ry. x and y:
/// Ry·Rz·Rx.
class JointConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Frames are given in each part's centre-of-mass frame; z is the own axis. All axes start locked at 0.
  JointConstraint(btRigidBody& parent, btRigidBody& child, const btTransform& frame_in_parent,
                  const btTransform& frame_in_child);

  /// Takes effect at the next internal step; absurd numbers are tamed (positions to 1e6, speeds to 1e5, forces to
  /// 1e12). A free axis that becomes limited takes the turn nearest to its range.
  void set_axis(int axis, const AxisSettings& settings);
  /// Of these settings only where to and how fast: servo target, spring's rest, velocity. The next tick reaches a new
  /// target or rest at a constant speed (AxisGoals). Returns whether one changed.
  bool set_goal(int axis, double target, double rest, double velocity);
  /// Whether a motor or spring is on.
  bool drives() const {
    return std::any_of(axes_.begin(), axes_.end(), [](const AxisSettings& s) { return s.drive != AxisDrive::off; });
  }
  const AxisSettings& axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }
  /// Targets and rests in force are those set, from the next step on, without a way from those before.
  void restart_goals() { goals_.restart(); }
  /// Smoothing time of targets and rests, s, 0: none. Within the BulletMemory::Scope that the constraint was made in.
  void set_smoothing(double time) { goals_.set_smoothing(time); }
  double smoothing() const { return goals_.smoothing(); }
  /// Moves the frames (centre-of-mass frames), keeping turns where it can.
  void set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child);
  const btTransform& frame_in_parent() const { return frame_a_; }
  const btTransform& frame_in_child() const { return frame_b_; }
  /// 0 .. 1: a limit met at speed w is left at -bounce·w.
  void set_bounce(double bounce) { bounce_ = to_scalar(std::clamp(bounce, 0.0, 1.0)); }
  btScalar bounce() const { return bounce_; }
  /// Passive damping of every axis that is not locked, in any mode: N·s/m and N·m·s/rad, >= 0, any value is stable.
  void set_damping(double damping) { damping_ = to_scalar(std::clamp(damping, 0.0, 1e12)); }
  btScalar damping() const { return damping_; }
  /// Whether a motor spins, a target is on its way, or a servo moves at a speed that its limit sets, however slowly.
  bool commands_motion() const;

  /// Call after a part was moved by hand: reads the pose anew, with the turns nearest to `near` (rad, own order; 0:
  /// outer and inner angle within ±pi, middle within ±pi/2), and forgets what servos learnt and motors applied.
  void reset(const Vec3& near = Vec3(0));
  /// Reads angles, offsets and rates from the parts' present poses; IslandWorld::step ends with this for every joint.
  void refresh();

  // Readouts, as of the last refresh. Angles are in the joint's own order and count full turns.
  Vec3 angles() const { return {angle_[0], angle_[1], angle_[2]}; }
  Vec3 offsets() const { return {offset_[0], offset_[1], offset_[2]}; }
  Vec3 angle_rates() const { return {rate_[3], rate_[4], rate_[5]}; }
  Vec3 offset_rates() const { return {rate_[0], rate_[1], rate_[2]}; }
  /// Position of one axis, 0..5, m or rad; its rate, m/s or rad/s.
  double value(int axis) const {
    const auto i = static_cast<std::size_t>(axis);
    return axis < 3 ? static_cast<double>(offset_[i]) : angle_[i - 3];
  }
  double rate(int axis) const { return static_cast<double>(rate_[static_cast<std::size_t>(axis)]); }
  /// The same rotation as Rz(z)·Ry(y)·Rx(x), whatever the own order; z counts turns where axis 5 may pass ±pi.
  Vec3 relrot() const;
  /// Outer, middle, inner axis, each 0 (x) .. 2 (z).
  std::array<int, 3> order() const { return {outer_, middle_, inner_}; }
  /// World pose of the joint's frame on the parent, and on the child (its own motion included).
  Pose parent_frame() const { return from_bt(m_rbA.getCenterOfMassTransform() * frame_a_); }
  Pose child_frame() const { return from_bt(m_rbB.getCenterOfMassTransform() * frame_b_); }

  /// What motors, servos and springs applied on the child, mean over the last tick, N and N·m per axis. A motor that
  /// presses against a limit applies its full force there, and the limit reacts.
  Vec3 applied_force() const { return {applied_[0], applied_[1], applied_[2]}; }
  Vec3 applied_torque() const { return {applied_[3], applied_[4], applied_[5]}; }
  /// The spring in force at the last internal step: stiffness is held below inertia/(16 h²), 0 where no spring acts.
  double stiffness_applied(int axis) const;
  double damping_applied(int axis) const;
  /// Whether a spring was held below its stiffness at the last internal step.
  bool holds_spring() const { return holds_spring_; }
  /// Whether the target of a servo was outside the limits at the last internal step.
  bool target_outside(int axis) const { return (outside_ >> axis & 1) != 0; }
  bool target_outside() const { return outside_ != 0; }
  /// Inertia that a spring on this axis works on, the locked axes held: kg or kg·m². It says how many substeps
  /// would lift the cap: h <= sqrt(inertia/(16·stiffness)).
  double effective_inertia(int axis) const;

  // For IslandSolver and IslandWorld.
  // motor: counts as applied; repair: of a limit that was passed
  enum class RowKind : std::uint8_t { plain, motor, repair, lock };
  /// One row to come: rate + softness·impulse = velocity, impulse within [lower, upper].
  struct Row {
    btScalar velocity;
    btScalar softness;
    btScalar lower;
    btScalar upper;
    std::uint8_t axis;
    RowKind kind;
  };
  /// Gradient of an axis's rate: on the child; the parent's linear part is the negative.
  struct Jacobian {
    btVector3 linear;
    btVector3 angular_a;
    btVector3 angular_b;
  };
  /// More rows no joint has: each of six axes a motor or spring, damping, friction and two limits.
  static constexpr std::size_t kMostRows = std::size_t{6} * 5;
  /// Reads the pose and plans the rows of the coming internal step, where there is room for kMostRows of them; there
  /// they are looked for until the step is solved.
  std::span<const Row> plan(Row* room);
  std::span<const Row> planned() const { return {rows_, static_cast<std::size_t>(row_count_)}; }
  Jacobian jacobian(int axis) const;
  /// From each part's centre of mass to the child's pivot, world; the parent-side frame's axes; the dual axes, of which
  /// the angular rates are dual·(spin of the child - spin of the parent).
  const btVector3& arm_a() const { return arm_a_; }
  const btVector3& arm_b() const { return arm_b_; }
  const btVector3& linear_axis(int i) const { return axis_a_[static_cast<std::size_t>(i)]; }
  const btVector3& dual_axis(int i) const { return dual_[static_cast<std::size_t>(i)]; }
  /// Impulse of the linear locks on the child in an internal step, N·s, world. It follows a weaker impulse at once, and
  /// a stronger one, or one in the opposite direction, within about ten steps.
  btVector3 pull() const { return axis_a_[0] * pull_[0] + axis_a_[1] * pull_[1] + axis_a_[2] * pull_[2]; }
  /// What TreeRows remembers of this joint from step to step.
  TreeMemory& tree_memory() { return tree_memory_; }
  /// What the locks of the tree that begins here have taken from it, J, >= 0: they may give it back.
  double& taken_by_locks() { return taken_by_locks_; }
  /// Impulses of the planned rows, in their order, once the step is solved.
  void take_impulses(std::span<const double> impulses);
  /// The internal step that the next rows are for: its length, s, and where it is in the tick: `left` of `count` steps,
  /// this one included, are still to come.
  void set_step(btScalar h, int left = 1, int count = 1) {
    h_ = h;
    steps_left_ = left;
    step_count_ = count;
  }
  /// Impulses of the rows just solved, in the order in which getInfo2 wrote them.
  void take_impulses(const btSolverConstraint* rows, int count);
  /// The rows end with one motor row (if any) and those of the locked axes; IslandSolver solves these together.
  int locked_rows() const { return locked_rows_; }
  bool has_bounded_row() const { return bounded_row_; }
  /// Impulses for these rows to start from, after those of the step before.
  const float* warm_impulses() const { return warm_.data(); }
  void forget_impulses() { warm_.fill(0); }
  /// After the parts moved for `h` s: moves fast angles by their rates, so that the next reading of the pose, which is
  /// ambiguous by full turns, takes the turn nearest to where they are expected.
  void predict_angles(btScalar h);
  /// Ends a tick: averages what was applied, refreshes the readouts.
  void end_tick();

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  /// BT_CONSTRAINT_STOP_ERP and BT_CONSTRAINT_STOP_CFM of one axis.
  void setParam(int parameter, btScalar value, int axis = -1) override;
  btScalar getParam(int parameter, int axis = -1) const override;

  /// Tells a JointConstraint from Bullet's own.
  static constexpr btTypedConstraintType kType = MAX_CONSTRAINT_TYPE;

 private:
  void choose_order();
  void read_pose(bool principal = false);
  void read_angles(const btVector3* axes_b, bool principal);
  void read_rates();
  double unwrapped(int axis, double raw) const;
  static btScalar mobility(const btRigidBody& a, const btRigidBody& b, const Jacobian& i, const Jacobian& j);

  void plan_rows();
  void take_impulse(const Row& row, btScalar impulse, btScalar step);
  void plan_lock(int axis);
  void plan_motion(int axis);
  void plan_motor(int axis);
  void plan_spring(int axis);
  void plan_limit(int axis, bool upper);
  btScalar servo_velocity(int axis);
  btScalar spin_velocity(int axis);
  btScalar braking_speed(int axis, btScalar way);
  void learn_inertia(int axis);
  btScalar capped_stiffness(int axis) const;
  void add_row(int axis, btScalar velocity, btScalar softness, btScalar lower, btScalar upper,
               RowKind kind = RowKind::plain);

  btTransform frame_a_;
  btTransform frame_b_;
  std::array<btVector3, 3> axis_a_;  // the parent-side frame's axes, world
  std::array<btVector3, 3> dual_;    // angular rate i = dual_[i] · (w_child - w_parent)
  btVector3 arm_a_;                  // from each centre of mass to the child's pivot, world
  btVector3 arm_b_;
  std::array<AxisSettings, 6> axes_{};
  AxisGoals goals_;
  std::array<double, 3> angle_{};
  std::array<float, 3> offset_{};
  std::array<float, 6> rate_{};
  std::array<float, 6> previous_rate_{};
  std::array<float, 6> motor_impulse_{};  // of the last internal step
  std::array<float, 6> last_impulse_{};   // of locks and motors, by axis
  std::array<float, 3> pull_{};           // along the parent-side axes; see pull()
  std::array<float, 7> warm_{};
  TreeMemory tree_memory_{};
  double taken_by_locks_ = 0;
  std::array<float, 6> repair_impulse_{};  // of the last internal step, on a limit that was passed
  std::array<float, 6> tick_impulse_{};    // of the tick so far
  std::array<float, 6> applied_{};
  std::array<float, 6> learnt_inertia_{};
  std::array<float, 6> pair_inertia_{};
  std::array<float, 6> stiffness_applied_{};
  std::array<std::int8_t, 6> presses_{};  // +1 against its upper limit, -1 against its lower one, by axis
  std::uint8_t outside_ = 0;              // axes of servos whose target is outside the limits, a bit each
  bool holds_spring_ = false;
  float tick_time_ = 0;
  btScalar h_ = btScalar(1.0 / 240.0);
  int steps_left_ = 1;
  int step_count_ = 1;
  btScalar bounce_ = 0;
  btScalar damping_ = 0;
  int outer_ = 2;
  int middle_ = 1;
  int inner_ = 0;
  int row_count_ = 0;
  int locked_rows_ = 0;
  bool bounded_row_ = false;
  Row* rows_ = nullptr;  // whoever solves has them, for a step
};

}  // namespace limber
