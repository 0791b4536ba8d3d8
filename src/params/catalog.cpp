// Addresses to places of the store.
#include "params/catalog.h"

#include <algorithm>
#include <optional>

#include "params/path_walk.h"

namespace limber {

namespace {

struct StoreShape {
  using Place = limber::Place;
  using PlaceRows = limber::PlaceRows;
  const Store& store;

  NodeId root() const { return store.root(); }
  std::string_view name(NodeId id) const { return store.name(id); }
  const Table& table(NodeId id) const { return store.table(id); }
  std::string path(NodeId id) const { return store.path(id); }
  std::uint32_t key(NodeId id) const { return id.slot; }
  std::size_t keys() const { return store.view()->slot_count; }
  std::optional<NodeId> exact_child(NodeId parent, std::string_view name) const {
    const NodeId child = store.child(parent, name);
    return child.null() ? std::nullopt : std::optional(child);
  }
  template <class F>
  void each_child(NodeId parent, F&& f) const {
    constexpr std::size_t kAhead = 4;  // their names may lie far off
    const std::span<const NodeId> children = store.children(parent);
    for (const NodeId child : children.first(std::min(kAhead, children.size()))) store.fetch_node(child);
    for (std::size_t i = 0; i < children.size(); i++) {
      if (i + kAhead < children.size()) store.fetch_node(children[i + kAhead]);
      if (!f(children[i])) return;
    }
  }
};

}  // namespace

Result<Place> find_place(const Store& store, std::string_view path, bool hint) {
  return PathWalk<StoreShape>::find({store}, path, hint);
}

Result<std::vector<Place>> match_places(const Store& store, std::string_view pattern, PatternBudget& budget,
                                        std::size_t limit) {
  const StoreShape shape{store};
  return PathWalk(shape, budget).match(pattern, limit);
}

Result<std::vector<PlaceRows>> match_things(const Store& store, std::string_view pattern, PatternBudget& budget) {
  const StoreShape shape{store};
  return PathWalk(shape, budget).match_things(pattern, SIZE_MAX);
}

}  // namespace limber
