// Sums of positions and velocities over pairs of neighboring points. All operations are rounded individually and in a
// fixed order, so that the result doesn't depend on the vector width of the processor. [sim]
#pragma once

#include <cstdint>
#include <span>

#include "base/vec.h"
#include "sim/neighbors/point_finder.h"

namespace limber::sim {

/// Position (m), velocity (m/s) and angular velocity (rad/s) of a point; the fourth component of its position is 1.
struct alignas(64) NeighborMotion {
  float position[4], velocity[4], angular_velocity[4], unused[4];
};
/// Sums over the neighbors of a point; the fourth component of the offset is their count.
struct alignas(64) NeighborSum {
  float offset[4], velocity[4], angular_velocity[4], unused[4];
};

using limber::put;
/// Copies a vector in single precision.
inline void put(float* to, const Vec3& v) {
  for (int i = 0; i < 3; i++) to[i] = static_cast<float>(v[i]);
}

/// Adds each of the points `found` to the sum of the point `index`, and that point to their sums. `found` must not
/// contain `index`.
using AddPairs = void (*)(std::uint32_t index, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                          NeighborSum* sums);
/// Returns an implementation with at most the given vector width, if the processor supports it. `motions`: velocities
/// are summed too; else their sums are undefined.
AddPairs select_add_pairs(VectorWidth width, bool motions);

}  // namespace limber::sim
