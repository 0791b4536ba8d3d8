// EllipsoidShape: support points in closed form.
#include "sim/shapes/ellipsoid_shape.h"

#include <algorithm>
#include <cmath>

namespace limber::sim {

namespace {

// Part of the smallest radius that is margin. The surface of core and margin together differs from the ellipsoid by
// less than this share of it.
constexpr btScalar kMarginShare = 0.01F;
constexpr btScalar kMaxMargin = 0.001F;

btVector3 support(const btVector3& radii, const btVector3& direction) {
  const btVector3 scaled = radii * direction;
  const btScalar length = scaled.length();
  if (!(length > SIMD_EPSILON * radii.length())) return {radii.x(), 0, 0};
  return radii * scaled / length;
}

}  // namespace

EllipsoidShape::EllipsoidShape(const Vec3& radii) : radii_(bullet::to_bt(radii)) {
  m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
  m_collisionMargin = std::min(kMaxMargin, kMarginShare * radii_[radii_.minAxis()]);
  core_ = radii_ - btVector3(m_collisionMargin, m_collisionMargin, m_collisionMargin);
}

btVector3 EllipsoidShape::localGetSupportingVertex(const btVector3& direction) const {
  return support(radii_, direction);
}

btVector3 EllipsoidShape::localGetSupportingVertexWithoutMargin(const btVector3& direction) const {
  return support(core_, direction);
}

void EllipsoidShape::batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions, btVector3* out,
                                                                       int count) const {
  for (int i = 0; i < count; ++i) out[i] = support(core_, directions[i]);
}

void EllipsoidShape::getAabb(const btTransform& pose, btVector3& min, btVector3& max) const {
  btVector3 half;
  for (int i = 0; i < 3; ++i) half[i] = (pose.getBasis().getRow(i) * radii_).length();
  min = pose.getOrigin() - half;
  max = pose.getOrigin() + half;
}

void EllipsoidShape::calculateLocalInertia(btScalar mass, btVector3& inertia) const {
  const btVector3 s = radii_ * radii_;
  inertia = btVector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()) * (mass / 5);
}

}  // namespace limber::sim
