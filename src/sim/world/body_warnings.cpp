// BodyWarnings: conditions and texts of the warnings.
#include "sim/world/body_warnings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/bullet/rotation_step.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

void BodyWarnings::warn_static_velocity(std::string_view subject) {
  if (std::exchange(state_.static_velocity, true)) return;
  log_warning("body '{}': {} can't move, so a velocity has no effect; ignored (reported once). Use a box instead.",
              body_.name(), subject);
}

void BodyWarnings::note(const Part& part) { is_clamped_ = is_clamped_ || bullet::clamped_speed(part.rigid()) > 0; }

void BodyWarnings::note(const Joint& joint) {
  const bullet::JointConstraint& constraint = joint.constraint();
  has_joint_problem_ =
      has_joint_problem_ || constraint.drives().spring_limited() || constraint.drives().target_outside();
}

void BodyWarnings::warn_clamped() {
  if (!std::exchange(is_clamped_, false) || std::exchange(state_.clamped, true)) return;
  const auto clamped_of = [](const std::unique_ptr<Part>& part) { return bullet::clamped_speed(part->rigid()); };
  const Part& part = **std::ranges::max_element(body_.parts(), {}, clamped_of);
  const World& world = body_.world();
  const double allowed = bullet::kMaxRotationPerStep * world.substeps() / world.timestep();
  const double excess = bullet::clamped_speed(part.rigid());
  const double requested = std::max(glm::length(part.angular_velocity()), allowed + excess);
  log_warning(
      "part '{}/{}': rotation of {:.4g} rad/s is clamped by {:.4g} rad/s, since it exceeds 45 degrees per substep; "
      "about {} substeps would allow it (reported once per body)",
      body_.name(), part.name(), requested, excess,
      std::ceil(requested * world.timestep() / bullet::kMaxRotationPerStep));
}

void BodyWarnings::warn_joints() {
  if (!std::exchange(has_joint_problem_, false)) return;
  for (const auto& joint : body_.joints()) {
    if (joint->motor() == nullptr) continue;
    if (joint->constraint().drives().spring_limited()) joint->motor()->warn_capped();
    if (joint->constraint().drives().target_outside()) joint->motor()->warn_target_outside();
  }
}

void BodyWarnings::log() {
  warn_clamped();
  warn_joints();
  for (const Joint* follower : body_.followers()) {
    bullet::GearConstraint& gear = *follower->mimic_gear();
    if (!gear.is_slipping() || !gear.report_slip()) continue;
    log_warning(
        "joint '{}/{}' is {:.3g} away from the position set by its leader '{}': limits, locks or contacts block it. "
        "Widen its limits or keep the leader within its range",
        body_.name(), follower->name(), std::abs(gear.error()), follower->spec().mimic->leader);
  }
}

void BodyWarnings::serialize(Archive& archive) { archive.serialize(state_); }

}  // namespace limber::sim
