// AxisSettings: the limits, motor, spring and friction of one axis of a joint.
#pragma once

#include <array>
#include <cstdint>

namespace limber::sim::bullet {

/// Converts an axis (0, 1, 2: along; 3, 4, 5: about x, y, z) to an array index.
inline std::size_t at(int axis) { return static_cast<std::size_t>(axis); }

/// Motor type of an axis. A motor on a locked axis does nothing.
enum class AxisDrive : std::uint8_t { off, spin, servo, spring, torque };

/// All settings of one axis. Linear axes: m, N, m/s; angular axes: rad, N·m, rad/s.
struct AxisSettings {
  float lower = 0;        ///< lower == upper: locked at this position; lower > upper: free; else limited.
  float upper = 0;        ///< Angular limits are not restricted to ±pi, and their range may exceed 2 pi.
  float stop_erp = 0.2f;  ///< 0 .. 1: part of a lock's or limit's error that one substep repairs.
  /// Compliance of a lock or limit at rest, m/N or rad/(N·m), independent of the step; any value >= 0 is stable.
  /// Together with stop_erp it is a spring 1/stop_cfm with damping h·(1 - stop_erp)/(stop_erp·stop_cfm).
  float stop_cfm = 0;
  AxisDrive drive = AxisDrive::off;
  float velocity = 0;   ///< Spin: target speed (0 brakes). Servo: speed limit, sign ignored, 0: no limit.
  float max_force = 0;  ///< Of spin, servo and torque, >= 0.
  /// Speed at which the force of the motor is used up: the largest force in the direction of motion decreases linearly
  /// from max_force at rest to 0 at this speed. 0: it doesn't depend on the speed.
  float no_load_speed = 0;
  float torque = 0;     ///< Of the drive `torque`: its force or torque, limited to max_force.
  double target = 0;    ///< Of the servo, counts full turns. Beyond a limit the servo presses against the limit.
  double rest = 0;      ///< Of the spring, counts full turns.
  float stiffness = 0;  ///< Of the spring, N/m or N·m/rad; reduced for stability (JointDrives::stiffness_applied).
  float spring_damping = 0;  ///< Of the spring, N·s/m or N·m·s/rad; implicit, so it is never reduced.
  float friction = 0;        ///< Coulomb friction, N or N·m, with any drive.
  float armature = 0;  ///< Inertia of the rotor, kg or kg·m², in addition to that of the bodies; with any drive.

  bool locked() const { return lower == upper; }
  bool free() const { return lower > upper; }
  bool limited() const { return lower < upper; }
  bool has_motor() const { return drive == AxisDrive::spin || drive == AxisDrive::servo; }
  /// Damping of the spring that is in effect, N·s/m or N·m·s/rad; 0 without a spring.
  double damping_applied() const {
    return drive == AxisDrive::spring && !locked() ? static_cast<double>(spring_damping) : 0;
  }
  bool operator==(const AxisSettings&) const = default;
};

/// Settings of the six axes of a joint.
using JointAxes = std::array<AxisSettings, 6>;

}  // namespace limber::sim::bullet
