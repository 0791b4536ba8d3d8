// RouteLink: a connection from one property to another, found from the addresses of a route. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "properties/catalog.h"

namespace limber::sim {

/// All numbers of a property, one of them, or the length of a vector.
struct RouteEnd {
  static constexpr std::int8_t kAll = -1;
  static constexpr std::int8_t kLength = -2;

  PropertyRef ref;
  std::int8_t component = kAll;

  /// Number of values.
  std::uint32_t width() const { return component == kAll ? ref.property->width : 1; }
};

/// From one end to the other. If the source has one number and the target three flags, the number sets all three.
struct RouteLink {
  RouteEnd from, to;
  std::uint32_t target = 0;  ///< Index of the target among those of all routes; RouteList sets it.
};

/// The most links of a route.
inline constexpr std::size_t kMaxRouteLinks = 4096;

/// Returns the links between the properties that two addresses or patterns match, each optionally followed by a
/// component: ".x", ".y", ".z", ".w" or, in `from`, ".length". One source is connected to all targets, several sources
/// to one target or, in the order of the tree, to as many targets. Errors name the address; with `hint` they list
/// similar names.
Result<std::vector<RouteLink>> find_route_links(const Store& store, std::string_view from, std::string_view to,
                                                bool hint);
/// Returns an error if this can't be the address of an end: too long, not printable, or it doesn't begin with /.
Result<void> check_route_address(std::string_view subject, std::string_view address);

}  // namespace limber::sim
