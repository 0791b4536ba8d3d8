// Catalog: addresses to nodes and rows and back, by exact path or by OSC pattern. [sim]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "params/pattern_budget.h"
#include "params/store.h"

namespace limber {

/// A row of a node, or the node itself when `row` is null.
struct Place {
  NodeId node;
  const Row* row = nullptr;
};

/// Rows of a node, a bit a row; none: the node itself.
struct PlaceRows {
  NodeId node;
  std::uint64_t rows = 0;
};

/// The place of an exact path such as "/physics/body/arm/part/tip/mass". Classes' and rows' names are compared by the
/// one naming rule, names of things exactly (%20 style undone). The error names the part that fails and, if `hint` says
/// so, near names, which are looked for among all that there are.
Result<Place> find_place(const Store& store, std::string_view path, bool hint = true);

/// Every row that an OSC pattern reaches, in tree order: `?` `*` `[a-z]` `[!a]` `{a,b}` within a name, `//` any depth.
/// At most `limit` places. Errors: it is no pattern, or more work than the budget allows.
Result<std::vector<Place>> match_places(const Store& store, std::string_view pattern, PatternBudget& budget,
                                        std::size_t limit = 1000000);
/// The same thing by thing, where each has many.
Result<std::vector<PlaceRows>> match_things(const Store& store, std::string_view pattern, PatternBudget& budget);

}  // namespace limber
