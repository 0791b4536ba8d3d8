// separation: pushes each part away from its neighbors in other bodies.
#include "sim/behavior/common_properties.h"
#include "sim/behavior/neighbor_behavior.h"
#include "sim/world/part.h"

namespace limber::sim {
namespace {

using namespace properties;

class Separation final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { amount = first_specific };

 private:
  unsigned needed_means() const override { return kWantSeparation; }

  void apply(const MemberInput& member) const override {
    const double strength = member.values[amount];
    for (std::size_t i = 0; i < member.parts.size(); i++) {
      if (member.means[i].count == 0) continue;
      const float* separation = member.means[i].separation;
      member.wrench(i).force -= strength * Vec3(separation[0], separation[1], separation[2]);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::create_group<Separation>(
      "separation", "Pushes each part away from its neighbors in other bodies, more strongly from near ones.",

      {distance("min_dist", 0, "Minimal distance of neighbors."),
       distance("max_dist", 1, "Maximal distance of neighbors."),
       load("amount", "N", 1, "Force of a neighbor at distance 0; negative: towards it.")});
});

}  // namespace
}  // namespace limber::sim
