// random_torque: applies a random torque to each part, which changes at regular intervals.
#include <vector>

#include "base/memory/archive.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class RandomTorque final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_torque, max_torque, scale, rand_interval, app_interval };

  void start() override { torques_.assign(parts().size(), Vec3(0)); }
  void serialize(Archive& archive) override { archive.serialize(torques_); }

  void step(double) override {
    if (interval_elapsed(rand_interval)) {
      for (Vec3& torque : torques_) torque = random_between(vec(min_torque), vec(max_torque));
    }
    if (!interval_elapsed(app_interval)) return;
    const double factor = number(scale);
    for (std::size_t i = 0; i < torques_.size(); i++) parts()[i]->apply_torque(factor * torques_[i]);
  }

 private:
  std::vector<Vec3> torques_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<RandomTorque>(
      "random_torque", "Applies a random torque to each part, which changes at regular intervals.",
      BehaviorTargets::parts,
      {load3("min_torque", "N·m", {-1, -1, -1}, "One corner of the box of random torques, world axes."),
       load3("max_torque", "N·m", {1, 1, 1}, "The other corner."),
       load("scale", "", 1, "Factor on the torque; takes effect at once."), properties::rand_interval(),
       properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
