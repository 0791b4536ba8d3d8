// Body: its kinematic trees, start poses, and the good poses that the stability check restores.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/log/log.h"
#include "sim/bullet/island_world.h"
#include "sim/world/body.h"
#include "sim/world/stability.h"
#include "sim/world/world.h"

namespace limber {

std::vector<std::size_t> Body::trees() const {
  const std::size_t count = parts_.size();
  std::unordered_map<const Part*, std::size_t> index;
  std::vector<std::size_t> parent(count);
  for (std::size_t i = 0; i < count; i++) index[parts_[i].get()] = parent[i] = i;
  for (const auto& joint : joints_) {
    const std::size_t child = index[&joint->child()];
    if (parent[child] == child) parent[child] = index[&joint->parent()];
  }
  std::vector<std::size_t> roots(count);
  for (std::size_t i = 0; i < count; i++) {
    std::size_t ancestor = i;
    for (std::size_t steps = 0; steps < count && parent[ancestor] != ancestor; steps++) ancestor = parent[ancestor];
    // a loop of joints has no root: use the lowest index in it
    roots[i] = ancestor;
    for (std::size_t next = parent[ancestor]; next != ancestor; next = parent[next])
      roots[i] = std::min(roots[i], next);
  }
  return roots;
}

void Body::move_tree(std::size_t root, const Pose& pose) {
  const std::vector<std::size_t> roots = trees();
  const Pose displacement = pose * parts_[root]->pose().inverse();
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (roots[i] == root) parts_[i]->set_pose(i == root ? pose : displacement * parts_[i]->pose());
  }
}

void Body::save_start_pose() {
  for (const auto& part : parts_) part->set_start_pose(part->pose());
  for (const auto& joint : joints_) joint->save_start();
}

void Body::save_start_pose(const Body& other) {
  for (std::size_t i = 0; i < other.parts_.size(); i++) parts_[i]->set_start_pose(other.parts_[i]->pose());
  for (std::size_t i = 0; i < other.joints_.size(); i++) joints_[i]->save_start(*other.joints_[i]);
}

bool Body::update_moved_joints() {
  if (!std::exchange(state_.joints_dirty, false)) return false;
  for (const auto& joint : joints_) joint->update_from_parts();
  return true;
}

void Body::save_good_pose() {
  state_.good_poses.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); i++) state_.good_poses[i] = parts_[i]->pose();
  state_.good_pose_count = parts_.size();
}

bool Body::restore_good_pose(const Part& part, const std::string& instability) {
  IslandWorld& bullet = world_.bullet();
  const std::string cause =
      state_.restored_this_tick ? "" : likely_cause(*this, part, *bullet.getDispatcher(), world_.substeps());
  for (std::size_t i = 0; i < parts_.size(); i++) {
    Part& member = *parts_[i];
    member.set_pose(i < state_.good_pose_count ? state_.good_poses[i] : member.start_pose());
    member.set_velocity(Vec3(0), Vec3(0));
    member.apply_pose();
    member.apply_velocity();
    member.wake();  // together with the parts that touch it, since its contacts are removed below
    // the force that caused the instability would do so again in this tick's next internal step
    member.rigid().clearForces();
    member.rigid().applyGravity();
    // without this, the contacts would warm-start from their previous impulses
    if (member.rigid().isInWorld()) {
      bullet.getPairCache()->cleanProxyFromPairs(member.rigid().getBroadphaseHandle(), bullet.getDispatcher());
    }
  }
  for (const auto& joint : joints_) joint->update_from_parts();
  if (std::exchange(state_.restored_this_tick, true)) return false;  // reported in this tick already
  if (std::exchange(state_.restored_once, true)) {
    set_enabled(false);
    log_warning("body '{}': {} again; the body is disabled (reset or enabled = true enables it); {}", name(),
                instability, cause);
  } else {
    log_warning("body '{}': {}; the body is restored to its last good pose, at rest; {}", name(), instability, cause);
  }
  return true;
}

void Body::finish_restore() {
  if (!std::exchange(state_.restored_this_tick, false)) return;
  for (const auto& part : parts_) part->rigid().clearForces();
}

}  // namespace limber
