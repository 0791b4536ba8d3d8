// Tree: a finished copy of the store's structure: who is there, of which class, and where each one's numbers stand.
// Made by the simulation when somebody asks, never changed, read by anyone.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "params/pattern_budget.h"
#include "params/store.h"

namespace limber {

/// A row of a thing, or the thing itself when `row` is null.
struct TreePlace {
  std::uint32_t node = 0;
  const Row* row = nullptr;
};

/// Where a row's numbers stand in a copy of the store's values.
struct TreeNumbers {
  enum class Block : std::uint8_t { none, kept, live, views, texts };
  Block block = Block::none;  ///< None: an action.
  std::uint32_t at = 0;       ///< Of texts: which one.
};

/// Tables live as long as the program, so rows may be held on to.
class Tree {
 public:
  struct Node {
    NodeId id;
    const Table* table = nullptr;
    std::uint32_t parent = 0;
    std::uint32_t end = 0;  ///< One behind the last node below it.
    std::uint32_t name_at = 0;
    std::uint32_t name_size = 0;
    std::uint32_t kept = 0;  ///< Where its numbers begin in each block.
    std::uint32_t live = 0;
    std::uint32_t views = 0;
    std::uint32_t texts = 0;
  };

  /// [sim]
  explicit Tree(const Store& store);

  /// Parents first, children in order; the first is the root. [any]
  const std::vector<Node>& nodes() const { return nodes_; }
  std::string_view name(std::uint32_t node) const {
    return std::string_view(names_).substr(nodes_[node].name_at, nodes_[node].name_size);
  }
  /// "/physics/body/my%20arm", "/" for the root.
  std::string path(std::uint32_t node) const;
  std::string path(const TreePlace& place) const;
  TreeNumbers numbers(const TreePlace& place) const;
  /// How many numbers all views have.
  std::uint32_t views_width() const { return views_width_; }
  std::uint32_t text_count() const { return text_count_; }

  /// Calls f(child) for each, in order, until it gives false.
  template <class F>
  void each_child(std::uint32_t node, F&& f) const {
    for (std::uint32_t child = node + 1; child < nodes_[node].end; child = nodes_[child].end) {
      if (!f(child)) return;
    }
  }

  /// As find_place and match_places of the catalog; "/" is the root.
  Result<TreePlace> find(std::string_view path) const;
  Result<std::vector<TreePlace>> match(std::string_view pattern, PatternBudget& budget, std::size_t limit) const;

 private:
  void add(const Store& store, NodeId id, std::uint32_t parent);

  std::string names_;  // one behind the other
  std::vector<Node> nodes_;
  std::uint32_t views_width_ = 0;
  std::uint32_t text_count_ = 0;
};

}  // namespace limber
