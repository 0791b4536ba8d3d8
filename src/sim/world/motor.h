// Motor: drives the axes of a joint, each in mode off, spin (velocity motor, also of a linear axis), servo (position
// motor), spring or torque (a given torque or force). It has the joint's name. [sim]
#pragma once

#include <array>
#include <string>

#include "properties/store.h"
#include "sim/world/joint.h"

namespace limber::sim {

enum class MotorMode : std::uint8_t { off, spin, servo, spring, torque };  // in the order of AxisDrive

class Motor {
 public:
  static const PropertyTable& table();

  /// Creates a servo on the own axis that holds the joint's present position.
  Motor(Joint& joint, NodeId group);
  ~Motor();
  Motor(const Motor&) = delete;
  Motor& operator=(const Motor&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const { return joint_.name(); }
  Joint& joint() const { return joint_; }
  /// The mode of an axis, derived from its flags.
  MotorMode mode(int axis) const;
  /// Sets the flags of the own axis according to a mode.
  void set_mode(MotorMode mode);
  /// Sets the servo position and the spring's rest position of the own axis, m or rad.
  void set_target(double target);

  /// Moves the targets of the angular axes that are servos or springs from the joint's present angles towards
  /// `target` (rad, in the joint's own order), by at most `max_step` each. A free axis takes the shorter way: its
  /// target may differ from `target` by full turns.
  void step_towards(const Vec3& target, double max_step);

  /// Stores the joint's present position as the one that a panic holds.
  void save_held_position();
  /// Warns once that a spring's stiffness is capped, and suggests more substeps.
  void warn_capped();
  /// Warns once that the target of a servo is outside the joint's limits.
  void warn_target_outside();

  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }

  // On-change callbacks, getters and setters of the properties; public for helper functions that build the table.
  void apply_axes();
  void apply_targets();
  void read_force(double* out) const;
  void read_torque(double* out) const;
  void read_linear_stiffness(double* out) const;
  void read_angular_stiffness(double* out) const;
  void read_linear_damping(double* out) const;
  void read_angular_damping(double* out) const;
  void read_mode(double* out) const;
  void write_mode(const double* in);
  void read_target(double* out) const;
  void write_target(const double* in);
  void read_target_torque(double* out) const;
  void write_target_torque(const double* in);
  void read_speed(double* out) const;
  void write_speed(const double* in);
  Result<void> validate_own_axis(const double* in) const;

 private:
  bool update_targets();
  void set_own_axis(const Property& linear_property, const Property& angular_property, double value);
  void warn_contradiction(int axis);

  static void prefetch_targets(const void* object);

  Joint& joint_;
  bullet::JointConstraint& constraint_;  // of the joint
  NodeId id_;
  // what persists from tick to tick, besides its properties
  struct State {
    std::array<double, 6> held_position{};
    bool warned_contradiction = false;
    bool warned_capped = false;
    bool warned_target_outside = false;
  } state_;
};

}  // namespace limber::sim
