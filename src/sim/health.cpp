// Bounds of speed, spin and distance (architecture.md, the tick, 7).
#include "sim/health.h"

#include <cmath>

namespace limber {

namespace {

constexpr double kMaxSpeed = 500;
constexpr double kMaxSpin = 1000;
constexpr double kMaxDistance = 1e4;

double squared(const btVector3& v) {
  const Vec3 d = from_bt(v);
  return glm::dot(d, d);
}

}  // namespace

const char* ailment(const btRigidBody& part) {
  const double speed = squared(part.getLinearVelocity());
  const double spin = squared(part.getAngularVelocity());
  const double distance = squared(part.getWorldTransform().getOrigin());
  if (speed < kMaxSpeed * kMaxSpeed && spin < kMaxSpin * kMaxSpin && distance < kMaxDistance * kMaxDistance)
    return nullptr;
  if (!std::isfinite(speed) || !std::isfinite(spin) || !std::isfinite(distance)) return "is no number any more";
  if (speed >= kMaxSpeed * kMaxSpeed) return "is faster than 500 m/s";
  return spin >= kMaxSpin * kMaxSpin ? "turns faster than 1000 rad/s" : "is beyond 10 km";
}

}  // namespace limber
