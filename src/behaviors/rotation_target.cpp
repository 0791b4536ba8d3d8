// rotation_target: leads servos and springs towards angles, a step at a time.
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/motor.h"

namespace limber {
namespace {

using namespace rows;

class RotationTarget final : public Behavior {
 public:
  enum Parameter : std::uint32_t { target, speed, app_interval };

  void step(double) override {
    if (!due(app_interval)) return;
    for (Motor* motor : motors()) motor->lead_to(vec(target), number(speed));
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<RotationTarget>(
      "rotation_target", "Leads servos and springs towards angles, a step at a time.", BehaviorTargets::motors,
      {vec3("target", "rad", {0, 0, 0}, -1e4, 1e4,
            "About the joint's axes, in its own order; z is the own axis. On a free axis it goes the shorter way "
            "round."),
       number("speed", "rad", 0.1, 0, 1e4,
              "How far ahead of the joint the servo or spring is set, at each application."),
       rows::app_interval()});
});

}  // namespace
}  // namespace limber
