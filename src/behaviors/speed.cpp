// speed: drives each part to a speed, along the way that it goes.
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

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
  return BehaviorType::of<Speed>(
      "speed", "Drives each part to a speed, along the way that it goes; what stands still stays.",
      BehaviorTargets::parts,
      {number("speed", "m/s", 1, -1e4, 1e4, "The speed to reach."),
       load("amount", "N·s/m", 1, "Force for each m/s that is missing; below 0: away from that speed.")});
});

}  // namespace
}  // namespace limber
