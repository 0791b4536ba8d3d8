// Access to motion capture for behaviors.
#include "sim/mocap/mocap_behavior.h"

#include <algorithm>
#include <utility>

#include "sim/mocap/mocap_list.h"
#include "sim/world/world.h"

namespace limber::sim {

const MocapSource* mocap_source(const World& world, double number) {
  const auto list = world.sensing().mocap().list();
  const auto index = static_cast<std::size_t>(number);
  return index == 0 || index > list.size() ? nullptr : list[index - 1].get();
}

const MocapJoint* mocap_joint(const World& world, double source, double joint) {
  const MocapSource* const of = mocap_source(world, source);
  const auto index = static_cast<std::size_t>(joint);
  if (of == nullptr || index == 0 || index > of->joints().size()) return nullptr;
  const MocapJoint& found = *of->joints()[index - 1];
  return found.placed() ? &found : nullptr;
}

double mocap_turn(const MocapJoint& joint, int axis) {
  const Quat& q = joint.local_rotation();
  const Vec3 about(q.x, q.y, q.z);
  return std::remainder(2 * fixed::atan2(about[axis], q.w), 2 * kPi);
}

double mocap_bend(const MocapJoint& joint) {
  const auto joints = joint.source().joints();
  const auto child = std::ranges::find_if(joints, [&](const auto& each) {
    return each->parent() >= 0 && joints[static_cast<std::size_t>(each->parent())].get() == &joint && each->placed();
  });
  if (joint.parent() < 0 || child == joints.end()) return 0;
  const Vec3 at = joint.pose().position;
  const Vec3 before = normalized(at - joints[static_cast<std::size_t>(joint.parent())]->pose().position);
  const Vec3 after = normalized((*child)->pose().position - at);
  return fixed::atan2(glm::length(glm::cross(before, after)), glm::dot(before, after));
}

Property mocap_source_number() {
  return properties::integer("source", 1, 1, 64, "Number of the source: the number of a mocap.");
}

Property mocap_joint_number(std::string name, double initial, std::string doc) {
  return properties::integer(std::move(name), initial, initial == 0 ? 0 : 1, 256, std::move(doc));
}

}  // namespace limber::sim
