// JointDrives: motors, servos and springs of a joint: plans their rows and measures the force that they apply.
#pragma once

#include <array>
#include <cstdint>

#include "sim/bullet/joints/joint_pose.h"
#include "sim/bullet/joints/joint_rows.h"
#include "sim/bullet/joints/target_interpolator.h"

namespace limber::sim::bullet {

/// In each substep: begin_step(), plan() for each axis with a drive, end_plan(), store() for each row,
/// end_substep(). [sim]
class JointDrives {
 public:
  /// An axis in the present substep.
  struct Axis {
    int index;
    const AxisSettings& settings;
    const JointPose& pose;
    const StepTiming& step;

    double value() const { return pose.value(index); }
    float rate() const { return pose.rates()[at(index)]; }
  };

  /// Targets of servos and rest positions of springs.
  TargetInterpolator& target_interpolator() { return interpolator_; }
  const TargetInterpolator& target_interpolator() const { return interpolator_; }
  /// Resets impulses, inertia estimates and goals.
  void reset(const JointPose& pose);

  void begin_step();
  /// Adds the row of the motor or spring.
  void plan(const Axis& axis, JointRows& rows);
  void end_plan(const JointPose& pose);
  /// Stores the impulse of a motor's or spring's row. `inverse_mobility`: its impulse per change of its rate.
  void store(const JointRow& row, btScalar impulse, btScalar inverse_mobility);
  void end_substep(btScalar h) { tick_time_ += h; }
  /// Ends a tick: averages the applied forces.
  void end_tick();

  /// Mean of the force that motors, servos and springs applied to the child in the last tick, N and N·m per axis. A
  /// motor that presses against a limit applies its full force there, and the limit reacts.
  Vec3 applied_force() const { return {applied_[0], applied_[1], applied_[2]}; }
  Vec3 applied_torque() const { return {applied_[3], applied_[4], applied_[5]}; }
  /// Stiffness of the spring in the last substep, limited to inertia/(16 h²); 0 without a spring.
  double stiffness_applied(int axis) const { return static_cast<double>(stiffness_applied_[at(axis)]); }
  /// True if a spring's stiffness was limited in the last substep.
  bool spring_limited() const { return spring_limited_; }
  /// True if the target of a servo was outside the limits in the last substep.
  bool target_outside(int axis) const { return (targets_outside_ >> axis & 1) != 0; }
  bool target_outside() const { return targets_outside_ != 0; }

 private:
  struct Range {
    double lower;
    double upper;
  };
  void plan_spring(const Axis& axis, JointRows& rows);
  void plan_torque(const Axis& axis, JointRows& rows);
  void plan_motor(const Axis& axis, btScalar velocity, JointRows& rows);
  btScalar spin_velocity(const Axis& axis);
  btScalar servo_velocity(const Axis& axis);
  Range servo_range(const Axis& axis);
  btScalar braking_speed(const Axis& axis, btScalar distance);
  void estimate_inertia(const Axis& axis);

  TargetInterpolator interpolator_;
  std::array<float, 6> impulse_{};       // of the last substep
  std::array<float, 6> tick_impulse_{};  // sum over the current tick
  std::array<float, 6> applied_{};
  std::array<float, 6> previous_rate_{};
  std::array<float, 6> inertia_estimate_{};
  std::array<float, 6> pair_inertia_{};
  std::array<float, 6> stiffness_applied_{};
  std::array<std::int8_t, 6> pressing_{};  // by axis: +1 presses against its upper limit, -1 against its lower one
  std::uint8_t targets_outside_ = 0;       // bit i: servo axis whose target is outside its limits
  bool spring_limited_ = false;
  float tick_time_ = 0;
};

}  // namespace limber::sim::bullet
