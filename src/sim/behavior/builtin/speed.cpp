// speed: accelerates each part to a given speed in its direction of motion.
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Speed final : public Behavior {
 public:
  enum Parameter : std::uint32_t { speed, amount };

  void step(double) override {
    for (Part* part : parts()) {
      const Vec3 velocity = part->linear_velocity();
      part->apply_force(number(amount) * (number(speed) - glm::length(velocity)) * normalized(velocity));
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<Speed>(
      "speed", "Accelerates each part to a speed in its direction of motion; parts at rest stay at rest.",
      BehaviorTargets::parts,
      {number("speed", "m/s", 1, -1e4, 1e4, "Target speed."),
       load("amount", "N·s/m", 1, "Force per m/s of difference; negative: away from that speed.")});
});

}  // namespace
}  // namespace limber::sim
