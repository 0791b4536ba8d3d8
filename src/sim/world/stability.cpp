// StabilityCheck: limits of speed, rotation and distance, and the diagnosis of their violation.
#include "sim/world/stability.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/memory/archive.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/rotation_step.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr double kMaxSpeed = 500;          // m/s
constexpr double kMaxTumblingRate = 1000;  // rad/s, about an axis that is neither a driven joint's nor a principal axis
constexpr double kMaxRotationRate = 2e4;   // rad/s, about any axis: more than any property can request
constexpr double kMaxDistance = 1e4;       // m, from the origin

/// Contacts deeper than this, in m, count as an overlap; a mass ratio of jointed parts above kMassRatio is a likely
/// cause.
constexpr double kOverlap = 0.002;
constexpr double kMassRatio = 500;
constexpr int kMaxSubsteps = 1000;

double squared(const btVector3& v) {
  const Vec3 d = bullet::from_bt(v);
  return glm::dot(d, d);
}

}  // namespace

const char* find_instability(const btRigidBody& part, double h) {
  const double speed = squared(part.getLinearVelocity());
  const double spin = squared(part.getAngularVelocity());
  const double distance = squared(part.getWorldTransform().getOrigin());
  if (speed < kMaxSpeed * kMaxSpeed && spin < kMaxTumblingRate * kMaxTumblingRate &&
      distance < kMaxDistance * kMaxDistance) {
    return nullptr;
  }
  if (!std::isfinite(speed) || !std::isfinite(spin) || !std::isfinite(distance))
    return "has a position or velocity that is not a number";
  if (speed >= kMaxSpeed * kMaxSpeed) return "is faster than 500 m/s";
  if (distance >= kMaxDistance * kMaxDistance) return "is farther than 10 km from the origin";
  if (spin >= kMaxRotationRate * kMaxRotationRate) return "rotates faster than 20000 rad/s";
  return glm::length(bullet::tumbling_velocity(part, h)) < kMaxTumblingRate ? nullptr
                                                                            : "tumbles faster than 1000 rad/s";
}

namespace {

// The deepest contact of a body: its depth (m) and the two parts.
struct DeepContact {
  double depth = 0;
  const Part* a = nullptr;
  const Part* b = nullptr;
};

DeepContact deepest_overlap(const Body& body, btDispatcher& contacts) {
  DeepContact deepest;
  for (int i = 0; i < contacts.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *contacts.getManifoldByIndexInternal(i);
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

std::string likely_cause(const Body& body, const Part& part) {
  const int suggested_substeps = std::min(2 * body.world().substeps(), kMaxSubsteps);
  const DeepContact overlap = deepest_overlap(body, *body.world().bullet().getDispatcher());
  if (overlap.depth > kOverlap) {
    return fmt::format(
        "likely cause: '{}/{}' and '{}/{}' overlap by {:.3g} m; move them apart, exclude the pair from "
        "collision, or try substeps = {}",
        overlap.a->body().name(), overlap.a->name(), overlap.b->body().name(), overlap.b->name(), overlap.depth,
        suggested_substeps);
  }
  double ratio = 1;
  const Joint* worst_joint = nullptr;
  for (const auto& joint : body.joints()) {
    const double a = joint->parent().mass();
    const double b = joint->child().mass();
    if (!(a > 0 && b > 0) || !(std::max(a / b, b / a) > ratio)) continue;
    ratio = std::max(a / b, b / a);
    worst_joint = joint.get();
  }
  if (ratio > kMassRatio) {
    return fmt::format(
        "likely cause: mass ratio {:.0f}:1 at joint '{}'; try substeps = {} or masses closer to each other", ratio,
        worst_joint->name(), suggested_substeps);
  }
  if (body.joints().empty()) {
    return "likely cause: a velocity, position, force or impulse that is too large; try a smaller one";
  }
  return fmt::format(
      "likely cause: the time step is too long for the forces and speeds of part '{}'; try substeps = {}, "
      "or smaller forces",
      part.name(), suggested_substeps);
}

void StabilityCheck::check_parts(double h) {
  if (!world_.bullet().is_unstable()) return;
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      const char* const instability = part->is_static() ? nullptr : find_instability(part->rigid(), h);
      if (instability == nullptr) continue;
      restore(*body, *part, fmt::format("part '{}' {}", part->name(), instability));
      break;
    }
  }
}

void StabilityCheck::check_joints(Body& body) {
  const Joint* const separated = body.recovery().consume_separated_joint();
  if (separated == nullptr) return;
  restore(body, separated->child(),
          fmt::format("joint '{}' has come apart by {:.3g} m", separated->name(), separated->gap()));
}

void StabilityCheck::restore(Body& body, const Part& part, const std::string& instability) {
  state_.body_restored = true;
  if (body.recovery().restore_good_pose(part, instability)) state_.events++;
}

void StabilityCheck::end_tick() {
  if (!std::exchange(state_.body_restored, false)) return;
  world_.flush();
  for (const auto& body : world_.bodies()) body->recovery().finish_restore();
}

void StabilityCheck::serialize(Archive& archive) { archive.serialize(state_); }

}  // namespace limber::sim
