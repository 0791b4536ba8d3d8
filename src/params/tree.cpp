// The copy of the structure, and the same walks as over the store.
#include "params/tree.h"

#include <algorithm>
#include <optional>

#include "base/text.h"
#include "params/path_walk.h"

namespace limber {

namespace {

struct TreeShape {
  using Place = TreePlace;
  struct PlaceRows {
    std::uint32_t node = 0;
    std::uint64_t rows = 0;
  };
  const Tree& tree;

  std::uint32_t root() const { return 0; }
  std::string_view name(std::uint32_t node) const { return tree.name(node); }
  const Table& table(std::uint32_t node) const { return *tree.nodes()[node].table; }
  std::string path(std::uint32_t node) const { return tree.path(node); }
  std::uint32_t key(std::uint32_t node) const { return node; }
  std::size_t keys() const { return tree.nodes().size(); }
  std::optional<std::uint32_t> exact_child(std::uint32_t parent, std::string_view name) const {
    std::optional<std::uint32_t> found;
    tree.each_child(parent, [&](std::uint32_t child) {
      if (tree.name(child) == name) found = child;
      return !found;
    });
    return found;
  }
  template <class F>
  void each_child(std::uint32_t parent, F&& f) const {
    tree.each_child(parent, f);
  }
};

}  // namespace

Tree::Tree(const Store& store) { add(store, store.root(), 0); }

void Tree::add(const Store& store, NodeId id, std::uint32_t parent) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  const std::string& name = store.name(id);
  const NodeSlot& slot = store.view()->slots[id.slot];
  Node& node = nodes_.emplace_back();
  node.id = id;
  node.table = &store.table(id);
  node.parent = parent;
  node.name_at = static_cast<std::uint32_t>(names_.size());
  node.name_size = static_cast<std::uint32_t>(name.size());
  node.kept = slot.kept;
  node.live = slot.live;
  node.views = views_width_;
  node.texts = text_count_;
  names_ += name;
  for (const Row& row : node.table->rows()) {
    if (row.view()) views_width_ += row.width;
    if (row.type == RowType::text) text_count_++;
  }
  for (const NodeId child : store.children(id)) add(store, child, at);
  nodes_[at].end = static_cast<std::uint32_t>(nodes_.size());
}

std::string Tree::path(std::uint32_t node) const {
  if (node == 0) return "/";
  std::vector<std::uint32_t> line;
  for (std::uint32_t at = node; at != 0; at = nodes_[at].parent) line.push_back(at);
  std::string path;
  std::for_each(line.rbegin(), line.rend(), [&](std::uint32_t at) { path += "/" + escape_name(name(at)); });
  return path;
}

std::string Tree::path(const TreePlace& place) const {
  std::string thing = path(place.node);
  if (place.row == nullptr) return thing;
  return place.node == 0 ? thing + place.row->name : thing + "/" + place.row->name;
}

TreeNumbers Tree::numbers(const TreePlace& place) const {
  const Node& node = nodes_[place.node];
  const Row& row = *place.row;
  if (row.type == RowType::text) {
    std::uint32_t at = node.texts;
    for (const Row& before : node.table->rows().first(row.index)) at += before.type == RowType::text ? 1 : 0;
    return {TreeNumbers::Block::texts, at};
  }
  if (row.stored()) {
    return row.live ? TreeNumbers{TreeNumbers::Block::live, node.live + row.offset}
                    : TreeNumbers{TreeNumbers::Block::kept, node.kept + row.offset};
  }
  if (!row.view()) return {};
  std::uint32_t at = node.views;
  for (const Row& before : node.table->rows().first(row.index)) {
    if (before.view()) at += before.width;
  }
  return {TreeNumbers::Block::views, at};
}

Result<TreePlace> Tree::find(std::string_view path) const {
  if (path == "/") return TreePlace{};
  return PathWalk<TreeShape>::find({*this}, path);
}

Result<std::vector<TreePlace>> Tree::match(std::string_view pattern, PatternBudget& budget, std::size_t limit) const {
  if (pattern == "/") return std::vector<TreePlace>{{}};
  const TreeShape shape{*this};
  return PathWalk(shape, budget).match(pattern, limit);
}

}  // namespace limber
