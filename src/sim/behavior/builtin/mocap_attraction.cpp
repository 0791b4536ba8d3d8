// mocap_attraction: pulls each part towards a joint of a dancer, or onto a coil around a limb.
#include <cmath>

#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/mocap/mocap_behavior.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class MocapAttraction final : public Behavior {
 public:
  enum Parameter : std::uint32_t {
    source,
    joint,
    to_joint,
    stiffness,
    damping,
    max_force,
    max_dist,
    radius,
    turns,
    phase
  };

  void step(double) override {
    const MocapJoint* const from = mocap_joint(world(), number(source), number(joint));
    if (from == nullptr || from->confidence() <= 0) return;
    const MocapJoint* const to = mocap_joint(world(), number(source), number(to_joint));
    const Vec3 start = from->pose().position;
    const Vec3 along = to == nullptr ? Vec3(0) : to->pose().position - start;
    const Vec3 axis = along == Vec3(0) ? Vec3(0, 0, 1) : normalized(along);
    const Vec3 side = normalized(glm::cross(axis, std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 across = glm::cross(axis, side);
    const double count = static_cast<double>(parts().size());
    double index = 0;
    for (Part* part : parts()) {
      const double share = count > 1 ? index++ / (count - 1) : 0;
      const fixed::SinCos turn = fixed::sincos(number(phase) + 2 * kPi * number(turns) * share);
      const Vec3 target = start + along * share + (side * turn.cos + across * turn.sin) * number(radius);
      const Vec3 offset = target - part->center();
      if (glm::length(offset) > number(max_dist)) continue;
      Vec3 force = offset * number(stiffness) + (from->velocity() - part->linear_velocity()) * number(damping);
      if (const double size = glm::length(force); size > number(max_force)) force *= number(max_force) / size;
      part->apply_force(force * from->confidence());
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<MocapAttraction>(
      "mocap_attraction", "Pulls each part towards a joint of a dancer.", BehaviorTargets::parts,
      {mocap_source_number(), mocap_joint_number("joint", 1, "Number of the joint."),
       mocap_joint_number("to_joint", 0,
                          "Number of a second joint; the parts are spread from the first to it. 0: none."),
       number("stiffness", "N/m", 20, 0, kMaxLoad, "Force per distance."),
       number("damping", "N·s/m", 2, 0, kMaxLoad, "Force per velocity relative to the joint."),
       number("max_force", "N", 50, 0, kMaxLoad, "Largest force."),
       distance("max_dist", 100, "Largest distance at which it acts."),
       distance("radius", 0, "Distance from the line between the joints: with turns, a coil around a limb."),
       number("turns", "", 1, -1000, 1000, "Turns of the coil from its first part to its last one."),
       number("phase", "rad", 0, -1e6, 1e6, "Angle at which the coil begins.")});
});

}  // namespace
}  // namespace limber::sim
