// random_torque: turns each part by a torque that is drawn for it, anew from time to time.
#include <vector>

#include "base/key_bytes.h"
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class RandomTorque final : public Behavior {
 public:
  enum Parameter : std::uint32_t { min_torque, max_torque, scale, rand_interval, app_interval };

  void start() override { drawn_.assign(parts().size(), Vec3(0)); }
  void pass_memory(KeyBytes& key) override { key.pass(drawn_); }

  void step(double) override {
    if (due(rand_interval)) {
      for (Vec3& torque : drawn_) torque = random_between(vec(min_torque), vec(max_torque));
    }
    if (!due(app_interval)) return;
    const double by = number(scale);
    for (std::size_t i = 0; i < drawn_.size(); i++) parts()[i]->apply_torque(by * drawn_[i]);
  }

 private:
  std::vector<Vec3> drawn_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<RandomTorque>(
      "random_torque", "Turns each part by a torque of its own that is drawn anew from time to time.",
      BehaviorTargets::parts,
      {load3("min_torque", "N·m", {-1, -1, -1}, "One corner of the box that torques are drawn from, world axes."),
       load3("max_torque", "N·m", {1, 1, 1}, "The other corner."),
       load("scale", "", 1, "What the torque is multiplied by; acts at once."), rows::rand_interval(),
       rows::app_interval()});
});

}  // namespace
}  // namespace limber
