// Path and pattern lookup over the store.
#include "properties/catalog.h"

#include <algorithm>
#include <optional>

#include "properties/path_matcher.h"

namespace limber {

namespace {

struct StoreTree {
  using Ref = limber::PropertyRef;
  using Set = limber::PropertySet;
  const Store& store;

  NodeId root() const { return store.root(); }
  std::string_view name(NodeId id) const { return store.name(id); }
  const PropertyTable& table(NodeId id) const { return store.table(id); }
  std::string path(NodeId id) const { return store.path(id); }
  std::uint32_t key(NodeId id) const { return id.slot; }
  std::size_t keys() const { return store.view()->slot_count; }
  std::optional<NodeId> exact_child(NodeId parent, std::string_view name) const {
    const NodeId child = store.child(parent, name);
    return child.null() ? std::nullopt : std::optional(child);
  }
  template <class F>
  void each_child(NodeId parent, F&& f) const {
    constexpr std::size_t kAhead = 4;  // prefetch distance: the names are scattered in memory
    const std::span<const NodeId> children = store.children(parent);
    for (const NodeId child : children.first(std::min(kAhead, children.size()))) store.prefetch_node(child);
    for (std::size_t i = 0; i < children.size(); i++) {
      if (i + kAhead < children.size()) store.prefetch_node(children[i + kAhead]);
      if (!f(children[i])) return;
    }
  }
};

}  // namespace

Result<PropertyRef> find_property(const Store& store, std::string_view path, bool hint) {
  return PathMatcher<StoreTree>::find({store}, path, hint);
}

Result<std::vector<PropertyRef>> match_properties(const Store& store, std::string_view pattern, PatternBudget& budget,
                                                  std::size_t limit) {
  const StoreTree tree{store};
  return PathMatcher(tree, budget).match(pattern, limit);
}

Result<std::vector<PropertySet>> match_nodes(const Store& store, std::string_view pattern, PatternBudget& budget) {
  const StoreTree tree{store};
  return PathMatcher(tree, budget).match_nodes(pattern, SIZE_MAX);
}

}  // namespace limber
