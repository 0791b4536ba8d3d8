// random_force: applies a random force to each part, with a new direction and magnitude at regular intervals.
#include <vector>

#include "base/memory/archive.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class RandomForce final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_dir, max_dir, min_amp, max_amp, rand_interval, app_interval };

  void start() override { forces_.assign(parts().size(), Vec3(0)); }
  void serialize(Archive& archive) override { archive.serialize(forces_); }

  void step(double) override {
    if (interval_elapsed(rand_interval)) randomize();
    if (!interval_elapsed(app_interval)) return;
    for (std::size_t i = 0; i < forces_.size(); i++) parts()[i]->apply_force(forces_[i]);
  }

 private:
  void randomize() {
    for (Vec3& force : forces_) {
      const Vec3 dir = random_between(vec(min_dir), vec(max_dir));
      force = normalized(dir) * random_between(number(min_amp), number(max_amp));
    }
  }

  std::vector<Vec3> forces_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<RandomForce>(
      "random_force", "Applies a random force to each part, which changes at regular intervals.",
      BehaviorTargets::parts,
      {direction("min_dir", {-1, -1, -1}, "One corner of the box of random directions."),
       direction("max_dir", {1, 1, 1}, "The other corner."),
       load("min_amp", "N", 0, "Lower bound of the random force."),
       load("max_amp", "N", 10, "Upper bound of the random force."), properties::rand_interval(),
       properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
