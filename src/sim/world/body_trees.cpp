// Body: its kinematic trees, and start poses copied from another body.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "sim/world/body.h"

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

void Body::save_start_pose(const Body& other) {
  for (std::size_t i = 0; i < other.parts_.size(); i++) parts_[i]->set_start_pose(other.parts_[i]->pose());
  for (std::size_t i = 0; i < other.joints_.size(); i++) joints_[i]->save_start(*other.joints_[i]);
}

bool Body::update_moved_joints() {
  if (!std::exchange(joints_dirty_, false)) return false;
  for (const auto& joint : joints_) joint->update_from_parts();
  return true;
}

}  // namespace limber
