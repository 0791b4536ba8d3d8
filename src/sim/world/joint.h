// Joint: connects a child part to its parent. Limits are set here, drives in its motor. All quantities are
// right-handed and describe the child relative to the parent. [sim]
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/memory/archive.h"
#include "model/body_model.h"
#include "properties/store.h"

namespace limber::sim::bullet {
class GearConstraint;
class JointConstraint;
}  // namespace limber::sim::bullet

namespace limber::sim {

class Body;
class Motor;
class Part;

/// Couples a follower to its leader, with reaction: value = multiplier · (leader's value) + offset.
struct Mimic {
  std::string leader;
  double multiplier = 1;
  double offset = 0;
};

/// Construction data of a joint.
struct JointSpec {
  model::JointType type = model::JointType::revolute;
  Pose frame_in_parent;  ///< In the parent's link frame; z = the own axis.
  Pose frame_in_child;
  bool limited = false;  ///< Whether the own axis has limits; else it is free.
  double lower = 0;
  double upper = 0;
  double friction = 0;  ///< Coulomb limit of the own axis, N·m or N (URDF <dynamics friction>).
  std::optional<Mimic> mimic;
};

class Joint {
 public:
  static const PropertyTable& table();

  Joint(Body& body, NodeId group, std::string name, Part& parent, Part& child, const JointSpec& spec);
  ~Joint();
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  model::JointType type() const { return spec_.type; }
  const JointSpec& spec() const { return spec_; }
  Body& body() const { return body_; }
  Part& parent() const { return parent_; }
  Part& child() const { return child_; }
  Motor* motor() const { return motor_; }
  void set_motor(Motor* motor) { motor_ = motor; }
  bullet::JointConstraint& constraint() { return *constraint_; }
  const bullet::JointConstraint& constraint() const { return *constraint_; }

  /// Index of the joint's own axis, which `value`, `mode` and `target` refer to: 2 (linear z) for a prismatic joint, -1
  /// for a fixed one, else 5 (angular z). Axes 0..2 are linear x y z, 3..5 angular x y z.
  int own_axis() const;
  /// True if the present limits of an axis don't lock it.
  bool is_open(int axis) const { return (state_.open_axes >> axis & 1) != 0; }
  /// Position of the own axis, rad or m.
  double value() const;

  /// Publishes the readouts to the store's transient values. Call after Bullet's step, or after poses were set.
  void publish();
  /// Counts the ticks in which the gap between the two sides of the joint exceeds the size of its parts; returns true
  /// when it has done so for several consecutive ticks. Call once per tick, after publish(). [any]
  bool check_separation();
  /// Distance between the two sides of the joint along its locked axes, without soft ones (stop_cfm), in m.
  double gap() const;
  /// Reads the position from the parts' poses again, after these were set. Chooses the turns closest to the published
  /// angles.
  void update_from_parts();
  /// Saves the present angles of this joint (or of `other`), with full turns, as those of the start pose.
  /// restore_start() publishes them, so that update_from_parts() chooses their turns after a reset.
  void save_start();
  void save_start(const Joint& other);
  void restore_start();
  /// Adds the constraint, and the gear to its leader, to Bullet's world or removes them; called by the body.
  void add_to_world();
  void remove_from_world();
  /// Wakes its parts in the next step. [any]
  void wake();
  bool in_world() const { return state_.in_world; }
  /// Couples this joint to its leader with the multiplier and offset of its `mimic` spec.
  void couple_to(Joint& leader);
  /// Adds the gear to Bullet's world, after both joints were added.
  void add_mimic_gear();
  /// The gear between this joint and its leader, or null if it has none.
  bullet::GearConstraint* mimic_gear() const { return mimic_gear_.get(); }
  /// Writes limits, ERP and CFM of all axes to the constraint; the on-change callback of these properties.
  void apply_limits();
  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }
  /// Getter of the property `axis`: direction of the own axis, world.
  void read_axis(double* out) const;
  /// Getters of the properties `swing` and `twist`.
  void read_swing(double* out) const;
  void read_twist(double* out) const;

 private:
  void apply_ball_limits();
  static std::unique_ptr<bullet::JointConstraint> make_constraint(Part& parent, Part& child, const JointSpec& spec);

  // fields that every tick reads come first
  Body& body_;
  NodeId id_;
  Motor* motor_ = nullptr;
  Part& parent_;
  Part& child_;
  std::unique_ptr<bullet::JointConstraint> constraint_;
  std::unique_ptr<bullet::GearConstraint> mimic_gear_;
  // what persists from tick to tick, besides its properties
  struct State {
    std::uint8_t open_axes = 0;  // bit set of the axes that are not locked
    bool in_world = false;
    bool gear_in_world = false;
    int separated_ticks = 0;  // consecutive ticks with a gap larger than its parts
    Vec3 start_angles{0};
  } state_;
  JointSpec spec_;
};

}  // namespace limber::sim
