// Contacts: each contact begins once, its impulse is the change of momentum, and removed parts are forgotten.
#include "sim/world/contacts.h"

#include <gtest/gtest.h>

#include "sim/arm.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

struct ContactsFixture : WorldFixture {
  Part& enable_reports(Part& part) {
    set(part.id(), "report_contacts", {1});
    return part;
  }
  /// Events of several ticks.
  std::vector<ContactEvent> events(int n) {
    std::vector<ContactEvent> all;
    for (int i = 0; i < n; i++) {
      ticks(1);
      all.insert(all.end(), world.sensing().contacts().events().begin(), world.sensing().contacts().events().end());
    }
    return all;
  }
};

TEST(Contacts, ImpulseIsTheChangeOfMomentum) {
  for (const double e : {0.0, 0.5, 1.0}) {
    ContactsFixture s;
    Part& wall = s.add_single_part(box_model({0.2, 4, 4}), 0, {{2, 0, 0}, quat_identity()});
    s.set(wall.id(), "restitution", {1});
    Part& ball = s.enable_reports(s.add_single_part(sphere_model(0.1), 3));
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

// At any distance at the start of the step of the impact: all of m·v over all points, without the weight that they bear
// afterwards.
TEST(Contacts, FlatBoxReportsItsWholeMomentum) {
  for (const double height : {0.98, 0.99, 1.0, 1.01, 1.02, 1.03}) {
    for (const bool plane : {true, false}) {
      ContactsFixture s;
      s.gravity({0, 0, -9.81});
      if (plane) {
        s.floor();
      } else {
        s.add_single_part(box_model({4, 4, 1}), 0, {{0, 0, -0.5}, quat_identity()});
      }
      Part& box =
          s.enable_reports(s.add_single_part(box_model({0.2, 0.2, 0.2}), 3, {{0, 0, height + 0.1}, quat_identity()}));
      const std::vector<ContactEvent> events = s.events(60);
      ASSERT_EQ(events.size(), 1u) << height << plane;
      EXPECT_EQ(events[0].part, box.id());
      const double momentum = 3 * std::sqrt(2 * 9.81 * height);
      EXPECT_NEAR(events[0].impulse, momentum, 0.03 * momentum) << height << plane;
    }
  }
}

TEST(Contacts, BothReportingPartsGetAnEvent) {
  ContactsFixture s;
  Part& a = s.enable_reports(s.add_single_part(sphere_model(0.1), 1));
  Part& b = s.enable_reports(s.add_single_part(sphere_model(0.1), 1, {{0.5, 0, 0}, quat_identity()}));
  s.set(a.id(), "linear_velocity", {2, 0, 0});
  const std::vector<ContactEvent> events = s.events(60);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].part, a.id());
  EXPECT_EQ(events[0].other, b.id());
  EXPECT_EQ(events[1].part, b.id());
  EXPECT_EQ(events[1].other, a.id());
  EXPECT_EQ(events[0].impulse, events[1].impulse);
  // equal masses, no restitution: both continue at half the speed
  EXPECT_NEAR(events[0].impulse, 1, 0.02);
}

TEST(Contacts, LastingContactBeginsOnce) {
  for (const double restitution : {0.0, 0.4}) {
    ContactsFixture s;
    s.floor();
    s.gravity({0, 0, -9.81});
    Part& box = s.enable_reports(s.add_single_part(box_model({0.4, 0.3, 0.2}), 2, {{0, 0, 0.11}, quat_identity()}));
    s.set(box.id(), "restitution", {restitution});
    // at 0.44 m/s and a restitution of 0.4 it is in the air for 36 ms: more than two ticks, so it touches twice
    const std::size_t touches = restitution > 0 ? 2 : 1;
    EXPECT_EQ(s.events(300).size(), touches) << restitution;
    // lifted and dropped: one more
    box.set_pose({{0, 0, 1}, quat_identity()});
    s.ticks(1);
    box.set_velocity(Vec3(0), Vec3(0));
    box.set_pose({{0, 0, 0.11}, quat_identity()});
    EXPECT_EQ(s.events(60).size(), touches) << restitution;
  }
}

TEST(Contacts, BouncingBallReportsEachBounce) {
  ContactsFixture s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& ball = s.enable_reports(s.add_single_part(sphere_model(0.1), 1, {{0, 0, 1.1}, quat_identity()}));
  s.set(ball.id(), "restitution", {0.7});
  // falls for 0.4515 s; then each bounce lasts 0.7 times the one before, the first 0.632 s: at 0.45, 1.08, 1.53, 1.84 s
  EXPECT_EQ(s.events(60).size(), 1u);
  EXPECT_EQ(s.events(60).size(), 3u);
}

TEST(Contacts, ReportsNothingUnlessEnabled) {
  ContactsFixture s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.11}, quat_identity()});
  EXPECT_TRUE(s.events(30).empty());
  // reporting is enabled while it rests: the contact begins for that part now
  s.enable_reports(ball);
  EXPECT_EQ(s.events(30).size(), 1u);
  s.set(ball.id(), "report_contacts", {0});
  ball.set_pose({{0, 0, 0.5}, quat_identity()});
  EXPECT_TRUE(s.events(60).empty());
}

TEST(Contacts, JoinedPartsDoNotReport) {
  ContactsFixture s;
  Body& body = s.body("body");
  Part& a = s.enable_reports(s.part(body, box_model(Vec3(0.2)), 1));
  Part& b = s.enable_reports(s.part(body, box_model(Vec3(0.2)), 1, {{0.1, 0, 0}, quat_identity()}));
  (void)body.add_joint("j", a, b, model::JointType::revolute, {0.05, 0, 0}, {0, 1, 0}).value();
  EXPECT_TRUE(s.events(10).empty());
  s.part(body, box_model(Vec3(0.2)), 1, {{-0.2, 0, 0}, quat_identity()});
  EXPECT_EQ(s.events(10).size(), 1u);
}

TEST(Contacts, ForgetsRemovedParts) {
  ContactsFixture s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& a = s.enable_reports(s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()}));
  Part& b = s.enable_reports(s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.3}, quat_identity()}));
  EXPECT_EQ(s.events(10).size(), 3u);  // a with the floor; a and b with each other
  s.world.remove_body(a.body());
  const std::vector<ContactEvent> events = s.events(60);
  ASSERT_EQ(events.size(), 1u);  // b lands
  EXPECT_EQ(events[0].part, b.id());
  for (int i = 0; i < 30; i++) {
    // slots are reused: the contacts of an added part are its own
    Part& c = s.enable_reports(s.add_single_part(sphere_model(0.1), 1, {{2, 0, 0.1}, quat_identity()}));
    EXPECT_EQ(s.events(2).size(), 1u);
    s.world.remove_body(c.body());
  }
}

TEST(Contacts, OrderOfEventsIsDeterministic) {
  std::vector<ContactEvent> runs[2];
  for (auto& run : runs) {
    ContactsFixture s;
    s.floor();
    s.gravity({0, 0, -9.81});
    for (int i = 0; i < 30; i++) {
      s.enable_reports(
          s.add_single_part(box_model({0.2, 0.16, 0.12}), 1, {{0.02 * (i % 3), 0, 0.1 + 0.15 * i}, quat_identity()}));
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
}  // namespace limber::sim
