// Surface motion: velocities at a contact point.
#include "sim/bullet/surface_motion.h"

namespace limber::sim::bullet {
namespace {

/// Rotation per step, rad, up to which the second-order correction applies.
constexpr btScalar kMaxCorrectedRotation = btScalar(0.8);

// Velocity of a moving static body's surface. A part that is carried moves straight within a step while the surface
// below it turns: w x arm alone would let it drift outwards by r·w²·h/2 per second. The mean velocity of the surface
// at the other body, which moves at u relative to this one, is larger by w x u·h/2; the term of second order corrects
// for u being that of the last step.
btVector3 velocity_of(const ContactSide& side, const btSolverBody& other, btScalar h) {
  const btVector3& w = side.body.m_angularVelocity;
  btVector3 velocity = side.body.m_linearVelocity + w.cross(side.arm);
  if (w.length2() * h * h < kMaxCorrectedRotation * kMaxCorrectedRotation) {
    const btVector3 turning = w.cross(other.m_linearVelocity - side.body.m_linearVelocity) * h;
    velocity += turning * btScalar(0.5) + w.cross(turning) * (h * btScalar(5.0 / 12.0));
  }
  return velocity;
}

btVector3 belt_velocity(const btCollisionObject& object) {
  const SurfaceVelocity* const belt = surface_velocity(object);
  return belt == nullptr ? btVector3(0, 0, 0) : object.getWorldTransform().getBasis() * belt->local;
}

}  // namespace

bool has_surface_motion(const btCollisionObject& a, const btSolverBody& body_a, const btCollisionObject& b,
                        const btSolverBody& body_b) {
  return surface_velocity(a) != nullptr || surface_velocity(b) != nullptr || is_moving_static(body_a) ||
         is_moving_static(body_b);
}

SurfaceMotion surface_motion(const ContactSide& a, const ContactSide& b, btScalar h) {
  SurfaceMotion motion;
  if (is_moving_static(a.body)) {
    motion.body += velocity_of(a, b.body, h);
    motion.spin += a.body.m_angularVelocity;
  }
  if (is_moving_static(b.body)) {
    motion.body -= velocity_of(b, a.body, h);
    motion.spin -= b.body.m_angularVelocity;
  }
  motion.surface = belt_velocity(a.object) - belt_velocity(b.object);
  return motion;
}

}  // namespace limber::sim::bullet
