// Looks up nodes and properties of the store by path or by OSC address pattern. [sim]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "properties/pattern_budget.h"
#include "properties/store.h"

namespace limber {

/// Refers to a property of a node, or to the node itself if `property` is null.
struct PropertyRef {
  NodeId node;
  const Property* property = nullptr;
};

/// Refers to some properties of a node, as a bit mask of their indices; 0: the node itself.
struct PropertySet {
  NodeId node;
  std::uint64_t properties = 0;
};

/// Returns the property or node at an exact path such as "/physics/body/arm/part/tip/mass". Names of classes and
/// properties are compared as same_name() does, names of objects exactly, after %20 style escapes are decoded. The
/// error names the component that was not found and, with `hint`, similar names (their search visits
/// all siblings).
Result<PropertyRef> find_property(const Store& store, std::string_view path, bool hint = true);

/// Returns all properties and nodes that match an OSC address pattern, in tree order, at most `limit`. Wildcards:
/// `?` `*` `[a-z]` `[!a]` `{a,b}` within a name, `//` for any depth. Errors: not a valid pattern, or it exceeds the
/// budget.
Result<std::vector<PropertyRef>> match_properties(const Store& store, std::string_view pattern, PatternBudget& budget,
                                                  std::size_t limit = 1000000);
/// Like match_properties(), with one result per node, without a limit.
Result<std::vector<PropertySet>> match_nodes(const Store& store, std::string_view pattern, PatternBudget& budget);

}  // namespace limber
