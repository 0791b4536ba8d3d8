// BehaviorList: a world's behaviors, built-in and Lua, in the order in which they are stepped: the order of their
// creation, unless one was moved. A group is one entry. Before them, a step applies the routes of the world. [sim]
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_group.h"
#include "sim/behavior/behavior_order.h"
#include "sim/behavior/behavior_transaction.h"
#include "sim/behavior/behavior_type.h"
#include "sim/clock/beat_clock.h"
#include "sim/neighbors/neighbor_set.h"
#include "sim/routes/route_list.h"

namespace limber::sim {

class BehaviorList {
 public:
  explicit BehaviorList(World& world, NodeId physics);
  ~BehaviorList();
  BehaviorList(const BehaviorList&) = delete;
  BehaviorList& operator=(const BehaviorList&) = delete;

  /// The routes of the world.
  RouteList& routes() const { return *routes_; }
  /// Musical time.
  BeatClock& clock() const { return *clock_; }
  BehaviorTypes& types() { return types_; }
  const BehaviorTypes& types() const { return types_; }

  /// Attaches a behavior to a body. Errors: unknown type, part, joint or motor (with a hint), the name is taken.
  Result<Behavior*> add(Body& body, std::string_view type, const std::string& name, BehaviorSetup setup = {});
  /// Attaches a behavior to each of several bodies. Errors as for add(), or a named body doesn't exist.
  Result<BehaviorGroup*> add_group(std::string_view type, std::string name, GroupSetup setup = {});
  /// Detaches a behavior; allowed while behaviors are stepped: it isn't stepped again. Rolled back if the guarded
  /// call fails.
  void remove(Behavior& behavior);
  void remove(BehaviorGroup& group);
  void clear();

  BehaviorGroup* find_group(std::string_view name) const;
  std::vector<BehaviorGroup*> groups() const;
  NodeId group_node() const { return group_node_; }

  /// Copies all behaviors of `source` with their values to its copy; those that belong to a group become new members of
  /// it. Does nothing if the source is of another world: the caller must add them then.
  void copy(const Body& source, Body& copy);
  void on_body_destroyed(Body& body);
  /// Starts the body's behaviors again before the next step, with freshly seeded generators.
  void on_body_reset(Body& body);
  /// Replaces each instance of the type that had this name before a reload by an instance of the new type. Properties
  /// that exist in both keep their values (clamped). Targets, place, random generator and timer intervals are
  /// preserved, and Behavior::adopt_state() is called. Instances of a type that was removed are left unchanged.
  void replace_instances(std::string_view type);

  /// Updates group members and targets to the present bodies. Cheap if none was added, removed or changed.
  void update_members();
  /// The order in which they are stepped.
  BehaviorOrder& order() { return order_; }
  const BehaviorOrder& order() const { return order_; }
  /// Returns an error while behaviors are being stepped.
  Result<void> check_can_move() const;
  /// Applies the routes, then steps every behavior that runs, in order.
  void step(double dt);
  /// Number of steps so far.
  std::uint64_t step_count() const { return step_count_; }
  /// Returns the neighbor set of these parts, which all groups with the same neighbors share.
  std::shared_ptr<NeighborSet> neighbor_set(std::vector<Part*> parts);

  /// Rolls back changes of behaviors by guarded calls.
  BehaviorTransaction& transaction() { return transaction_; }

  /// Number of behaviors, including group members, that are suspended by an error. O(n).
  std::size_t suspended_count() const;
  /// Sets the callback that is called once for each error.
  void on_fault(std::function<void(const Behavior&)> hook) { on_fault_ = std::move(hook); }
  std::uint64_t state_hash(std::uint64_t start) const;
  World& world() const { return world_; }

  // Called by Behavior, BehaviorGroup and BehaviorTransaction. [sim]
  /// Makes a behavior of the body that is in no list of behaviors or members yet. Errors as for add().
  Result<std::unique_ptr<Behavior>> make(Body& body, const std::shared_ptr<const BehaviorType>& type,
                                         const std::string& name, const std::shared_ptr<const BehaviorSetup>& setup,
                                         BehaviorGroup* group);
  /// Removes a behavior, or a group without members, from all lists; its node stays.
  RemovedBehavior extract(Behavior& behavior);
  RemovedBehavior extract(BehaviorGroup& group);
  /// Undoes extract().
  void insert(RemovedBehavior removed);
  /// Destroys a removed behavior or group; at the end of the step if behaviors are being stepped.
  void retire(RemovedBehavior removed);
  /// The next update_members() checks all members and targets.
  void request_update() { structure_version_ = 0; }
  void report_fault(const Behavior& behavior) const;
  /// Serializes the state of all behaviors, for checkpoints.
  void serialize(Archive& archive);

 private:
  void copy_values(const Behavior& from, Behavior& to);
  void record_entry_count();
  void destroy(Behavior& behavior);
  void destroy_group(BehaviorGroup& group);
  void destroy_last();
  template <class Predicate>
  RemovedBehavior extract_last(Predicate predicate);

  World& world_;
  NodeId group_node_;
  BehaviorTypes types_;
  std::unique_ptr<RouteList> routes_;
  std::unique_ptr<BeatClock> clock_;
  std::vector<StepEntry> entries_;
  BehaviorOrder order_{world_, entries_};
  std::vector<RemovedBehavior> retired_;  // removed while behaviors were stepped
  std::vector<std::weak_ptr<NeighborSet>> neighbor_sets_;
  std::uint64_t structure_version_ = 0;
  std::uint64_t step_count_ = 0;
  bool stepping_ = false;
  BehaviorTransaction transaction_{*this};
  std::function<void(const Behavior&)> on_fault_;
};

}  // namespace limber::sim
