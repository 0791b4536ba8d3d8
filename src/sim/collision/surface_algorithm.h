// SurfaceAlgorithm: contacts of a convex shape with the triangles of a surface.
#pragma once

#include <array>
#include <cstdint>

#include "model/mesh/surface.h"
#include "sim/collision/closest_points.h"
#include "sim/collision/manifold_builder.h"
#include "sim/collision/pair_algorithm.h"

namespace limber::sim::collision {

/// A contact has the normal of the triangle's face. Only at a ridge, an edge from which both triangles slope away, its
/// normal is the direction between the closest points, which is between the normals of both faces. An edge of a flat
/// or hollow place has no contacts of its own: its normal would stop parts that slide across it. Contacts with
/// different normals are in different manifolds, at most four. [sim]
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
