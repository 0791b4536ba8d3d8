// Force accumulators: applied once, only to parts in the world; released elements are reused.
#include "sim/world/force_accumulators.h"

#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(ForceAccumulators, ForcesActInOneTick) {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.5), 2);
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

TEST(ForceAccumulators, DisabledBodyLosesPendingForces) {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.5), 2);
  s.ticks(1);
  part.body().set_enabled(false);
  part.apply_force({6, 0, 0});
  s.ticks(1);
  part.body().set_enabled(true);
  s.ticks(2);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
}

TEST(ForceAccumulators, ResetClearsThem) {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.5), 2);
  s.ticks(1);
  part.apply_force({6, 0, 0});
  part.apply_impulse({0, 6, 0});
  part.body().recovery().reset();
  s.ticks(1);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
}

TEST(ForceAccumulators, ReusesReleasedElements) {
  WorldFixture s;
  Part& one = s.add_single_part(sphere_model(0.5), 2);
  Part& two = s.add_single_part(sphere_model(0.5), 2, {{5, 0, 0}, quat_identity()});
  const std::uint32_t place = one.accumulator_index();
  one.apply_force({6, 0, 0});
  s.world.remove_body(one.body());
  Part& three = s.add_single_part(sphere_model(0.5), 2, {{0, 5, 0}, quat_identity()});
  EXPECT_EQ(three.accumulator_index(), place);
  EXPECT_NE(two.accumulator_index(), place);
  s.ticks(1);
  EXPECT_EQ(three.linear_velocity(), Vec3(0));
}

}  // namespace
}  // namespace limber::sim
