// TreeSnapshot: an immutable copy of the store's structure: its nodes, their classes, and the location of each node's
// numbers in a snapshot of the values. The simulation creates it on request; all threads may read it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "properties/pattern_budget.h"
#include "properties/store.h"

namespace limber {

/// Refers to a property of a node, or to the node itself if `property` is null.
struct TreePropertyRef {
  std::uint32_t node = 0;
  const Property* property = nullptr;
};

/// The location of a property's numbers in a snapshot of the store's values.
struct ValueLocation {
  enum class Block : std::uint8_t { none, persistent, transient, computed, texts };
  Block block = Block::none;  ///< `none` for an action.
  std::uint32_t offset = 0;   ///< First number of the block; the index of a text.
};

/// A copy of the tree that does not change with the store. It refers to tables and properties by pointer; tables live
/// until the program exits.
class TreeSnapshot {
 public:
  struct Node {
    NodeId id;
    const PropertyTable* table = nullptr;
    std::uint32_t parent = 0;
    std::uint32_t subtree_end = 0;  ///< One past its last descendant.
    std::uint32_t name_offset = 0;
    std::uint32_t name_size = 0;
    std::uint32_t persistent = 0;  ///< First number of the node in each block.
    std::uint32_t transient = 0;
    std::uint32_t computed = 0;
    std::uint32_t texts = 0;
  };

  /// [sim]
  explicit TreeSnapshot(const Store& store);

  /// All nodes in depth-first order, parents before children; the first is the root. [any]
  const std::vector<Node>& nodes() const { return nodes_; }
  std::string_view name(std::uint32_t node) const {
    return std::string_view(names_).substr(nodes_[node].name_offset, nodes_[node].name_size);
  }
  /// Returns the path: "/physics/body/my%20arm", "/" for the root.
  std::string path(std::uint32_t node) const;
  std::string path(const TreePropertyRef& place) const;
  /// Returns the location of a property's numbers; `place.property` is not null.
  ValueLocation location(const TreePropertyRef& place) const;
  /// Number of numbers in the block of computed properties.
  std::uint32_t computed_width() const { return computed_width_; }
  std::uint32_t text_count() const { return text_count_; }

  /// Calls f(child) for each child in order until it returns false.
  template <class F>
  void each_child(std::uint32_t node, F&& f) const {
    for (std::uint32_t child = node + 1; child < nodes_[node].subtree_end; child = nodes_[child].subtree_end) {
      if (!f(child)) return;
    }
  }

  /// Like find_property() and match_properties() of catalog.h; "/" is the root.
  Result<TreePropertyRef> find(std::string_view path) const;
  Result<std::vector<TreePropertyRef>> match(std::string_view pattern, PatternBudget& budget, std::size_t limit) const;

 private:
  void add(const Store& store, NodeId id, std::uint32_t parent);

  std::string names_;  // concatenated
  std::vector<Node> nodes_;
  std::uint32_t computed_width_ = 0;
  std::uint32_t text_count_ = 0;
};

}  // namespace limber
