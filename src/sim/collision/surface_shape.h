// SurfaceShape: a model::Surface as a shape of Bullet.
#pragma once

#include <memory>
#include <utility>

#include "model/mesh/surface.h"
#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// For static and kinematic parts: it has no mass. [sim]
class SurfaceShape final : public btConcaveShape {
 public:
  explicit SurfaceShape(std::shared_ptr<const model::Surface> surface);

  const model::Surface& surface() const { return *surface_; }

  void getAabb(const btTransform& pose, btVector3& min, btVector3& max) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low, const btVector3& high) const override;
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return scaling_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "surface"; }

 private:
  std::shared_ptr<const model::Surface> surface_;
  btVector3 scaling_{1, 1, 1};
};

}  // namespace limber::sim::collision
