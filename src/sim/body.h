// Body: a named tree of parts, joints and motors; made by hand, from a model, or as a copy. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/body_model.h"
#include "params/store.h"
#include "sim/behavior.h"
#include "sim/joint.h"
#include "sim/motor.h"
#include "sim/part.h"
#include "sim/part_pairs.h"
#include "sim/shape.h"

namespace limber {

class World;

/// How a body is made from a model.
struct BuildOptions {
  bool servo_motors = true;      ///< false: motors are made off.
  std::optional<Vec3> position;  ///< Of the root's link frame; left out: as the model places it.
  std::optional<Quat> rotation;
};

class Body {
 public:
  static const Table& table();

  Body(World& world, NodeId group, std::string name);
  ~Body();
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  World& world() const { return world_; }
  Store& store() const;
  std::span<const std::unique_ptr<Part>> parts() const { return parts_; }
  std::span<const std::unique_ptr<Joint>> joints() const { return joints_; }
  std::span<const std::unique_ptr<Motor>> motors() const { return motors_; }
  /// In the order in which they were made; the world's list (sim/behavior_list.h) makes and removes them.
  std::span<Behavior* const> behaviors() const { return behaviors_; }
  Part* root() const { return parts_.empty() ? nullptr : parts_.front().get(); }
  Part* find_part(std::string_view name) const;
  Joint* find_joint(std::string_view name) const;
  Motor* find_motor(std::string_view name) const;
  Behavior* find_behavior(std::string_view name) const;
  /// The model it was imported from, or null; carries the merged links' frames.
  const std::shared_ptr<const BodyModel>& model() const { return model_; }
  /// World pose of a link by name, merged ones included.
  Result<Pose> link_pose(std::string_view name) const;

  /// Adds a part of a shape; `mass` 0: static. Errors: a taken or unprintable name, a plane with mass.
  Result<Part*> add_part(std::string name, Shape& shape, double mass, const Pose& pose);
  /// Adds a joint in the pose that the parts have now, which becomes its zero. `position` and `axis` are world.
  Result<Joint*> add_joint(std::string name, Part& parent, Part& child, JointType type, const Vec3& position,
                           const Vec3& axis);
  /// One motor a joint; a fixed joint takes none.
  Result<Motor*> add_motor(Joint& joint);

  /// Pairs of its parts that overlap or were edited. Pairs excluded from collision by default: a model's that overlap
  /// with all joints at 0, and, of other parts, those that overlap in the first tick.
  const PartPairs& pairs() const { return pairs_; }
  bool excludes(const Part& a, const Part& b) const;
  /// Excludes a pair of its parts from collision, or includes it, or restores its default; from the next step on.
  /// Errors: a part of another body, twice the same part.
  Result<void> edit_pair(const Part& a, const Part& b, PairEdit edit);
  bool self_collision() const;
  /// Whether it has parts and none of them moves.
  bool is_static() const;
  /// Warns once that a velocity has no effect; `what`: "part 'floor' is".
  void report_static_velocity(std::string_view what);

  /// The root's link frame. Setting moves the whole body rigidly; velocities stay.
  Pose pose() const;
  /// Of a body without parts: where its first part is placed, unless that is told a pose of its own.
  void set_pose(const Pose& pose);
  bool enabled() const;
  /// Whether its parts may fall asleep.
  bool can_sleep() const;
  /// Whether all its parts that can move sleep, and there are some.
  bool asleep() const;
  /// Whether it takes part: what `enabled` said at the last effects.
  bool in_world() const { return in_world_; }
  /// Takes the body out of the world, or back in, before the next step: what health does, and `reset` undoes.
  void set_enabled(bool on);
  /// Back to the start pose, at rest, enabled; values stay.
  void reset();
  /// The present pose becomes the start pose.
  void take_start_pose();
  /// The pose of a body of the same making becomes the start pose.
  void take_start_pose(const Body& other);

  /// For each part, by number, the part at whose end of the joints it hangs: the first that no joint leads to.
  std::vector<std::size_t> trees() const;
  /// Moves the parts of one tree rigidly, so that its first part is at `pose`; velocities stay.
  void move_tree(std::size_t first, const Pose& pose);

  /// A part's pose was set by hand: joints read it anew before the next step.
  void note_moved();

  /// Joints that are coupled to a leader (URDF mimic), in their order.
  std::span<Joint* const> followers() const { return followers_; }
  /// Readouts of its parts and joints. [any thread, while nobody else is at this body]
  void tell();
  /// After tell(): logs, once each, springs whose stiffness is capped, targets outside limits and clamped rotations.
  void say_caps();
  /// Logs followers that something holds away from where their leader puts them, once each.
  void report_slips() const;
  /// The present pose is what health goes back to.
  void take_good_pose();
  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  friend class World;
  friend class Behavior;
  friend class BehaviorList;
  friend class BehaviorUndo;
  friend class WorldUndo;
  friend class WorldKey;
  void keep();
  void say_clamp();
  void build(const std::shared_ptr<const BodyModel>& model, const BuildOptions& options);
  void build_motor(Joint& joint, const JointModel& m, bool servo);
  void build_copy(const Body& source);
  void enter();
  /// True when parts were moved by hand.
  bool settle_joints();
  void couple_followers();
  void effect_enabled();
  void effect_self_collision();
  void set_pair(std::size_t a, std::size_t b, PairEdit edit);
  void apply_pair(std::size_t a, std::size_t b);
  void apply_pairs();
  bool has_unchecked_parts() const { return pairs_.checked < parts_.size(); }
  void find_overlaps();
  void effect_can_sleep();
  void read_asleep(double* out) const { out[0] = asleep() ? 1 : 0; }
  void read_position(double* out) const;
  void write_position(const double* in);
  void read_rotation(double* out) const;
  void write_rotation(const double* in);
  void read_linear_velocity(double* out) const;
  void write_linear_velocity(const double* in);
  void read_angular_velocity(double* out) const;
  void write_angular_velocity(const double* in);
  Result<void> act_reset(std::span<const double> args);
  Result<void> act_remove(std::span<const double> args);

  World& world_;
  NodeId id_;
  NodeId part_group_, joint_group_, motor_group_, behavior_group_;
  std::shared_ptr<const BodyModel> model_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<std::unique_ptr<Joint>> joints_;
  std::vector<std::unique_ptr<Motor>> motors_;
  std::vector<Joint*> followers_;
  std::vector<Behavior*> behaviors_;
  std::uint32_t structure_ = 0;  // counts what is added: behaviours then look for their targets anew
  PartPairs pairs_;
  Pose planned_;  // while there is no part
  bool in_world_ = true;
  std::size_t entered_parts_ = 0;  // the first so many are in Bullet's world
  std::size_t entered_joints_ = 0;
  bool moved_ = false;
  bool reported_static_velocity_ = false;
  bool fresh_ = true;  // made since the last step: where it is then is its start pose

  // health: the pose after the last good tick, and whether it was needed already
  std::vector<Pose> last_good_;
  std::size_t good_poses_ = 0;  // so many of them count
  std::uint64_t kept_in_ = 0;   // the guarded call whose undo knows this body
  bool restored_once_ = false;
  bool broken_ = false;   // healed in this tick
  bool warns_ = false;    // a joint may have to report a capped spring or a target outside its limits
  bool clamped_ = false;  // the rotation of a part was clamped in this tick
  bool said_clamp_ = false;
  Joint* torn_ = nullptr;  // a joint that came apart in this tick
};

}  // namespace limber
