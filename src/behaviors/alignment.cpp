// alignment: gives each part the motion of its neighbours in other bodies.
#include <algorithm>

#include "sim/behavior_rows.h"
#include "sim/neighbor_behavior.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

Vec3 vec_of(const float* v) { return {v[0], v[1], v[2]}; }

// a gain that within a tick brings an inertia to the mean and no further: what is more would overshoot, and grow
double bounded(double gain, double inertia, double dt) { return std::clamp(gain, -inertia / dt, inertia / dt); }

// bounded about each principal axis by itself: a thin part takes less about its long axis than across
Vec3 bounded_torque(const Part& part, double mass, double gain, const Vec3& spin, double dt) {
  const Vec3 inertia = mass * part.geometry()->unit_inertia;
  const Quat axes = part.principal_axes();
  Vec3 own = glm::conjugate(axes) * spin;
  for (int i = 0; i < 3; i++) own[i] *= bounded(gain, inertia[i], dt);
  return axes * own;
}

class Alignment final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { linear_amount = first_own, angular_amount, amount };

 private:
  unsigned wants() const override { return kWantVelocity; }

  void act(const Share& own) const override {
    const double near = own.values[min_dist];
    const double far = own.values[max_dist];
    const double linear = own.values[amount] * own.values[linear_amount];
    const double angular = own.values[amount] * own.values[angular_amount];
    for (std::size_t i = 0; i < own.parts.size(); i++) {
      if (own.means[i].count == 0) continue;
      PartLoads::Load& load = own.load(i);
      const double s = std::clamp(1 - (glm::length(vec_of(own.means[i].offset)) - near) / (far - near), 0.0, 1.0);
      load.force += bounded(linear * s, own.mass(i), own.dt) * vec_of(own.means[i].velocity);
      const double gain = angular * s;
      const Vec3 spin = vec_of(own.means[i].spin);
      const bool stable = std::abs(gain) * own.dt <= own.least_inertia(i);
      load.torque += stable ? gain * spin : bounded_torque(*own.parts[i], own.mass(i), gain, spin, own.dt);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of_group<Alignment>(
      "alignment", "Gives each part the motion of its neighbours in other bodies.",
      {distance("min_dist", 0, "Neighbours are further away than this"),
       distance("max_dist", 10, "and nearer than this."),
       load("linear_amount", "N·s/m", 1, "Force for each m/s that differs; never more than ends the difference."),
       load("angular_amount", "N·m·s/rad", 1,
            "Torque for each rad/s that differs; never more than ends the difference."),
       load("amount", "", 1, "What both are multiplied by; below 0: away from the neighbours' motion.")});
});

}  // namespace
}  // namespace limber
