// Overlap: how deep two convex shapes penetrate each other, and which parts of a body overlap.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "model/body_model.h"

namespace limber {

/// Parts of one body that overlap by more than this (m) don't collide with each other by default.
inline constexpr double kOverlapTolerance = 1e-4;

/// Penetration depth of two shapes placed in one frame, m: the shortest shift that separates them. 0 where it is at
/// most `tolerance`. Depths are exact within 2 %, or a tenth of a micrometer; a deep one may be reported up to its
/// extent too large, since only the comparison with `tolerance` is decided exactly. Mesh shapes count as their contact
/// hull, without the collision margin. Planes are unbounded scenery and overlap nothing. [any]
double overlap_depth(const PlacedShape& a, const PlacedShape& b, double tolerance = kOverlapTolerance);

/// One part for find_overlaps().
struct OverlapPart {
  std::span<const PlacedShape> shapes;  ///< In the part's frame.
  Pose pose;                            ///< Of that frame; all parts in one frame.
};

struct OverlapResult {
  std::vector<Overlap> found;  ///< a < b, in ascending order.
  std::size_t unchecked = 0;   ///< Pairs of parts that were not compared, because the work is bounded.
};

/// All pairs (a < b) that `wanted` accepts and whose shapes overlap by more than kOverlapTolerance. [any]
OverlapResult find_overlaps(std::span<const OverlapPart> parts,
                            const std::function<bool(std::size_t a, std::size_t b)>& wanted);

}  // namespace limber
