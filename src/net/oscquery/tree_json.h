// OSCQuery's JSON of the tree, from a value snapshot. [any]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/output/value_snapshot.h"

namespace limber::oscquery {

inline constexpr std::size_t kMaxProperties = 100000;

/// Returns a node and its descendants: FULL_PATH, then CONTENTS, or a property's attributes and VALUE. Nodes more than
/// `depth` levels below are omitted and their parent's CONTENTS is empty. If there are more than kMaxProperties
/// properties, whole levels are omitted, the deepest first.
std::string node_json(const engine::ValueSnapshot& snapshot, const TreePropertyRef& ref, int depth = 64);

/// Returns the properties that contain every word in their path, compared as normalized names, as
/// `{"FOUND":[{…},…],"MORE":false}`; without words there are none. At most `limit` of them; MORE is true if there are
/// others.
std::string find_json(const engine::ValueSnapshot& snapshot, std::string_view words, std::size_t limit = 100);

/// Returns the value of a property as JSON; empty if it has none.
std::string property_value_json(const engine::ValueSnapshot& snapshot, const TreePropertyRef& ref);

}  // namespace limber::oscquery
