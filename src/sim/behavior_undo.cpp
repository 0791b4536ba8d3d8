// BehaviorUndo: out of sight, back into its place, or gone.
#include "sim/behavior_undo.h"

#include <algorithm>
#include <utility>

#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

namespace {

template <class List>
auto iterator_at(List& list, std::size_t place) {
  return list.begin() + static_cast<std::ptrdiff_t>(place);
}

template <class List, class Is>
std::size_t place_in(const List& list, Is is) {
  return static_cast<std::size_t>(std::find_if(list.begin(), list.end(), is) - list.begin());
}

}  // namespace

void BehaviorUndo::begin() {
  call_++;
  kept_count_ = 0;
  targets_.clear();
  list_.orders_before_.clear();
}

void BehaviorUndo::end() {
  Store& store = list_.world_.store();
  for (Hidden& hidden : hidden_) {
    if (hidden.node_hidden) store.drop_hidden(hidden.id);
    if (hidden.group != nullptr) {
      list_.bury(std::move(hidden.group));
    } else {
      list_.bury(std::move(hidden.behavior));
    }
  }
  hidden_.clear();
}

void BehaviorUndo::keep(Behavior& behavior) {
  WorldUndo& undo = list_.world_.undo();
  if (!undo.active() || std::exchange(behavior.kept_in_, call_) == call_) return;
  if (kept_count_ == kept_.size()) kept_.emplace_back();
  Kept& kept = kept_[kept_count_];
  kept.behavior = &behavior;
  kept.random = behavior.random_;
  kept.seeded_with = behavior.seeded_with_;
  kept.fresh = behavior.fresh_;
  kept.fault = behavior.fault_;
  kept.beats = behavior.beats_;
  undo.note(
      [](void* owner, std::size_t at) {
        const Kept& kept = static_cast<BehaviorUndo*>(owner)->kept_[at];
        Behavior& behavior = *kept.behavior;
        behavior.random_ = kept.random;
        behavior.seeded_with_ = kept.seeded_with;
        behavior.fresh_ = kept.fresh;
        behavior.fault_ = kept.fault;
        behavior.beats_ = kept.beats;
        behavior.call_attention();
      },
      this, kept_count_++);
}

void BehaviorUndo::keep_targets(Behavior& behavior) {
  WorldUndo& undo = list_.world_.undo();
  if (!undo.active()) return;
  keep(behavior);
  targets_.push_back({&behavior, behavior.parts_, behavior.joints_, behavior.motors_});
  undo.note(
      [](void* owner, std::size_t at) {
        Targets& kept = static_cast<BehaviorUndo*>(owner)->targets_[at];
        kept.behavior->parts_ = std::move(kept.parts);
        kept.behavior->joints_ = std::move(kept.joints);
        kept.behavior->motors_ = std::move(kept.motors);
      },
      this, targets_.size() - 1);
}

void BehaviorUndo::made_member(const Behavior& member) {
  constexpr unsigned kHalf = 32;
  const NodeId made = member.id();
  list_.world_.undo().note(
      [](void* owner, std::size_t value) {
        BehaviorList& list = static_cast<BehaviorUndo*>(owner)->list_;
        const NodeId id{static_cast<std::uint32_t>(value >> kHalf), static_cast<std::uint32_t>(value)};
        if (!list.world_.store().alive(id)) return;  // gone with its group
        auto& member = *static_cast<Behavior*>(list.world_.store().thing(id));
        BehaviorGroup& group = *member.group();
        list.drop(member);
        group.left_.pop_back();  // nobody took it away by hand
      },
      this, std::size_t{made.slot} << kHalf | made.generation);
}

// a node of a body that is out of sight is so already
void BehaviorUndo::hide_node(Hidden& hidden) const {
  Store& store = list_.world_.store();
  hidden.node_hidden = store.alive(hidden.id);
  if (hidden.node_hidden) hidden.place_in_tree = store.hide(hidden.id);
}

void BehaviorUndo::hide(Behavior& behavior) {
  Hidden hidden;
  hidden.id = behavior.id();
  hide_node(hidden);
  auto& on_body = behavior.body().behaviors_;
  hidden.place_on_body = place_in(on_body, [&](const Behavior* b) { return b == &behavior; });
  on_body.erase(iterator_at(on_body, hidden.place_on_body));
  if (BehaviorGroup* const group = behavior.group()) {
    group->left_.push_back(behavior.body().id());
    auto& members = group->members_;
    hidden.place = place_in(members, [&](const auto& member) { return member.get() == &behavior; });
    hidden.behavior = std::move(members[hidden.place]);
    members.erase(iterator_at(members, hidden.place));
    group->laid_out_ = false;
  } else {
    hidden.place = place_in(list_.entries_, [&](const auto& entry) { return entry.single.get() == &behavior; });
    hidden.behavior = std::move(list_.entries_[hidden.place].single);
    list_.close_gap(hidden.place);
  }
  put_away(std::move(hidden));
}

void BehaviorUndo::hide(BehaviorGroup& group) {
  while (!group.members_.empty()) hide(*group.members_.back());
  Hidden hidden;
  hidden.id = group.id();
  hide_node(hidden);
  hidden.place = place_in(list_.entries_, [&](const auto& entry) { return entry.group.get() == &group; });
  hidden.group = std::move(list_.entries_[hidden.place].group);
  list_.close_gap(hidden.place);
  put_away(std::move(hidden));
}

void BehaviorUndo::put_away(Hidden hidden) {
  hidden_.push_back(std::move(hidden));
  list_.world_.undo().note([](void* owner, std::size_t) { static_cast<BehaviorUndo*>(owner)->bring_back(); }, this);
}

// the one that was hidden last: all that came after is undone
void BehaviorUndo::bring_back() {
  Hidden hidden = std::move(hidden_.back());
  hidden_.pop_back();
  if (hidden.node_hidden) list_.world_.store().show(hidden.id, hidden.place_in_tree);
  if (hidden.group != nullptr) return list_.open_gap(hidden.place).group.swap(hidden.group);
  Behavior& behavior = *hidden.behavior;
  auto& on_body = behavior.body().behaviors_;
  on_body.insert(iterator_at(on_body, hidden.place_on_body), &behavior);
  if (BehaviorGroup* const group = behavior.group()) {
    group->left_.pop_back();
    group->members_.insert(iterator_at(group->members_, hidden.place), std::move(hidden.behavior));
    group->laid_out_ = false;
  } else {
    list_.open_gap(hidden.place).single = std::move(hidden.behavior);
  }
}

}  // namespace limber
