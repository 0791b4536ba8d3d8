// Contacts: each touch begins once, its impulse is the change of momentum, and the dead are forgotten.
#include "sim/contacts.h"

#include <gtest/gtest.h>

#include "sim/arm.h"
#include "sim/stage.h"

namespace limber {
namespace {

using namespace test;

struct Touches : Stage {
  Part& reporting(Part& part) {
    set(part.id(), "report_contacts", {1});
    return part;
  }
  /// Events of some ticks.
  std::vector<ContactEvent> events(int n) {
    std::vector<ContactEvent> all;
    for (int i = 0; i < n; i++) {
      ticks(1);
      all.insert(all.end(), world.contacts().begin(), world.contacts().end());
    }
    return all;
  }
};

TEST(Contacts, AnImpulseIsTheChangeOfMomentum) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Touches s;
    Part& wall = s.lone(box_model({0.2, 4, 4}), 0, {{2, 0, 0}, quat_identity()});
    s.set(wall.id(), "restitution", {1});
    Part& ball = s.reporting(s.lone(sphere_model(0.1), 3));
    s.set(ball.id(), "restitution", {e});
    s.set(ball.id(), "linear_velocity", {5, 0, 0});
    const std::vector<ContactEvent> events = s.events(60);
    ASSERT_EQ(events.size(), 1u) << e;
    EXPECT_EQ(events[0].part, ball.id());
    EXPECT_EQ(events[0].other, wall.id());
    EXPECT_NEAR(ball.linear_velocity().x, -5 * e, 0.02) << e;
    EXPECT_NEAR(events[0].impulse, 3 * (5 - ball.linear_velocity().x), 0.01 * 15) << e;
    EXPECT_NEAR(events[0].position.x, 1.9, 0.03);
    EXPECT_NEAR(events[0].position.y, 0, 1e-3);
  }
}

// Whatever the distance at which the step of the impact begins: all of m·v, over all points, and nothing of the weight
// that they carry afterwards.
TEST(Contacts, AFlatBoxReportsItsWholeMomentum) {
  for (const double height : {0.98, 0.99, 1.0, 1.01, 1.02, 1.03}) {
    for (const bool plane : {true, false}) {
      Touches s;
      s.gravity({0, 0, -9.81});
      if (plane) {
        s.floor();
      } else {
        s.lone(box_model({4, 4, 1}), 0, {{0, 0, -0.5}, quat_identity()});
      }
      Part& box = s.reporting(s.lone(box_model({0.2, 0.2, 0.2}), 3, {{0, 0, height + 0.1}, quat_identity()}));
      const std::vector<ContactEvent> events = s.events(60);
      ASSERT_EQ(events.size(), 1u) << height << plane;
      EXPECT_EQ(events[0].part, box.id());
      const double momentum = 3 * std::sqrt(2 * 9.81 * height);
      EXPECT_NEAR(events[0].impulse, momentum, 0.03 * momentum) << height << plane;
    }
  }
}

TEST(Contacts, BothReportWhenBothAsk) {
  Touches s;
  Part& a = s.reporting(s.lone(sphere_model(0.1), 1));
  Part& b = s.reporting(s.lone(sphere_model(0.1), 1, {{0.5, 0, 0}, quat_identity()}));
  s.set(a.id(), "linear_velocity", {2, 0, 0});
  const std::vector<ContactEvent> events = s.events(60);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].part, a.id());
  EXPECT_EQ(events[0].other, b.id());
  EXPECT_EQ(events[1].part, b.id());
  EXPECT_EQ(events[1].other, a.id());
  EXPECT_EQ(events[0].impulse, events[1].impulse);
  // equal masses, nothing given back: both go on with half the speed
  EXPECT_NEAR(events[0].impulse, 1, 0.02);
}

TEST(Contacts, ATouchThatLastsBeginsOnce) {
  for (const double restitution : {0.0, 0.4}) {
    Touches s;
    s.floor();
    s.gravity({0, 0, -9.81});
    Part& box = s.reporting(s.lone(box_model({0.4, 0.3, 0.2}), 2, {{0, 0, 0.11}, quat_identity()}));
    s.set(box.id(), "restitution", {restitution});
    // met at 0.44 m/s and left at 0.4 of that, it is in the air for 36 ms: more than two ticks, so it touches twice
    const std::size_t touches = restitution > 0 ? 2 : 1;
    EXPECT_EQ(s.events(300).size(), touches) << restitution;
    // lifted and dropped: once more
    box.set_pose({{0, 0, 1}, quat_identity()});
    s.ticks(1);
    box.set_velocity(Vec3(0), Vec3(0));
    box.set_pose({{0, 0, 0.11}, quat_identity()});
    EXPECT_EQ(s.events(60).size(), touches) << restitution;
  }
}

