// BehaviorTransaction: hides behaviors, restores them, or destroys them.
#include "sim/behavior/behavior_transaction.h"

#include <algorithm>
#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber {

namespace {

template <class List>
auto iterator_at(List& list, std::size_t index) {
  return list.begin() + static_cast<std::ptrdiff_t>(index);
}

template <class List, class Predicate>
std::size_t index_in(const List& list, Predicate predicate) {
  return static_cast<std::size_t>(std::find_if(list.begin(), list.end(), predicate) - list.begin());
}

}  // namespace

void BehaviorTransaction::begin() {
  call_++;
  saved_count_ = 0;
  saved_targets_.clear();
  list_.saved_orders_.clear();
}

void BehaviorTransaction::commit() {
  Store& store = list_.world_.store();
  for (Hidden& hidden : hidden_) {
    if (hidden.node_hidden) store.remove_hidden(hidden.id);
    if (hidden.group != nullptr) {
      list_.retire(std::move(hidden.group));
    } else {
      list_.retire(std::move(hidden.behavior));
    }
  }
  hidden_.clear();
}

void BehaviorTransaction::save(Behavior& behavior) {
  WorldTransaction& transaction = list_.world_.transaction();
  if (!transaction.active() || std::exchange(behavior.saved_in_call_, call_) == call_) return;
  if (saved_count_ == saved_.size()) saved_.emplace_back();
  SavedState& saved = saved_[saved_count_];
  saved.behavior = &behavior;
  saved.random = behavior.random_;
  saved.seeded_with = behavior.seeded_with_;
  saved.needs_start = behavior.needs_start_;
  saved.fault = behavior.fault_;
  saved.timers = behavior.timers_;
  transaction.record(
      [](void* owner, std::size_t at) {
        const SavedState& saved = static_cast<BehaviorTransaction*>(owner)->saved_[at];
        Behavior& behavior = *saved.behavior;
        behavior.random_ = saved.random;
        behavior.seeded_with_ = saved.seeded_with;
        behavior.needs_start_ = saved.needs_start;
        behavior.fault_ = saved.fault;
        behavior.timers_ = saved.timers;
        behavior.request_preparation();
      },
      this, saved_count_++);
}

void BehaviorTransaction::save_targets(Behavior& behavior) {
  WorldTransaction& transaction = list_.world_.transaction();
  if (!transaction.active()) return;
  save(behavior);
  saved_targets_.push_back({&behavior, behavior.parts_, behavior.joints_, behavior.motors_});
  transaction.record(
      [](void* owner, std::size_t at) {
        SavedTargets& saved = static_cast<BehaviorTransaction*>(owner)->saved_targets_[at];
        saved.behavior->parts_ = std::move(saved.parts);
        saved.behavior->joints_ = std::move(saved.joints);
        saved.behavior->motors_ = std::move(saved.motors);
        // an earlier call may have changed the structure: resolve the targets again
        saved.behavior->resolved_structure_--;
        static_cast<BehaviorTransaction*>(owner)->list_.structure_version_ = 0;
      },
      this, saved_targets_.size() - 1);
}

void BehaviorTransaction::member_added(const Behavior& member) {
  constexpr unsigned kHalf = 32;
  const NodeId added = member.id();
  list_.world_.transaction().record(
      [](void* owner, std::size_t value) {
        BehaviorList& list = static_cast<BehaviorTransaction*>(owner)->list_;
        const NodeId id{static_cast<std::uint32_t>(value >> kHalf), static_cast<std::uint32_t>(value)};
        if (!list.world_.store().alive(id)) return;  // removed with its group
        auto& member = *static_cast<Behavior*>(list.world_.store().object(id));
        BehaviorGroup& group = *member.group();
        list.destroy(member);
        group.removed_bodies_.pop_back();  // not an explicit removal
      },
      this, std::size_t{added.slot} << kHalf | added.generation);
}

// If the body is hidden, its nodes are hidden already.
void BehaviorTransaction::hide_node(Hidden& hidden) const {
  Store& store = list_.world_.store();
  hidden.node_hidden = store.alive(hidden.id);
  if (hidden.node_hidden) hidden.sibling_index = store.hide(hidden.id);
}

void BehaviorTransaction::hide(Behavior& behavior) {
  Hidden hidden;
  hidden.id = behavior.id();
  hide_node(hidden);
  auto& on_body = behavior.body().behaviors_;
  hidden.index_on_body = index_in(on_body, [&](const Behavior* b) { return b == &behavior; });
  on_body.erase(iterator_at(on_body, hidden.index_on_body));
  if (BehaviorGroup* const group = behavior.group()) {
    group->removed_bodies_.push_back(behavior.body().id());
    auto& members = group->members_;
    hidden.index = index_in(members, [&](const auto& member) { return member.get() == &behavior; });
    hidden.behavior = std::move(members[hidden.index]);
    members.erase(iterator_at(members, hidden.index));
    group->layout_valid_ = false;
  } else {
    hidden.index = index_in(list_.entries_, [&](const auto& entry) { return entry.single.get() == &behavior; });
    hidden.behavior = std::move(list_.entries_[hidden.index].single);
    list_.erase_entry(hidden.index);
  }
  record_hidden(std::move(hidden));
}

void BehaviorTransaction::hide(BehaviorGroup& group) {
  while (!group.members_.empty()) hide(*group.members_.back());
  Hidden hidden;
  hidden.id = group.id();
  hide_node(hidden);
  hidden.index = index_in(list_.entries_, [&](const auto& entry) { return entry.group.get() == &group; });
  hidden.group = std::move(list_.entries_[hidden.index].group);
  list_.erase_entry(hidden.index);
  record_hidden(std::move(hidden));
}

void BehaviorTransaction::record_hidden(Hidden hidden) {
  hidden_.push_back(std::move(hidden));
  list_.world_.transaction().record(
      [](void* owner, std::size_t) { static_cast<BehaviorTransaction*>(owner)->show_last(); }, this);
}

// Restores the behavior that was hidden last; all later changes are undone already.
void BehaviorTransaction::show_last() {
  Hidden hidden = std::move(hidden_.back());
  hidden_.pop_back();
  if (hidden.node_hidden) list_.world_.store().show(hidden.id, hidden.sibling_index);
  if (hidden.group != nullptr) return list_.insert_entry(hidden.index).group.swap(hidden.group);
  Behavior& behavior = *hidden.behavior;
  auto& on_body = behavior.body().behaviors_;
  on_body.insert(iterator_at(on_body, hidden.index_on_body), &behavior);
  if (BehaviorGroup* const group = behavior.group()) {
    group->removed_bodies_.pop_back();
    group->members_.insert(iterator_at(group->members_, hidden.index), std::move(hidden.behavior));
    group->layout_valid_ = false;
  } else {
    list_.insert_entry(hidden.index).single = std::move(hidden.behavior);
  }
}

}  // namespace limber
