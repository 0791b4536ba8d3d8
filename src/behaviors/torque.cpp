// torque: turns every part about one axis.
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class Torque final : public Behavior {
 public:
  enum Parameter : std::uint32_t { torque, scale, app_interval };

  void step(double) override {
    if (!due(app_interval)) return;
    const Vec3 load = number(scale) * vec(torque);
    for (Part* part : parts()) part->apply_torque(load);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<Torque>("torque", "Turns every part about one axis.", BehaviorTargets::parts,
                                  {load3("torque", "N·m", {0, 0, 0}, "About the world's axes."),
                                   load("scale", "", 1, "What torque is multiplied by."), app_interval()});
});

}  // namespace
}  // namespace limber
