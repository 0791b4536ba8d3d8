// Loads: what waits is handed over once, to parts in the world only; places are used again.
#include "sim/part_loads.h"

#include "sim/stage.h"

namespace limber {
namespace {

using namespace test;

TEST(PartLoads, WhatWaitsActsInOneTick) {
  Stage s;
  Part& part = s.lone(sphere_model(0.5), 2);
  part.apply_force({6, 0, 0});
  part.apply_force({0, 12, 0});
  part.apply_torque({0, 0, 1});
  part.apply_impulse({0, 0, 4});
  s.ticks(1);
  EXPECT_NEAR(part.linear_velocity().x, 6.0 / 2 / 60, 1e-6);
  EXPECT_NEAR(part.linear_velocity().y, 12.0 / 2 / 60, 1e-6);
  EXPECT_NEAR(part.linear_velocity().z, 4.0 / 2, 1e-6);
  EXPECT_NEAR(part.angular_velocity().z, 1 / (0.4 * 2 * 0.25) / 60, 1e-6);
  const Vec3 before = part.linear_velocity();
  s.ticks(5);
  EXPECT_EQ(part.linear_velocity(), before);
}

TEST(PartLoads, ABodyThatIsOutLosesWhatWaited) {
  Stage s;
  Part& part = s.lone(sphere_model(0.5), 2);
  s.ticks(1);
  part.body().set_enabled(false);
  part.apply_force({6, 0, 0});
  s.ticks(1);
  part.body().set_enabled(true);
  s.ticks(2);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
}

TEST(PartLoads, AResetForgetsThem) {
  Stage s;
  Part& part = s.lone(sphere_model(0.5), 2);
  s.ticks(1);
  part.apply_force({6, 0, 0});
  part.apply_impulse({0, 6, 0});
  part.body().reset();
  s.ticks(1);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
}

TEST(PartLoads, PlacesAreUsedAgain) {
  Stage s;
  Part& one = s.lone(sphere_model(0.5), 2);
  Part& two = s.lone(sphere_model(0.5), 2, {{5, 0, 0}, quat_identity()});
  const std::uint32_t place = one.load_place();
  one.apply_force({6, 0, 0});
  s.world.remove_body(one.body());
  Part& three = s.lone(sphere_model(0.5), 2, {{0, 5, 0}, quat_identity()});
  EXPECT_EQ(three.load_place(), place);
  EXPECT_NE(two.load_place(), place);
  s.ticks(1);
  EXPECT_EQ(three.linear_velocity(), Vec3(0));
}

}  // namespace
}  // namespace limber
