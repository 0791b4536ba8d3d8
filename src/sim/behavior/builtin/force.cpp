// force: pushes every part in one direction.
#include <algorithm>

#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Force final : public Behavior {
 public:
  enum Parameter : std::uint32_t { dir, amp, max_amp, app_interval };

  void step(double) override {
    if (!interval_elapsed(app_interval)) return;
    const double limit = number(max_amp);
    const Vec3 force = normalized(vec(dir)) * std::clamp(number(amp), -limit, limit);
    for (Part* part : parts()) part->apply_force(force);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<Force>(
      "force", "Applies a force to every part.", BehaviorTargets::parts,
      {direction("dir", {1, 0, 0}, "Direction, world; its length has no influence."),
       load("amp", "N", 0, "Force; negative: opposite direction."),
       number("max_amp", "N", 1e4, 0, kMaxLoad, "Limit of the magnitude of amp."), app_interval()});
});

}  // namespace
}  // namespace limber::sim
