// Path events: OSCQuery notifications of the differences between two trees. [any]
#pragma once

#include <string>
#include <vector>

#include "properties/tree_snapshot.h"

namespace limber::oscquery {

inline constexpr std::size_t kMaxPathEvents = 64;

/// Returns frames such as `{"COMMAND":"PATH_ADDED","DATA":"/physics/body/arm"}`, with the topmost path of each added or
/// removed object or property, and PATH_CHANGED for a property with different attributes. More than kMaxPathEvents
/// events are replaced by one PATH_CHANGED of their common parent.
std::vector<std::string> path_events_between(const TreeSnapshot& before, const TreeSnapshot& after);

}  // namespace limber::oscquery
