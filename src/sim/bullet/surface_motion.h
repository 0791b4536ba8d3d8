// Surface motion: the velocity that moving static bodies (kinematic ones) and conveyors give the surfaces of a contact.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

/// True if the object is static and moves at a given velocity (KinematicBodies). It is never pushed.
inline bool is_moving_static(const btCollisionObject& object) {
  if (!object.isStaticObject()) return false;
  const btRigidBody* const body = btRigidBody::upcast(&object);
  const btVector3 zero(0, 0, 0);
  return body != nullptr && (body->getLinearVelocity() != zero || body->getAngularVelocity() != zero);
}

/// True for the solver body of a static object that moves.
inline bool is_moving_static(const btSolverBody& body) {
  const btVector3 zero(0, 0, 0);
  return body.m_originalBody == nullptr && (body.m_linearVelocity != zero || body.m_angularVelocity != zero);
}

/// Velocity at which the surface of an object moves along the object itself, like a belt, in the object's frame.
struct SurfaceVelocity {
  BT_DECLARE_ALIGNED_ALLOCATOR();
  btVector3 local;
};
/// Null: the surface doesn't move.
inline const SurfaceVelocity* surface_velocity(const btCollisionObject& object) {
  return static_cast<const SurfaceVelocity*>(object.internalGetExtensionPointer());
}

/// Velocities of the surfaces of A relative to those of B at a contact, beyond the motion of the dynamic bodies.
struct SurfaceMotion {
  btVector3 body{0, 0, 0};     ///< Of moving static bodies at the contact point, m/s.
  btVector3 surface{0, 0, 0};  ///< Of conveyors, m/s.
  btVector3 spin{0, 0, 0};     ///< Angular velocity of moving static bodies, rad/s.
  btVector3 velocity() const { return body + surface; }
};

/// One side of a contact: the object, its solver body, and the vector from its center to the contact point.
struct ContactSide {
  const btCollisionObject& object;
  const btSolverBody& body;
  btVector3 arm;
};
/// True if surface_motion() of these two sides may differ from zero.
bool has_surface_motion(const btCollisionObject& a, const btSolverBody& body_a, const btCollisionObject& b,
                        const btSolverBody& body_b);
/// Surface motion at a contact point during a step of `h` s.
SurfaceMotion surface_motion(const ContactSide& a, const ContactSide& b, btScalar h);

}  // namespace limber::sim::bullet
