// alignment: accelerates each part towards the motion of its neighbors in other bodies.
#include <algorithm>

#include "sim/behavior/common_properties.h"
#include "sim/behavior/neighbor_behavior.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

Vec3 to_vec3(const float* v) { return {v[0], v[1], v[2]}; }

// Limits a gain so that one tick changes the velocity of an inertia by at most the difference; more would overshoot
// and diverge.
double limited_gain(double gain, double inertia, double dt) { return std::clamp(gain, -inertia / dt, inertia / dt); }

// Limits the gain about each principal axis separately: a thin part allows less about its long axis than across it.
Vec3 limited_torque(const Part& part, double mass, double gain, const Vec3& spin, double dt) {
  const Vec3 inertia = mass * part.geometry()->unit_inertia;
  const Quat axes = part.principal_axes();
  Vec3 local = glm::conjugate(axes) * spin;
  for (int i = 0; i < 3; i++) local[i] *= limited_gain(gain, inertia[i], dt);
  return axes * local;
}

class Alignment final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { linear_amount = first_specific, angular_amount, amount };

 private:
  unsigned needed_means() const override { return kWantVelocity; }

  void apply(const MemberInput& member) const override {
    const double min_distance = member.values[min_dist];
    const double max_distance = member.values[max_dist];
    const double linear = member.values[amount] * member.values[linear_amount];
    const double angular = member.values[amount] * member.values[angular_amount];
    for (std::size_t i = 0; i < member.parts.size(); i++) {
      if (member.means[i].count == 0) continue;
      ForceAccumulators::Wrench& wrench = member.wrench(i);
      const double s = std::clamp(
          1 - (glm::length(to_vec3(member.means[i].offset)) - min_distance) / (max_distance - min_distance), 0.0, 1.0);
      wrench.force += limited_gain(linear * s, member.mass(i), member.dt) * to_vec3(member.means[i].velocity);
      const double gain = angular * s;
      const Vec3 spin = to_vec3(member.means[i].angular_velocity);
      const bool stable = std::abs(gain) * member.dt <= member.min_inertia(i);
      wrench.torque += stable ? gain * spin : limited_torque(*member.parts[i], member.mass(i), gain, spin, member.dt);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create_group<Alignment>(
      "alignment", "Accelerates each part towards the motion of its neighbors in other bodies.",
      {distance("min_dist", 0, "Minimal distance of neighbors."),
       distance("max_dist", 10, "Maximal distance of neighbors."),
       load("linear_amount", "N·s/m", 1,
            "Force per m/s of difference, limited to the force that removes it in one tick."),
       load("angular_amount", "N·m·s/rad", 1,
            "Torque per rad/s of difference, limited to the torque that removes it in one tick."),
       load("amount", "", 1, "Factor on both; negative: away from the neighbors' motion.")});
});

}  // namespace
}  // namespace limber::sim
