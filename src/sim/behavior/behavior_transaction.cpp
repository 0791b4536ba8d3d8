// BehaviorTransaction: hides behaviors, restores them, or destroys them.
#include "sim/behavior/behavior_transaction.h"

#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber::sim {

void BehaviorTransaction::begin() {
  saved_count_ = 0;
  saved_targets_.clear();
  saved_orders_.clear();
}

void BehaviorTransaction::commit() {
  for (Hidden& hidden : hidden_) {
    if (hidden.node_hidden) list_.world().store().remove_hidden(hidden.id);
    list_.retire(std::move(hidden.removed));
  }
  hidden_.clear();
}

void BehaviorTransaction::save(Behavior& behavior) {
  if (saved_count_ == saved_.size()) saved_.emplace_back();
  saved_[saved_count_].behavior = &behavior;
  saved_[saved_count_].state = behavior.state();
  list_.world().transaction().record(
      [](void* owner, std::size_t at) {
        const SavedState& saved = static_cast<BehaviorTransaction*>(owner)->saved_[at];
        saved.behavior->restore(saved.state);
      },
      this, saved_count_++);
}

void BehaviorTransaction::save_targets(Behavior& behavior) {
  WorldTransaction& transaction = list_.world().transaction();
  if (!transaction.active()) return;
  behavior.save_for_rollback();
  saved_targets_.push_back({&behavior, behavior.targets()});
  transaction.record(
      [](void* owner, std::size_t at) {
        auto& self = *static_cast<BehaviorTransaction*>(owner);
        SavedTargets& saved = self.saved_targets_[at];
        saved.behavior->set_targets(std::move(saved.targets));
        self.list_.request_update();  // an earlier call may have changed the structure
      },
      this, saved_targets_.size() - 1);
}

void BehaviorTransaction::save_order() {
  WorldTransaction& transaction = list_.world().transaction();
  if (!transaction.active()) return;
  saved_orders_.push_back(list_.order().keys());
  transaction.record(
      [](void* owner, std::size_t at) {
        auto& self = *static_cast<BehaviorTransaction*>(owner);
        self.list_.order().sort(self.saved_orders_[at]);
      },
      this, saved_orders_.size() - 1);
}

template <class T>
void BehaviorTransaction::hide_from_list(T& behavior) {
  Store& store = list_.world().store();
  Hidden& hidden = hidden_.emplace_back();
  hidden.id = behavior.id();
  hidden.node_hidden = store.alive(hidden.id);  // else it is hidden with its body
  if (hidden.node_hidden) hidden.sibling_index = store.hide(hidden.id);
  hidden.removed = list_.extract(behavior);
  list_.world().transaction().record(
      [](void* owner, std::size_t) { static_cast<BehaviorTransaction*>(owner)->show_last(); }, this);
}

void BehaviorTransaction::hide(Behavior& behavior) { hide_from_list(behavior); }

void BehaviorTransaction::hide(BehaviorGroup& group) {
  while (!group.members().empty()) hide_from_list(*group.members().back());
  hide_from_list(group);
}

// Restores the behavior that was hidden last; all later changes are undone already.
void BehaviorTransaction::show_last() {
  Hidden hidden = std::move(hidden_.back());
  hidden_.pop_back();
  if (hidden.node_hidden) list_.world().store().show(hidden.id, hidden.sibling_index);
  list_.insert(std::move(hidden.removed));
}

}  // namespace limber::sim
