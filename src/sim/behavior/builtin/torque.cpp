// torque: turns every part about one axis.
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Torque final : public Behavior {
 public:
  enum Parameter : std::uint32_t { torque, scale, app_interval };

  void step(double) override {
    if (!interval_elapsed(app_interval)) return;
    const Vec3 scaled_torque = number(scale) * vec(torque);
    for (Part* part : parts()) part->apply_torque(scaled_torque);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<Torque>("torque", "Applies a torque to every part.", BehaviorTargets::parts,
                                      {load3("torque", "N·m", {0, 0, 0}, "Torque, world axes."),
                                       load("scale", "", 1, "Factor on the torque."), app_interval()});
});

}  // namespace
}  // namespace limber::sim
