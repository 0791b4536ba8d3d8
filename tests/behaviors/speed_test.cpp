// speed: F = amount · (speed − |v|) · v̂, every tick.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Speed, PushesAlongTheMotionByTheDifference) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "speed");
  for (int i = 0; i < 20; i++) {
    const Vec3 v = s.draw3(-3, 3);
    const double target_speed = s.draw(0, 5);
    const double amount = s.draw(-4, 4);
    part.set_velocity(v, {0, 0, 0});
    s.set(b.id(), "speed", {target_speed});
    s.set(b.id(), "amount", {amount});
    s.clear(part);
    s.step_behaviors();
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    expect_near(s.force(part), amount * (target_speed - length) / length * v, 1e-12);
  }
}

TEST(Speed, PartsAtRestStayAtRest) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  s.add(part.body(), "speed");
  s.ticks(10);
  expect_near(part.linear_velocity(), {0, 0, 0}, 0);
}

// m·dv/dt = amount·(speed − v): the difference decreases by the factor 1 − amount·dt/m per tick.
TEST(Speed, ReachesTheSpeedLikeADampedMass) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0}, 2);
  Behavior& b = s.add(part.body(), "speed");
  s.set(b.id(), "speed", {4});
  s.set(b.id(), "amount", {6});
  part.set_velocity({0, 1, 0}, {0, 0, 0});
  s.ticks(30);
  EXPECT_NEAR(part.linear_velocity().y, 4 - 3 * std::pow(1 - 6.0 / 60 / 2, 30), 1e-4);
}

}  // namespace
}  // namespace limber::sim
