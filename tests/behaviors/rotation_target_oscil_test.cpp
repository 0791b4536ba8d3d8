// rotation_target_oscil: rotation_target towards target1 and target2 in turn.
#include "behaviors/rig.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;

struct Swing : OneAxisFixture {
  Swing() : OneAxisFixture(5) {
    set(motor.id(), "mode", {2});
    limits(-3, 3);
    world.flush();
    behavior = *world.behaviors().add(robot, "RotationTargetOscilBehavior", "swing");
    set(behavior->id(), "speed", {10});
    set(behavior->id(), "target1", {0, 0, -0.5});
    set(behavior->id(), "target2", {0, 0, 0.75});
  }
  // the servo's target in each of `count` ticks
  std::vector<double> play(int count) {
    std::vector<double> targets;
    for (int i = 0; i < count; i++) {
      ticks(1);
      targets.push_back(vec(motor.id(), "angular_servo_position").z);
    }
    return targets;
  }
  Behavior* behavior = nullptr;
};

std::vector<double> alternating(int count, int interval) {
  std::vector<double> expected;
  for (int i = 0; i < count; i++) expected.push_back(i / interval % 2 == 0 ? -0.5 : 0.75);
  return expected;
}

void expect_targets(const std::vector<double>& actual, const std::vector<double>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); i++) EXPECT_NEAR(actual[i], expected[i], 1e-6) << "tick " << i;
}

// 100 ms are six ticks.
TEST(RotationTargetOscil, ChangesTheTargetAtTheInterval) {
  Swing s;
  s.set(s.behavior->id(), "oscil_interval", {100});
  expect_targets(s.play(25), alternating(25, 6));
}

TEST(RotationTargetOscil, LeadsTheJointByItsSpeed) {
  Swing s;
  s.set(s.behavior->id(), "speed", {0.1});
  s.world.behaviors().step(s.world.timestep());
  EXPECT_NEAR(s.vec(s.motor.id(), "angular_servo_position").z, -0.1, 1e-6);
}

TEST(RotationTargetOscil, CheckpointsRestoreItsPhase) {
  Swing s;
  s.set(s.behavior->id(), "oscil_interval", {100});
  s.ticks(8);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<double> first = s.play(8);
  EXPECT_NEAR(first[0], 0.75, 1e-6);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(s.play(8), first);
  checkpoint.release(pages);
}

}  // namespace
}  // namespace limber::sim
