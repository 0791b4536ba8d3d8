// Kinematics: decides for each part between a move to a pose, a motion at a velocity, and rest.
#include "sim/motion/kinematics.h"

#include <utility>

#include "sim/bullet/island_world.h"
#include "sim/bullet/surface_motion.h"
#include "sim/motion/part_motion.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {
namespace {

/// A part that would have to move faster to its new pose is teleported: the limit of the stability check, m/s.
constexpr double kMaxMoveSpeed = 500;

btTransform target_of(const Part& part) { return bullet::to_bt(part.pose() * part.geometry()->frame); }

bool has_velocity(const KinematicState& state) { return state.linear != Vec3(0) || state.angular != Vec3(0); }

void stop(Part& part) {
  part.rigid().setLinearVelocity(btVector3(0, 0, 0));
  part.rigid().setAngularVelocity(btVector3(0, 0, 0));
}

}  // namespace

void Kinematics::add(Part& part) {
  const std::size_t index = part.accumulator_index();
  if (index >= listed_.size()) listed_.resize(index + 1);
  if (listed_[index]) return;
  listed_[index] = true;
  parts_.push_back(&part);
}

void Kinematics::remove(const Part& part) {
  const std::size_t index = part.accumulator_index();
  if (index >= listed_.size() || !listed_[index]) return;
  listed_[index] = false;
  std::erase(parts_, &part);
}

bool Kinematics::moves_to_pose(const Part& part) const {
  const KinematicState& state = part.kinematic();
  if (!part.is_static() || is_plane(part) || !part.rigid().isInWorld() || state.teleports) return false;
  return part.motion() == PartMotion::kinematic || state.has_target ||
         (static_parts_move_ && world_.tick() > 0 && state.pose_tick == world_.tick());
}

void Kinematics::begin_tick(double seconds) {
  for (Part* const part : parts_) start(*part, seconds);
}

void Kinematics::start(Part& part, double seconds) {
  KinematicState& state = part.kinematic();
  const bool has_target = std::exchange(state.has_target, false);
  if (!part.is_static()) return;
  stop(part);
  if (!part.rigid().isInWorld()) return;
  bullet::KinematicBodies& bodies = world_.bullet().kinematic();
  if (has_target) {
    state.pose_tick = world_.tick() + 1;
    const btTransform to = target_of(part);
    if (to == part.rigid().getWorldTransform()) return;
    const bullet::KinematicMove move = bullet::move_to(part.rigid(), to, seconds);
    if (glm::length(move.linear) <= kMaxMoveSpeed) return bodies.add(move);
    place_part(part);
  } else if (has_velocity(state) && !world_.panic().on()) {
    bodies.add(bullet::move_at(part.rigid(), state.linear, state.angular, seconds));
  }
}

void Kinematics::place() {
  for (Part* const part : parts_) {
    if (std::exchange(part->kinematic().has_target, false)) place_part(*part);
  }
}

void Kinematics::end_tick() {
  for (Part* const part : parts_) {
    if (part->is_static() && part->rigid().isInWorld()) part->publish();
  }
  std::erase_if(parts_, [this](const Part* part) {
    const KinematicState& state = part->kinematic();
    const bool stays = part->is_static() && (has_velocity(state) || state.pose_tick == world_.tick() ||
                                             bullet::is_moving_static(part->rigid()));
    if (!stays) listed_[part->accumulator_index()] = false;
    return !stays;
  });
}

void Kinematics::restore() {
  parts_.clear();
  listed_.clear();
  count_motion_change();
  for (const auto& body : world_.bodies()) {
    for (const auto& part : body->parts()) {
      const KinematicState& state = part->kinematic();
      if (!part->is_static()) continue;
      if (has_velocity(state) || state.has_target || bullet::is_moving_static(part->rigid())) add(*part);
    }
  }
}

}  // namespace limber::sim
