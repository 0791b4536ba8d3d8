// Neighbour sets: order, other bodies only, bodies that are out, sharing, one answer for who asks the same.
#include "sim/neighbors.h"

#include "sim/behavior_rig.h"

namespace limber {
namespace {

using namespace test;

/// Bodies of two balls each along x: bodies at 0, 1, 2 …, the second ball 10 above the first.
struct RowOfParts : BehaviorRig {
  explicit RowOfParts(int count) {
    Shape& ball = shape(sphere_model(0.05));
    for (int i = 0; i < count; i++) {
      Body& b = body("b" + std::to_string(i));
      const double x = i;
      low.push_back(*b.add_part("low", ball, 1, {{x, 0, 0}, quat_identity()}));
      high.push_back(*b.add_part("high", ball, 1, {{x, 0, 10}, quat_identity()}));
    }
    all = std::make_unique<NeighborSet>(world, mixed());
    turn();
  }
  std::vector<Part*> mixed() const {
    std::vector<Part*> parts;
    for (std::size_t i = 0; i < low.size(); i++) parts.insert(parts.end(), {low[i], high[i]});
    return parts;
  }
  /// A step of the behaviours: what was gathered is gathered again.
  void turn() { world.behaviors().step(1.0 / 60); }
  std::vector<std::uint32_t> near(const Part& of, double radius) {
    std::vector<Neighbor> found;
    all->near(of, radius, found);
    std::vector<std::uint32_t> indices;
    for (const Neighbor& n : found) indices.push_back(n.index);
    return indices;
  }
  std::vector<Part*> low, high;
  std::unique_ptr<NeighborSet> all;
};

using Indices = std::vector<std::uint32_t>;

TEST(Neighbors, AreOfOtherBodiesInTheOrderOfTheParts) {
  RowOfParts s(6);
  EXPECT_EQ(s.near(*s.low[2], 1), (Indices{2, 6}));
  EXPECT_EQ(s.near(*s.low[2], 2.5), (Indices{0, 2, 6, 8}));
  EXPECT_EQ(s.near(*s.low[2], 10), (Indices{0, 2, 6, 8, 10}));  // its own body's high part is 10 away
  EXPECT_EQ(s.near(*s.low[0], 1e9), (Indices{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(s.near(*s.low[0], 0.5), Indices{});
  EXPECT_EQ(s.near(*s.low[0], -1), Indices{});
}

TEST(Neighbors, HaveOffsetAndDistance) {
  RowOfParts s(3);
  std::vector<Neighbor> found;
  s.all->near(*s.low[0], 10.1, found);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[1].index, 3U);  // the high part of the next
  EXPECT_NEAR(found[1].offset.x, 1, 1e-6);
  EXPECT_NEAR(found[1].offset.z, 10, 1e-6);
  EXPECT_NEAR(found[1].distance, std::sqrt(101), 1e-6);
}

TEST(Neighbors, ACoincidentPartIsOneAtRadiusZero) {
  RowOfParts s(2);
  EXPECT_EQ(s.near(*s.low[0], 0), Indices{});
  s.low[1]->set_pose(s.low[0]->pose());
  s.turn();
  EXPECT_EQ(s.near(*s.low[0], 0), (Indices{2}));
}

TEST(Neighbors, AreWhereTheyWereWhenTheTurnBegan) {
  RowOfParts s(2);
  EXPECT_EQ(s.near(*s.low[0], 2), (Indices{2}));
  s.low[1]->set_pose({{50, 0, 0}, quat_identity()});
  EXPECT_EQ(s.near(*s.low[0], 2), (Indices{2}));
  s.turn();
  EXPECT_EQ(s.near(*s.low[0], 2), Indices{});
}

TEST(Neighbors, ABodyThatIsOutOfTheWorldIsNone) {
  RowOfParts s(3);
  s.world.find_body("b1")->set_enabled(false);
  s.turn();
  EXPECT_EQ(s.near(*s.low[0], 5), (Indices{4}));
  s.all->forget(*s.world.find_body("b2"));
  EXPECT_EQ(s.near(*s.low[0], 5), Indices{});
  EXPECT_EQ(s.all->parts().size(), 4U);
}

TEST(Neighbors, MeansAreTheSameByEveryWay) {
  RowOfParts s(40);
  for (std::size_t i = 0; i < s.low.size(); i++) {
    const double x = static_cast<double>(i);
    s.low[i]->set_velocity({x, 0, 1}, {0, x, 0});
  }
  s.turn();
  const std::vector<Part*> everyone = s.mixed();
  const std::vector<Part*> few = {s.low[7], s.low[3]};
  // all at once (each pair once), some by themselves, and where the distance covers all, by sums over all
  for (const double most : {2.2, 9.0, 12.0, 1000.0}) {
    s.turn();
    const auto found = s.all->means(everyone, 0, most, kWantVelocity);
    const std::vector<NeighborMeans> together(found.begin(), found.end());
    const auto alone = s.all->means(few, 0, most, kWantVelocity);
    for (std::size_t i = 0; i < few.size(); i++) {
      const NeighborMeans& a = together[i == 0 ? 14 : 6];
      EXPECT_EQ(alone[i].count, a.count) << most;
      for (std::size_t k = 0; k < 3; k++) {
        EXPECT_NEAR(alone[i].offset[k], a.offset[k], 1e-5) << most;
        EXPECT_NEAR(alone[i].velocity[k], a.velocity[k], 1e-5) << most;
        EXPECT_NEAR(alone[i].spin[k], a.spin[k], 1e-5) << most;
      }
    }
    // by hand: of low[3] within 2.2 are low[1], [2], [4], [5]
    if (most == 2.2) {
      EXPECT_EQ(together[6].count, 4U);
      EXPECT_NEAR(together[6].offset[0], 0, 1e-6);
      EXPECT_NEAR(together[6].velocity[0], 0, 1e-6);
      EXPECT_NEAR(together[0].offset[0], 1.5, 1e-6);    // low[0]: 1 and 2 away
      EXPECT_NEAR(together[0].velocity[0], 1.5, 1e-6);  // mean 1.5, own 0
      EXPECT_NEAR(together[0].spin[1], 1.5, 1e-6);
    }
  }
}

TEST(Neighbors, WhoAsksTheSameInOneTurnGetsTheSame) {
  RowOfParts s(10);
  const std::vector<Part*> everyone = s.mixed();
  const NeighborMeans* const first = s.all->means(everyone, 0, 2, kWantVelocity).data();
  EXPECT_EQ(s.all->means(everyone, 0, 2, 0).data(), first);
  EXPECT_EQ(s.all->means(everyone, 0, 2, kWantVelocity).data(), first);
  EXPECT_NE(s.all->means(everyone, 0, 3, 0).data(), first);
}

TEST(Neighbors, ASetKnowsItsPartsFromOthersInTheSamePlace) {
  RowOfParts s(2);
  EXPECT_TRUE(s.all->holds(s.mixed()));
  std::vector<Part*> fewer = s.mixed();
  fewer.pop_back();
  EXPECT_FALSE(s.all->holds(fewer));
  const NeighborSet lows(s.world, s.low);
  EXPECT_FALSE(lows.holds(s.high));
}

}  // namespace
}  // namespace limber
