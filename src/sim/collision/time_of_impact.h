// Time of impact of two moving shapes, by conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996).
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// A shape and its motion in a step: constant velocities from `start` on, until `stop`. [any]
struct Sweep {
  const btCollisionShape* shape = nullptr;
  btTransform start;           ///< Pose at the start of the step.
  btVector3 linear{0, 0, 0};   ///< m per step.
  btVector3 angular{0, 0, 0};  ///< rad per step, world axes.
  btScalar stop = 1;           ///< Fraction of the step after which it stands.
  btScalar radius = 0;         ///< inner_radius() of the shape; 0: unknown.

  btTransform at(btScalar fraction) const;
  /// Boundaries of the shape during the whole motion.
  void bounds(btVector3& low, btVector3& high) const;
};

/// Removes rotation about an axis of symmetry of the shape, which moves no point of its surface to another place.
void remove_symmetric_spin(Sweep& sweep);

/// Radius of a sphere that fits into each convex part of a shape, m: a shape that moves by less than that can't pass
/// through another one unnoticed. 0: a plane, or a surface without volume; BT_LARGE_FLOAT: nothing to collide.
btScalar inner_radius(const btCollisionShape& shape);

/// Returns the fraction of the step at which the shapes begin to overlap, by a little, so that the next step finds a
/// contact. Shapes that touch at the start, whose contacts limit their motion already, may overlap more deeply, by a
/// quarter of the smaller inner radius. 1: that happens not in this step.
btScalar time_of_impact(const Sweep& a, const Sweep& b);

}  // namespace limber::sim::collision
