// Body: its trees of parts, each of which stands on its own, and start poses that another body tells.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "sim/body.h"

namespace limber {

std::vector<std::size_t> Body::trees() const {
  const std::size_t count = parts_.size();
  std::unordered_map<const Part*, std::size_t> number;
  std::vector<std::size_t> hangs_on(count);
  for (std::size_t i = 0; i < count; i++) number[parts_[i].get()] = hangs_on[i] = i;
  for (const auto& joint : joints_) {
    const std::size_t child = number[&joint->child()];
    if (hangs_on[child] == child) hangs_on[child] = number[&joint->parent()];
  }
  std::vector<std::size_t> first(count);
  for (std::size_t i = 0; i < count; i++) {
    std::size_t at = i;
    for (std::size_t steps = 0; steps < count && hangs_on[at] != at; steps++) at = hangs_on[at];
    // a ring of joints has no end: the least of its parts counts as one
    first[i] = at;
    for (std::size_t on = hangs_on[at]; on != at; on = hangs_on[on]) first[i] = std::min(first[i], on);
  }
  return first;
}

void Body::move_tree(std::size_t first, const Pose& pose) {
  const std::vector<std::size_t> tree = trees();
  const Pose moved = pose * parts_[first]->pose().inverse();
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (tree[i] == first) parts_[i]->set_pose(i == first ? pose : moved * parts_[i]->pose());
  }
}

void Body::take_start_pose(const Body& other) {
  for (std::size_t i = 0; i < other.parts_.size(); i++) parts_[i]->set_start_pose(other.parts_[i]->pose());
  for (std::size_t i = 0; i < other.joints_.size(); i++) joints_[i]->take_start(*other.joints_[i]);
}

bool Body::settle_joints() {
  if (!std::exchange(moved_, false)) return false;
  for (const auto& joint : joints_) joint->read_anew();
  return true;
}

}  // namespace limber
