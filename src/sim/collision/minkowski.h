// Support points of the difference A - B of two convex shapes, in double precision.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// Point of the difference, and the point of B that it belongs to, world.
struct DifferencePoint {
  Vec3 difference{0};  ///< Point of A minus point of B.
  Vec3 on_b{0};
};

/// Two placed shapes, with or without their margins. [any]
struct ShapeDifference {
  const btConvexShape& a;
  const btTransform& pose_a;
  const btConvexShape& b;
  const btTransform& pose_b;
  bool margins;

  /// The point of the difference that is farthest in a direction.
  DifferencePoint support(const Vec3& direction) const {
    const Vec3 on_b = support(b, pose_b, -direction);
    return {support(a, pose_a, direction) - on_b, on_b};
  }

 private:
  Vec3 support(const btConvexShape& shape, const btTransform& pose, const Vec3& direction) const {
    const btVector3 local = bullet::to_bt(direction) * pose.getBasis();
    return bullet::from_bt(pose(margins ? shape.localGetSupportVertexNonVirtual(local)
                                        : shape.localGetSupportVertexWithoutMarginNonVirtual(local)));
  }
};

}  // namespace limber::sim::collision
