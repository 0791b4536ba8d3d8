// Rows that several types of behaviour share, so that one name means one thing. [any]
#pragma once

#include "params/table.h"

namespace limber::rows {

inline constexpr double kMostLoad = 1e9;      ///< N, N·m and their gains: far beyond what any part stands.
inline constexpr double kMostDistance = 1e6;  ///< m

inline Row app_interval() {
  return number("app_interval", "ms", 1, 0, 1e9,
                "Simulated time from one application to the next; shorter than a tick: every tick.");
}
inline Row rand_interval() {
  return number("rand_interval", "ms", 1000, 0, 1e9, "Simulated time from one random draw to the next.");
}
inline Row distance(std::string name, double initial, std::string doc) {
  return number(std::move(name), "m", initial, 0, kMostDistance, std::move(doc));
}
inline Row load(std::string name, std::string unit, double initial, std::string doc) {
  return number(std::move(name), std::move(unit), initial, -kMostLoad, kMostLoad, std::move(doc));
}
inline Row load3(std::string name, std::string unit, std::array<double, 3> initial, std::string doc) {
  return vec3(std::move(name), std::move(unit), initial, -kMostLoad, kMostLoad, std::move(doc));
}
inline Row direction(std::string name, std::array<double, 3> initial, std::string doc) {
  return vec3(std::move(name), "", initial, -1e6, 1e6, std::move(doc));
}

}  // namespace limber::rows
