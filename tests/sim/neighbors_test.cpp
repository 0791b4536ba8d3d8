// Neighbor sets: order, parts of other bodies only, disabled bodies, sharing, cached results.
#include "sim/neighbors/neighbor_set.h"

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

/// Bodies of two balls each along x: bodies at 0, 1, 2 …, the second ball 10 above the first.
struct LineOfBodies : BehaviorRig {
  explicit LineOfBodies(int count) {
    Shape& ball = shape(sphere_model(0.05));
    for (int i = 0; i < count; i++) {
      Body& b = body("b" + std::to_string(i));
      const double x = i;
      low.push_back(*b.add_part("low", ball, 1, {{x, 0, 0}, quat_identity()}));
      high.push_back(*b.add_part("high", ball, 1, {{x, 0, 10}, quat_identity()}));
    }
    all = std::make_unique<NeighborSet>(world, mixed());
    step();
  }
  std::vector<Part*> mixed() const {
    std::vector<Part*> parts;
    for (std::size_t i = 0; i < low.size(); i++) parts.insert(parts.end(), {low[i], high[i]});
    return parts;
  }
  /// Simulates a step of the behaviors: positions are gathered again.
  void step() { world.behaviors().step(1.0 / 60); }
  std::vector<std::uint32_t> near(const Part& of, double radius) {
    std::vector<Neighbor> found;
    all->find_near(of, radius, found);
    std::vector<std::uint32_t> indices;
    for (const Neighbor& n : found) indices.push_back(n.index);
    return indices;
  }
  std::vector<Part*> low, high;
  std::unique_ptr<NeighborSet> all;
};

using Indices = std::vector<std::uint32_t>;

