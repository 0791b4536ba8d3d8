// Contact features: the face, edge or point of a convex shape that faces a direction.
#pragma once

#include <array>

#include "sim/bullet.h"

namespace limber {

/// A convex polygon, a segment (2 points) or a point, counterclockwise about its normal. Its surface is `margin`
/// outside the points, along the normal. [sim]
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
  /// Into the frame that `pose` is given in.
  void transform(const btTransform& pose);
};

/// The feature of `shape` whose outward normal is nearest to `direction` (local, unit length). Faces of a hull need
/// its polyhedral features; without them, and for other kinds of shapes, it is the support point. Caps of cylinders
/// and cones are polygons of 12 corners.
void find_feature(const btConvexShape& shape, const btVector3& direction, ContactFeature& feature);

/// All points of `shape` that may touch a plane whose normal is -`direction` (local, unit length), `plane` m from the
/// origin along `direction`, complete with the deepest one: every vertex of a hull that is at most `reach` above the
/// plane, corners of a box's lowest face, the lowest points of caps, ends of segments.
void find_points_on_plane(const btConvexShape& shape, const btVector3& direction, btScalar plane, btScalar reach,
                          ContactFeature& feature);

}  // namespace limber
