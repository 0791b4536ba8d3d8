// Closest points of two convex shapes, or their depth of overlap.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

struct ClosestPoints {
  bool found = false;
  btScalar distance = 0;      ///< Negative: depth of overlap, m.
  btVector3 normal{0, 0, 0};  ///< From B to A, unit length, world axes.
  btVector3 point{0, 0, 0};   ///< On the surface of B, world.
};

/// Finds them by the algorithm of Gilbert, Johnson and Keerthi (1988) for the shapes without their margins, by which
/// they are rounded; if these overlap, by find_penetration(). Both are in double precision, and their tolerances are
/// relative to the shapes: Bullet's have lengths of up to 1 cm, which makes contacts of small parts wrong. Not found:
/// the shapes are degenerate. [any]
ClosestPoints closest_points(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                             const btTransform& pose_b);

}  // namespace limber::sim::collision
