// Gathered from /physics/group and /physics/body/*/behavior.
#include "gui/behavior_entries.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

std::uint32_t child_called(const Tree& tree, std::uint32_t node, std::string_view name) {
  std::uint32_t found = 0;
  tree.each_child(node, [&](std::uint32_t child) {
    if (tree.name(child) == name) found = child;
    return found == 0;
  });
  return found;
}

const double* numbers_of(const Image& image, std::uint32_t node, std::string_view row_name) {
  const Row* const row = image.tree->nodes()[node].table->find(row_name);
  return row == nullptr ? nullptr : image.value(image.tree->numbers({node, row})).numbers;
}

}  // namespace

std::vector<BehaviorEntry> behavior_entries(const Tree& tree, std::uint32_t body) {
  std::vector<BehaviorEntry> entries;
  std::unordered_map<std::string_view, std::size_t> known;
  const std::uint32_t physics = child_called(tree, 0, "physics");
  const auto type_of = [&](std::uint32_t node) { return tree.nodes()[node].table->name(); };
  const std::uint32_t groups = child_called(tree, physics, "group");
  if (groups != 0) {
    tree.each_child(groups, [&](std::uint32_t node) {
      known[tree.name(node)] = entries.size();
      if (body == 0)
        entries.push_back({std::string(tree.name(node)), tree.path(node), type_of(node), true, {node}, 0, 0, 0, {}});
      return true;
    });
  }
  const std::size_t group_count = known.size();
  const auto gather = [&](std::uint32_t of) {
    const std::uint32_t list = child_called(tree, of, "behavior");
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
    gather(body);
  } else if (const std::uint32_t bodies = child_called(tree, physics, "body"); bodies != 0) {
    tree.each_child(bodies, gather);
  }
  return entries;
}

namespace {

int place_of(const Image& image, std::uint32_t node) {
  const double* const place = numbers_of(image, node, "place");
  return place == nullptr ? 0 : static_cast<int>(place[0]);
}

}  // namespace

void order_entries(std::vector<BehaviorEntry>& entries) {
  std::ranges::stable_sort(entries, {}, &BehaviorEntry::place);
}

std::vector<Message> put_past(const Image& image, const BehaviorEntry& entry, const BehaviorEntry& neighbor) {
  const auto message = [](const std::string& path, int place) {
    return Message{path + "/place", {Arg::of(static_cast<double>(place))}};
  };
  if (entry.group) return {message(entry.pattern, neighbor.place)};
  const Tree& tree = *image.tree;
  std::vector<Message> messages;
  bool alike = true;
  for (const std::uint32_t node : entry.nodes) {
    // a group's instance on that body is called as the group is
    const std::uint32_t other = child_called(tree, tree.nodes()[node].parent, neighbor.name);
    const int place = other == 0 ? 0 : place_of(image, other);
    alike =
        alike && place != 0 && place == place_of(image, entry.nodes.front()) + (neighbor.place < entry.place ? -1 : 1);
    if (place != 0) messages.push_back(message(tree.path(node), place));
  }
  if (alike && messages.size() > 1)
    return {message(entry.pattern, place_of(image, entry.nodes.front()) + (neighbor.place < entry.place ? -1 : 1))};
  return messages;
}

void renew_entry(const Image& image, BehaviorEntry& entry) {
  entry.active = 0;
  entry.place = entry.nodes.empty() ? 0 : place_of(image, entry.nodes.front());
  entry.time = 0;
  entry.error.clear();
  for (const std::uint32_t node : entry.nodes) {
    if (const double* const active = numbers_of(image, node, "active")) entry.active += active[0] != 0 ? 1 : 0;
    if (const double* const time = numbers_of(image, node, "time")) entry.time += time[0];
    const Row* const error = image.tree->nodes()[node].table->find("error");
    if (error == nullptr || error->type != RowType::text || !entry.error.empty()) continue;
    entry.error = image.value(image.tree->numbers({node, error})).text;
  }
}

}  // namespace limber
