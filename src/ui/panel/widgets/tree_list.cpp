// Collects the visible nodes of the snapshot's tree.
#include "ui/panel/widgets/tree_list.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace limber::panel {

namespace {

constexpr std::size_t kMaxMatches = 20000;

struct Title {
  std::string_view name, title;
};
// Titles of the top-level nodes in display order; other nodes follow.
constexpr std::array kTitles = {Title{"scene", "Scene"},
                                Title{"sim", "World"},
                                Title{"body", "Bodies"},
                                Title{"gear", "Gears"},
                                Title{"mocap", "Motion capture"},
                                Title{"route", "Routes"},
                                Title{"group", "Groups"},
                                Title{"visuals", "View"},
                                Title{"lighting", "Lighting"},
                                Title{"clock", "Musical time"},
                                Title{"cue", "Cues"},
                                Title{"midi", "MIDI"},
                                Title{"transport", "Transport"},
                                Title{"preset", "Presets"},
                                Title{"take", "Takes"},
                                Title{"edit", "Undo"},
                                Title{"osc", "OSC counters"}};
// Titles of the groups of a body's members.
constexpr std::array kMembers = {Title{"part", "Parts"},     Title{"joint", "Joints"},
                                 Title{"motor", "Motors"},   Title{"sensor", "Sensors"},
                                 Title{"tendon", "Tendons"}, Title{"behavior", "Behaviors"}};

std::size_t rank(std::string_view name) {
  const auto* found = std::find_if(kTitles.begin(), kTitles.end(), [&](const Title& t) { return t.name == name; });
  return static_cast<std::size_t>(found - kTitles.begin());
}

bool contains_ignoring_case(std::string_view name, std::string_view query) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(name.begin(), name.end(), query.begin(), query.end(), same) != name.end();
}

}  // namespace

std::uint64_t TreeList::key(const TreeSnapshot& tree, std::uint32_t node) {
  const NodeId id = tree.nodes()[node].id;
  return static_cast<std::uint64_t>(id.generation) << 32 | id.slot;
}

std::string_view TreeList::title(const TreeSnapshot& tree, std::uint32_t node) {
  const std::string_view name = tree.name(node);
  const std::uint32_t parent = tree.nodes()[node].parent;
  const bool top = parent == 0 || (tree.nodes()[parent].parent == 0 && tree.name(parent) == "physics");
  const std::size_t at = rank(name);
  if (top && at < kTitles.size()) return kTitles[at].title;
  if (!tree.nodes()[node].table->properties().empty()) return name;
  const auto* members = std::find_if(kMembers.begin(), kMembers.end(), [&](const Title& t) { return t.name == name; });
  return members == kMembers.end() ? name : members->title;
}

// Returns the root's children, with /physics replaced by its children.
std::vector<std::uint32_t> TreeList::top() const {
  std::vector<std::uint32_t> nodes;
  const auto add_node = [&](std::uint32_t node) {
    const TreeSnapshot::Node& n = tree_->nodes()[node];
    if (!n.table->properties().empty() || n.subtree_end > node + 1) nodes.push_back(node);
    return true;
  };
  tree_->each_child(0, [&](std::uint32_t child) {
    if (tree_->name(child) == "physics") {
      tree_->each_child(child, add_node);
      return true;
    }
    return add_node(child);
  });
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rank(tree_->name(a)) < rank(tree_->name(b)); });
  return nodes;
}

void TreeList::add(std::uint32_t node, std::uint16_t depth) {
  const TreeSnapshot::Node& n = tree_->nodes()[node];
  // skip empty groups of an object (part, joint, motor, behavior)
  if (n.table->properties().empty() && n.subtree_end == node + 1) return;
  const bool opens = n.subtree_end > node + 1;
  const bool open = opens && expanded_.contains(key(*tree_, node));
  lines_.push_back({node, depth, opens, open});
  if (!open) return;
  tree_->each_child(node, [&](std::uint32_t child) {
    add(child, static_cast<std::uint16_t>(depth + 1));
    return true;
  });
}

// Adds the nodes that match and their ancestors.
void TreeList::add_matches(std::string_view query) {
  std::vector<std::uint32_t> ancestors;
  std::vector<std::uint32_t> listed;  // the ancestors that are already in the list
  for (const std::uint32_t begin : top()) {
    listed.clear();
    for (std::uint32_t node = begin; node < tree_->nodes()[begin].subtree_end && lines_.size() < kMaxMatches; node++) {
      const TreeSnapshot::Node& n = tree_->nodes()[node];
      const bool group = n.table->properties().empty();
      if (group || !contains_ignoring_case(title(*tree_, node), query)) continue;
      ancestors.clear();
      for (std::uint32_t at = node; at != begin; at = tree_->nodes()[at].parent) ancestors.push_back(at);
      ancestors.push_back(begin);
      std::reverse(ancestors.begin(), ancestors.end());
      std::size_t same = 0;
      while (same < listed.size() && same < ancestors.size() && listed[same] == ancestors[same]) same++;
      for (std::size_t i = same; i < ancestors.size(); i++) {
        const bool below = i + 1 < ancestors.size();
        lines_.push_back({ancestors[i], static_cast<std::uint16_t>(i), below, below});
      }
      listed = ancestors;
    }
  }
}

const std::vector<TreeList::Line>& TreeList::lines(const std::shared_ptr<const TreeSnapshot>& tree,
                                                   std::string_view query) {
  if (tree == tree_ && query == query_ && !dirty_) return lines_;
  tree_ = tree;
  query_ = query;
  dirty_ = false;
  lines_.clear();
  if (!query.empty()) {
    add_matches(query);
    return lines_;
  }
  for (const std::uint32_t node : top()) {
    if (!initialized_ && tree_->name(node) == "body") expanded_.insert(key(*tree_, node));
  }
  initialized_ = true;
  for (const std::uint32_t node : top()) add(node, 0);
  return lines_;
}

void TreeList::toggle(std::uint32_t node) {
  const std::uint64_t k = key(*tree_, node);
  if (expanded_.erase(k) == 0) expanded_.insert(k);
  dirty_ = true;
}

void TreeList::reveal(std::uint32_t node) {
  for (std::uint32_t at = tree_->nodes()[node].parent; at != 0; at = tree_->nodes()[at].parent)
    expanded_.insert(key(*tree_, at));
  dirty_ = true;
}

}  // namespace limber::panel
