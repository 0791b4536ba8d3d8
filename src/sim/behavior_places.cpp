// BehaviorList: places in the order of acting, as rows tell and set them.
#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

std::string_view BehaviorList::name_of(const Entry& entry) {
  return entry.group != nullptr ? entry.group->name() : entry.single->name();
}

bool BehaviorList::acts_on(const Entry& entry, const Body& body) {
  return entry.group != nullptr ? entry.group->member_of(body) != nullptr : &entry.single->body() == &body;
}

// by the first of each; a group's is its own even where a body's behaviour is called alike
std::vector<std::string_view> BehaviorList::names() const {
  std::vector<std::string_view> names;
  std::unordered_set<std::string_view> known;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr || known.insert(name_of(entry)).second) names.push_back(name_of(entry));
  }
  return names;
}

// all at once: an image asks for each
void BehaviorList::count_places() const {
  if (std::exchange(places_of_, world_.store().structure_version()) == world_.store().structure_version()) return;
  std::unordered_map<const Body*, std::uint32_t> on_body;
  std::unordered_set<std::string_view> known;
  std::uint32_t count = 0;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) {
      entry.group->place_ = ++count;
      for (const auto& member : entry.group->members_) member->place_ = ++on_body[&member->body()];
      continue;
    }
    if (entry.single == nullptr) continue;
    if (known.insert(name_of(entry)).second) count++;
    entry.single->place_ = ++on_body[&entry.single->body()];
  }
}

std::size_t BehaviorList::place(const Behavior& behavior) const {
  count_places();
  return behavior.place_;
}

std::size_t BehaviorList::place(const BehaviorGroup& group) const {
  count_places();
  return group.place_;
}

Result<void> BehaviorList::may_move() const {
  if (!stepping_) return {};
  return Error{"behaviours can't be put elsewhere while they act; a scene's callbacks may do it"};
}

// before the order changes: a guarded call that fails has it back
void BehaviorList::note_order() {
  if (!world_.undo().active()) return;
  orders_before_.push_back(order());
  const auto take_back = [](void* list, std::size_t number) {
    auto& self = *static_cast<BehaviorList*>(list);
    self.bring_into(self.orders_before_[number]);
  };
  world_.undo().note(take_back, this, orders_before_.size() - 1);
}

void BehaviorList::put_at(Behavior& behavior, std::size_t place) {
  const Body& body = behavior.body();
  std::vector<std::size_t> others;  // that act on the body
  std::size_t own = entries_.size();
  for (std::size_t i = 0; i < entries_.size(); i++) {
    if (entries_[i].single.get() == &behavior) {
      own = i;
    } else if (acts_on(entries_[i], body)) {
      others.push_back(i);
    }
  }
  if (own == entries_.size() || others.empty()) return;
  const std::size_t at = std::min(std::max<std::size_t>(place, 1) - 1, others.size());
  // right before the one that stands there, or right behind the last
  std::size_t to = at < others.size() ? others[at] : others.back() + 1;
  if (this->place(behavior) == at + 1) return;
  note_order();
  Entry entry = std::move(entries_[own]);
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(own));
  if (to > own) to--;
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(to), std::move(entry));
  world_.store().note_structure();
}

void BehaviorList::put_at(BehaviorGroup& group, std::size_t place) {
  std::vector<std::string_view> order = names();
  const std::size_t before = this->place(group) - 1;
  const std::size_t at = std::min(std::max<std::size_t>(place, 1), order.size()) - 1;
  if (at == before) return;
  note_order();
  // numbers of names in the new order; a group's name may be a body's behaviour's as well
  std::vector<std::size_t> numbers(order.size());
  for (std::size_t i = 0; i < order.size(); i++) {
    numbers[i] = i == before ? at : i < before && i >= at ? i + 1 : i > before && i <= at ? i - 1 : i;
  }
  std::unordered_map<std::string_view, std::size_t> of_singles;
  std::unordered_map<const BehaviorGroup*, std::size_t> of_groups;
  std::size_t next = 0;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) {
      of_groups[entry.group.get()] = numbers[next++];
    } else if (of_singles.try_emplace(name_of(entry), next).second) {
      of_singles[name_of(entry)] = numbers[next++];
    }
  }
  const auto number = [&](const Entry& e) {
    return e.group != nullptr ? of_groups[e.group.get()] : of_singles[name_of(e)];
  };
  std::stable_sort(entries_.begin(), entries_.end(),
                   [&](const Entry& a, const Entry& b) { return number(a) < number(b); });
  world_.store().note_structure();
}

}  // namespace limber
