// SurfaceShape: bounds and triangles in single precision.
#include "sim/collision/surface_shape.h"

namespace limber::sim::collision {

using bullet::from_bt;
using bullet::to_bt;

SurfaceShape::SurfaceShape(std::shared_ptr<const model::Surface> surface) : surface_(std::move(surface)) {
  m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE;
}

void SurfaceShape::getAabb(const btTransform& pose, btVector3& min, btVector3& max) const {
  const btVector3 center = pose(to_bt((surface_->low() + surface_->high()) / 2.0));
  const btVector3 half = pose.getBasis().absolute() * to_bt((surface_->high() - surface_->low()) / 2.0);
  min = center - half;
  max = center + half;
}

void SurfaceShape::processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                                       const btVector3& high) const {
  surface_->for_each_near(from_bt(low), from_bt(high), [&](unsigned index) {
    const model::Surface::Triangle triangle = surface_->triangle(index);
    btVector3 corners[] = {to_bt(triangle.corner[0]), to_bt(triangle.corner[1]), to_bt(triangle.corner[2])};
    callback->processTriangle(corners, 0, static_cast<int>(index));
  });
}

}  // namespace limber::sim::collision
