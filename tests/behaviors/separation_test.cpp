// separation: F = −amount · mean of r̂_j · (1 − |r_j|/max_dist).
#include "behaviors/flock_rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Separation, PushesMoreStronglyFromNearParts) {
  Rig s;
  Part& one = s.single_ball({0, 0, 0});
  Part& two = s.single_ball({0.25, 0, 0});
  BehaviorGroup& group = s.add_group("separation");
  s.set(group.id(), "amount", {8});
  s.step_behaviors();
  expect_near(s.force(one), {-6, 0, 0}, 1e-6);
  expect_near(s.force(two), {6, 0, 0}, 1e-6);
}

TEST(Separation, CoincidentPartsHaveNoDirection) {
  Rig s;
  Part& one = s.single_ball({1, 2, 3});
  s.single_ball({1, 2, 3});
  s.add_group("separation");
  s.step_behaviors();
  expect_near(s.force(one), {0, 0, 0}, 0);
}

TEST(Separation, EqualsBruteForce) {
  for (const int parts : {1, 3}) {
    FlockRig s;
    s.fill(120, parts, 6);
    BehaviorGroup& group = s.add_group("separation");
    s.set(group.id(), "amount", {2.5});
    for (const auto& [min_distance, max_distance] :
         std::vector<std::pair<double, double>>{{0, 0.3}, {0, 1}, {0, 2.5}, {0.5, 1.5}, {0, 7}, {0, 1000}}) {
      s.set(group.id(), "min_dist", {min_distance});
      s.set(group.id(), "max_dist", {max_distance});
      for (Part* part : s.parts) s.clear(*part);
      s.step_behaviors();
      for (const Part* part : s.parts) {
        expect_near(s.force(*part), -2.5 * s.brute_force_means(*part, min_distance, max_distance).unit_sum, 2e-5,
                    std::to_string(max_distance));
      }
    }
  }
}

}  // namespace
}  // namespace limber::sim
