// BehaviorList: how behaviours go, while others step, and in guarded calls that may fail yet.
#include <algorithm>
#include <utility>

#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

namespace {

// what came last goes first, mostly
template <class T, class Is>
auto from_behind(std::vector<T>& list, Is is) {
  return std::find_if(list.rbegin(), list.rend(), is).base() - 1;
}

}  // namespace

// what a guarded call has made goes again when it fails
void BehaviorList::note_made() {
  if (!world_.undo().active()) return;
  const auto take_back = [](void* list, std::size_t count) {
    auto& self = *static_cast<BehaviorList*>(list);
    while (self.entries_.size() > count) self.remove_last();
  };
  world_.undo().note(take_back, this, entries_.size());
}

void BehaviorList::remove_last() {
  const Entry& last = entries_.back();
  if (last.group != nullptr) {
    take_out(*last.group);
  } else {
    take_out(*last.single);
  }
}

void BehaviorList::remove(Behavior& behavior) { world_.undo().active() ? hide(behavior) : take_out(behavior); }

void BehaviorList::remove_group(BehaviorGroup& group) { world_.undo().active() ? hide(group) : take_out(group); }

void BehaviorList::bury(std::unique_ptr<Behavior> behavior) {
  behavior->body_ = nullptr;
  if (stepping_) graves_.push_back(std::move(behavior));
}

void BehaviorList::take_out(Behavior& behavior) {
  std::erase(behavior.body_->behaviors_, &behavior);
  world_.store().remove(behavior.id_);
  if (BehaviorGroup* group = behavior.group_) {
    group->left_.push_back(behavior.body_->id());
    const auto at = from_behind(group->members_, [&](const auto& member) { return member.get() == &behavior; });
    bury(std::move(*at));
    group->members_.erase(at);
    group->laid_out_ = false;
    return;
  }
  const auto at = from_behind(entries_, [&](const Entry& e) { return e.single.get() == &behavior; });
  bury(std::move(at->single));
  if (!stepping_) entries_.erase(at);
}

void BehaviorList::take_out(BehaviorGroup& group) {
  while (!group.members_.empty()) take_out(*group.members_.back());
  world_.store().remove(group.id_);
  const auto at = from_behind(entries_, [&](const Entry& e) { return e.group.get() == &group; });
  if (stepping_) {
    group_graves_.push_back(std::move(at->group));
  } else {
    entries_.erase(at);
  }
}

// it keeps its place in the list, so that coming back is being seen again
void BehaviorList::hide(Behavior& behavior) {
  std::vector<Behavior*>& siblings = behavior.body_->behaviors_;
  const auto at = std::find(siblings.begin(), siblings.end(), &behavior);
  hidden_.push_back({&behavior, static_cast<std::size_t>(at - siblings.begin()), world_.store().hide(behavior.id_)});
  siblings.erase(at);
  if (behavior.group_ != nullptr) behavior.group_->left_.push_back(behavior.body_->id());
  const auto show = [](void* list, std::size_t) {
    auto& self = *static_cast<BehaviorList*>(list);
    const Hidden& last = self.hidden_.back();
    Behavior& shown = *last.behavior;
    self.world_.store().show(shown.id_, last.place_in_tree);
    std::vector<Behavior*>& siblings = shown.body_->behaviors_;
    siblings.insert(siblings.begin() + static_cast<std::ptrdiff_t>(last.place), &shown);
    if (shown.group_ != nullptr) shown.group_->left_.pop_back();
    self.hidden_.pop_back();
  };
  const auto go = [](void* list, std::size_t at) {
    auto& self = *static_cast<BehaviorList*>(list);
    Behavior& gone = *self.hidden_[at].behavior;
    if (gone.group_ != nullptr) gone.group_->left_.pop_back();  // taking it out says so again
    self.world_.store().drop_hidden(gone.id_);
    self.take_out(gone);
    if (at + 1 == self.hidden_.size()) self.hidden_.clear();
  };
  world_.undo().note(show, this);
  world_.undo().at_end(go, this, hidden_.size() - 1);
}

void BehaviorList::hide(BehaviorGroup& group) {
  for (auto member = group.members_.rbegin(); member != group.members_.rend(); ++member) {
    if (world_.store().alive((*member)->id_)) hide(**member);
  }
  const std::size_t place = world_.store().hide(group.id_);
  const auto show = [](void* shown, std::size_t place_in_tree) {
    auto& group = *static_cast<BehaviorGroup*>(shown);
    group.world_.store().show(group.id_, place_in_tree);
  };
  const auto go = [](void* gone, std::size_t) {
    auto& group = *static_cast<BehaviorGroup*>(gone);
    group.world_.store().drop_hidden(group.id_);
    group.world_.behaviors().take_out(group);
  };
  world_.undo().note(show, &group, place);
  world_.undo().at_end(go, &group);
}

void BehaviorList::keep_fault(Behavior& behavior) {
  if (!world_.undo().active()) return;
  faults_.emplace_back(&behavior, behavior.fault_);
  const auto take_back = [](void* list, std::size_t) {
    auto& self = *static_cast<BehaviorList*>(list);
    self.faults_.back().first->fault_ = std::move(self.faults_.back().second);
    self.faults_.pop_back();
  };
  const auto forget = [](void* list, std::size_t) { static_cast<BehaviorList*>(list)->faults_.clear(); };
  world_.undo().note(take_back, this);
  world_.undo().at_end(forget, this);
}

}  // namespace limber
