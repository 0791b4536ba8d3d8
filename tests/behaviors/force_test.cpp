// force: F = d̂ir · clamp(amp, −max_amp, max_amp) on each part.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Force, AppliesTheForceAlongDirOfAnyLength) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {1, 0, 0});
  Behavior& b = s.add(body, "force");
  s.set(b.id(), "dir", {0, 30, 40});
  s.set(b.id(), "amp", {10});
  s.step_behaviors();
  for (const Part* part : {&one, &two}) {
    expect_near(s.force(*part), {0, 6, 8}, 1e-12);
    expect_near(s.torque(*part), {0, 0, 0}, 0);
  }
}

TEST(Force, IsLimitedToMaxAmpInBothDirections) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "force");
  s.set(b.id(), "max_amp", {5});
  for (const double amp : {4.0, 7.0, -3.0, -8.0}) {
    s.set(b.id(), "amp", {amp});
    s.clear(part);
    s.step_behaviors();
    expect_near(s.force(part), {amp > 5 ? 5 : amp < -5 ? -5 : amp, 0, 0}, 1e-12);
  }
}

TEST(Force, ZeroDirectionAppliesNoForce) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "force");
  s.set(b.id(), "dir", {0, 0, 0});
  s.set(b.id(), "amp", {10});
  s.step_behaviors();
  expect_near(s.force(part), {0, 0, 0}, 0);
}

// A force F for one tick of dt changes the velocity by F·dt/m, with any number of substeps.
TEST(Force, ActsOnEveryInternalStepOfTheTick) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0}, 2);
  Behavior& b = s.add(part.body(), "force");
  s.set(b.id(), "amp", {12});
  s.substeps(7);
  s.ticks(1);
  EXPECT_NEAR(part.linear_velocity().x, 12.0 / 2 / 60, 1e-6);
  s.ticks(1);
  EXPECT_NEAR(part.linear_velocity().x, 2 * 12.0 / 2 / 60, 1e-6);
}

// An interval of 10 ms with ticks of 4 ms: at 0, 12, 20, 32, 40 … ms, 100 times per simulated second.
TEST(Force, IntervalDoesNotDrift) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "force");
  s.set(s.world.id(), "timestep", {0.004});
  s.set(b.id(), "amp", {1});
  s.set(b.id(), "app_interval", {10});
  std::vector<int> fired;
  double before = 0;
  for (int tick = 0; tick < 250; tick++) {
    s.ticks(1);
    if (part.linear_velocity().x > before + 0.002) fired.push_back(4 * tick);
    before = part.linear_velocity().x;
  }
  EXPECT_EQ(fired.size(), 100U);
  EXPECT_EQ((std::vector<int>(fired.begin(), fired.begin() + 6)), (std::vector<int>{0, 12, 20, 32, 40, 52}));
}

}  // namespace
}  // namespace limber::sim
