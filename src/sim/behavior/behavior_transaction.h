// BehaviorTransaction: logs a guarded call's changes of behaviors, to roll them back if the call fails. Behaviors that
// the call removes are hidden until it ends. There is no rollback(): it registers functions that undo the changes with
// WorldTransaction::record(), which runs them. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_group.h"

namespace limber::sim {

class BehaviorList;

class BehaviorTransaction {
 public:
  explicit BehaviorTransaction(BehaviorList& list) : list_(list) {}

  /// Call when a guarded call begins.
  void begin();
  /// The call succeeded: destroys the behaviors that it removed.
  void commit();
  /// Saves the state of a behavior; called by Behavior::save_for_rollback().
  void save(Behavior& behavior);
  /// Saves the targets. Call before they are resolved again. Does nothing outside of guarded calls.
  void save_targets(Behavior& behavior);
  /// Saves the order of the list. Call before it changes. Does nothing outside of guarded calls.
  void save_order();
  /// Removes a behavior, or a group with its members, from its list and keeps it hidden until the call ends.
  void hide(Behavior& behavior);
  void hide(BehaviorGroup& group);

 private:
  struct SavedState {
    Behavior* behavior = nullptr;
    Behavior::State state;
  };
  struct SavedTargets {
    Behavior* behavior = nullptr;
    Behavior::Targets targets;
  };
  struct Hidden {
    RemovedBehavior removed;
    NodeId id;
    bool node_hidden = false;       // its node was hidden here; else it is hidden with its body
    std::size_t sibling_index = 0;  // index among its node's siblings
  };
  template <class T>
  void hide_from_list(T& behavior);
  void show_last();

  BehaviorList& list_;
  std::vector<SavedState> saved_;  // the first saved_count_ are valid; the others are reused to avoid allocations
  std::size_t saved_count_ = 0;
  std::vector<SavedTargets> saved_targets_;
  std::vector<std::vector<std::string>> saved_orders_;
  std::vector<Hidden> hidden_;
};

}  // namespace limber::sim
