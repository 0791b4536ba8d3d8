// EllipsoidShape: an ellipsoid with its axes along x, y and z, as a convex shape of Bullet with an exact surface.
#pragma once

#include "base/vec.h"
#include "sim/bullet/bullet.h"

namespace limber::sim {

class EllipsoidShape final : public btConvexInternalShape {
 public:
  /// `radii`: half the lengths of its axes, m.
  explicit EllipsoidShape(const Vec3& radii);

  btVector3 localGetSupportingVertex(const btVector3& direction) const override;
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& direction) const override;
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions, btVector3* out,
                                                         int count) const override;
  void getAabb(const btTransform& pose, btVector3& min, btVector3& max) const override;
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  const char* getName() const override { return "ellipsoid"; }

 private:
  btVector3 radii_;
  btVector3 core_;  // radii of the ellipsoid that the margin is added to
};

}  // namespace limber::sim
