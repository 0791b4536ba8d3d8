// Contact algorithms with complete contact manifolds in every step: convex shapes with planes and surfaces, boxes with
// boxes, and other convex shapes with each other.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// Bullet adds one point per step, and perturbs the pose of a shape to find another: a box that falls flat tilts, and
/// one that slides sinks and turns while its points drift. These algorithms find all points of a step at once, from the
/// opposing features of the shapes, including points that will touch by the step's end. [sim]
class ContactAlgorithms {
 public:
  /// Registers the algorithms. The object must outlive `dispatcher`'s use of them.
  void install(btCollisionDispatcher& dispatcher);

 private:
  struct CreatePlane : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  struct CreateSurface : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  struct CreateBox : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  struct CreateConvex : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };

  CreatePlane convex_plane_;
  CreatePlane plane_convex_;
  CreateSurface convex_surface_;
  CreateSurface surface_convex_;
  CreateBox box_box_;
  CreateConvex convex_convex_;
};

}  // namespace limber::sim::collision
