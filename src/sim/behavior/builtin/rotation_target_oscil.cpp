// rotation_target_oscil: moves servos and springs to one of two rotations in turn.
#include <cstdint>

#include "base/memory/archive.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/motor.h"

namespace limber::sim {
namespace {

using namespace properties;

class RotationTargetOscil final : public Behavior {
 public:
  enum Parameter : std::uint32_t { target1, target2, speed, oscil_interval, app_interval };

  void start() override {
    at_second_ = false;
    started_ = false;
  }
  void serialize(Archive& archive) override { archive.serialize_all(at_second_, started_); }

  void step(double) override {
    // the interval elapses in the first step, too, which begins with the first target
    if (interval_elapsed(oscil_interval)) {
      at_second_ = started_ && !at_second_;
      started_ = true;
    }
    if (!interval_elapsed(app_interval)) return;
    for (Motor* motor : motors()) motor->step_towards(vec(at_second_ ? target2 : target1), number(speed));
  }

 private:
  bool at_second_ = false;
  bool started_ = false;
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<RotationTargetOscil>(
      "rotation_target_oscil",
      "Moves servos and springs to one of two rotations, and at regular intervals to the other.",
      BehaviorTargets::motors,
      {vec3("target1", "rad", {0, 0, -1}, -1e4, 1e4,
            "First angles about the joint's axes; z is the own axis. Free axes take the shorter way."),
       vec3("target2", "rad", {0, 0, 1}, -1e4, 1e4, "Second angles about the joint's axes."),
       number("speed", "rad", 0.1, 0, 1e4,
              "Maximal lead of the target over the joint's angle, set at each application."),
       number("oscil_interval", "ms", 1000, 0, 1e9, "Simulated time from one target to the other."),
       properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
