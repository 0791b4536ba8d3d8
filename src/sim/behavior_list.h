// BehaviorList: a world's behaviours, in the order in which they act, C++ and Lua alike: that in which they were made,
// until one is put elsewhere. A group stands where it was made. [sim]
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/behavior.h"
#include "sim/behavior_group.h"
#include "sim/behavior_type.h"
#include "sim/behavior_undo.h"
#include "sim/neighbors.h"

namespace limber {

class BehaviorList {
 public:
  explicit BehaviorList(World& world, NodeId physics);
  ~BehaviorList();
  BehaviorList(const BehaviorList&) = delete;
  BehaviorList& operator=(const BehaviorList&) = delete;

  BehaviorTypes& types() { return types_; }
  const BehaviorTypes& types() const { return types_; }

  /// Attaches a behaviour to a body. Errors name what exists: a type, a part, a joint, a motor; a taken name.
  Result<Behavior*> add(Body& body, std::string_view type, const std::string& name, BehaviorSetup setup = {});
  /// Attaches one to each of several bodies. Errors as of add; a body that is named and does not exist.
  Result<BehaviorGroup*> add_group(std::string_view type, std::string name, GroupSetup setup = {});
  /// Detaches it. May be called while behaviours step: it does not act again. A guarded call that fails has not done
  /// it.
  void remove(Behavior& behavior);
  void remove_group(BehaviorGroup& group);
  void clear();

  BehaviorGroup* find_group(std::string_view name) const;
  std::vector<BehaviorGroup*> groups() const;
  NodeId group_node() const { return group_node_; }

  /// All behaviours of the source for its copy, with their values; groups get a member more. Of a body of another world
  /// there are none: whoever copies it makes them.
  void copy(const Body& source, Body& copy);
  void body_gone(Body& body);
  /// start() again before the next step, generators anew.
  void body_reset(Body& body);
  /// Instances of that type are made again of the type that now has its name: rows that both have keep their values
  /// (clamped), targets, place, generator and beats stay, and Behavior::take_over is called. Instances of a type that
  /// no longer has an entry stay as they are.
  void renew(std::string_view type);

  /// Members of groups, and targets, as bodies now are. Cheap while none has come, gone or changed.
  void follow_bodies();
  /// Which one it is, from 1, of those that act on its body: its own, and groups that it is a member of. [sim]
  std::size_t place(const Behavior& behavior) const;
  /// Which one it is, from 1, of all names that behaviours of bodies and groups have, by their first.
  std::size_t place(const BehaviorGroup& group) const;
  /// It acts there from the next step on; beyond the last: as the last. The others keep their order. A guarded call
  /// that fails has not done it. Not while they step, and not for a member.
  void put_at(Behavior& behavior, std::size_t place);
  /// The same for a group among names: then all behaviours act in the order of their names, in every body.
  void put_at(BehaviorGroup& group, std::size_t place);
  /// An error: they step now.
  Result<void> may_move() const;
  /// Names in the order in which they act: "body/behaviour", and "/group".
  std::vector<std::string> order() const;
  /// Brings them into such an order; those that are not named act behind, as they did.
  void bring_into(const std::vector<std::string>& order);
  /// Every behaviour that runs, in order.
  void step(double dt);
  /// Counts the steps.
  std::uint64_t turn() const { return turn_; }
  /// The set of these parts, shared by all groups that look at the same ones.
  std::shared_ptr<NeighborSet> neighbor_set(std::vector<Part*> parts);

  /// What guarded calls do to behaviours.
  BehaviorUndo& undo() { return undo_; }

  /// How many have an error and are suspended, members of groups among them. Looks at each.
  std::size_t suspended() const;
  /// Told of each error, once.
  void on_fault(std::function<void(const Behavior&)> hook) { on_fault_ = std::move(hook); }
  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  friend class Behavior;
  friend class BehaviorGroup;
  friend class BehaviorUndo;
  friend class WorldKey;
  /// One behaviour or one group.
  struct Entry {
    std::unique_ptr<Behavior> single;
    std::unique_ptr<BehaviorGroup> group;
  };

  static std::string key_of(const Entry& entry);
  static std::string_view name_of(const Entry& entry);
  static bool acts_on(const Entry& entry, const Body& body);
  std::vector<std::string_view> names() const;
  void count_places() const;
  void note_order();
  Result<std::unique_ptr<Behavior>> make(Body& body, const std::shared_ptr<const BehaviorType>& type,
                                         const std::string& name, const std::shared_ptr<const BehaviorSetup>& setup,
                                         BehaviorGroup* group);
  std::unique_ptr<Behavior> renewed(Behavior& before, const std::shared_ptr<const BehaviorType>& type);
  void copy_values(const Behavior& from, Behavior& to);
  void say_fault(const Behavior& behavior) const;
  void note_made();
  void drop(Behavior& behavior);
  void drop_group(BehaviorGroup& group);
  void drop_last();
  void bury(std::unique_ptr<Behavior> behavior);
  void bury(std::unique_ptr<BehaviorGroup> group);
  void close_gap(std::size_t place);
  Entry& open_gap(std::size_t place);

  World& world_;
  NodeId group_node_;
  BehaviorTypes types_;
  std::vector<Entry> entries_;
  std::vector<std::unique_ptr<Behavior>> graves_;  // removed while they were stepped
  std::vector<std::unique_ptr<BehaviorGroup>> group_graves_;
  std::vector<std::weak_ptr<NeighborSet>> neighbor_sets_;
  std::uint64_t structure_ = 0;
  mutable std::uint64_t places_of_ = ~std::uint64_t{0};  // the structure whose places were counted
  std::vector<std::vector<std::string>> orders_before_;  // of a guarded call
  std::uint64_t turn_ = 0;
  bool stepping_ = false;
  BehaviorUndo undo_{*this};
  std::function<void(const Behavior&)> on_fault_;
};

}  // namespace limber
