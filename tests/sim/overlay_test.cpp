// The debug overlay, compared with expected physical quantities.
#include "sim/visuals/overlay.h"

#include "sim/stage.h"

namespace limber::sim::test {
namespace {

using Kind = OverlayMark::Kind;

struct OverlayFixture : WorldFixture {
  void show(bool on) { set(world.visuals().appearance().id(), "overlay", {on ? 1.0 : 0.0}); }
  std::vector<OverlayMark> marks(Kind kind) {
    std::vector<OverlayMark> all;
    std::vector<OverlayMark> found;
    world.visuals().overlay().collect(all);
    for (const OverlayMark& mark : all) {
      if (mark.kind == kind) found.push_back(mark);
    }
    return found;
  }
};

TEST(Overlay, ContactForceOfABallAtRestIsItsWeight) {
  OverlayFixture s;
  s.show(true);
  s.gravity({0, 0, -9.81});
  (void)s.body("floor").add_part("floor", s.shape(plane_model()), 0, {});
  Part& ball = **s.body("ball").add_part("ball", s.shape(sphere_model(0.2)), 3, {{1, 2, 0.2}, quat_identity()});
  s.ticks(120);
  const std::vector<OverlayMark> contacts = s.marks(Kind::contact);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].slot, ball.id().slot);
  EXPECT_NEAR(contacts[0].vector.z, 1, 0.02) << "in weights, upwards";
  EXPECT_NEAR(glm::length(contacts[0].position - Vec3(1, 2, 0)), 0, 0.01);
  const std::vector<OverlayMark> centers = s.marks(Kind::center);
  ASSERT_EQ(centers.size(), 1U) << "static parts have none";
  EXPECT_NEAR(glm::length(centers[0].position - ball.center()), 0, 1e-12);
  EXPECT_NEAR(centers[0].size, std::sqrt(3 * 0.4) * 0.2, 1e-6);
}

TEST(Overlay, ShowsForcesOfTheLastTick) {
  OverlayFixture s;
  s.show(true);
  Part& ball = **s.body("ball").add_part("ball", s.shape(sphere_model(0.2)), 2, {});
  ball.apply_force({0, 3 * 2 * 9.81, 0});
  s.ticks(1);
  ASSERT_EQ(s.marks(Kind::force).size(), 1U);
  EXPECT_NEAR(s.marks(Kind::force)[0].vector.y, 3, 1e-9);
  s.ticks(1);
  EXPECT_TRUE(s.marks(Kind::force).empty());
  // an impulse counts as the force with the same effect in one tick
  ball.apply_impulse({2 * 9.81 / 60, 0, 0});
  s.ticks(1);
  ASSERT_EQ(s.marks(Kind::force).size(), 1U);
  EXPECT_NEAR(s.marks(Kind::force)[0].vector.x, 1, 1e-9);
  s.show(false);
  ball.apply_force({1, 0, 0});
  s.ticks(1);
  EXPECT_TRUE(s.marks(Kind::force).empty()) << "nothing is captured while the overlay is off";
}

TEST(Overlay, ShowsOpenJointAxesWithLimits) {
  OverlayFixture s;
  Body& body = s.body("arm");
  Shape& ball = s.shape(sphere_model(0.1));
  Part& base = **body.add_part("base", ball, 0, {{0, 0, 1}, quat_identity()});
  Part& tip = **body.add_part("tip", ball, 1, {{1, 0, 1}, quat_identity()});
  Joint& hinge = **body.add_joint("hinge", base, tip, model::JointType::revolute, {0.5, 0, 1}, {0, 1, 0});
  s.set_one(hinge.id(), "angular_lower_limit", 2, -0.5);
  s.set_one(hinge.id(), "angular_upper_limit", 2, 1.5);
  s.world.flush();
  const std::vector<OverlayMark> turns = s.marks(Kind::rotation_axis);
  ASSERT_EQ(turns.size(), 1U) << "one axis is open";
  EXPECT_EQ(turns[0].axis, 2);
  EXPECT_TRUE(turns[0].limited);
  EXPECT_NEAR(turns[0].lower, -0.5, 1e-6);
  EXPECT_NEAR(turns[0].upper, 1.5, 1e-6);
  EXPECT_NEAR(glm::length(turns[0].position - Vec3(0.5, 0, 1)), 0, 1e-6);
  EXPECT_NEAR(glm::length(turns[0].rotation * Vec3(0, 0, 1) - Vec3(0, 1, 0)), 0, 1e-6) << "the own axis, world";
  s.set_one(hinge.id(), "linear_upper_limit", 0, 0.25);
  s.world.flush();
  ASSERT_EQ(s.marks(Kind::translation_axis).size(), 1U);
  EXPECT_EQ(s.marks(Kind::translation_axis)[0].axis, 0);
  body.set_enabled(false);
  s.world.flush();
  EXPECT_TRUE(s.marks(Kind::rotation_axis).empty()) << "nothing of a disabled body is shown";
}

TEST(Overlay, StyleOfTheSceneHasPriorityOverPrefer) {
  OverlayFixture s;
  const NodeId appearance = s.world.visuals().appearance().id();
  const Property& prefer = Appearance::table().at("prefer");
  const double studio = 1;
  ASSERT_TRUE(prefer.invoke(s.store.object(appearance), {&studio, 1}).ok());
  EXPECT_EQ(s.number(appearance, "style"), 1);
  {
    const Store::ExplicitSetScope explicit_scope(s.store, true);
    s.set(appearance, "style", {0});
  }
  ASSERT_TRUE(prefer.invoke(s.store.object(appearance), {&studio, 1}).ok());
  EXPECT_EQ(s.number(appearance, "style"), 0);
}

}  // namespace
}  // namespace limber::sim::test
