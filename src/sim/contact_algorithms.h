// Contact algorithms: convex shapes on planes, boxes on boxes, and other convex shapes on each other, with complete
// contact manifolds in every step.
#pragma once

#include "sim/bullet.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>

namespace limber {

/// Bullet adds one point a step, and turns a shape about a little to find the next: a box that falls flat tilts, and
/// one that slides sinks and turns while its points drift. Here, all points of a step are found at once, from the
/// features of the shapes that face each other, also those that will touch by its end. [sim]
class ContactAlgorithms {
 public:
  /// Registers them; must outlive `dispatcher`'s use of them.
  void install(btCollisionDispatcher& dispatcher);

 private:
  struct CreatePlane : btCollisionAlgorithmCreateFunc {
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
    btGjkEpaPenetrationDepthSolver depth_solver;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };

  CreatePlane convex_plane_;
  CreatePlane plane_convex_;
  CreateBox box_box_;
  CreateConvex convex_convex_;
};

}  // namespace limber
