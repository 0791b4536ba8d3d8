// torque: τ = scale · torque, world axes.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Torque, IsScaledAndInWorldAxes) {
  Rig s;
  Part& part = s.add_single_part(box_model({0.1, 0.2, 0.3}), 1, {{0, 0, 0}, quat_axis({0, 0, 1}, 1)});
  Behavior& b = s.add(part.body(), "torque");
  s.set(b.id(), "torque", {1, -2, 3});
  s.set(b.id(), "scale", {-0.5});
  s.step_behaviors();
  expect_near(s.torque(part), {-0.5, 1, -1.5}, 1e-12);
  expect_near(s.force(part), {0, 0, 0}, 0);
}

TEST(Torque, AcceleratesABallByItsInertia) {
  Rig s;
  Part& part = s.add_single_part(sphere_model(0.5), 2);
  Behavior& b = s.add(part.body(), "torque");
  s.set(b.id(), "torque", {0, 0, 3});
  s.ticks(6);
  const double inertia = 0.4 * 2 * 0.25;
  EXPECT_NEAR(part.angular_velocity().z, 3 / inertia * 6 / 60, 1e-4);
}

TEST(Torque, AppliesAfterEachInterval) {
  Rig s;
  Part& part = s.add_single_part(sphere_model(0.5), 2);
  Behavior& b = s.add(part.body(), "torque");
  s.set(b.id(), "torque", {0, 0, 3});
  s.set(b.id(), "app_interval", {100});  // six ticks
  s.ticks(12);
  const double inertia = 0.4 * 2 * 0.25;
  EXPECT_NEAR(part.angular_velocity().z, 3 / inertia * 2 / 60, 1e-4);
}

}  // namespace
}  // namespace limber::sim
