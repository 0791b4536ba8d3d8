// cohesion: pulls each part towards the center of its neighbors in other bodies.
#include <algorithm>

#include "sim/behavior/common_properties.h"
#include "sim/behavior/neighbor_behavior.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Cohesion final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { amount = first_specific };

 private:
  unsigned needed_means() const override { return 0; }

  void apply(const MemberInput& member) const override {
    const double min_distance = member.values[min_dist];
    const double max_distance = member.values[max_dist];
    const double strength = member.values[amount];
    for (std::size_t i = 0; i < member.parts.size(); i++) {
      if (member.means[i].count == 0) continue;
      const Vec3 offset(member.means[i].offset[0], member.means[i].offset[1], member.means[i].offset[2]);
      const double s = min_distance > 0
                           ? std::clamp((glm::length(offset) - min_distance) / (max_distance - min_distance), 0.0, 1.0)
                           : 1;
      member.wrench(i).force += strength * s * normalized(offset);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create_group<Cohesion>("cohesion",
                                              "Pulls each part towards the center of its neighbors in other bodies.",
                                              {distance("min_dist", 0, "Minimal distance of neighbors."),
                                               distance("max_dist", 10, "Maximal distance of neighbors."),
                                               load("amount", "N", 1, "Force; negative: away from the neighbors.")});
});

}  // namespace
}  // namespace limber::sim
