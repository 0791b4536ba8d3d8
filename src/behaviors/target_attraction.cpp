// target_attraction: pulls each part towards a point.
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class TargetAttraction final : public Behavior {
 public:
  enum Parameter : std::uint32_t { target_pos, min_dist, max_dist, min_amp, max_amp, app_interval };

  void step(double) override {
    if (!due(app_interval)) return;
    const double far = number(max_dist);
    const double from = number(min_amp);
    for (Part* part : parts()) {
      const Vec3 way = vec(target_pos) - part->center();
      const double d = glm::length(way);
      if (d == 0 || d > far || d < number(min_dist)) continue;
      part->apply_force(way / d * (from + (number(max_amp) - from) * d / far));
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<TargetAttraction>(
      "target_attraction", "Pulls each part towards a point.", BehaviorTargets::parts,
      {vec3("target_pos", "m", {0, 0, 0}, -kMostDistance, kMostDistance, "The point, world."),
       distance("min_dist", 0, "Nothing acts nearer than this"), distance("max_dist", 10, "or further than this."),
       load("min_amp", "N", 0, "Force close to the point; below 0: away from it."),
       load("max_amp", "N", 10, "Force at max_dist."), rows::app_interval()});
});

}  // namespace
}  // namespace limber
