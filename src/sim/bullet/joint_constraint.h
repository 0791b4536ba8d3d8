// JointConstraint: six-axis joint between two parts, with limits, motors, springs, damping and friction. It writes its
// own solver rows, so that all values are right-handed and of the child relative to the parent.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/vec.h"
#include "sim/bullet/axis_goals.h"
#include "sim/bullet/bullet.h"
#include "sim/solver/indexed_array.h"

namespace limber {

/// Converts an axis (0, 1, 2: along; 3, 4, 5: about x, y, z) to an array index.
inline std::size_t at(int axis) { return static_cast<std::size_t>(axis); }

/// Motor type of an axis. A motor on a locked axis does nothing.
enum class AxisDrive : std::uint8_t { off, spin, servo, spring };

/// All settings of one axis. Linear axes: m, N, m/s; angular axes: rad, N·m, rad/s.
struct AxisSettings {
  float lower = 0;        ///< lower == upper: locked at this position; lower > upper: free; else limited.
  float upper = 0;        ///< Angular limits are not restricted to ±pi, and their range may exceed 2 pi.
  float stop_erp = 0.2f;  ///< 0 .. 1: part of a lock's or limit's error that one internal step repairs.
  /// Compliance of a lock or limit at rest, m/N or rad/(N·m), independent of the step; any value >= 0 is stable.
  /// Together with stop_erp it is a spring 1/stop_cfm with damping h·(1 - stop_erp)/(stop_erp·stop_cfm).
  float stop_cfm = 0;
  AxisDrive drive = AxisDrive::off;
  float velocity = 0;        ///< Spin: target speed (0 brakes). Servo: speed limit, sign ignored, 0: no limit.
  float max_force = 0;       ///< Of spin and servo, >= 0.
  double target = 0;         ///< Of the servo, counts full turns. Beyond a limit the servo presses against the limit.
  double rest = 0;           ///< Of the spring, counts full turns.
  float stiffness = 0;       ///< Of the spring, N/m or N·m/rad; reduced for stability (see stiffness_applied).
  float spring_damping = 0;  ///< Of the spring, N·s/m or N·m·s/rad; implicit, so it is never reduced.
  float friction = 0;        ///< Coulomb friction, N or N·m, with any drive.

  bool locked() const { return lower == upper; }
  bool free() const { return lower > upper; }
  bool limited() const { return lower < upper; }
  bool operator==(const AxisSettings&) const = default;
};

/// Axes 0..2 are linear along the parent-side frame's axes, 3..5 are angular about x, y, z. The own axis is z (2 and
/// 5). Positive: the child moves or turns relative to the parent along or about +axis. Requires IslandSolver. [sim]
///
/// Order of angles: R(child in parent) = R_outer·R_middle·R_inner. The middle axis, which alone is singular at ±pi/2,
/// is the one with the smallest range (a locked one if there is one); outer is z, or y if z is the middle. Free x, y,
/// z, or only z or x free: Rz·Ry·Rx. Only y, or y and z free: Rz·Rx·Ry. x and y: Ry·Rz·Rx.
class JointConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Frames are given in each part's center-of-mass frame; z is the own axis. All axes start locked at 0.
  JointConstraint(btRigidBody& parent, btRigidBody& child, const btTransform& frame_in_parent,
                  const btTransform& frame_in_child);

