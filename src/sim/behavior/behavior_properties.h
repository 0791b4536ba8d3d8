// The properties that every behavior and group has before its parameters: `active`, `time`, `remove`, `place`. [any]
#pragma once

#include <cstdint>
#include <vector>

#include "properties/property_table.h"

namespace limber::sim {

inline constexpr std::uint32_t kCommonBehaviorProperties = 4;

/// The properties of an instance.
std::vector<Property> common_behavior_properties();
/// The properties of a group.
std::vector<Property> common_group_properties();

}  // namespace limber::sim
