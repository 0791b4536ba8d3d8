// cohesion: draws each part towards the middle of its neighbours in other bodies.
#include <algorithm>

#include "sim/behavior_rows.h"
#include "sim/neighbor_behavior.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class Cohesion final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { amount = first_own };

 private:
  unsigned wants() const override { return 0; }

  void act(const Share& own) const override {
    const double near = own.values[min_dist];
    const double far = own.values[max_dist];
    const double strength = own.values[amount];
    for (std::size_t i = 0; i < own.parts.size(); i++) {
      if (own.means[i].count == 0) continue;
      const Vec3 way(own.means[i].offset[0], own.means[i].offset[1], own.means[i].offset[2]);
      const double s = near > 0 ? std::clamp((glm::length(way) - near) / (far - near), 0.0, 1.0) : 1;
      own.load(i).force += strength * s * normalized(way);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of_group<Cohesion>("cohesion",
                                          "Draws each part towards the middle of its neighbours in other bodies.",
                                          {distance("min_dist", 0, "Neighbours are further away than this"),
                                           distance("max_dist", 10, "and nearer than this."),
                                           load("amount", "N", 1, "Force; below 0: away from the neighbours.")});
});

}  // namespace
}  // namespace limber
