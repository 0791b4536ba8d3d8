// Contact features: the face, edge or point of a convex shape with the support in a direction.
#pragma once

#include <array>

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// A convex polygon, a segment (2 points) or a point, counterclockwise about its normal. The surface is `margin`
/// outside of the points, along the normal. [sim]
struct ContactFeature {
  static constexpr int kMaxPoints = 64;

  std::array<btVector3, kMaxPoints> points;
  int count = 0;
  btVector3 normal{0, 0, 0};  ///< Outward, unit length.
  btScalar margin = 0;

  void add(const btVector3& point) {
    if (count < kMaxPoints) points[static_cast<std::size_t>(count++)] = point;
  }
  const btVector3& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
  btVector3& operator[](int i) { return points[static_cast<std::size_t>(i)]; }
  /// Transforms the points and the normal by `pose`.
  void transform(const btTransform& pose);
};

/// Finds the feature of `shape` whose outward normal is nearest to `direction` (local, unit length). Faces of a hull
/// require its polyhedral features; without them, and for other kinds of shapes, the result is the support point. Caps
/// of cylinders and cones are polygons of 12 corners.
void find_feature(const btConvexShape& shape, const btVector3& direction, ContactFeature& feature);

/// Finds all points of `shape` that may touch a plane whose normal is -`direction` (local, unit length), `plane` m from
/// the origin along `direction`, always including the deepest one: every vertex of a hull that is at most
/// `max_distance` above the plane, corners of a box's lowest face, the lowest points of caps, ends of segments.
void find_points_on_plane(const btConvexShape& shape, const btVector3& direction, btScalar plane, btScalar max_distance,
                          ContactFeature& feature);

}  // namespace limber::sim::collision
