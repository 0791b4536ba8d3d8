// BehaviorTransaction: logs a guarded call's changes of behaviors, to roll them back if the call fails. Behaviors that
// the call removes are hidden until it ends. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_group.h"

namespace limber {

class BehaviorList;

class BehaviorTransaction {
 public:
  explicit BehaviorTransaction(BehaviorList& list) : list_(list) {}

  /// Call when a guarded call begins.
  void begin();
  /// The call succeeded: destroys the behaviors that it removed.
  void commit();
  /// Saves random generator, interval timers, error and start flag. Call before they change. Does nothing outside of
  /// guarded calls.
  void save(Behavior& behavior);
  /// Saves the targets. Call before they are resolved again.
  void save_targets(Behavior& behavior);
  /// Logs that a group got a new member.
  void member_added(const Behavior& member);
  /// Removes a behavior, or a group with its members, from its list and keeps it hidden until the call ends.
  void hide(Behavior& behavior);
  void hide(BehaviorGroup& group);

 private:
  struct SavedState {
    Behavior* behavior = nullptr;
    Random random;
    std::uint64_t seeded_with = 0;
    bool needs_start = false;
    BehaviorFault fault;
    std::vector<Behavior::IntervalTimer> timers;
  };
  struct SavedTargets {
    Behavior* behavior = nullptr;
    std::vector<Part*> parts;
    std::vector<Joint*> joints;
    std::vector<Motor*> motors;
  };
  struct Hidden {
    std::unique_ptr<Behavior> behavior;  // one of the two is set
    std::unique_ptr<BehaviorGroup> group;
    NodeId id;
    bool node_hidden = false;  // its node was hidden here; else it is hidden with its body
    std::size_t index = 0;     // index in the list, or among the members of its group
    std::size_t index_on_body = 0;
    std::size_t sibling_index = 0;  // index among its node's siblings
  };
  void hide_node(Hidden& hidden) const;
  void record_hidden(Hidden hidden);
  void show_last();

  BehaviorList& list_;
  std::uint64_t call_ = 0;
  std::vector<SavedState> saved_;  // the first saved_count_ are valid; the others are reused to avoid allocations
  std::size_t saved_count_ = 0;
  std::vector<SavedTargets> saved_targets_;
  std::vector<Hidden> hidden_;
};

}  // namespace limber
