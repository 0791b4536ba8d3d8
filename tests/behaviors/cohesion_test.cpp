// cohesion: m = mean offset of the neighbours, s = clamp((|m| − min)/(max − min), 0, 1) where min > 0, else 1;
// F = amount · s · m̂.
#include "behaviors/flock_rig.h"

namespace limber {
namespace {

using namespace test;

TEST(Cohesion, PullsTwoTowardsEachOther) {
  Rig s;
  Part& one = s.loose({0, 0, 0});
  Part& two = s.loose({0, 3, 4});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "amount", {10});
  s.act();
  expect_near(s.force(one), {0, 6, 8}, 1e-6);
  expect_near(s.force(two), {0, -6, -8}, 1e-6);
}

TEST(Cohesion, ANegativeAmountEvades) {
  Rig s;
  Part& one = s.loose({0, 0, 0});
  s.loose({2, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "amount", {-3});
  s.act();
  expect_near(s.force(one), {-3, 0, 0}, 1e-6);
}

TEST(Cohesion, PartsOfOneBodyAreNoNeighbours) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  s.ball(body, {1, 0, 0});
  Part& other = s.loose({0, 2, 0});
  s.add_group("cohesion");
  s.act();
  expect_near(s.force(one), {0, 1, 0}, 1e-6);
  expect_near(s.force(other), unit({0.5, -2, 0}), 1e-6);
}

TEST(Cohesion, DistancesCountInclusively) {
  Rig s;
  Part& one = s.loose({0, 0, 0});
  Part& two = s.loose({2, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  const auto pull = [&](double least, double most) {
    s.set(group.id(), "min_dist", {least});
    s.set(group.id(), "max_dist", {most});
    for (Part* part : {&one, &two}) s.clear(*part);
    s.act();
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

TEST(Cohesion, WhereNeighboursCancelNothingPulls) {
  Rig s;
  Part& middle = s.loose({0, 0, 0});
  s.loose({1, 0, 0});
  s.loose({-1, 0, 0});
  BehaviorGroup& group = s.add_group("cohesion");
  s.set(group.id(), "max_dist", {1.5});
  s.act();
  expect_near(s.force(middle), {0, 0, 0}, 0);
}

void compare(FlockRig& s, BehaviorGroup& group, double least, double most, double amount) {
  s.set(group.id(), "min_dist", {least});
  s.set(group.id(), "max_dist", {most});
  s.set(group.id(), "amount", {amount});
  for (Part* part : s.parts) s.clear(*part);
  s.act();
  int seen = 0;
  for (const Part* part : s.parts) {
    const SlowMeans m = s.slow_means(*part, least, most);
    const double scale = least > 0 ? clamped((length_of(m.offset) - least) / (most - least), 0, 1) : 1;
    const Vec3 wanted = m.count == 0 ? Vec3(0) : amount * scale * unit(m.offset);
    // a mean that almost cancels is known only so well
    const double sure = m.count == 0 ? 1 : std::min(1.0, 1e5 * length_of(m.offset) / most);
    expect_near(s.force(*part), wanted, (2e-5 / sure + 1e-9) * std::abs(amount), std::to_string(most));
    seen += m.count;
  }
  // of what can be seen at this distance something is seen
  if (most > 2 * least && most >= 1) {
    EXPECT_GT(seen, 0);
  }
}

TEST(Cohesion, IsWhatLookingAtEveryPartGives) {
  FlockRig s;
  s.fill(120, 3, 6);
  BehaviorGroup& group = s.add_group("cohesion");
  for (const auto& [least, most] : std::vector<std::pair<double, double>>{
           {0, 0.3}, {0, 1}, {0, 2.5}, {0.5, 1.5}, {1, 1.2}, {0, 7}, {2, 9}, {0, 10.4}, {0, 1000}, {3, 1000}}) {
    compare(s, group, least, most, s.draw(-5, 5));
  }
}

// one part a body: another path through the same sums
TEST(Cohesion, IsTheSameForBodiesOfOnePart) {
  FlockRig s;
  s.fill(200, 1, 5);
  BehaviorGroup& group = s.add_group("cohesion");
  for (const double most : {0.4, 1.0, 1.9, 50.0}) compare(s, group, 0, most, 2);
}

}  // namespace
}  // namespace limber
