// Motor: what drives a joint, axis by axis: off, spin, servo or spring. It carries the joint's name. [sim]
#pragma once

#include <array>
#include <string>

#include "params/store.h"
#include "sim/joint.h"

namespace limber {

enum class MotorMode : std::uint8_t { off, spin, servo, spring };

class Motor {
 public:
  static const Table& table();

  /// Made as a servo of the own axis that holds where the joint is.
  Motor(Joint& joint, NodeId group);
  ~Motor();
  Motor(const Motor&) = delete;
  Motor& operator=(const Motor&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const { return joint_.name(); }
  Joint& joint() const { return joint_; }
  /// What is in force on an axis, from the three flags.
  MotorMode mode(int axis) const;
  /// Sets the flags of the own axis to a mode, through the door.
  void set_mode(MotorMode mode);
  /// Servo position and spring rest of the own axis, through the door.
  void set_target(double target);

  /// Sets each angular axis that is a servo or spring, through the door, on the way from where the joint is to `target`
  /// (rad, the joint's own order), at most `most` ahead; on a free axis to the nearest angle that differs from `target`
  /// by full turns.
  void lead_to(const Vec3& target, double most);

  /// Where the joint is now is what a panic that holds motors holds.
  void hold_here();
  /// A spring of it was held below its stiffness: said once, with the cure.
  void say_cap();
  /// Warns once that the target of a servo is outside the joint's limits.
  void warn_outside();

  // What the rows do and read; public because the table, which is no member, names them.
  void effect_axes();
  void effect_goals();
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
  void read_speed(double* out) const;
  void write_speed(const double* in);
  Result<void> refuse_own_axis(const double* in) const;

 private:
  friend class WorldKey;
  bool set_goals();
  void set_own(const Row& linear_row, const Row& angular_row, double value);
  void say_contradiction(int axis);

  static void fetch(const void* thing);

  Joint& joint_;
  JointConstraint& constraint_;  // the joint's
  NodeId id_;
  std::array<double, 6> hold_{};
  bool said_contradiction_ = false;
  bool said_cap_ = false;
  bool warned_outside_ = false;
};

}  // namespace limber
