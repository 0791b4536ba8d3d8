// Body: a named tree of parts, joints and motors, created part by part, from a model, or as a copy. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/body_model.h"
#include "properties/store.h"
#include "sim/world/body_behaviors.h"
#include "sim/world/body_recovery.h"
#include "sim/world/body_warnings.h"
#include "sim/world/object_list.h"
#include "sim/world/part_pairs.h"

namespace limber::sim {

class Joint;
class Motor;
class Part;
class SensorList;
class Shape;
class World;

/// Options for building a body from a model.
struct BuildOptions {
  /// Mode of the motors: servo or off; unset: servo, except for joints that no actuator of the file drives.
  std::optional<bool> servo_motors;
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
  std::span<const std::unique_ptr<Part>> parts() const { return parts_.list(); }
  std::span<const std::unique_ptr<Joint>> joints() const { return joints_.list(); }
  std::span<const std::unique_ptr<Motor>> motors() const { return motors_.list(); }
  Part* root() const { return parts().empty() ? nullptr : parts().front().get(); }
  Part* find_part(std::string_view name) const { return parts_.find(name); }
  Joint* find_joint(std::string_view name) const { return joints_.find(name); }
  Motor* find_motor(std::string_view name) const { return motors_.find(name); }
  SensorList& sensors() const { return *sensors_; }
  BodyBehaviors& behaviors() { return behaviors_; }
  const BodyBehaviors& behaviors() const { return behaviors_; }
  /// The model that it was imported from, or null; contains the frames of merged links.
  const std::shared_ptr<const model::BodyModel>& model() const { return model_; }

  /// Adds a part with the given shape; `mass` in kg, 0: static. Errors: the name is taken or can't be printed, the pose
  /// is invalid, the mass is out of range, a plane with mass, an empty compound.
  Result<Part*> add_part(std::string name, Shape& shape, double mass, const Pose& pose);
  /// Adds a joint. The present pose of its parts becomes its zero position. `position` and `axis` are in world
  /// coordinates. Errors: the name is taken, parts of another body, the same part twice, two static parts, an axis of
  /// length 0.
  Result<Joint*> add_joint(std::string name, Part& parent, Part& child, model::JointType type, const Vec3& position,
                           const Vec3& axis);
  /// Adds a motor. A joint has at most one; a fixed joint can't have one.
  Result<Motor*> add_motor(Joint& joint);

  /// Pairs of its parts that don't collide, or were edited.
  PartPairs& pairs() { return pairs_; }
  const PartPairs& pairs() const { return pairs_; }
  BodyRecovery& recovery() { return recovery_; }
  BodyWarnings& warnings() { return warnings_; }
  /// True if it has parts and none of them can move.
  bool is_static() const;

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
  /// body, and BodyRecovery::reset() enables it.
  void set_enabled(bool on);

  /// Requests that joints read their positions from the parts again before the next step, because a part's pose was
  /// set.
  void mark_joints_dirty();
  bool joints_dirty() const { return state_.joints_dirty; }
  /// Makes joints read their positions again if this was requested; returns whether it was.
  bool update_moved_joints();

  /// Joints that are coupled to a leader (URDF mimic), in order of creation.
  std::span<Joint* const> followers() const { return followers_; }
  /// Counts additions of parts, joints and motors, and changes of the motion of parts: behaviors then resolve their
  /// targets again.
  std::uint32_t structure_version() const;

  // Construction of an empty body; called by World.
  void build(const std::shared_ptr<const model::BodyModel>& model, const BuildOptions& options);
  void build_copy(const Body& source);

  /// Adds new parts and joints to Bullet's world; called by World before a step.
  void add_to_world();
  /// Publishes the readouts of its parts and joints after a step. [any, one thread per body]
  void publish();
  /// For checkpoints: its state beyond properties, and that of its parts, joints and motors.
  void serialize(Archive& archive);

 private:
  void save_for_rollback();
  void apply_enabled();

  World& world_;
  NodeId id_;
  std::shared_ptr<const model::BodyModel> model_;
  ObjectList<Part> parts_;
  ObjectList<Joint> joints_;
  ObjectList<Motor> motors_;
  std::unique_ptr<SensorList> sensors_;
  std::vector<Joint*> followers_;
  BodyBehaviors behaviors_;
  std::uint32_t structure_version_ = 0;
  PartPairs pairs_{*this};
  BodyRecovery recovery_{*this};
  BodyWarnings warnings_{*this};
  // what persists from tick to tick, besides its properties
  struct State {
    bool in_world = true;
    bool joints_dirty = false;
    std::size_t added_parts = 0;  // number of parts that have been added to Bullet's world, in order; joints alike
    std::size_t added_joints = 0;
    Pose initial_pose;  // pose for the first part, used while there are no parts
  } state_;
  std::uint64_t saved_in_call_ = 0;  // the last guarded call that saved this body
};

}  // namespace limber::sim
