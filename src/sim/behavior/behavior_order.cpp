// BehaviorList: positions in the step order, as the properties `place` read and set them.
#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber {

std::string_view BehaviorList::name_of(const Entry& entry) {
  return entry.group != nullptr ? entry.group->name() : entry.single->name();
}

bool BehaviorList::acts_on(const Entry& entry, const Body& body) {
  return entry.group != nullptr ? entry.group->member_of(body) != nullptr : &entry.single->body() == &body;
}

// Names of behaviors and groups, in order of their first entry. A group's name is listed separately, even if a body's
// behavior has the same name.
std::vector<std::string_view> BehaviorList::names() const {
  std::vector<std::string_view> names;
  std::unordered_set<std::string_view> seen;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr || seen.insert(name_of(entry)).second) names.push_back(name_of(entry));
  }
  return names;
}

// Computes all places at once, since a snapshot reads each of them.
void BehaviorList::compute_places() const {
  if (std::exchange(places_structure_, world_.store().structure_version()) == world_.store().structure_version())
    return;
  std::unordered_map<const Body*, std::uint32_t> on_body;
  std::unordered_set<std::string_view> seen;
  std::uint32_t count = 0;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) {
      entry.group->set_place(++count);
      for (const auto& member : entry.group->members()) member->set_place(++on_body[&member->body()]);
      continue;
    }
    if (entry.single == nullptr) continue;
    if (seen.insert(name_of(entry)).second) count++;
    entry.single->set_place(++on_body[&entry.single->body()]);
  }
}

std::size_t BehaviorList::place(const Behavior& behavior) const {
  compute_places();
  return behavior.place();
}

std::size_t BehaviorList::place(const BehaviorGroup& group) const {
  compute_places();
  return group.place();
}

Result<void> BehaviorList::check_can_move() const {
  if (!stepping_) return {};
  return Error{"behaviors can't be moved while they are stepped; move them from a scene's callback"};
}

void BehaviorList::move_to(Behavior& behavior, std::size_t place) {
  const Body& body = behavior.body();
  std::vector<std::size_t> others;  // entries that act on the body
  std::size_t current = entries_.size();
  for (std::size_t i = 0; i < entries_.size(); i++) {
    if (entries_[i].single.get() == &behavior) {
      current = i;
    } else if (acts_on(entries_[i], body)) {
      others.push_back(i);
    }
  }
  if (current == entries_.size() || others.empty()) return;
  const std::size_t new_index = std::min(std::max<std::size_t>(place, 1) - 1, others.size());
  // insert before the entry at the requested position, or behind the last
  std::size_t insert_index = new_index < others.size() ? others[new_index] : others.back() + 1;
  if (this->place(behavior) == new_index + 1) return;
  transaction_.save_order();
  Entry entry = std::move(entries_[current]);
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(current));
  if (insert_index > current) insert_index--;
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(insert_index), std::move(entry));
  world_.store().bump_structure_version();
}

void BehaviorList::move_to(BehaviorGroup& group, std::size_t place) {
  std::vector<std::string_view> order = names();
  const std::size_t old_index = this->place(group) - 1;
  const std::size_t new_index = std::min(std::max<std::size_t>(place, 1), order.size()) - 1;
  if (new_index == old_index) return;
  transaction_.save_order();
  // index of each name in the new order; a group may have the same name as a body's behavior
  std::vector<std::size_t> new_ranks(order.size());
  for (std::size_t i = 0; i < order.size(); i++) {
    new_ranks[i] = i == old_index                    ? new_index
                   : i < old_index && i >= new_index ? i + 1
                   : i > old_index && i <= new_index ? i - 1
                                                     : i;
  }
  std::unordered_map<std::string_view, std::size_t> single_ranks;
  std::unordered_map<const BehaviorGroup*, std::size_t> group_ranks;
  std::size_t next = 0;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) {
      group_ranks[entry.group.get()] = new_ranks[next++];
    } else if (single_ranks.try_emplace(name_of(entry), next).second) {
      single_ranks[name_of(entry)] = new_ranks[next++];
    }
  }
  const auto rank = [&](const Entry& e) {
    return e.group != nullptr ? group_ranks[e.group.get()] : single_ranks[name_of(e)];
  };
  std::stable_sort(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) { return rank(a) < rank(b); });
  world_.store().bump_structure_version();
}

}  // namespace limber
