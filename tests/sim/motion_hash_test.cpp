// The motion hash: covered and uncovered values, and added and removed bodies.
#include "sim/state/motion_hash.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/arm.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

struct Arms {
  Arms() {
    s.gravity({0, 0, -9.81});
    one = &make_arm(s, "one", {3});
    two = &make_arm(s, "two", {2, {1, 0, 0}});
    s.ticks(10);
  }
  std::vector<std::uint64_t> bodies() {
    const auto hashes = s.world.motion_hash().body_hashes();
    return {hashes.begin(), hashes.end()};
  }
  WorldFixture s;
  Body* one = nullptr;
  Body* two = nullptr;
};

TEST(MotionHash, CoversEveryValueOfEveryPart) {
  Arms arms;
  WorldFixture& s = arms.s;
  std::set<std::uint64_t> seen{s.world.motion_hash().compute()};
  const std::vector<std::uint64_t> before = arms.bodies();
  for (const auto& part : arms.two->parts()) {
    for (const char* name : {"position", "rotation", "linear_velocity", "angular_velocity"}) {
      const Property& property = Part::table().at(name);
      double* const values = s.store.mutable_values(part->id(), property);
      for (std::size_t i = 0; i < property.width; i++) {
        const double previous = std::exchange(values[i], values[i] + 1e-9);
        EXPECT_TRUE(seen.insert(s.world.motion_hash().compute()).second) << part->name() << " " << name << " " << i;
        EXPECT_EQ(arms.bodies()[0], before[0]);
        EXPECT_NE(arms.bodies()[1], before[1]);
        values[i] = previous;
      }
    }
  }
  EXPECT_EQ(seen.size(), 1 + arms.two->parts().size() * 13);
  EXPECT_FALSE(seen.insert(s.world.motion_hash().compute()).second) << "all values are restored";
}

TEST(MotionHash, CoversEnabled) {
  Arms arms;
  const std::uint64_t on = arms.s.world.motion_hash().compute();
  *arms.s.store.mutable_values(arms.one->id(), Body::table().at("enabled")) = 0;
  EXPECT_NE(arms.s.world.motion_hash().compute(), on);
}

TEST(MotionHash, CoversAddedAndRemovedBodies) {
  Arms arms;
  WorldFixture& s = arms.s;
  const std::uint64_t two = s.world.motion_hash().compute();
  const std::vector<std::uint64_t> before = arms.bodies();
  make_arm(s, "three", {1, {2, 0, 0}});
  EXPECT_NE(s.world.motion_hash().compute(), two);
  ASSERT_EQ(arms.bodies().size(), 3U);
  EXPECT_EQ(arms.bodies()[0], before[0]);
  EXPECT_EQ(arms.bodies()[1], before[1]);
  s.world.remove_body(*arms.one);
  EXPECT_NE(s.world.motion_hash().compute(), two);
  ASSERT_EQ(arms.bodies().size(), 2U);
  EXPECT_EQ(arms.bodies()[0], before[1]) << "the others move as they did";
}

TEST(MotionHash, EqualMotionHasEqualHash) {
  Arms a;
  Arms b;
  EXPECT_EQ(a.s.world.motion_hash().compute(), b.s.world.motion_hash().compute());
  // the friction of parts without contacts has no influence
  b.s.set(b.two->parts()[1]->id(), "friction", {0.1});
  for (int i = 0; i < 5; i++) {
    a.s.ticks(1);
    b.s.ticks(1);
    EXPECT_EQ(a.s.world.motion_hash().compute(), b.s.world.motion_hash().compute());
    EXPECT_NE(a.s.world.state_hash(), b.s.world.state_hash());
  }
}

}  // namespace
}  // namespace limber::sim
