// Body: a named tree of parts, joints and motors, created part by part, from a model, or as a copy. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/body_model.h"
#include "properties/store.h"
#include "sim/behavior/behavior.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/part_pairs.h"
#include "sim/world/shape.h"

namespace limber {

class World;

/// Options for building a body from a model.
struct BuildOptions {
  bool servo_motors = true;      ///< false: motors are created in mode `off`.
  std::optional<Vec3> position;  ///< Of the root's link frame; default: as in the model.
  std::optional<Quat> rotation;
};

class Body {
 public:
  static const PropertyTable& table();

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
  /// In order of creation. The world's BehaviorList (sim/behavior/behavior_list.h) creates and removes them.
  std::span<Behavior* const> behaviors() const { return behaviors_; }
  Part* root() const { return parts_.empty() ? nullptr : parts_.front().get(); }
  Part* find_part(std::string_view name) const;
  Joint* find_joint(std::string_view name) const;
  Motor* find_motor(std::string_view name) const;
  Behavior* find_behavior(std::string_view name) const;
  /// The model that it was imported from, or null; contains the frames of merged links.
  const std::shared_ptr<const BodyModel>& model() const { return model_; }
  /// Returns the world pose of a link by name, including links that the importer merged into a part.
  Result<Pose> link_pose(std::string_view name) const;

  /// Adds a part with the given shape; `mass` in kg, 0: static. Errors: the name is taken or can't be printed, the pose
  /// is invalid, the mass is out of range, a plane with mass, an empty compound.
  Result<Part*> add_part(std::string name, Shape& shape, double mass, const Pose& pose);
  /// Adds a joint. The present pose of its parts becomes its zero position. `position` and `axis` are in world
  /// coordinates. Errors: the name is taken, parts of another body, the same part twice, two static parts, an axis of
  /// length 0.
  Result<Joint*> add_joint(std::string name, Part& parent, Part& child, JointType type, const Vec3& position,
                           const Vec3& axis);
  /// Adds a motor. A joint has at most one; a fixed joint can't have one.
  Result<Motor*> add_motor(Joint& joint);

  /// Pairs of its parts that overlap or were edited. Two parts don't collide by default if they overlap with all
  /// joints at 0 (bodies from models), or in the first tick (other parts).
  const PartPairs& pairs() const { return state_.pairs; }
  bool excludes(const Part& a, const Part& b) const;
  /// Excludes a pair of its parts from collision, includes it, or restores its default, from the next step on.
  /// Errors: a part of another body, the same part twice.
  Result<void> edit_pair(const Part& a, const Part& b, PairEdit edit);
  bool self_collision() const;
  /// True if it has parts and none of them can move.
  bool is_static() const;
  /// Warns, once per body, that setting a velocity has no effect. `subject` begins the sentence: "part 'floor' is".
  void warn_static_velocity(std::string_view subject);

  /// Pose of the root's link frame. Setting it moves the whole body rigidly; velocities don't change.
  Pose pose() const;
  /// If the body has no parts yet, sets the pose for its first part, unless that part gets a pose of its own.
  void set_pose(const Pose& pose);
  bool enabled() const;
  /// Whether its parts are allowed to fall asleep.
  bool can_sleep() const;
  /// True if it has parts that can move and all of these sleep.
  bool asleep() const;
  /// True if it takes part in the simulation: the value of `enabled` when changes were last applied.
  bool in_world() const { return state_.in_world; }
  /// Removes the body from the simulation or adds it again, before the next step. The stability check disables a
  /// body, and reset() enables it.
  void set_enabled(bool on);
  /// Returns to the start pose, at rest and enabled; other values don't change.
  void reset();
  /// Makes the present pose the start pose.
  void save_start_pose();
  /// Makes the pose of `other`, a body of the same structure, the start pose.
  void save_start_pose(const Body& other);

  /// For each part, the index of the root of its tree of joints: the first part that is no joint's child.
  std::vector<std::size_t> trees() const;
  /// Moves the parts of one tree rigidly, so that its root is at `pose`; velocities don't change.
  void move_tree(std::size_t root, const Pose& pose);

