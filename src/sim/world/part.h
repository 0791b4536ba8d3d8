// Part: a rigid body of an articulated body. Its public pose is that of its link frame; Bullet uses the
// center-of-mass frame. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "base/memory/archive.h"
#include "properties/store.h"
#include "sim/motion/kinematics.h"
#include "sim/shapes/geometry.h"
#include "sim/world/force_accumulators.h"

class btRigidBody;

namespace limber::sim {

class Body;
class Shape;
class World;

class Part {
 public:
  static const PropertyTable& table();

  /// `mass` 0: never dynamic. `pose`: link frame in world coordinates.
  Part(Body& body, NodeId group, std::string name, std::shared_ptr<const Geometry> geometry, double mass,
       const Pose& pose);
  ~Part();
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  Body& body() const { return body_; }
  PartMotion motion() const { return state_.kinematic.motion; }
  /// True unless it is dynamic: no force moves it.
  bool is_static() const { return motion() != PartMotion::dynamic; }
  KinematicState& kinematic() { return state_.kinematic; }
  const KinematicState& kinematic() const { return state_.kinematic; }
  const std::shared_ptr<const Geometry>& geometry() const { return geometry_; }
  /// The scene's shape that it was created from, or a null id (URDF).
  NodeId shape() const { return shape_; }
  void set_shape(NodeId shape) { shape_ = shape; }
  btRigidBody& rigid() { return *rigid_; }
  const btRigidBody& rigid() const { return *rigid_; }

  /// Link frame from the store: as published after the last tick, or as set since.
  Pose pose() const;
  /// Center of mass, world.
  Vec3 center() const;
  /// In kg; 0: static.
  double mass() const;
  /// Axes of its principal moments (the geometry's, times the mass), in world coordinates.
  Quat principal_axes() const { return pose().rotation * geometry_->frame.rotation; }
  Vec3 linear_velocity() const;
  Vec3 angular_velocity() const;
  void set_pose(const Pose& pose);
  void set_velocity(const Vec3& linear, const Vec3& angular);
  /// Pose and motion, in the store's and in Bullet's representation, for an exact transfer to another part.
  struct Motion {
    Pose pose;
    Vec3 linear_velocity, angular_velocity;
    std::array<float, 12> bullet_pose;  ///< Rotation matrix by rows, then the origin.
    std::array<float, 3> bullet_linear_velocity, bullet_angular_velocity;
    Vec3 set_linear_velocity, set_angular_velocity;  ///< Of a kinematic part.
  };
  Motion capture_motion() const;
  void set_motion(const Motion& motion);
  /// The pose that reset() restores.
  const Pose& start_pose() const { return state_.start; }
  void set_start_pose(const Pose& pose) { state_.start = pose; }

  /// Forces (N) and torques (N·m) act in each substep of the next tick, impulses (N·s) once at its start; then
  /// they are cleared. All in world axes. `at`: point in world coordinates; without it, the center of mass.
  void apply_force(const Vec3& force);
  void apply_force_at(const Vec3& force, const Vec3& at);
  void apply_torque(const Vec3& torque);
  void apply_impulse(const Vec3& impulse);
  void apply_impulse_at(const Vec3& impulse, const Vec3& at);
  void clear_forces();
  /// Saves the pending forces, and nothing else, in the world's rollback log, before a guarded call changes them or the
  /// velocity.
  void save_for_rollback();
  /// Applies pending property changes to Bullet now, ahead of the next step: in a guarded call those of this part
  /// alone, whose motion it saves for the rollback, else those of all nodes.
  void flush();

  /// Adds it to Bullet's world or removes it; called by the body.
  void add_to_world();
  void remove_from_world();
  /// Wakes it in the next step; if it is static, wakes the parts that touch it. [any]
  void wake();
  /// True if it is at rest and skipped by steps until something wakes it.
  bool asleep() const;

  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }
  /// Its index in World::force_accumulators().
  std::uint32_t accumulator_index() const { return accumulator_; }
  /// Publishes pose and velocity to the store's transient values. Call after Bullet's step.
  void publish();
  bool reports_contacts() const;

  /// Applies its collision group, mask, and whether it collides with parts of its own body.
  void apply_collision();

 private:
  void apply_report_contacts();

  Body& body_;
  NodeId id_;
  NodeId shape_;
  std::uint32_t accumulator_;  // its index in World::force_accumulators()
  std::shared_ptr<const Geometry> geometry_;
  std::unique_ptr<btRigidBody> rigid_;
  // what persists from tick to tick, besides its properties
  struct State {
    bool report_contacts = false;
    KinematicState kinematic;
    Pose start;
  } state_;
  std::uint64_t saved_in_call_ = 0;  // the last guarded call that saved its forces
};

}  // namespace limber::sim
