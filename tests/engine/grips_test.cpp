// Mouse springs: they pull with any mass and are removed after a time.
#include "engine/commands/mouse_springs.h"

#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr const char* kBallScene = R"(
sim.gravity = vec3(0, 0, 0)
local body = sim:add_body("body")
body:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1), mass = 2 })
body:add_part("base", "ball", { position = vec3(5, 0, 1), mass = 0 })
)";

TEST(MouseSprings, PullAPointToTheTarget) {
  const SceneFile file(kBallScene);
  Show show(file.path());
  for (int i = 0; i < 120; i++) {
    show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 1, 2, 3);
    show.ticks(1);
  }
  EXPECT_NEAR(show.read("/physics/body/body/part/ball/position", 0), 1, 0.01);
  EXPECT_NEAR(show.read("/physics/body/body/part/ball/position", 1), 2, 0.01);
  EXPECT_NEAR(show.read("/physics/body/body/part/ball/position", 2), 3, 0.01);
}

// k = m·ω², c = 2·m·ω: from rest at distance d, after t: d·(1 + ω·t)·e^(−ω·t), a little more as forces come by ticks
TEST(MouseSprings, MoveAFreeBodyWithoutOvershoot) {
  const SceneFile file(kBallScene);
  Show show(file.path());
  double max_x = 0;
  for (int i = 1; i <= 60; i++) {
    show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 1, 0, 1);
    show.ticks(1);
    const double x = show.read("/physics/body/body/part/ball/position", 0);
    max_x = std::max(max_x, x);
    const double t = MouseSprings::kOmega * i / 60.0;
    EXPECT_NEAR(1 - x, (1 + t) * std::exp(-t), 0.12) << "tick " << i;
  }
  EXPECT_LT(max_x, 1.02);
}

TEST(MouseSprings, MoveAKinematicPart) {
  const SceneFile file(kBallScene);
  Show show(file.path());
  show.send("/physics/part/hold", "body", "base", 0, 0, 0, 5, 3, 1);
  show.ticks(2);
  EXPECT_EQ(show.read("/physics/body/body/part/base/position", 1), 0) << "it is static";
  show.send("/physics/body/body/part/base/motion", "kinematic");
  show.ticks(1);
  show.send("/physics/part/hold", "body", "base", 0, 0, 0.1, 5, 0.5, 1.1);
  show.ticks(1);
  EXPECT_NEAR(show.read("/physics/body/body/part/base/position", 1), 0.5, 1e-6);
  EXPECT_NEAR(show.read("/physics/body/body/part/base/linear_velocity", 1), 0.5 * 60, 1e-3);
  show.ticks(1);
  EXPECT_NEAR(show.read("/physics/body/body/part/base/linear_velocity", 1), 0, 1e-3);
}

TEST(MouseSprings, AreRemovedAfterATimeout) {
  const SceneFile file(kBallScene);
  Show show(file.path());
  show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 0, 100, 1);
  show.ticks(32);
  const double speed = show.read("/physics/body/body/part/ball/linear_velocity", 1);
  EXPECT_GT(speed, 1);
  show.ticks(10);
  EXPECT_EQ(show.read("/physics/body/body/part/ball/linear_velocity", 1), speed) << "after half a second it is free";
  show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 0, 100, 1);
  show.ticks(1);
  show.send("/physics/part/release", "body", "ball");
  const double speed_after_release = show.read("/physics/body/body/part/ball/linear_velocity", 1);
  show.ticks(5);
  EXPECT_EQ(show.read("/physics/body/body/part/ball/linear_velocity", 1), speed_after_release)
      << "or at once, by /physics/part/release";
}

TEST(MouseSprings, PullALightTipOfAHeavyBodyStably) {
  const SceneFile file(R"(
sim.gravity = vec3(0, 0, 0)
local body = sim:add_body("body")
body:add_part("heavy", sim:add_sphere_shape("ball", 0.2), { position = vec3(0, 0, 1), mass = 50 })
body:add_part("tip", "ball", { position = vec3(0, 0, 2), mass = 0.01 })
body:add_joint("j", "heavy", "tip", { axis = vec3(0, 1, 0), position = vec3(0, 0, 1.5) })
)");
  Show show(file.path());
  for (int i = 0; i < 300; i++) {
    show.send("/physics/part/hold", "body", "tip", 0, 0, 0, 0.5, 0, 2);
    show.ticks(1);
    ASSERT_LT(std::abs(show.read("/physics/body/body/part/tip/linear_velocity", 0)), 20) << "tick " << i;
  }
}

TEST(MouseSprings, RejectInvalidMessages) {
  const SceneFile file(kBallScene);
  Show show(file.path());
  const auto rejected_count = [&] { return show.link.counters.refused.load(); };
  show.send("/physics/part/hold", "body", "base", 0, 0, 0, 1, 0, 1);
  show.send("/physics/part/hold", "body", "missing", 0, 0, 0, 1, 0, 1);
  show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 1, 0);
  show.send("/physics/part/hold", "body", "*", 0, 0, 0, 1, 0, 1);
  show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 1, 0, std::numeric_limits<double>::quiet_NaN());
  show.ticks(1);
  EXPECT_EQ(rejected_count(), 5u);
  show.send("/physics/part/hold", "body", "ball", 0, 0, 0, 1, 0, 1);
  show.send("/physics/body/body/remove");
  show.ticks(3);
  EXPECT_EQ(rejected_count(), 5u) << "the spring of a removed part is removed";
}

}  // namespace
}  // namespace limber::engine::test
