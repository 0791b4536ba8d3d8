// random_force: pushes each part in a direction and as hard as is drawn for it, anew from time to time.
#include <vector>

#include "base/key_bytes.h"
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class RandomForce final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_dir, max_dir, min_amp, max_amp, rand_interval, app_interval };

  void start() override { drawn_.assign(parts().size(), Vec3(0)); }
  void pass_memory(KeyBytes& key) override { key.pass(drawn_); }

  void step(double) override {
    if (due(rand_interval)) draw();
    if (!due(app_interval)) return;
    for (std::size_t i = 0; i < drawn_.size(); i++) parts()[i]->apply_force(drawn_[i]);
  }

 private:
  void draw() {
    for (Vec3& force : drawn_) {
      const Vec3 dir = random_between(vec(min_dir), vec(max_dir));
      force = normalized(dir) * random_between(number(min_amp), number(max_amp));
    }
  }

  std::vector<Vec3> drawn_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<RandomForce>(
      "random_force", "Pushes each part in a direction of its own that is drawn anew from time to time.",
      BehaviorTargets::parts,
      {direction("min_dir", {-1, -1, -1}, "One corner of the box that directions are drawn from."),
       direction("max_dir", {1, 1, 1}, "The other corner."), load("min_amp", "N", 0, "The force is drawn from this"),
       load("max_amp", "N", 10, "to this."), rows::rand_interval(), rows::app_interval()});
});

}  // namespace
}  // namespace limber
