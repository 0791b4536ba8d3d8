// BehaviorOrder: computing places, moving behaviors and groups.
#include "sim/behavior/behavior_order.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

std::string StepEntry::key() const {
  return group != nullptr ? "/" + group->name() : single->body().name() + "/" + single->name();
}

bool StepEntry::acts_on(const Body& body) const {
  return group != nullptr ? group->member_of(body) != nullptr : &single->body() == &body;
}

// Names of behaviors and groups, in order of their first entry. A group's name is listed separately, even if a body's
// behavior has the same name.
std::vector<std::string_view> BehaviorOrder::names() const {
  std::vector<std::string_view> names;
  std::unordered_set<std::string_view> seen;
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr || seen.insert(entry.name()).second) names.push_back(entry.name());
  }
  return names;
}

// Computes all places at once if the structure has changed, since a snapshot reads each of them.
std::size_t BehaviorOrder::place_of(NodeId id) const {
  const Store& store = world_.store();
  if (std::exchange(places_structure_, store.structure_version()) == store.structure_version()) return places_[id.slot];
  places_.assign(store.view()->slot_count, 0);
  std::unordered_map<const Body*, std::uint32_t> on_body;
  std::unordered_set<std::string_view> seen;
  std::uint32_t count = 0;
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) {
      places_[entry.group->id().slot] = ++count;
      for (const auto& member : entry.group->members()) places_[member->id().slot] = ++on_body[&member->body()];
    } else if (entry.single != nullptr) {
      if (seen.insert(entry.name()).second) count++;
      places_[entry.single->id().slot] = ++on_body[&entry.single->body()];
    }
  }
  return places_[id.slot];
}

std::size_t BehaviorOrder::place(const Behavior& behavior) const { return place_of(behavior.id()); }

std::size_t BehaviorOrder::place(const BehaviorGroup& group) const { return place_of(group.id()); }

std::vector<std::string> BehaviorOrder::keys() const {
  std::vector<std::string> keys;
  keys.reserve(entries_.size());
  for (const StepEntry& entry : entries_) keys.push_back(entry.key());
  return keys;
}

void BehaviorOrder::sort(const std::vector<std::string>& keys) {
  std::unordered_map<std::string_view, std::size_t> ranks;
  for (std::size_t i = 0; i < keys.size(); i++) ranks[keys[i]] = i;
  std::vector<std::pair<std::size_t, StepEntry>> ranked;
  for (StepEntry& entry : entries_) {
    const auto found = ranks.find(entry.key());
    ranked.emplace_back(found == ranks.end() ? keys.size() : found->second, std::move(entry));
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  entries_.clear();
  for (auto& [rank, entry] : ranked) entries_.push_back(std::move(entry));
  world_.store().bump_structure_version();
}

void BehaviorOrder::move(Behavior& behavior, std::size_t place) {
  const Body& body = behavior.body();
  std::vector<std::size_t> others;  // entries that act on the body
  std::size_t current = entries_.size();
  for (std::size_t i = 0; i < entries_.size(); i++) {
    if (entries_[i].single.get() == &behavior) {
      current = i;
    } else if (entries_[i].acts_on(body)) {
      others.push_back(i);
    }
  }
  if (current == entries_.size() || others.empty()) return;
  const std::size_t new_index = std::min(std::max<std::size_t>(place, 1) - 1, others.size());
  // insert before the entry at the requested position, or behind the last
  std::size_t insert_index = new_index < others.size() ? others[new_index] : others.back() + 1;
  if (this->place(behavior) == new_index + 1) return;
  world_.behaviors().transaction().save_order();
  StepEntry entry = std::move(entries_[current]);
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(current));
  if (insert_index > current) insert_index--;
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(insert_index), std::move(entry));
  world_.store().bump_structure_version();
}

void BehaviorOrder::move(BehaviorGroup& group, std::size_t place) {
  std::vector<std::string_view> order = names();
  const std::size_t old_index = this->place(group) - 1;
  const std::size_t new_index = std::min(std::max<std::size_t>(place, 1), order.size()) - 1;
  if (new_index == old_index) return;
  world_.behaviors().transaction().save_order();
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
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) {
      group_ranks[entry.group.get()] = new_ranks[next++];
    } else if (single_ranks.try_emplace(entry.name(), next).second) {
      single_ranks[entry.name()] = new_ranks[next++];
    }
  }
  const auto rank = [&](const StepEntry& e) {
    return e.group != nullptr ? group_ranks[e.group.get()] : single_ranks[e.name()];
  };
  std::stable_sort(entries_.begin(), entries_.end(),
                   [&](const StepEntry& a, const StepEntry& b) { return rank(a) < rank(b); });
  world_.store().bump_structure_version();
}

}  // namespace limber::sim
