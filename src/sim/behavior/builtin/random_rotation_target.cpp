// random_rotation_target: moves each servo and spring towards random angles, which change at regular intervals.
#include <vector>

#include "base/memory/archive.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/motor.h"

namespace limber::sim {
namespace {

using namespace properties;

class RandomRotationTarget final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_target, max_target, speed, rand_interval, app_interval };

  void start() override { targets_.assign(motors().size(), Vec3(0)); }
  void serialize(Archive& archive) override { archive.serialize(targets_); }

  void step(double) override {
    if (interval_elapsed(rand_interval)) {
      for (Vec3& target : targets_) target = random_between(vec(min_target), vec(max_target));
    }
    if (!interval_elapsed(app_interval)) return;
    for (std::size_t i = 0; i < targets_.size(); i++) motors()[i]->step_towards(targets_[i], number(speed));
  }

 private:
  std::vector<Vec3> targets_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<RandomRotationTarget>(
      "random_rotation_target", "Moves each servo and spring towards random angles, which change at regular intervals.",
      BehaviorTargets::motors,
      {vec3("min_target", "rad", {0, 0, 0}, -1e4, 1e4, "Lower bounds of the random angles about the joint's axes."),
       vec3("max_target", "rad", {0, 0, 0}, -1e4, 1e4,
            "Upper bounds of the random angles. Free axes take the shorter way."),
       number("speed", "rad", 0.1, 0, 1e4,
              "Maximal lead of the target over the joint's angle, set at each application."),
       properties::rand_interval(), properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
