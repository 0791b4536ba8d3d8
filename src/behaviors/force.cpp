// force: pushes every part in one direction.
#include <algorithm>

#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class Force final : public Behavior {
 public:
  enum Parameter : std::uint32_t { dir, amp, max_amp, app_interval };

  void step(double) override {
    if (!due(app_interval)) return;
    const double most = number(max_amp);
    const Vec3 force = normalized(vec(dir)) * std::clamp(number(amp), -most, most);
    for (Part* part : parts()) part->apply_force(force);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<Force>(
      "force", "Pushes every part in one direction.", BehaviorTargets::parts,
      {direction("dir", {1, 0, 0}, "Where to, world; its length does not matter."),
       load("amp", "N", 0, "How hard; below 0: the other way."),
       number("max_amp", "N", 1e4, 0, kMostLoad, "What amp is held below, either way."), app_interval()});
});

}  // namespace
}  // namespace limber
