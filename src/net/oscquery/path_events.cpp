// Walks both trees in parallel and compares nodes by name, because a reset creates the same objects again, which is not
// a change.
#include "net/oscquery/path_events.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "net/oscquery/attributes.h"

namespace limber::oscquery {

namespace {

struct PathEvent {
  std::string_view command;
  std::string path;
};

class Comparison {
 public:
  Comparison(const TreeSnapshot& before, const TreeSnapshot& after) : before_(before), after_(after) {}

  void compare_nodes(std::uint32_t a, std::uint32_t b) {
    const PropertyTable& old_table = *before_.nodes()[a].table;
    const PropertyTable& new_table = *after_.nodes()[b].table;
    if (&old_table != &new_table) compare_properties(a, old_table, b, new_table);
    if (same_names(a, b)) return compare_in_order(a, b);
    std::unordered_map<std::string_view, std::uint32_t> old_children;
    before_.each_child(a, [&](std::uint32_t child) { return old_children.emplace(before_.name(child), child).second; });
    after_.each_child(b, [&](std::uint32_t child) {
      const auto known = old_children.find(after_.name(child));
      if (known == old_children.end()) {
        add("PATH_ADDED", after_.path(child));
      } else {
        compare_nodes(known->second, child);
        old_children.erase(known);
      }
      return true;
    });
    before_.each_child(a, [&](std::uint32_t child) {
      if (old_children.contains(before_.name(child))) add("PATH_REMOVED", before_.path(child));
      return true;
    });
  }

  const std::vector<PathEvent>& events() const { return events_; }

 private:
  void add(std::string_view command, std::string path) { events_.push_back({command, std::move(path)}); }

  void compare_properties(std::uint32_t a, const PropertyTable& old_table, std::uint32_t b,
                          const PropertyTable& new_table) {
    const auto find_property = [](const PropertyTable& table, const std::string& name) {
      const auto properties = table.properties();
      const auto found =
          std::ranges::find_if(properties, [&](const Property& property) { return property.name == name; });
      return found == properties.end() ? nullptr : &*found;
    };
    for (const Property& property : old_table.properties()) {
      if (find_property(new_table, property.name) == nullptr) add("PATH_REMOVED", before_.path({a, &property}));
    }
    for (const Property& property : new_table.properties()) {
      const Property* const old = find_property(old_table, property.name);
      if (old == nullptr) {
        add("PATH_ADDED", after_.path({b, &property}));
      } else if (attributes_text(*old) != attributes_text(property)) {
        add("PATH_CHANGED", after_.path({b, &property}));
      }
    }
  }

  bool same_names(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t x = a + 1;
    std::uint32_t y = b + 1;
    while (x < before_.nodes()[a].subtree_end && y < after_.nodes()[b].subtree_end) {
      if (before_.name(x) != after_.name(y)) return false;
      x = before_.nodes()[x].subtree_end;
      y = after_.nodes()[y].subtree_end;
    }
    return x == before_.nodes()[a].subtree_end && y == after_.nodes()[b].subtree_end;
  }

  void compare_in_order(std::uint32_t a, std::uint32_t b) {
    std::uint32_t y = b + 1;
    before_.each_child(a, [&](std::uint32_t x) {
      compare_nodes(x, y);
      y = after_.nodes()[y].subtree_end;
      return true;
    });
  }

  const TreeSnapshot& before_;
  const TreeSnapshot& after_;
  std::vector<PathEvent> events_;
};

// Returns the deepest path that contains all of them.
std::string common_parent(const std::vector<PathEvent>& events) {
  std::string_view common = events.front().path;
  common = common.substr(0, common.rfind('/'));
  for (const PathEvent& n : events) {
    while (!common.empty() && !(n.path.starts_with(common) && n.path[common.size()] == '/'))
      common = common.substr(0, common.rfind('/'));
  }
  return common.empty() ? "/" : std::string(common);
}

std::string frame(std::string_view command, std::string_view path) {
  return fmt::format(R"({{"COMMAND":"{}","DATA":{}}})", command, json_text(path));
}

}  // namespace

std::vector<std::string> path_events_between(const TreeSnapshot& before, const TreeSnapshot& after) {
  Comparison comparison(before, after);
  comparison.compare_nodes(0, 0);
  const std::vector<PathEvent>& events = comparison.events();
  if (events.size() > kMaxPathEvents) return {frame("PATH_CHANGED", common_parent(events))};
  std::vector<std::string> frames;
  frames.reserve(events.size());
  for (const PathEvent& n : events) frames.push_back(frame(n.command, n.path));
  return frames;
}

}  // namespace limber::oscquery
