// separation: keeps each part away from its neighbours in other bodies.
#include "sim/behavior_rows.h"
#include "sim/neighbor_behavior.h"
#include "sim/part.h"

namespace limber {
namespace {

using namespace rows;

class Separation final : public NeighborBehavior {
 public:
  enum Parameter : std::uint32_t { amount = first_own };

 private:
  unsigned wants() const override { return kWantPush; }

  void act(const Share& own) const override {
    const double strength = own.values[amount];
    for (std::size_t i = 0; i < own.parts.size(); i++) {
      if (own.means[i].count == 0) continue;
      const float* push = own.means[i].push;
      own.load(i).force -= strength * Vec3(push[0], push[1], push[2]);
    }
  }
};

const BuiltInBehavior registered([] {
  return BehaviorType::of_group<Separation>(
      "separation", "Keeps each part away from its neighbours in other bodies, the nearest most.",

      {distance("min_dist", 0, "Neighbours are further away than this"),
       distance("max_dist", 1, "and nearer than this."),
       load("amount", "N", 1, "Force of a neighbour close by; below 0: towards them.")});
});

}  // namespace
}  // namespace limber
