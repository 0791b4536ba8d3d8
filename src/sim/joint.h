// Joint: how a child part hangs on its parent. Limits here, drives in its motor. Everything right-handed, child
// relative to parent. [sim]
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "params/store.h"
#include "sim/gear_constraint.h"
#include "sim/joint_constraint.h"
#include "sim/part.h"

namespace limber {

class Motor;

/// Couples a follower to its leader, with reaction: value = multiplier · (leader's value) + offset.
struct Mimic {
  std::string leader;
  double multiplier = 1;
  double offset = 0;
};

/// What a joint is made of.
struct JointSpec {
  JointType type = JointType::revolute;
  Pose frame_in_parent;  ///< In the parent's link frame; z = the own axis.
  Pose frame_in_child;
  bool limited = false;  ///< Limits of the own axis; else it is free.
  double lower = 0;
  double upper = 0;
  double friction = 0;  ///< Coulomb limit of the own axis, N·m or N (URDF <dynamics friction>).
  std::optional<Mimic> mimic;
};

class Joint {
 public:
  static const Table& table();

  Joint(Body& body, NodeId group, std::string name, Part& parent, Part& child, const JointSpec& spec);
  ~Joint();
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  JointType type() const { return spec_.type; }
  const JointSpec& spec() const { return spec_; }
  Body& body() const { return body_; }
  Part& parent() const { return parent_; }
  Part& child() const { return child_; }
  Motor* motor() const { return motor_; }
  void set_motor(Motor* motor) { motor_ = motor; }
  JointConstraint& constraint() { return *constraint_; }
  const JointConstraint& constraint() const { return *constraint_; }

  /// 0..2 linear x y z, 3..5 angular x y z; -1: a fixed joint has none.
  int own_axis() const;
  /// Whether an axis moves at all, by the limits in force.
  bool is_open(int axis) const { return (open_ >> axis & 1) != 0; }
  /// Own axis: rad or m.
  double value() const;

  /// After Bullet stepped, or poses were set: readouts into the live block.
  void tell();
  /// Once a tick, after tell(): true when the gap between the two sides of the joint has been larger than its parts for
  /// some ticks. [any thread]
  bool comes_apart();
  /// Distance between the two sides of the joint along its locked axes, soft ones (stop_cfm) left out, m.
  double gap() const;
  /// After poses were set by hand: reads them anew, turns as near as can be to those told.
  void read_anew();
  /// The angles told now, full turns included, are the start's; the next read_anew() comes back to them.
  void take_start();
  void take_start(const Joint& other) { start_angles_ = other.constraint_->angles(); }
  void go_to_start();
  /// Into Bullet's world and out of it, with the gear to its leader; the body says when.
  void enter();
  void leave();
  /// Its parts are awake from the next step on. [any thread]
  void wake();
  bool in_world() const { return in_world_; }
  /// Couples this joint to its leader, as the spec's mimic says.
  void couple_to(Joint& leader);
  /// After both joints have entered.
  void enter_mimic_gear();
  /// The gear between this joint and its leader; null: it follows none.
  GearConstraint* mimic_gear() const { return mimic_gear_.get(); }
  /// Limits, ERP and CFM of all axes into the constraint: the effect of their rows.
  void effect_limits();
  void read_axis(double* out) const;

 private:
  friend class WorldKey;
  static std::unique_ptr<JointConstraint> make_constraint(Part& parent, Part& child, const JointSpec& spec);

  // what every tick needs stands first
  Body& body_;
  NodeId id_;
  std::uint8_t open_ = 0;  // the axes that are not locked, a bit each
  bool in_world_ = false;
  Motor* motor_ = nullptr;
  Part& parent_;
  Part& child_;
  std::unique_ptr<JointConstraint> constraint_;
  std::unique_ptr<GearConstraint> mimic_gear_;
  bool gear_in_world_ = false;
  JointSpec spec_;
  Vec3 start_angles_{0};
  int torn_ticks_ = 0;  // consecutive ticks with a gap larger than its parts
};

}  // namespace limber
