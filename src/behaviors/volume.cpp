// volume: pushes parts apart, two by two, so that a body keeps its volume.
#include "sim/behavior.h"
#include "sim/behavior_rows.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class Volume final : public Behavior {
 public:
  enum Parameter : std::uint32_t { max_dist, min_amp, max_amp, app_interval };

  void step(double) override {
    if (!due(app_interval)) return;
    for (std::size_t i = 0; i + 1 < parts().size(); i += 2) push_apart(*parts()[i], *parts()[i + 1]);
  }

 private:
  void push_apart(Part& first, Part& second) const {
    const Vec3 way = second.center() - first.center();
    const double d = glm::length(way);
    const double far = number(max_dist);
    if (d == 0 || d > far) return;
    const double from = number(min_amp);
    const Vec3 force = way / d * (from + (number(max_amp) - from) * (1 - d / far));
    first.apply_force(-force);
    second.apply_force(force);
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of<Volume>(
      "volume", "Pushes parts apart, two by two in the order in which they are named.", BehaviorTargets::pairs,
      {distance("max_dist", 1, "Nothing acts beyond this."), load("min_amp", "N", 0, "Force at max_dist."),
       load("max_amp", "N", 10, "Force close to each other; below 0: towards each other."), rows::app_interval()});
});

}  // namespace
}  // namespace limber