  /// Sets an axis, from the next internal step on. Values are clamped (positions to ±1e6, speeds to ±1e5, forces to
  /// 1e12). If a free angular axis becomes limited, its angle changes by full turns to be nearest to the limits'
  /// center.
  void set_axis(int axis, const AxisSettings& settings);
  /// Sets only the goals of an axis: servo target, rest position of the spring, velocity. A new target or rest position
  /// is interpolated linearly over the next tick (AxisGoals). Returns true if one of them changed.
  bool set_goal(int axis, double target, double rest, double velocity);
  /// True if a motor or spring is on.
  bool has_drive() const {
    return std::any_of(axes_.begin(), axes_.end(), [](const AxisSettings& s) { return s.drive != AxisDrive::off; });
  }
  const AxisSettings& axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }
  /// Makes targets and rest positions take effect at once in the next step, without interpolation.
  void restart_goals() { goals_.restart(); }
  /// Sets the smoothing time of targets and rest positions, s; 0: none. Call within the BulletMemory::Scope that the
  /// constraint was created in.
  void set_smoothing(double time) { goals_.set_smoothing(time); }
  double smoothing() const { return goals_.smoothing(); }
  /// Sets the joint's frames (in center-of-mass frames). Angles are read again, with the turns nearest to the present.
  void set_frames(const btTransform& frame_in_parent, const btTransform& frame_in_child);
  const btTransform& frame_in_parent() const { return frame_a_; }
  const btTransform& frame_in_child() const { return frame_b_; }
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
  void refresh();

  // Readouts as of the last refresh. Angles are in the joint's own order and count full turns.
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
  /// The same rotation as Rz(z)·Ry(y)·Rx(x), whatever the own order; z counts turns if axis 5 can exceed ±pi.
  Vec3 relrot() const;
  /// Outer, middle, inner axis, each 0 (x) .. 2 (z).
  std::array<int, 3> order() const { return {outer_, middle_, inner_}; }
  /// World pose of the joint's frame on the parent, and on the child (which includes the joint's motion).
  Pose parent_frame() const { return from_bt(m_rbA.getCenterOfMassTransform() * frame_a_); }
  Pose child_frame() const { return from_bt(m_rbB.getCenterOfMassTransform() * frame_b_); }

  /// Mean of the force that motors, servos and springs applied to the child in the last tick, N and N·m per axis. A
  /// motor that presses against a limit applies its full force there, and the limit reacts.
  Vec3 applied_force() const { return {applied_[0], applied_[1], applied_[2]}; }
  Vec3 applied_torque() const { return {applied_[3], applied_[4], applied_[5]}; }
  /// Stiffness of the spring in the last internal step, limited to inertia/(16 h²); 0 without a spring.
  double stiffness_applied(int axis) const;
  double damping_applied(int axis) const;
  /// True if a spring's stiffness was limited in the last internal step.
  bool spring_limited() const { return spring_limited_; }
  /// True if the target of a servo was outside the limits in the last internal step.
  bool target_outside(int axis) const { return (targets_outside_ >> axis & 1) != 0; }
  bool target_outside() const { return targets_outside_ != 0; }
  /// Inertia about this axis with all locked axes rigid: kg or kg·m². A spring is not limited if h <=
  /// sqrt(inertia/(16·stiffness)).
  double effective_inertia(int axis) const;

  // The following functions are for IslandSolver and IslandWorld.

  enum class RowKind : std::uint8_t {
    other,
    motor,   ///< Its impulse counts as applied force.
    repair,  ///< Returns an axis to a limit that it exceeds.
    lock
  };
  /// A planned constraint row: rate + softness·impulse = velocity, with the impulse in [lower, upper].
  struct Row {
    btScalar velocity;
    btScalar softness;
    btScalar lower;
    btScalar upper;
    std::uint8_t axis;
    RowKind kind;
  };
  /// Jacobian of an axis: its rate per velocity of the child (linear, angular_b) and of the parent (-linear,
  /// angular_a).
  struct Jacobian {
    btVector3 linear;
    btVector3 angular_a;
    btVector3 angular_b;
  };
  /// Maximum number of rows: for each of six axes a motor or spring, damping, friction and two limits.
  static constexpr int kMaxRows = 6 * 5;
  /// Reads the pose and plans the rows of the next internal step into `rows`, an array of kMaxRows that must stay
  /// valid until the step is solved.
  IndexedSpan<const Row> plan(Row* rows);
  IndexedSpan<const Row> planned() const { return {rows_, row_count_}; }
  Jacobian jacobian(int axis) const;
  /// Vectors from the centers of mass of the parent (a) and the child (b) to the child's pivot, world.
  const btVector3& arm_a() const { return arm_a_; }
  const btVector3& arm_b() const { return arm_b_; }
  /// Axis i of the joint's frame on the parent, world.
  const btVector3& linear_axis(int i) const { return axis_a_[static_cast<std::size_t>(i)]; }
  /// Dual axis i, world: the rate of angle i is its dot product with the child's angular velocity relative to the
  /// parent.
  const btVector3& dual_axis(int i) const { return dual_[static_cast<std::size_t>(i)]; }
  /// Filtered impulse of the linear locks on the child in an internal step, N·s, world. It follows decreases at once,
  /// and increases or changes of direction within about ten steps.
  btVector3 lock_impulse() const {
    return axis_a_[0] * lock_impulse_[0] + axis_a_[1] * lock_impulse_[1] + axis_a_[2] * lock_impulse_[2];
  }
  /// Active set of the last step, the warm start of AxisActiveSet.
  FixedArray<std::uint8_t, 6>& active_set_memory() { return active_set_memory_; }
  /// Energy that the locks of a tree have absorbed and may return, J, >= 0; stored in the tree's first joint.
  double& lock_energy() { return lock_energy_; }
  /// Sets the impulses of the planned rows, in their order, once the step is solved.
  void set_impulses(IndexedSpan<const double> impulses);
  /// Sets the length of the next internal step, s, and its position in the tick: `steps_left` of `count` steps, this
  /// one included, are still ahead.
  void set_step(btScalar h, int steps_left = 1, int count = 1) {
    h_ = h;
    steps_left_ = steps_left;
    step_count_ = count;
  }
  /// Sets the impulses of the rows just solved, in the order in which getInfo2 wrote them.
  void set_impulses(const btSolverConstraint* rows, int count);
  /// Number of rows of locked axes. They are the last rows; IslandSolver solves them as a block, together with the
  /// motor row before them if has_bounded_row().
  int locked_rows() const { return locked_rows_; }
  bool has_bounded_row() const { return bounded_row_; }
  /// Warm-start impulses of the rows of that block, from the previous step.
  const float* warm_impulses() const { return warm_impulses_.data(); }
  void reset_warm_start() { warm_impulses_.fill(0); }
  /// Advances fast angles by their rates, because a pose is ambiguous by full turns and the next read chooses the turn
  /// nearest to the predicted angle. Call after the parts moved for `h` s.
  void predict_angles(btScalar h);
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
  void choose_order();
  void read_pose(bool principal = false);
  void read_angles(const btVector3* axes_b, bool principal);
  void read_rates();
  double unwrapped(int axis, double raw) const;
  static btScalar mobility(const btRigidBody& a, const btRigidBody& b, const Jacobian& i, const Jacobian& j);

  void plan_rows();
  void set_impulse(const Row& row, btScalar impulse, btScalar inverse_mobility);
  void plan_lock(int axis);
  void plan_unlocked(int axis);
  void plan_motor(int axis);
  void plan_spring(int axis);
  void plan_limit(int axis, bool upper);
  btScalar servo_velocity(int axis);
  btScalar spin_velocity(int axis);
  btScalar braking_speed(int axis, btScalar distance);
  void estimate_inertia(int axis);
  btScalar capped_stiffness(int axis) const;
  void add_row(int axis, btScalar velocity, btScalar softness, btScalar lower, btScalar upper,
               RowKind kind = RowKind::other);

  btTransform frame_a_;
  btTransform frame_b_;
  std::array<btVector3, 3> axis_a_;  // the parent-side frame's axes, world
  std::array<btVector3, 3> dual_;    // angular rate i = dual_[i] · (w_child - w_parent)
  btVector3 arm_a_;                  // from each center of mass to the child's pivot, world
  btVector3 arm_b_;
  std::array<AxisSettings, 6> axes_{};
  AxisGoals goals_;
  std::array<double, 3> angle_{};
  std::array<float, 3> offset_{};
  std::array<float, 6> rate_{};
  std::array<float, 6> previous_rate_{};
  std::array<float, 6> motor_impulse_{};  // of the last internal step
  std::array<float, 6> last_impulse_{};   // of locks and motors, by axis
  std::array<float, 3> lock_impulse_{};   // along the parent-side axes; see lock_impulse()
  std::array<float, 7> warm_impulses_{};
  FixedArray<std::uint8_t, 6> active_set_memory_{};
  double lock_energy_ = 0;
  std::array<float, 6> repair_impulse_{};  // of the last internal step, on a limit that is exceeded
  std::array<float, 6> tick_impulse_{};    // sum over the current tick
  std::array<float, 6> applied_{};
  std::array<float, 6> inertia_estimate_{};
  std::array<float, 6> pair_inertia_{};
  std::array<float, 6> stiffness_applied_{};
  std::array<std::int8_t, 6> pressing_{};  // by axis: +1 presses against its upper limit, -1 against its lower one
  std::uint8_t targets_outside_ = 0;       // bit i: servo axis whose target is outside its limits
  bool spring_limited_ = false;
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
  Row* rows_ = nullptr;  // owned by the solver, valid for a step
};

}  // namespace limber