TEST(Contacts, ABouncingBallBeginsWithEachBounce) {
  Touches s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& ball = s.reporting(s.lone(sphere_model(0.1), 1, {{0, 0, 1.1}, quat_identity()}));
  s.set(ball.id(), "restitution", {0.7});
  // falls for 0.4515 s; then each bounce lasts 0.7 times the one before, the first 0.632 s: at 0.45, 1.08, 1.53, 1.84 s
  EXPECT_EQ(s.events(60).size(), 1u);
  EXPECT_EQ(s.events(60).size(), 3u);
}

TEST(Contacts, NobodyAsksNobodyTells) {
  Touches s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& ball = s.lone(sphere_model(0.1), 1, {{0, 0, 0.11}, quat_identity()});
  EXPECT_TRUE(s.events(30).empty());
  // asking while it lies there: the touch begins for the one who asks now
  s.reporting(ball);
  EXPECT_EQ(s.events(30).size(), 1u);
  s.set(ball.id(), "report_contacts", {0});
  ball.set_pose({{0, 0, 0.5}, quat_identity()});
  EXPECT_TRUE(s.events(60).empty());
}

TEST(Contacts, JoinedPartsDoNotTouchOthersOfTheBodyMay) {
  Touches s;
  Body& body = s.body("body");
  Part& a = s.reporting(s.part(body, box_model(Vec3(0.2)), 1));
  Part& b = s.reporting(s.part(body, box_model(Vec3(0.2)), 1, {{0.1, 0, 0}, quat_identity()}));
  (void)body.add_joint("j", a, b, JointType::revolute, {0.05, 0, 0}, {0, 1, 0}).value();
  EXPECT_TRUE(s.events(10).empty());
  s.part(body, box_model(Vec3(0.2)), 1, {{-0.2, 0, 0}, quat_identity()});
  EXPECT_EQ(s.events(10).size(), 1u);
}

TEST(Contacts, WhatWasRemovedIsForgotten) {
  Touches s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& a = s.reporting(s.lone(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()}));
  Part& b = s.reporting(s.lone(box_model(Vec3(0.2)), 1, {{0, 0, 0.3}, quat_identity()}));
  EXPECT_EQ(s.events(10).size(), 3u);  // a with the floor; a and b with each other
  s.world.remove_body(a.body());
  const std::vector<ContactEvent> events = s.events(60);
  ASSERT_EQ(events.size(), 1u);  // b lands
  EXPECT_EQ(events[0].part, b.id());
  for (int i = 0; i < 30; i++) {
    // slots are used again: a newcomer's touches are its own
    Part& c = s.reporting(s.lone(sphere_model(0.1), 1, {{2, 0, 0.1}, quat_identity()}));
    EXPECT_EQ(s.events(2).size(), 1u);
    s.world.remove_body(c.body());
  }
}

TEST(Contacts, EventsStandInTheSameOrderEveryTime) {
  std::vector<ContactEvent> runs[2];
  for (auto& run : runs) {
    Touches s;
    s.floor();
    s.gravity({0, 0, -9.81});
    for (int i = 0; i < 30; i++) {
      s.reporting(s.lone(box_model({0.2, 0.16, 0.12}), 1, {{0.02 * (i % 3), 0, 0.1 + 0.15 * i}, quat_identity()}));
    }
    run = s.events(120);
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  ASSERT_GT(runs[0].size(), 50u);
  for (std::size_t i = 0; i < runs[0].size(); i++) {
    EXPECT_EQ(runs[0][i].part, runs[1][i].part);
    EXPECT_EQ(runs[0][i].other, runs[1][i].other);
    EXPECT_EQ(runs[0][i].impulse, runs[1][i].impulse);
    EXPECT_EQ(runs[0][i].position, runs[1][i].position);
  }
}

}  // namespace
}  // namespace limber
