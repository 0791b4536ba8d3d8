// Walks over the image's tree.
#include "gui/tree_list.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace limber {

namespace {

constexpr std::size_t kMostFound = 20000;

struct Title {
  std::string_view name, title;
};
// the top of the tree, in the order in which it is shown; what is not named here comes behind
constexpr std::array kTitles = {
    Title{"scene", "scene"},         Title{"sim", "world"},      Title{"body", "bodies"},
    Title{"gear", "gears"},          Title{"group", "groups"},   Title{"visuals", "picture"},
    Title{"transport", "transport"}, Title{"preset", "presets"}, Title{"osc", "OSC counters"}};

std::size_t rank(std::string_view name) {
  const auto* found = std::find_if(kTitles.begin(), kTitles.end(), [&](const Title& t) { return t.name == name; });
  return static_cast<std::size_t>(found - kTitles.begin());
}

bool has_words(std::string_view name, std::string_view words) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(name.begin(), name.end(), words.begin(), words.end(), same) != name.end();
}

}  // namespace

std::uint64_t TreeList::key(const Tree& tree, std::uint32_t node) {
  const NodeId id = tree.nodes()[node].id;
  return static_cast<std::uint64_t>(id.generation) << 32 | id.slot;
}

std::string_view TreeList::title(const Tree& tree, std::uint32_t node) {
  const std::string_view name = tree.name(node);
  const std::uint32_t parent = tree.nodes()[node].parent;
  const bool top = parent == 0 || (tree.nodes()[parent].parent == 0 && tree.name(parent) == "physics");
  const std::size_t at = rank(name);
  return top && at < kTitles.size() ? kTitles[at].title : name;
}

// the root's children, with those of /physics in its place
std::vector<std::uint32_t> TreeList::top() const {
  std::vector<std::uint32_t> nodes;
  const auto take = [&](std::uint32_t node) {
    const Tree::Node& n = tree_->nodes()[node];
    if (!n.table->rows().empty() || n.end > node + 1) nodes.push_back(node);
    return true;
  };
  tree_->each_child(0, [&](std::uint32_t child) {
    if (tree_->name(child) == "physics") {
      tree_->each_child(child, take);
      return true;
    }
    return take(child);
  });
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rank(tree_->name(a)) < rank(tree_->name(b)); });
  return nodes;
}

void TreeList::add(std::uint32_t node, std::uint16_t depth) {
  const Tree::Node& n = tree_->nodes()[node];
  // a group of one thing's (part, joint, motor, behavior) without members is nothing to see
  if (n.table->rows().empty() && n.end == node + 1) return;
  const bool opens = n.end > node + 1;
  const bool open = opens && open_.contains(key(*tree_, node));
  lines_.push_back({node, depth, opens, open});
  if (!open) return;
  tree_->each_child(node, [&](std::uint32_t child) {
    add(child, static_cast<std::uint16_t>(depth + 1));
    return true;
  });
}

// what fits, below the things that it lies in
void TreeList::add_found(std::string_view words) {
  std::vector<std::uint32_t> above;
  std::vector<std::uint32_t> shown;  // of `above`, those that are lines already
  for (const std::uint32_t begin : top()) {
    shown.clear();
    for (std::uint32_t node = begin; node < tree_->nodes()[begin].end && lines_.size() < kMostFound; node++) {
      const Tree::Node& n = tree_->nodes()[node];
      const bool group = n.table->rows().empty();
      if (group || !has_words(title(*tree_, node), words)) continue;
      above.clear();
      for (std::uint32_t at = node; at != begin; at = tree_->nodes()[at].parent) above.push_back(at);
      above.push_back(begin);
      std::reverse(above.begin(), above.end());
      std::size_t same = 0;
      while (same < shown.size() && same < above.size() && shown[same] == above[same]) same++;
      for (std::size_t i = same; i < above.size(); i++) {
        const bool below = i + 1 < above.size();
        lines_.push_back({above[i], static_cast<std::uint16_t>(i), below, below});
      }
      shown = above;
    }
  }
}

const std::vector<TreeList::Line>& TreeList::lines(const std::shared_ptr<const Tree>& tree, std::string_view words) {
  if (tree == tree_ && words == words_ && !stale_) return lines_;
  tree_ = tree;
  words_ = words;
  stale_ = false;
  lines_.clear();
  if (!words.empty()) {
    add_found(words);
    return lines_;
  }
  for (const std::uint32_t node : top()) {
    if (!begun_ && tree_->name(node) == "body") open_.insert(key(*tree_, node));
  }
  begun_ = true;
  for (const std::uint32_t node : top()) add(node, 0);
  return lines_;
}

void TreeList::toggle(std::uint32_t node) {
  const std::uint64_t k = key(*tree_, node);
  if (open_.erase(k) == 0) open_.insert(k);
  stale_ = true;
}

void TreeList::reveal(std::uint32_t node) {
  for (std::uint32_t at = tree_->nodes()[node].parent; at != 0; at = tree_->nodes()[at].parent)
    open_.insert(key(*tree_, at));
  stale_ = true;
}

}  // namespace limber
