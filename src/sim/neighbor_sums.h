// Sums over pairs of points that are near each other: where they are, how they move. Each operation is rounded by
// itself and in a fixed order, so that the widest vectors of a processor add up to what the narrowest do. [sim]
#pragma once

#include <cstdint>
#include <span>

#include "sim/point_finder.h"

namespace limber {

/// Of a point; the fourth lane of its position is 1.
struct alignas(64) NeighborMotion {
  float position[4], velocity[4], spin[4], unused[4];
};
/// Over a point's neighbours; the fourth lane of the offsets counts them.
struct alignas(64) NeighborSum {
  float offset[4], velocity[4], spin[4], unused[4];
};

/// Adds each of the points `found` to the sum at `place`, and that point to theirs; `found` does not have `place`.
using AddPairs = void (*)(std::uint32_t place, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                          NeighborSum* sums);
/// By as many lanes at most, and as this processor has. `motions`: velocities are added up too, else nothing is said of
/// them.
AddPairs add_pairs_by(PointLanes lanes, bool motions);

}  // namespace limber
