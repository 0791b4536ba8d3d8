// Copies the store's structure, and looks up paths and patterns in the copy.
#include "properties/tree_snapshot.h"

#include <algorithm>
#include <optional>

#include "base/text.h"
#include "properties/path_matcher.h"

namespace limber {

namespace {

struct SnapshotTree {
  using Ref = TreePropertyRef;
  struct Set {
    std::uint32_t node = 0;
    std::uint64_t properties = 0;
  };
  const TreeSnapshot& tree;

  std::uint32_t root() const { return 0; }
  std::string_view name(std::uint32_t node) const { return tree.name(node); }
  const PropertyTable& table(std::uint32_t node) const { return *tree.nodes()[node].table; }
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

TreeSnapshot::TreeSnapshot(const Store& store) { add(store, store.root(), 0); }

void TreeSnapshot::add(const Store& store, NodeId id, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  const std::string& name = store.name(id);
  const NodeSlot& slot = store.view()->slots[id.slot];
  Node& node = nodes_.emplace_back();
  node.id = id;
  node.table = &store.table(id);
  node.parent = parent;
  node.name_offset = static_cast<std::uint32_t>(names_.size());
  node.name_size = static_cast<std::uint32_t>(name.size());
  node.persistent = slot.persistent;
  node.transient = slot.transient;
  node.computed = computed_width_;
  node.texts = text_count_;
  names_ += name;
  for (const Property& property : node.table->properties()) {
    if (property.computed()) computed_width_ += property.width;
    if (property.type == PropertyType::text) text_count_++;
  }
  for (const NodeId child : store.children(id)) add(store, child, index);
  nodes_[index].subtree_end = static_cast<std::uint32_t>(nodes_.size());
}

std::string TreeSnapshot::path(std::uint32_t node) const {
  if (node == 0) return "/";
  std::vector<std::uint32_t> ancestors;
  for (std::uint32_t at = node; at != 0; at = nodes_[at].parent) ancestors.push_back(at);
  std::string path;
  std::for_each(ancestors.rbegin(), ancestors.rend(), [&](std::uint32_t at) { path += "/" + escape_name(name(at)); });
  return path;
}

std::string TreeSnapshot::path(const TreePropertyRef& place) const {
  std::string thing = path(place.node);
  if (place.property == nullptr) return thing;
  return place.node == 0 ? thing + place.property->name : thing + "/" + place.property->name;
}

ValueLocation TreeSnapshot::location(const TreePropertyRef& place) const {
  const Node& node = nodes_[place.node];
  const Property& property = *place.property;
  if (property.type == PropertyType::text) {
    std::uint32_t offset = node.texts;
    for (const Property& before : node.table->properties().first(property.index))
      offset += before.type == PropertyType::text ? 1 : 0;
    return {ValueLocation::Block::texts, offset};
  }
  if (property.stored()) {
    return property.transient ? ValueLocation{ValueLocation::Block::transient, node.transient + property.offset}
                              : ValueLocation{ValueLocation::Block::persistent, node.persistent + property.offset};
  }
  if (!property.computed()) return {};
  std::uint32_t offset = node.computed;
  for (const Property& before : node.table->properties().first(property.index)) {
    if (before.computed()) offset += before.width;
  }
  return {ValueLocation::Block::computed, offset};
}

Result<TreePropertyRef> TreeSnapshot::find(std::string_view path) const {
  if (path == "/") return TreePropertyRef{};
  return PathMatcher<SnapshotTree>::find({*this}, path);
}

Result<std::vector<TreePropertyRef>> TreeSnapshot::match(std::string_view pattern, PatternBudget& budget,
                                                         std::size_t limit) const {
  if (pattern == "/") return std::vector<TreePropertyRef>{{}};
  const SnapshotTree tree{*this};
  return PathMatcher(tree, budget).match(pattern, limit);
}

}  // namespace limber
