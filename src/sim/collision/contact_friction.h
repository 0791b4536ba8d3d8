// Contact friction: directions and strength of friction at a contact.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// Kind of a friction row, stored in its m_overrideNumSolverIterations, which Bullet doesn't use for friction. Each
/// friction_along row is followed by its friction_across row.
enum FrictionRow : int { friction_spin, friction_along, friction_across };

/// Two friction axes in the tangent plane. The first one is the expected direction of friction: against the slip where
/// the contact slides, else that of the previous step. A friction pyramid that is aligned with it is as strong as the
/// cone in any direction of motion. [sim]
struct FrictionFrame {
  btVector3 along{0, 0, 0};
  btVector3 across{0, 0, 0};
  btScalar friction = 0;  ///< Coefficient in the direction `along`.
  /// Slip speed (m/s, rad/s); 0: it sticks. While it slides, friction across follows the direction of slip: it is
  /// viscous, with the coefficient friction / speed.
  btScalar speed = 0;
  btScalar speed_across = 0;  ///< Speed across at which friction across is zero; nonzero only if it is anisotropic.
};

/// Returns the frame of sliding friction. `slip`: velocity of body A relative to B at the point at the start of the
/// step; `expected`: the same including the effect of gravity and other external forces in the step.
FrictionFrame sliding_frame(const btManifoldPoint& point, const btCollisionObject& a, const btCollisionObject& b,
                            const btVector3& slip, const btVector3& expected);

/// The same for rolling; `spin`: angular velocity of A relative to B.
FrictionFrame rolling_frame(const btManifoldPoint& point, const btVector3& spin, const btVector3& expected);
/// Stores the rolling friction torque for the frame of the next step.
void store_rolling_friction(btManifoldPoint& point, const btVector3& torque);

/// Sets anisotropic friction: friction of `object` along `direction` (local) is `factor` times that across it. A zero
/// direction: isotropic.
void set_friction_direction(btCollisionObject& object, const btVector3& direction, btScalar factor);

}  // namespace limber::sim::collision
