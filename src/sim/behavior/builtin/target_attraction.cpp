// target_attraction: pulls each part towards a point.
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class TargetAttraction final : public Behavior {
 public:
  enum Parameter : std::uint32_t { target_pos, min_dist, max_dist, min_amp, max_amp, app_interval };

  void step(double) override {
    if (!interval_elapsed(app_interval)) return;
    const double max_distance = number(max_dist);
    const double near_force = number(min_amp);
    for (Part* part : parts()) {
      const Vec3 offset = vec(target_pos) - part->center();
      const double distance = glm::length(offset);
      if (distance == 0 || distance > max_distance || distance < number(min_dist)) continue;
      part->apply_force(offset / distance * (near_force + (number(max_amp) - near_force) * distance / max_distance));
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<TargetAttraction>(
      "target_attraction", "Pulls each part towards a point.", BehaviorTargets::parts,
      {vec3("target_pos", "m", {0, 0, 0}, -kMaxDistance, kMaxDistance, "Target point, world."),
       distance("min_dist", 0, "Minimal distance at which it acts."),
       distance("max_dist", 10, "Maximal distance at which it acts."),
       load("min_amp", "N", 0, "Force at distance 0; negative: away from the point."),
       load("max_amp", "N", 10, "Force at max_dist."), properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
