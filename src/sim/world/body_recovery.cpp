// BodyRecovery: saving and restoring of poses.
#include "sim/world/body_recovery.h"

#include <utility>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/surface_motion.h"
#include "sim/motion/part_motion.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/stability.h"
#include "sim/world/world.h"

namespace limber::sim {

void BodyRecovery::save_new_start_pose() {
  if (!std::exchange(state_.is_new, false)) return;
  for (const auto& part : body_.parts()) part->set_start_pose(part->pose());
  for (const auto& joint : body_.joints()) joint->save_start();
}

void BodyRecovery::save_start_pose(const Body& other) {
  for (std::size_t i = 0; i < other.parts().size(); i++) body_.parts()[i]->set_start_pose(other.parts()[i]->pose());
  for (std::size_t i = 0; i < other.joints().size(); i++) body_.joints()[i]->save_start(*other.joints()[i]);
}

void BodyRecovery::reset() {
  WorldTransaction& transaction = body_.world().transaction();
  if (transaction.first_in_call(saved_in_call_)) transaction.save_fields(state_.good_pose_count, state_.restored_once);
  for (const auto& part : body_.parts()) {
    teleport_part(*part, part->start_pose());
    part->set_velocity(Vec3(0), Vec3(0));
    part->clear_forces();
  }
  for (const auto& joint : body_.joints()) joint->restore_start();
  body_.world().behaviors().on_body_reset(body_);
  state_.restored_once = false;
  state_.good_pose_count = 0;
  body_.set_enabled(true);
}

void BodyRecovery::save_good_pose(Joint* separated) {
  separated_joint_ = separated;
  if (state_.restored_this_tick || separated != nullptr) return;
  const auto parts = body_.parts();
  state_.good_poses.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); i++) state_.good_poses[i] = parts[i]->pose();
  state_.good_pose_count = parts.size();
}

const Joint* BodyRecovery::consume_separated_joint() {
  const Joint* const separated = std::exchange(separated_joint_, nullptr);
  return state_.restored_this_tick ? nullptr : separated;
}

bool BodyRecovery::restore_good_pose(const Part& part, const std::string& instability) {
  bullet::IslandWorld& bullet = body_.world().bullet();
  const std::string cause = state_.restored_this_tick ? "" : likely_cause(body_, part);
  for (std::size_t i = 0; i < body_.parts().size(); i++) {
    Part& member = *body_.parts()[i];
    if (bullet::is_moving_static(member.rigid())) continue;
    member.set_pose(i < state_.good_pose_count ? state_.good_poses[i] : member.start_pose());
    member.set_velocity(Vec3(0), Vec3(0));
    apply_part_pose(member);
    apply_part_velocity(member);
    member.wake();  // together with the parts that touch it, since its contacts are removed below
    // the force that caused the instability would do so again in this tick's next substep
    member.rigid().clearForces();
    member.rigid().applyGravity();
    // without this, the contacts would warm-start from their previous impulses
    if (member.rigid().isInWorld()) {
      bullet.getPairCache()->cleanProxyFromPairs(member.rigid().getBroadphaseHandle(), bullet.getDispatcher());
    }
  }
  for (const auto& joint : body_.joints()) joint->update_from_parts();
  if (std::exchange(state_.restored_this_tick, true)) return false;  // reported in this tick already
  if (std::exchange(state_.restored_once, true)) {
    body_.set_enabled(false);
    log_warning("body '{}': {} again; the body is disabled (reset or enabled = true enables it); {}", body_.name(),
                instability, cause);
  } else {
    log_warning("body '{}': {}; the body is restored to its last good pose, at rest; {}", body_.name(), instability,
                cause);
  }
  return true;
}

void BodyRecovery::finish_restore() {
  if (!std::exchange(state_.restored_this_tick, false)) return;
  for (const auto& part : body_.parts()) part->rigid().clearForces();
}

void BodyRecovery::serialize(Archive& archive) {
  auto& [is_new, restored_this_tick, restored_once, good_pose_count, good_poses] = state_;
  archive.serialize_all(is_new, restored_this_tick, restored_once, good_pose_count, good_poses);
}

}  // namespace limber::sim
