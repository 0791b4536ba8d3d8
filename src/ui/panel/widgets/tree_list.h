// TreeList: the lines of the object tree: nodes whose ancestors are all expanded, or the matches of a search. The list
// is rebuilt only when the tree, the expanded nodes or the search changes, so that a frame costs only the visible
// lines.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "properties/tree_snapshot.h"

namespace limber::panel {

/// [main]
class TreeList {
 public:
  struct Line {
    std::uint32_t node = 0;
    std::uint16_t depth = 0;
    bool expandable = false;  ///< The node has children.
    bool expanded = false;
  };

  /// Returns the lines of that tree; with a `query`, only nodes whose title contains it (case-insensitive), and their
  /// ancestors.
  const std::vector<Line>& lines(const std::shared_ptr<const TreeSnapshot>& tree, std::string_view query);
  void toggle(std::uint32_t node);
  /// Expands all ancestors of a node.
  void reveal(std::uint32_t node);

  /// Returns the displayed name: "World" for /physics/sim.
  static std::string_view title(const TreeSnapshot& tree, std::uint32_t node);

 private:
  void add(std::uint32_t node, std::uint16_t depth);
  void add_matches(std::string_view query);
  static std::uint64_t key(const TreeSnapshot& tree, std::uint32_t node);
  std::vector<std::uint32_t> top() const;

  std::shared_ptr<const TreeSnapshot> tree_;
  std::string query_;
  bool dirty_ = true;
  bool initialized_ = false;
  std::unordered_set<std::uint64_t> expanded_;
  std::vector<Line> lines_;
};

}  // namespace limber::panel
