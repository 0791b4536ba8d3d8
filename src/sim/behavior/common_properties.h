// Property definitions that several behavior types share, so that a name has the same meaning everywhere. [any]
#pragma once

#include "properties/property_table.h"

namespace limber::properties {

inline constexpr double kMaxLoad = 1e9;      ///< N, N·m and their gains: far beyond the strength of any part.
inline constexpr double kMaxDistance = 1e6;  ///< m

inline Property app_interval() {
  return number("app_interval", "ms", 1, 0, 1e9,
                "Simulated time between applications; shorter than a tick: every tick.");
}
inline Property rand_interval() {
  return number("rand_interval", "ms", 1000, 0, 1e9, "Simulated time between random draws.");
}
inline Property distance(std::string name, double initial, std::string doc) {
  return number(std::move(name), "m", initial, 0, kMaxDistance, std::move(doc));
}
inline Property load(std::string name, std::string unit, double initial, std::string doc) {
  return number(std::move(name), std::move(unit), initial, -kMaxLoad, kMaxLoad, std::move(doc));
}
inline Property load3(std::string name, std::string unit, std::array<double, 3> initial, std::string doc) {
  return vec3(std::move(name), std::move(unit), initial, -kMaxLoad, kMaxLoad, std::move(doc));
}
inline Property direction(std::string name, std::array<double, 3> initial, std::string doc) {
  return vec3(std::move(name), "", initial, -1e6, 1e6, std::move(doc));
}

}  // namespace limber::properties