  /// Requests that joints read their positions from the parts again before the next step, because a part's pose was
  /// set.
  void mark_joints_dirty();
  bool joints_dirty() const { return state_.joints_dirty; }
  /// Makes joints read their positions again if this was requested; returns whether it was.
  bool update_moved_joints();

  /// Joints that are coupled to a leader (URDF mimic), in order of creation.
  std::span<Joint* const> followers() const { return followers_; }
  /// Counts additions of parts, joints and motors: behaviors then resolve their targets again.
  std::uint32_t structure_version() const { return structure_version_; }

  // Construction of an empty body; called by World.
  void build(const std::shared_ptr<const BodyModel>& model, const BuildOptions& options);
  void build_copy(const Body& source);

  // Steps of a tick, called by World in this order.
  /// Adds new parts and joints to Bullet's world.
  void add_to_world();
  /// Saves the start pose of a new body, and excludes pairs of its new parts that overlap.
  void prepare_step();
  /// Restores the last good pose, at rest, because a part is unstable; the second time since the last reset it also
  /// disables the body. Logs this, once per tick; returns true if it did.
  bool restore_good_pose(const Part& part, const std::string& instability);
  /// Publishes the readouts of its parts and joints, and saves the pose as good unless the body was restored or came
  /// apart. [any, one thread per body]
  void publish();
  /// After publish(): logs, once each, springs with a capped stiffness, targets outside limits, and clamped
  /// rotations.
  void log_warnings();
  /// Warns, once each, about mimic joints that something keeps from the positions that their leaders demand.
  void warn_slipping_joints() const;
  /// Returns a joint that came apart in this tick, once, or null. Null also if the body was restored in this tick.
  const Joint* consume_separated_joint();
  /// After the last internal step: discards forces that a restored body got for further steps.
  void finish_restore();

  // The list of its behaviors, which BehaviorList keeps up to date.
  NodeId behavior_group() const { return behavior_group_; }
  void insert_behavior(std::size_t index, Behavior& behavior);
  void replace_behavior(const Behavior& previous, Behavior& behavior);
  /// Returns the index that it had.
  std::size_t remove_behavior(const Behavior& behavior);

  std::uint64_t state_hash(std::uint64_t start) const;
  /// For checkpoints: its state beyond properties, and that of its parts, joints and motors.
  void serialize(Archive& archive);

 private:
  void save_for_rollback();
  void warn_clamped();
  void build_motor(Joint& joint, const JointModel& m, bool servo);
  template <auto kList>
  void record_added();
  void save_good_pose();
  void couple_followers();
  void apply_enabled();
  void apply_self_collision();
  void set_pair(std::size_t a, std::size_t b, PairEdit edit);
  void apply_pair(std::size_t a, std::size_t b);
  void apply_pairs();
  bool has_unchecked_parts() const { return state_.pairs.checked_count < parts_.size(); }
  void find_overlaps();
  void apply_can_sleep();
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
  std::uint32_t structure_version_ = 0;
  // what persists from tick to tick, besides its properties
  struct State {
    bool in_world = true;
    bool joints_dirty = false;
    bool restored_this_tick = false;
    bool restored_once = false;
    bool is_new = true;  // created since the last step: the next step stores its start pose
    bool warned_static_velocity = false;
    bool warned_clamped = false;
    std::size_t added_parts = 0;  // number of parts that have been added to Bullet's world, in order; joints alike
    std::size_t added_joints = 0;
    std::size_t good_pose_count = 0;  // number of valid elements of good_poses
    std::vector<Pose> good_poses;     // of the parts after the last good tick, for the stability check
    PartPairs pairs;
    Pose initial_pose;  // pose for the first part, used while there are no parts
  } state_;
  std::uint64_t saved_in_call_ = 0;   // the last guarded call that saved this body
  bool has_joint_warnings_ = false;   // a joint may have to report a capped spring or a target outside its limits
  bool clamped_ = false;              // the rotation of a part was clamped in this tick
  Joint* separated_joint_ = nullptr;  // a joint that came apart in this tick
};

}  // namespace limber
