// Gear: couples the own axes of two joints of any bodies, both ways: position_b = ratio·position_a + offset. [sim]
#pragma once

#include <memory>
#include <string>

#include "params/store.h"
#include "sim/gear_constraint.h"

namespace limber {

class Body;
class Joint;
class World;

class Gear {
 public:
  static const Table& table();

  Gear(World& world, NodeId group, std::string name, Joint& joint_a, Joint& joint_b);
  ~Gear();
  Gear(const Gear&) = delete;
  Gear& operator=(const Gear&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  Joint& joint_a() const { return *joint_a_; }
  Joint& joint_b() const { return *joint_b_; }
  GearConstraint& constraint() { return *constraint_; }
  const GearConstraint& constraint() const { return *constraint_; }
  double ratio() const;
  double offset() const;
  bool enabled() const;
  bool couples(const Body& body) const;

  /// Other joints of the same kind, as a body was rebuilt. The gear must not be in Bullet's world.
  void attach(Joint& joint_a, Joint& joint_b);
  /// Into Bullet's world when it is enabled, its joints are there and it is not redundant; else out of it.
  void settle();
  void leave();
  /// Redundant: other gears determine the position already.
  void set_redundant(bool redundant) { redundant_ = redundant; }
  bool redundant() const { return redundant_; }

  // Called by the properties.
  void effect_settings();
  void read_error(double* out) const;
  void read_force(double* out) const;
  Result<void> refuse_ratio(const double* in) const;
  Result<void> act_remove(std::span<const double> args);

 private:
  friend class WorldKey;
  void make_constraint();

  World& world_;
  NodeId id_;
  Joint* joint_a_;
  Joint* joint_b_;
  std::unique_ptr<GearConstraint> constraint_;
  bool in_world_ = false;
  bool redundant_ = false;
};

/// A joint whose own axis a gear can couple: it turns or slides about one axis. The error says why not.
Result<void> check_gear_joint(const Joint& joint);

}  // namespace limber
