// mocap_body: moves kinematic parts as the bones of a dancer.
#include <algorithm>
#include <cstdint>

#include "sim/behavior/behavior.h"
#include "sim/mocap/mocap_behavior.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

// The rotation that turns the z axis along a bone, by the shortest way from the present rotation.
Quat rotation_along(const Quat& before, const Vec3& bone) {
  const Vec3 from = before * Vec3(0, 0, 1);
  const double cosine = std::clamp(glm::dot(from, bone), -1.0, 1.0);
  const Vec3 axis = glm::cross(from, bone);
  if (glm::length(axis) < 1e-9) {
    return cosine > 0 ? before : glm::normalize(quat_axis(before * Vec3(1, 0, 0), kPi) * before);
  }
  return glm::normalize(quat_axis(normalized(axis), fixed::acos(cosine)) * before);
}

class MocapBody final : public Behavior {
 public:
  enum Parameter : std::uint32_t { source };

  void step(double) override {
    const MocapSource* const dancer = mocap_source(world(), number(source));
    if (dancer == nullptr) return;
    for (Part* part : parts()) {
      const MocapJoint* const joint = dancer->find(part->name());
      if (joint == nullptr || !joint->placed() || part->motion() != PartMotion::kinematic) continue;
      const MocapJoint* const parent =
          joint->parent() < 0 ? nullptr : dancer->joints()[static_cast<std::size_t>(joint->parent())].get();
      if (parent == nullptr || !parent->placed()) {
        part->set_pose(joint->pose());
        continue;
      }
      const Vec3 start = parent->pose().position;
      const Vec3 bone = joint->pose().position - start;
      const Quat before = part->pose().rotation;
      part->set_pose({start + bone / 2.0, bone == Vec3(0) ? before : rotation_along(before, normalized(bone))});
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<MocapBody>(
      "mocap_body",
      "Moves kinematic parts as the bones of a dancer: each from the parent of the joint of its name "
      "to this joint.",
      BehaviorTargets::parts, {mocap_source_number()});
});

}  // namespace
}  // namespace limber::sim
