// What the debug picture shows, beside what physics says it must be.
#include "sim/overlay.h"

#include "sim/stage.h"

namespace limber::test {
namespace {

using Kind = OverlayMark::Kind;

struct OverlayStage : Stage {
  void show(bool on) { set(world.visuals().look().id(), "overlay", {on ? 1.0 : 0.0}); }
  std::vector<OverlayMark> marks(Kind kind) {
    std::vector<OverlayMark> all;
    std::vector<OverlayMark> found;
    world.overlay().gather(all);
    for (const OverlayMark& mark : all) {
      if (mark.kind == kind) found.push_back(mark);
    }
    return found;
  }
};

TEST(Overlay, ABallAtRestIsHeldByItsOwnWeight) {
  OverlayStage s;
  s.show(true);
  s.gravity({0, 0, -9.81});
  (void)s.body("floor").add_part("floor", s.shape(plane_model()), 0, {});
  Part& ball = **s.body("ball").add_part("ball", s.shape(sphere_model(0.2)), 3, {{1, 2, 0.2}, quat_identity()});
  s.ticks(120);
  const std::vector<OverlayMark> contacts = s.marks(Kind::contact);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].slot, ball.id().slot);
  EXPECT_NEAR(contacts[0].vector.z, 1, 0.02) << "in weights, upwards";
  EXPECT_NEAR(glm::length(contacts[0].at - Vec3(1, 2, 0)), 0, 0.01);
  const std::vector<OverlayMark> centers = s.marks(Kind::center);
  ASSERT_EQ(centers.size(), 1U) << "the floor's is none";
  EXPECT_NEAR(glm::length(centers[0].at - ball.center()), 0, 1e-12);
  EXPECT_NEAR(centers[0].reach, std::sqrt(3 * 0.4) * 0.2, 1e-6);
}

TEST(Overlay, ForcesAreThoseOfTheTickBefore) {
  OverlayStage s;
  s.show(true);
  Part& ball = **s.body("ball").add_part("ball", s.shape(sphere_model(0.2)), 2, {});
  ball.apply_force({0, 3 * 2 * 9.81, 0});
  s.ticks(1);
  ASSERT_EQ(s.marks(Kind::force).size(), 1U);
  EXPECT_NEAR(s.marks(Kind::force)[0].vector.y, 3, 1e-9);
  s.ticks(1);
  EXPECT_TRUE(s.marks(Kind::force).empty());
  // an impulse counts as the force that would do the same in a tick
  ball.apply_impulse({2 * 9.81 / 60, 0, 0});
  s.ticks(1);
  ASSERT_EQ(s.marks(Kind::force).size(), 1U);
  EXPECT_NEAR(s.marks(Kind::force)[0].vector.x, 1, 1e-9);
  s.show(false);
  ball.apply_force({1, 0, 0});
  s.ticks(1);
  EXPECT_TRUE(s.marks(Kind::force).empty()) << "while it is off nothing is taken";
}

TEST(Overlay, JointsHaveTheirOpenAxesWithLimits) {
  OverlayStage s;
  Body& body = s.body("arm");
  Shape& ball = s.shape(sphere_model(0.1));
  Part& base = **body.add_part("base", ball, 0, {{0, 0, 1}, quat_identity()});
  Part& tip = **body.add_part("tip", ball, 1, {{1, 0, 1}, quat_identity()});
  Joint& hinge = **body.add_joint("hinge", base, tip, JointType::revolute, {0.5, 0, 1}, {0, 1, 0});
  s.set_one(hinge.id(), "angular_lower_limit", 2, -0.5);
  s.set_one(hinge.id(), "angular_upper_limit", 2, 1.5);
  s.world.settle();
  const std::vector<OverlayMark> turns = s.marks(Kind::turn);
  ASSERT_EQ(turns.size(), 1U) << "one axis is open";
  EXPECT_EQ(turns[0].axis, 2);
  EXPECT_TRUE(turns[0].limited);
  EXPECT_NEAR(turns[0].low, -0.5, 1e-6);
  EXPECT_NEAR(turns[0].high, 1.5, 1e-6);
  EXPECT_NEAR(glm::length(turns[0].at - Vec3(0.5, 0, 1)), 0, 1e-6);
  EXPECT_NEAR(glm::length(turns[0].turn * Vec3(0, 0, 1) - Vec3(0, 1, 0)), 0, 1e-6) << "the own axis, world";
  s.set_one(hinge.id(), "linear_upper_limit", 0, 0.25);
  s.world.settle();
  ASSERT_EQ(s.marks(Kind::shift).size(), 1U);
  EXPECT_EQ(s.marks(Kind::shift)[0].axis, 0);
  body.set_enabled(false);
  s.world.settle();
  EXPECT_TRUE(s.marks(Kind::turn).empty()) << "what is switched off is not there";
}

TEST(Overlay, AScenesOwnStyleWinsOverThePreferredOne) {
  OverlayStage s;
  const NodeId look = s.world.visuals().look().id();
  const Row& prefer = Look::table().at("prefer");
  const double studio = 1;
  ASSERT_TRUE(prefer.act(s.store.thing(look), {&studio, 1}).ok());
  EXPECT_EQ(s.number(look, "style"), 1);
  {
    const Store::Saying saying(s.store, true);
    s.set(look, "style", {0});
  }
  ASSERT_TRUE(prefer.act(s.store.thing(look), {&studio, 1}).ok());
  EXPECT_EQ(s.number(look, "style"), 0);
}

}  // namespace
}  // namespace limber::test
