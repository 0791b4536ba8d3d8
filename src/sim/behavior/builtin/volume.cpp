// volume: pushes the two parts of each pair apart, so that a body keeps its volume.
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Volume final : public Behavior {
 public:
  enum Parameter : std::uint32_t { max_dist, min_amp, max_amp, app_interval };

  void step(double) override {
    if (!interval_elapsed(app_interval)) return;
    for (std::size_t i = 0; i + 1 < parts().size(); i += 2) push_apart(*parts()[i], *parts()[i + 1]);
  }

 private:
  void push_apart(Part& first, Part& second) const {
    const Vec3 offset = second.center() - first.center();
    const double distance = glm::length(offset);
    const double max_distance = number(max_dist);
    if (distance == 0 || distance > max_distance) return;
    const double far_force = number(min_amp);
    const Vec3 force = offset / distance * (far_force + (number(max_amp) - far_force) * (1 - distance / max_distance));
    first.apply_force(-force);
    second.apply_force(force);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<Volume>(
      "volume", "Pushes the two parts of each pair apart; pairs are in the order in which the parts are named.",
      BehaviorTargets::pairs,
      {distance("max_dist", 1, "Maximal distance at which it acts."), load("min_amp", "N", 0, "Force at max_dist."),
       load("max_amp", "N", 10, "Force at distance 0; negative: towards each other."), properties::app_interval()});
});

}  // namespace
}  // namespace limber::sim
