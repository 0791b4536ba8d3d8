// Gear: couples the own axes of two joints of any bodies in both directions: position_b = ratio·position_a + offset.
// [sim]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/memory/archive.h"
#include "properties/store.h"

namespace limber::sim::bullet {
class GearConstraint;
}  // namespace limber::sim::bullet

namespace limber::sim {

class Body;
class Joint;
class World;

class Gear {
 public:
  static const PropertyTable& table();

  Gear(World& world, NodeId group, std::string name, Joint& joint_a, Joint& joint_b);
  ~Gear();
  Gear(const Gear&) = delete;
  Gear& operator=(const Gear&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  Joint& joint_a() const { return *joint_a_; }
  Joint& joint_b() const { return *joint_b_; }
  bullet::GearConstraint& constraint() { return *constraint_; }
  const bullet::GearConstraint& constraint() const { return *constraint_; }
  double ratio() const;
  double offset() const;
  bool enabled() const;
  /// True if one of its joints belongs to the body.
  bool couples(const Body& body) const;

  /// Replaces the joints by others of the same kind after a body was rebuilt. Its constraint
  /// must have been removed (remove_constraint()) before the previous joints were destroyed.
  void replace_joints(Joint& joint_a, Joint& joint_b);
  /// Adds the constraint to Bullet's world if the gear is enabled, not redundant and its joints are in the world; else
  /// removes it.
  void update_constraint();
  void remove_constraint();
  /// Redundant: other gears determine the position already (or contradict this gear), so its constraint is not used.
  void set_redundant(bool redundant) { state_.redundant = redundant; }
  bool redundant() const { return state_.redundant; }

  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }

  // Callbacks of the properties.
  void apply_settings();
  void read_error(double* out) const;
  void read_force(double* out) const;
  Result<void> validate_ratio(const double* in) const;
  Result<void> act_remove(std::span<const double> args);

 private:
  void make_constraint();

  World& world_;
  NodeId id_;
  Joint* joint_a_;
  Joint* joint_b_;
  std::unique_ptr<bullet::GearConstraint> constraint_;
  // what persists from tick to tick, besides its properties
  struct State {
    bool in_world = false;
    bool redundant = false;
  } state_;
};

/// Checks that a gear can couple the joint: it must have one axis, revolute or prismatic. The error gives the reason.
Result<void> check_gear_joint(const Joint& joint);
/// Couples the joints of a body to their leaders (URDF mimic); returns the coupled joints. To be called once all joints
/// exist, because a leader may be listed after its follower in the file.
std::vector<Joint*> couple_mimic_joints(const Body& body);

}  // namespace limber::sim
