// BehaviorAttachment: where a behavior is attached: its node, body, type and group, and the parts, joints and motors
// that it acts on. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/id.h"
#include "base/result.h"
#include "sim/behavior/behavior_type.h"
#include "sim/behavior/selection.h"

namespace limber {
class Store;
}  // namespace limber

namespace limber::sim {

class BehaviorGroup;
class Body;
class Joint;
class Motor;
class Part;
class World;

/// The targets of a behavior, as selected by the scene. Copies of a body and members of a group share one object.
struct BehaviorSetup {
  Selection parts;
  Selection joints;
  Selection motors;
  bool operator==(const BehaviorSetup&) const = default;
};

class BehaviorAttachment {
 public:
  // Identity, valid from start() on. A behavior that is removed while it steps has no body and an empty name.
  NodeId id() const { return id_; }
  const std::string& name() const;
  Body& body() const { return *body_; }
  World& world() const { return *world_; }
  Store& store() const;
  bool removed() const { return body_ == nullptr; }
  const BehaviorType& type() const { return *type_; }
  /// The group that it is a member of, or null.
  BehaviorGroup* group() const { return group_; }
  const BehaviorSetup& setup() const { return *setup_; }
  const std::shared_ptr<const BehaviorType>& shared_type() const { return type_; }
  const std::shared_ptr<const BehaviorSetup>& shared_setup() const { return setup_; }

  /// Its targets in stream order (root to tip), without duplicates; a type that acts on pairs has its parts in the
  /// order in which the scene names them. "all" leaves out parts without mass.
  std::span<Part* const> parts() const { return targets_.parts; }
  std::span<Joint* const> joints() const { return targets_.joints; }
  std::span<Motor* const> motors() const { return targets_.motors; }

  struct Targets {
    std::vector<Part*> parts;
    std::vector<Joint*> joints;
    std::vector<Motor*> motors;
    bool operator==(const Targets&) const = default;
  };
  const Targets& targets() const { return targets_; }
  void set_targets(Targets targets) { targets_ = std::move(targets); }
  /// Marks it as removed.
  void detach() { body_ = nullptr; }

 protected:
  BehaviorAttachment() = default;
  ~BehaviorAttachment() = default;

  /// Sets its body, type, setup and group (or null).
  void attach_to(Body& body, std::shared_ptr<const BehaviorType> type, std::shared_ptr<const BehaviorSetup> setup,
                 BehaviorGroup* group);
  void set_id(NodeId id) { id_ = id; }
  /// Returns the objects of the body that the setup selects.
  Targets selected_targets() const;
  /// Error: a name that the setup selects doesn't exist. Members of a group need not have all names: the group checks
  /// them.
  Result<void> check_selected_names() const;

 private:
  bool selects_motors_by_joint() const;

  World* world_ = nullptr;
  Body* body_ = nullptr;  // null: removed
  BehaviorGroup* group_ = nullptr;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  std::shared_ptr<const BehaviorSetup> setup_;
  Targets targets_;
};

}  // namespace limber::sim
