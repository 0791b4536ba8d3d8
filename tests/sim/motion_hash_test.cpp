// The motion's hash: what it sees, what it does not, and that it follows things that come and go.
#include "sim/motion_hash.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/arm.h"
#include "sim/stage.h"

namespace limber {
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
    const auto hashes = s.world.motion_hash().bodies();
    return {hashes.begin(), hashes.end()};
  }
  Stage s;
  Body* one = nullptr;
  Body* two = nullptr;
};

TEST(MotionHash, EveryNumberOfEveryPartIsSeen) {
  Arms arms;
  Stage& s = arms.s;
  std::set<std::uint64_t> seen{s.world.motion_hash().now()};
  const std::vector<std::uint64_t> before = arms.bodies();
  for (const auto& part : arms.two->parts()) {
    for (const char* row : {"position", "rotation", "linear_velocity", "angular_velocity"}) {
      const Row& found = Part::table().at(row);
      double* const numbers = s.store.tell(part->id(), found);
      for (std::size_t i = 0; i < found.width; i++) {
        const double was = std::exchange(numbers[i], numbers[i] + 1e-9);
        EXPECT_TRUE(seen.insert(s.world.motion_hash().now()).second) << part->name() << " " << row << " " << i;
        EXPECT_EQ(arms.bodies()[0], before[0]);
        EXPECT_NE(arms.bodies()[1], before[1]);
        numbers[i] = was;
      }
    }
  }
  EXPECT_EQ(seen.size(), 1 + arms.two->parts().size() * 13);
  EXPECT_FALSE(seen.insert(s.world.motion_hash().now()).second) << "all is as it was";
}

TEST(MotionHash, ABodySwitchedOffIsSeen) {
  Arms arms;
  const std::uint64_t on = arms.s.world.motion_hash().now();
  *arms.s.store.tell(arms.one->id(), Body::table().at("enabled")) = 0;
  EXPECT_NE(arms.s.world.motion_hash().now(), on);
}

TEST(MotionHash, WhatComesAndGoesIsSeen) {
  Arms arms;
  Stage& s = arms.s;
  const std::uint64_t two = s.world.motion_hash().now();
  const std::vector<std::uint64_t> before = arms.bodies();
  make_arm(s, "three", {1, {2, 0, 0}});
  EXPECT_NE(s.world.motion_hash().now(), two);
  ASSERT_EQ(arms.bodies().size(), 3U);
  EXPECT_EQ(arms.bodies()[0], before[0]);
  EXPECT_EQ(arms.bodies()[1], before[1]);
  s.world.remove_body(*arms.one);
  EXPECT_NE(s.world.motion_hash().now(), two);
  ASSERT_EQ(arms.bodies().size(), 2U);
  EXPECT_EQ(arms.bodies()[0], before[1]) << "the others move as they did";
}

TEST(MotionHash, RunsThatMoveAlikeHaveOneHash) {
  Arms a;
  Arms b;
  EXPECT_EQ(a.s.world.motion_hash().now(), b.s.world.motion_hash().now());
  // a friction that touches nothing moves nothing
  b.s.set(b.two->parts()[1]->id(), "friction", {0.1});
  for (int i = 0; i < 5; i++) {
    a.s.ticks(1);
    b.s.ticks(1);
    EXPECT_EQ(a.s.world.motion_hash().now(), b.s.world.motion_hash().now());
    EXPECT_NE(a.s.world.state_hash(), b.s.world.state_hash());
  }
}

}  // namespace
}  // namespace limber
