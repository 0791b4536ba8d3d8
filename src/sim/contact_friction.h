// Contact friction: in which directions friction acts at a contact, and how strongly.
#pragma once

#include "sim/bullet.h"

namespace limber {

/// Which row of friction one of Bullet's is: its m_overrideNumSolverIterations, which Bullet does not use there. One
/// along an axis is followed by the one across.
enum FrictionRow : int { friction_spin, friction_along, friction_across };

/// Two axes of friction in the tangent plane. The first is the direction in which friction is expected to act: against
/// the slip where the contact slides, else as in the step before. A pyramid of friction that is aligned with it has the
/// strength of the cone, whatever the heading. [sim]
struct FrictionFrame {
  btVector3 along{0, 0, 0};
  btVector3 across{0, 0, 0};
  btScalar friction = 0;  ///< Coefficient in the direction `along`.
  /// Speed (m/s, rad/s) at which it slides, 0: it sticks. While it slides, friction across follows the direction of
  /// slip: it is viscous, with friction / speed.
  btScalar speed = 0;
  btScalar speed_across = 0;  ///< At which there is no friction across: not 0 where friction is anisotropic.
};

/// `slip`: velocity of body A relative to B at the point, as the step begins; `expected`: the same with gravity and
/// other external forces of the step.
FrictionFrame sliding_frame(const btManifoldPoint& point, const btCollisionObject& a, const btCollisionObject& b,
                            const btVector3& slip, const btVector3& expected);

/// The same of rolling; `spin`: angular velocity of A relative to B.
FrictionFrame rolling_frame(const btManifoldPoint& point, const btVector3& spin, const btVector3& expected);
/// What the frame of the next step looks at.
void remember_rolling(btManifoldPoint& point, const btVector3& torque);

/// Friction of `object` along `direction` (local) is `factor` times that across it. A direction of zeros: the same in
/// all directions.
void set_friction_direction(btCollisionObject& object, const btVector3& direction, btScalar factor);

}  // namespace limber
