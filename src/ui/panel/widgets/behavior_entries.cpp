// Collects the behaviors of /physics/group and /physics/body/*/behavior.
#include "ui/panel/widgets/behavior_entries.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::panel {

namespace {

std::uint32_t find_child(const TreeSnapshot& tree, std::uint32_t node, std::string_view name) {
  std::uint32_t found = 0;
  tree.each_child(node, [&](std::uint32_t child) {
    if (tree.name(child) == name) found = child;
    return found == 0;
  });
  return found;
}

const double* numbers_of(const engine::ValueSnapshot& snapshot, std::uint32_t node, std::string_view property_name) {
  const Property* const property = snapshot.tree->nodes()[node].table->find(property_name);
  return property == nullptr ? nullptr : snapshot.value(snapshot.tree->location({node, property})).numbers;
}

}  // namespace

std::vector<BehaviorEntry> behavior_entries(const TreeSnapshot& tree, std::uint32_t body) {
  std::vector<BehaviorEntry> entries;
  std::unordered_map<std::string_view, std::size_t> known;
  const std::uint32_t physics = find_child(tree, 0, "physics");
  const auto type_of = [&](std::uint32_t node) { return tree.nodes()[node].table->name(); };
  const std::uint32_t groups = find_child(tree, physics, "group");
  if (groups != 0) {
    tree.each_child(groups, [&](std::uint32_t node) {
      known[tree.name(node)] = entries.size();
      if (body == 0)
        entries.push_back({std::string(tree.name(node)), tree.path(node), type_of(node), true, {node}, 0, 0, 0, {}});
      return true;
    });
  }
  const std::size_t group_count = known.size();
  const auto collect = [&](std::uint32_t of) {
    const std::uint32_t list = find_child(tree, of, "behavior");
    if (list == 0) return true;
    tree.each_child(list, [&](std::uint32_t node) {
      const auto [at, fresh] = known.try_emplace(tree.name(node), entries.size());
      const bool of_group = !fresh && at->second < group_count && body == 0;
      if (of_group) return true;
      if (fresh || body != 0) {
        std::string pattern =
            body != 0 ? tree.path(node) : fmt::format("/physics/body/*/behavior/{}", escape_name(tree.name(node)));
        entries.push_back({std::string(tree.name(node)), std::move(pattern), type_of(node), false, {}, 0, 0, 0, {}});
        at->second = entries.size() - 1;
      }
      entries[at->second].nodes.push_back(node);
      return true;
    });
    return true;
  };
  if (body != 0) {
    collect(body);
  } else if (const std::uint32_t bodies = find_child(tree, physics, "body"); bodies != 0) {
    tree.each_child(bodies, collect);
  }
  return entries;
}

namespace {

int position_of(const engine::ValueSnapshot& snapshot, std::uint32_t node) {
  const double* const position = numbers_of(snapshot, node, "place");
  return position == nullptr ? 0 : static_cast<int>(position[0]);
}

}  // namespace

void sort_entries(std::vector<BehaviorEntry>& entries) {
  std::ranges::stable_sort(entries, {}, &BehaviorEntry::position);
}

std::vector<Message> move_past(const engine::ValueSnapshot& snapshot, const BehaviorEntry& entry,
                               const BehaviorEntry& neighbor) {
  const auto message = [](const std::string& path, int position) {
    return Message{path + "/place", {Arg::of(static_cast<double>(position))}};
  };
  if (entry.group) return {message(entry.pattern, neighbor.position)};
  const TreeSnapshot& tree = *snapshot.tree;
  std::vector<Message> messages;
  bool same_position = true;
  for (const std::uint32_t node : entry.nodes) {
    // a group's instance on a body has the name of the group
    const std::uint32_t other = find_child(tree, tree.nodes()[node].parent, neighbor.name);
    const int position = other == 0 ? 0 : position_of(snapshot, other);
    same_position =
        same_position && position != 0 &&
        position == position_of(snapshot, entry.nodes.front()) + (neighbor.position < entry.position ? -1 : 1);
    if (position != 0) messages.push_back(message(tree.path(node), position));
  }
  if (same_position && messages.size() > 1)
    return {message(entry.pattern,
                    position_of(snapshot, entry.nodes.front()) + (neighbor.position < entry.position ? -1 : 1))};
  return messages;
}

void update_entry(const engine::ValueSnapshot& snapshot, BehaviorEntry& entry) {
  entry.active = 0;
  entry.position = entry.nodes.empty() ? 0 : position_of(snapshot, entry.nodes.front());
  entry.time = 0;
  entry.error.clear();
  for (const std::uint32_t node : entry.nodes) {
    if (const double* const active = numbers_of(snapshot, node, "active")) entry.active += active[0] != 0 ? 1 : 0;
    if (const double* const time = numbers_of(snapshot, node, "time")) entry.time += time[0];
    const Property* const error = snapshot.tree->nodes()[node].table->find("error");
    if (error == nullptr || error->type != PropertyType::text || !entry.error.empty()) continue;
    entry.error = snapshot.value(snapshot.tree->location({node, error})).text;
  }
}

}  // namespace limber::panel
