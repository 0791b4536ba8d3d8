// rotation_target: moves servos and springs towards given angles step by step.
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/motor.h"

namespace limber::sim {
namespace {

using namespace properties;

class RotationTarget final : public Behavior {
 public:
  enum Parameter : std::uint32_t { target, speed, app_interval };

  void step(double) override {
    if (!interval_elapsed(app_interval)) return;
    for (Motor* motor : motors()) motor->step_towards(vec(target), number(speed));
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<RotationTarget>(
      "rotation_target", "Moves servos and springs towards given angles step by step.", BehaviorTargets::motors,
      {vec3("target", "rad", {0, 0, 0}, -1e4, 1e4,
            "Angles about the joint's axes, in its own order; z is the own axis. Free axes take the shorter way."),
       number("speed", "rad", 0.1, 0, 1e4,
              "Maximal lead of the target over the joint's angle, set at each application."),
       properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
