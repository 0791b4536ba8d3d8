// random_rotation_target: leads each servo and spring towards angles that are drawn for it, anew from time to time.
#include <vector>

#include "base/key_bytes.h"
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/motor.h"

namespace limber {
namespace {

using namespace rows;

class RandomRotationTarget final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_target, max_target, speed, rand_interval, app_interval };

  void start() override { drawn_.assign(motors().size(), Vec3(0)); }
  void pass_memory(KeyBytes& key) override { key.pass(drawn_); }

  void step(double) override {
    if (due(rand_interval)) {
      for (Vec3& target : drawn_) target = random_between(vec(min_target), vec(max_target));
    }
    if (!due(app_interval)) return;
    for (std::size_t i = 0; i < drawn_.size(); i++) motors()[i]->lead_to(drawn_[i], number(speed));
  }

 private:
  std::vector<Vec3> drawn_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<RandomRotationTarget>(
      "random_rotation_target", "Leads each servo and spring towards angles of its own, drawn anew from time to time.",
      BehaviorTargets::motors,
      {vec3("min_target", "rad", {0, 0, 0}, -1e4, 1e4, "Angles are drawn from these, about the joint's axes,"),
       vec3("max_target", "rad", {0, 0, 0}, -1e4, 1e4, "to these. On free axes it goes the shorter way round."),
       number("speed", "rad", 0.1, 0, 1e4,
              "How far ahead of the joint the servo or spring is set, at each application."),
       rows::rand_interval(), rows::app_interval()});
});

}  // namespace
}  // namespace limber
