// cohesion: m = mean offset of the neighbors, s = clamp((|m| − min)/(max − min), 0, 1) if min > 0, else 1; F = amount
// · s · m̂.
#include "behaviors/flock_rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Cohesion, PullsTwoPartsTogether) {
  Rig s;
  Part& one = s.single_ball({0, 0, 0});
  Part& two = s.single_ball({0, 3, 4});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "amount", {10});
  s.step_behaviors();
  expect_near(s.force(one), {0, 6, 8}, 1e-6);
  expect_near(s.force(two), {0, -6, -8}, 1e-6);
}

TEST(Cohesion, NegativeAmountPushesAway) {
  Rig s;
  Part& one = s.single_ball({0, 0, 0});
  s.single_ball({2, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "amount", {-3});
  s.step_behaviors();
  expect_near(s.force(one), {-3, 0, 0}, 1e-6);
}

TEST(Cohesion, IgnoresPartsOfTheSameBody) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  s.ball(body, {1, 0, 0});
  Part& other = s.single_ball({0, 2, 0});
  s.add_group("cohesion");
  s.step_behaviors();
  expect_near(s.force(one), {0, 1, 0}, 1e-6);
  expect_near(s.force(other), unit({0.5, -2, 0}), 1e-6);
}

TEST(Cohesion, DistancesAreInclusive) {
  Rig s;
  Part& one = s.single_ball({0, 0, 0});
  Part& two = s.single_ball({2, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  const auto pull = [&](double min_distance, double max_distance) {
    s.set(group.id(), "min_dist", {min_distance});
    s.set(group.id(), "max_dist", {max_distance});
    for (Part* part : {&one, &two}) s.clear(*part);
    s.step_behaviors();
    return s.force(one).x;
  };
  EXPECT_EQ(pull(0, 1.99), 0);
  EXPECT_NEAR(pull(0, 2), 1, 1e-6);
  EXPECT_NEAR(pull(1, 3), 0.5, 1e-6);  // s = (2 − 1)/(3 − 1)
  EXPECT_NEAR(pull(2, 3), 0, 1e-6);    // s = 0
  EXPECT_EQ(pull(2.01, 3), 0);
  EXPECT_EQ(pull(3, 2), 0);
  EXPECT_EQ(pull(2, 2), 0);
  EXPECT_EQ(pull(0, 0), 0);
}

TEST(Cohesion, SymmetricNeighborsCancelOut) {
  Rig s;
  Part& middle = s.single_ball({0, 0, 0});
  s.single_ball({1, 0, 0});
  s.single_ball({-1, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "max_dist", {1.5});
  s.step_behaviors();
  expect_near(s.force(middle), {0, 0, 0}, 0);
}

void compare(FlockRig& s, BehaviorGroup& group, double min_distance, double max_distance, double amount) {
  s.set(group.id(), "min_dist", {min_distance});
  s.set(group.id(), "max_dist", {max_distance});
  s.set(group.id(), "amount", {amount});
  for (Part* part : s.parts) s.clear(*part);
  s.step_behaviors();
  int neighbors = 0;
  for (const Part* part : s.parts) {
    const BruteForceMeans m = s.brute_force_means(*part, min_distance, max_distance);
    const double scale =
        min_distance > 0 ? clamped((length_of(m.offset) - min_distance) / (max_distance - min_distance), 0, 1) : 1;
    const Vec3 expected = m.count == 0 ? Vec3(0) : amount * scale * unit(m.offset);
    // a nearly vanishing mean has a large relative error
    const double precision = m.count == 0 ? 1 : std::min(1.0, 1e5 * length_of(m.offset) / max_distance);
    expect_near(s.force(*part), expected, (2e-5 / precision + 1e-9) * std::abs(amount), std::to_string(max_distance));
    neighbors += m.count;
  }
  // at this distance at least one neighbor must be found
  if (max_distance > 2 * min_distance && max_distance >= 1) {
    EXPECT_GT(neighbors, 0);
  }
}

TEST(Cohesion, EqualsBruteForce) {
  FlockRig s;
  s.fill(120, 3, 6);
  BehaviorGroup& group = s.add_group("cohesion");
  for (const auto& [min_distance, max_distance] : std::vector<std::pair<double, double>>{
           {0, 0.3}, {0, 1}, {0, 2.5}, {0.5, 1.5}, {1, 1.2}, {0, 7}, {2, 9}, {0, 10.4}, {0, 1000}, {3, 1000}}) {
    compare(s, group, min_distance, max_distance, s.draw(-5, 5));
  }
}

// Bodies of one part use another code path.
TEST(Cohesion, EqualsBruteForceForBodiesOfOnePart) {
  FlockRig s;
  s.fill(200, 1, 5);
  BehaviorGroup& group = s.add_group("cohesion");
  for (const double max_distance : {0.4, 1.0, 1.9, 50.0}) compare(s, group, 0, max_distance, 2);
}

}  // namespace
}  // namespace limber::sim
