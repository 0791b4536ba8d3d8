// Part: one rigid piece of a body. Users see its link frame; Bullet moves its centre-of-mass frame. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "params/store.h"
#include "sim/geometry.h"
#include "sim/part_loads.h"

namespace limber {

class Body;
class Shape;
class World;

class Part {
 public:
  static const Table& table();

  /// `mass` 0: static, now and for ever. `pose`: the link frame, world.
  Part(Body& body, NodeId group, std::string name, std::shared_ptr<const Geometry> geometry, double mass,
       const Pose& pose);
  ~Part();
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  Body& body() const { return body_; }
  bool is_static() const { return is_static_; }
  const std::shared_ptr<const Geometry>& geometry() const { return geometry_; }
  /// The scene's shape that it was made of, or a null id (URDF).
  NodeId shape() const { return shape_; }
  void set_shape(NodeId shape) { shape_ = shape; }
  btRigidBody& rigid() { return *rigid_; }
  const btRigidBody& rigid() const { return *rigid_; }

  /// Link frame as the store has it: as told after the last tick, or as set since.
  Pose pose() const;
  Vec3 center() const;
  /// kg; 0: static.
  double mass() const;
  /// About which its principal moments (geometry's, times the mass) are, world.
  Quat principal_axes() const { return pose().rotation * geometry_->frame.rotation; }
  Vec3 linear_velocity() const;
  Vec3 angular_velocity() const;
  void set_pose(const Pose& pose);
  void set_velocity(const Vec3& linear, const Vec3& angular);
  /// Where it is and how it moves, to the bit: for another part that stands in its place.
  struct Stance {
    Pose pose;
    Vec3 linear_velocity, angular_velocity;
    btTransform transform;
    btVector3 linear, angular;
  };
  Stance stance() const;
  void stand(const Stance& stance);
  /// Where it was made: reset's goal.
  const Pose& start_pose() const { return start_; }
  void set_start_pose(const Pose& pose) { start_ = pose; }

  /// Forces act for the whole coming tick on each internal step, then end. `at`: a world point.
  void apply_force(const Vec3& force);
  void apply_force_at(const Vec3& force, const Vec3& at);
  void apply_torque(const Vec3& torque);
  void apply_impulse(const Vec3& impulse);
  void apply_impulse_at(const Vec3& impulse, const Vec3& at);
  void clear_forces();
  /// Before the forces that wait are changed, or its speed by a guarded call: lets the world's undo know them.
  void keep();
  /// Brings what was set into Bullet now, ahead of the next step.
  void settle();

  /// Into Bullet's world and out of it; the body says when.
  void enter();
  void leave();
  /// Awake from the next step on; of a static part: what touches it. [any thread]
  void wake();
  /// At rest, left out of steps until something wakes it.
  bool asleep() const { return !is_static_ && !rigid_->isActive(); }

  /// Before Bullet steps: takes what waited for it.
  void push(const PartLoads::Load& load, const PartLoads::Kick& kick);
  /// Its place in World::loads().
  std::uint32_t load_place() const { return load_; }
  /// After Bullet stepped: poses and velocities into the live block.
  void tell();
  bool reports_contacts() const;

  /// Has the processor ask for what Bullet knows of a part: a step or more before it is wanted.
  static void fetch(const void* thing);

  /// Pose and velocity of the store into Bullet: the effects of their rows, and of health.
  void effect_pose();
  void effect_velocity();
  /// Its group, mask, and whether it collides with its own body.
  void effect_collision();

 private:
  void effect_mass();
  void effect_damping();
  void effect_surface();
  void effect_reports();
  void read_center(double* out) const;
  void read_inertia(double* out) const;
  void read_principal_axes(double* out) const;
  void read_rotation_clamped(double* out) const;
  Result<void> refuse_mass(const double* in) const;
  Result<void> act_force(std::span<const double> args);
  Result<void> act_impulse(std::span<const double> args);
  Result<void> act_torque(std::span<const double> args);

  friend class WorldUndo;
  friend class WorldKey;
  Body& body_;
  NodeId id_;
  NodeId shape_;
  std::uint32_t load_;  // its place among the world's loads
  std::shared_ptr<const Geometry> geometry_;
  std::unique_ptr<btRigidBody> rigid_;
  bool is_static_ = false;
  bool reports_ = false;
  Pose start_;
  std::uint64_t kept_in_ = 0;  // the guarded call whose undo knows its forces
};

}  // namespace limber
