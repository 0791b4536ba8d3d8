// Friction frames. Anisotropic friction is an ellipse: of all forces within it, the one that dissipates most power
// acts.
#include "sim/collision/contact_friction.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::collision {
namespace {

/// Below this speed a contact sticks: m/s, rad/s.
constexpr btScalar kMinSlipSpeed = 1e-3F;
constexpr btScalar kMinRollSpeed = 1e-3F;
/// A tangential vector has no direction if its squared length is below kMinLength2, or below this fraction of that of
/// the whole vector, because it is a rounding error then.
constexpr btScalar kMinLength2 = 1e-14F;
constexpr btScalar kMinTangentialFraction2 = 1e-10F;
constexpr btScalar kMinAnisotropy = 1e-3F;

btVector3 tangential(const btVector3& v, const btVector3& normal) { return v - normal * normal.dot(v); }

// Scales the part of `v` along the object's friction direction by factor^exponent.
btVector3 scale(const btCollisionObject& object, const btVector3& normal, int exponent, const btVector3& v) {
  if (!object.hasAnisotropicFriction()) return v;
  const btVector3& local = object.getAnisotropicFriction();
  const btVector3 direction = tangential(object.getWorldTransform().getBasis() * local, normal);
  const btScalar length2 = direction.length2();
  if (length2 < 1e-6F) return v;
  const btScalar factor = local.m_floats[3];
  const btScalar multiplier = exponent < 0 ? 1 / factor : exponent == 1 ? factor : factor * factor;
  return v + direction * ((multiplier - 1) * direction.dot(v) / length2);
}

// The first of the vectors that has a tangential direction becomes the first axis.
void set_axes(const btVector3& normal, const btVector3& first, const btVector3& second, const btVector3& third,
              FrictionFrame& frame) {
  for (const btVector3* v : {&first, &second, &third}) {
    const btVector3 direction = tangential(*v, normal);
    const btScalar length2 = direction.length2();
    if (!(length2 > std::max(kMinLength2, kMinTangentialFraction2 * v->length2()))) continue;
    // projected twice: rounding leaves a normal part, which matters if most of the vector was normal
    frame.along = tangential(direction / std::sqrt(length2), normal).normalized();
    frame.across = frame.along.cross(normal);
    return;
  }
  btPlaneSpace1(normal, frame.along, frame.across);
}

}  // namespace

FrictionFrame sliding_frame(const btManifoldPoint& point, const btCollisionObject& a, const btCollisionObject& b,
                            const btVector3& slip, const btVector3& expected) {
  FrictionFrame frame;
  frame.friction = point.m_combinedFriction;
  const btVector3& normal = point.m_normalWorldOnB;
  const btVector3 sliding = tangential(slip, normal);
  const btScalar speed2 = sliding.length2();
  const bool slides = speed2 > kMinSlipSpeed * kMinSlipSpeed;
  if (slides) frame.speed = std::sqrt(speed2);
  const btVector3 previous_friction = point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                                      point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
  const btVector3 none(0, 0, 0);
  if (!a.hasAnisotropicFriction() && !b.hasAnisotropicFriction()) {
    set_axes(normal, slides ? sliding : none, previous_friction, expected, frame);
    return frame;
  }
  const auto force_direction = [&](const btVector3& v) {
    return scale(b, normal, 2, scale(a, normal, 2, tangential(v, normal)));
  };
  set_axes(normal, slides ? force_direction(sliding) : none, previous_friction, force_direction(expected), frame);
  if (slides) frame.speed_across = frame.across.dot(sliding);
  frame.friction /= scale(a, normal, -1, frame.along).length() * scale(b, normal, -1, frame.along).length();
  return frame;
}

FrictionFrame rolling_frame(const btManifoldPoint& point, const btVector3& spin, const btVector3& expected) {
  FrictionFrame frame;
  frame.friction = point.m_combinedRollingFriction;
  const btVector3& normal = point.m_normalWorldOnB;
  const btVector3 rolling = tangential(spin, normal);
  const btScalar speed2 = rolling.length2();
  const bool rolls = speed2 > kMinRollSpeed * kMinRollSpeed;
  if (rolls) frame.speed = std::sqrt(speed2);
  btVector3 x;
  btVector3 y;
  btPlaneSpace1(normal, x, y);
  const btVector3 previous_torque = x * point.m_contactMotion1 + y * point.m_contactMotion2;
  set_axes(normal, rolls ? rolling : btVector3(0, 0, 0), previous_torque, expected, frame);
  return frame;
}

void store_rolling_friction(btManifoldPoint& point, const btVector3& torque) {
  btVector3 x;
  btVector3 y;
  btPlaneSpace1(point.m_normalWorldOnB, x, y);
  point.m_contactMotion1 = x.dot(torque);
  point.m_contactMotion2 = y.dot(torque);
}

void set_friction_direction(btCollisionObject& object, const btVector3& direction, btScalar factor) {
  btVector3 stored(1, 1, 1);  // Bullet's value for isotropic friction
  const btScalar length = direction.length();
  if (length > SIMD_EPSILON && factor != 1) {
    stored = direction / length;
    stored.m_floats[3] = std::max(factor, kMinAnisotropy);
  }
  object.setAnisotropicFriction(stored);
}

}  // namespace limber::sim::collision
