// Bounds of speed, rotation and distance.
#include "sim/health.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/body.h"
#include "sim/spin.h"

namespace limber {

namespace {

constexpr double kMaxSpeed = 500;
/// Of rotation about another axis than that of a driven joint or a principal one.
constexpr double kMaxTumbling = 1000;
/// Of any rotation: more than any property asks for.
constexpr double kMaxSpin = 2e4;
constexpr double kMaxDistance = 1e4;

/// Contacts deeper than this, m, count as an overlap, and a larger ratio of two jointed masses as a cause.
constexpr double kOverlap = 0.002;
constexpr double kMassRatio = 500;
constexpr int kMostSubsteps = 1000;

double squared(const btVector3& v) {
  const Vec3 d = from_bt(v);
  return glm::dot(d, d);
}

}  // namespace

const char* ailment(const btRigidBody& part, double h) {
  const double speed = squared(part.getLinearVelocity());
  const double spin = squared(part.getAngularVelocity());
  const double distance = squared(part.getWorldTransform().getOrigin());
  if (speed < kMaxSpeed * kMaxSpeed && spin < kMaxTumbling * kMaxTumbling && distance < kMaxDistance * kMaxDistance) {
    return nullptr;
  }
  if (!std::isfinite(speed) || !std::isfinite(spin) || !std::isfinite(distance))
    return "has a position or velocity that is not a number";
  if (speed >= kMaxSpeed * kMaxSpeed) return "is faster than 500 m/s";
  if (distance >= kMaxDistance * kMaxDistance) return "is farther than 10 km from the origin";
  if (spin >= kMaxSpin * kMaxSpin) return "turns faster than 20000 rad/s";
  return glm::length(tumbling(part, h)) < kMaxTumbling ? nullptr : "tumbles faster than 1000 rad/s";
}

namespace {

// The deepest contact of a body: depth (m) and the two parts.
struct DeepContact {
  double depth = 0;
  const Part* a = nullptr;
  const Part* b = nullptr;
};

DeepContact deepest_overlap(const Body& body, const btDispatcher& contacts) {
  DeepContact deepest;
  for (int i = 0; i < contacts.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *const_cast<btDispatcher&>(contacts).getManifoldByIndexInternal(i);
    const auto* a = static_cast<const Part*>(manifold.getBody0()->getUserPointer());
    const auto* b = static_cast<const Part*>(manifold.getBody1()->getUserPointer());
    if (a == nullptr || b == nullptr || (&a->body() != &body && &b->body() != &body)) continue;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const double depth = -static_cast<double>(manifold.getContactPoint(k).getDistance());
      if (depth > deepest.depth) deepest = {depth, a, b};
    }
  }
  return deepest;
}

}  // namespace

std::string likely_cause(const Body& body, const Part& part, const btDispatcher& contacts, int substeps) {
  const int more = std::min(2 * substeps, kMostSubsteps);
  const DeepContact overlap = deepest_overlap(body, contacts);
  if (overlap.depth > kOverlap) {
    return fmt::format(
        "likely cause: '{}/{}' and '{}/{}' overlap by {:.3g} m; move them apart, exclude the pair from "
        "collision, or try substeps = {}",
        overlap.a->body().name(), overlap.a->name(), overlap.b->body().name(), overlap.b->name(), overlap.depth, more);
  }
  double ratio = 1;
  const Joint* at = nullptr;
  for (const auto& joint : body.joints()) {
    const double a = joint->parent().mass();
    const double b = joint->child().mass();
    if (!(a > 0 && b > 0) || !(std::max(a / b, b / a) > ratio)) continue;
    ratio = std::max(a / b, b / a);
    at = joint.get();
  }
  if (ratio > kMassRatio) {
    return fmt::format(
        "likely cause: mass ratio {:.0f}:1 at joint '{}'; try substeps = {} or masses closer to each other", ratio,
        at->name(), more);
  }
  if (body.joints().empty()) {
    return "likely cause: a velocity, position, force or impulse that is too large; try a smaller one";
  }
  return fmt::format(
      "likely cause: the time step is too long for the forces and speeds of part '{}'; try substeps = {}, "
      "or smaller forces",
      part.name(), more);
}

}  // namespace limber