TEST(Neighbors, AreOfOtherBodiesInTheOrderOfParts) {
  LineOfBodies s(6);
  EXPECT_EQ(s.near(*s.low[2], 1), (Indices{2, 6}));
  EXPECT_EQ(s.near(*s.low[2], 2.5), (Indices{0, 2, 6, 8}));
  EXPECT_EQ(s.near(*s.low[2], 10), (Indices{0, 2, 6, 8, 10}));  // the high part of its own body is at distance 10
  EXPECT_EQ(s.near(*s.low[0], 1e9), (Indices{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(s.near(*s.low[0], 0.5), Indices{});
  EXPECT_EQ(s.near(*s.low[0], -1), Indices{});
}

TEST(Neighbors, HaveOffsetAndDistance) {
  LineOfBodies s(3);
  std::vector<Neighbor> found;
  s.all->find_near(*s.low[0], 10.1, found);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[1].index, 3U);  // the high part of the next body
  EXPECT_NEAR(found[1].offset.x, 1, 1e-6);
  EXPECT_NEAR(found[1].offset.z, 10, 1e-6);
  EXPECT_NEAR(found[1].distance, std::sqrt(101), 1e-6);
}

TEST(Neighbors, IncludeCoincidentPartsAtRadiusZero) {
  LineOfBodies s(2);
  EXPECT_EQ(s.near(*s.low[0], 0), Indices{});
  s.low[1]->set_pose(s.low[0]->pose());
  s.step();
  EXPECT_EQ(s.near(*s.low[0], 0), (Indices{2}));
}

// After a body with one part is removed, the set has as many parts as it had bodies, but one body has two of them.
TEST(Neighbors, ExcludeTheOwnBodyAfterAnotherIsRemoved) {
  LineOfBodies s(40);
  NeighborSet set(s.world, {s.low[0], s.low[1], s.high[1], s.low[39]});
  set.remove_body(s.low[0]->body());
  s.step();
  for (const NeighborMeans& means : set.means(set.parts(), 0, 12, kWantVelocity)) EXPECT_EQ(means.count, 0U);
}

TEST(Neighbors, UsePositionsFromTheStartOfTheStep) {
  LineOfBodies s(2);
  EXPECT_EQ(s.near(*s.low[0], 2), (Indices{2}));
  s.low[1]->set_pose({{50, 0, 0}, quat_identity()});
  EXPECT_EQ(s.near(*s.low[0], 2), (Indices{2}));
  s.step();
  EXPECT_EQ(s.near(*s.low[0], 2), Indices{});
}

TEST(Neighbors, ExcludeDisabledBodies) {
  LineOfBodies s(3);
  s.world.find_body("b1")->set_enabled(false);
  s.step();
  EXPECT_EQ(s.near(*s.low[0], 5), (Indices{4}));
  s.all->remove_body(*s.world.find_body("b2"));
  EXPECT_EQ(s.near(*s.low[0], 5), Indices{});
  EXPECT_EQ(s.all->parts().size(), 4U);
}

TEST(Neighbors, MeansAreEqualForAllMethods) {
  LineOfBodies s(40);
  for (std::size_t i = 0; i < s.low.size(); i++) {
    const double x = static_cast<double>(i);
    s.low[i]->set_velocity({x, 0, 1}, {0, x, 0});
  }
  s.step();
  const std::vector<Part*> everyone = s.mixed();
  const std::vector<Part*> few = {s.low[7], s.low[3]};
  // all parts at once (visiting each pair once), a few parts separately, and by totals if the distance covers all
  for (const double max_distance : {2.2, 9.0, 12.0, 1000.0}) {
    s.step();
    const auto found = s.all->means(everyone, 0, max_distance, kWantVelocity);
    const std::vector<NeighborMeans> together(found.begin(), found.end());
    const auto alone = s.all->means(few, 0, max_distance, kWantVelocity);
    for (std::size_t i = 0; i < few.size(); i++) {
      const NeighborMeans& a = together[i == 0 ? 14 : 6];
      EXPECT_EQ(alone[i].count, a.count) << max_distance;
      for (std::size_t k = 0; k < 3; k++) {
        EXPECT_NEAR(alone[i].offset[k], a.offset[k], 1e-5) << max_distance;
        EXPECT_NEAR(alone[i].velocity[k], a.velocity[k], 1e-5) << max_distance;
        EXPECT_NEAR(alone[i].angular_velocity[k], a.angular_velocity[k], 1e-5) << max_distance;
      }
    }
    // expected: the neighbors of low[3] within 2.2 are low[1], [2], [4], [5]
    if (max_distance == 2.2) {
      EXPECT_EQ(together[6].count, 4U);
      EXPECT_NEAR(together[6].offset[0], 0, 1e-6);
      EXPECT_NEAR(together[6].velocity[0], 0, 1e-6);
      EXPECT_NEAR(together[0].offset[0], 1.5, 1e-6);    // low[0]: neighbors at distances 1 and 2
      EXPECT_NEAR(together[0].velocity[0], 1.5, 1e-6);  // mean 1.5, own 0
      EXPECT_NEAR(together[0].angular_velocity[1], 1.5, 1e-6);
    }
  }
}

TEST(Neighbors, EqualQueriesInOneStepShareTheResult) {
  LineOfBodies s(10);
  const std::vector<Part*> everyone = s.mixed();
  const NeighborMeans* const first = s.all->means(everyone, 0, 2, kWantVelocity).data();
  EXPECT_EQ(s.all->means(everyone, 0, 2, 0).data(), first);
  EXPECT_EQ(s.all->means(everyone, 0, 2, kWantVelocity).data(), first);
  EXPECT_NE(s.all->means(everyone, 0, 3, 0).data(), first);
}

TEST(Neighbors, SetDetectsPartsAtReusedAddresses) {
  LineOfBodies s(2);
  EXPECT_TRUE(s.all->consists_of(s.mixed()));
  std::vector<Part*> fewer = s.mixed();
  fewer.pop_back();
  EXPECT_FALSE(s.all->consists_of(fewer));
  const NeighborSet lows(s.world, s.low);
  EXPECT_FALSE(lows.consists_of(s.high));
}

}  // namespace
}  // namespace limber::sim
