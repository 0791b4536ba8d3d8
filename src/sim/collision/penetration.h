// Depth of overlap of two convex shapes: expanding polytope algorithm (van den Bergen, Proximity Queries and
// Penetration Depth Computation on 3D Game Objects, 2001), in double precision.
#pragma once

#include "sim/collision/minkowski.h"

namespace limber::sim::collision {

struct Penetration {
  bool found = false;
  double depth = 0;    ///< Length of the shortest translation that separates the shapes, m.
  Vec3 normal{0};      ///< Direction in which A must move, unit length, world axes.
  Vec3 point_on_b{0};  ///< Deepest point of B, world.
};

/// Not found: the shapes don't overlap, or their difference is flat, as that of two segments. [any]
Penetration find_penetration(const ShapeDifference& shapes);

}  // namespace limber::sim::collision
