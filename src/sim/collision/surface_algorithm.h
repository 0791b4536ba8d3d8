// SurfaceAlgorithm: contacts of a convex shape with the triangles of a surface.
#pragma once

#include <array>
#include <cstdint>

#include "model/mesh/surface.h"
#include "sim/collision/closest_points.h"
#include "sim/collision/manifold_builder.h"
#include "sim/collision/pair_algorithm.h"

namespace limber::sim::collision {

/// A triangle is touched in its face, unless the nearest point is on an edge that stands out: then any direction
/// between the two faces of the edge is the normal. At an edge of a flat or hollow place, the faces do what is needed,
/// so that nothing is caught by an edge that two triangles share. Contacts with different normals have manifolds of
/// their own, at most four. [sim]
class SurfaceAlgorithm : public PairAlgorithm {
 public:
  SurfaceAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                   const btCollisionObjectWrapper* b, bool surface_first);
  ~SurfaceAlgorithm() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  static constexpr std::size_t kMaxManifolds = 4;
  class Step;

  std::array<btPersistentManifold*, kMaxManifolds> manifolds_{};  // the first is that of PairAlgorithm
  // of the latest contacts, world; three numbers each, because the size of algorithms is limited
  std::array<std::array<btScalar, 3>, kMaxManifolds> normals_{};
  std::uint8_t count_ = 1;
  bool surface_first_;
};

}  // namespace limber::sim::collision
