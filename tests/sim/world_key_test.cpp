// World checkpoints: after a checkpoint is restored, all further ticks are the same bit for bit.
#include "sim/state/world_checkpoint.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "base/random.h"
#include "sim/arm.h"
#include "sim/behavior_rig.h"
#include "sim/counted_new.h"
#include "support/skip.h"

namespace limber::sim {
namespace {

using namespace test;

// A scene with scripted input: the input before each tick depends only on the tick.
struct ScriptedScene : BehaviorRig {
  std::vector<std::function<void(std::uint64_t tick)>> inputs;

  void play(int count) {
    for (int i = 0; i < count; i++) {
      for (const auto& input : inputs) input(world.tick());
      world.step();
    }
  }
  std::vector<std::uint64_t> hashes(int count) {
    std::vector<std::uint64_t> list;
    for (int i = 0; i < count; i++) {
      play(1);
      list.push_back(world.state_hash());
    }
    return list;
  }
};

// Boxes, balls, compounds and chains fall into a heap in which arms wave.
void heap(ScriptedScene& s, int count) {
  s.gravity({0, 0, -9.81});
  s.floor();
  model::ShapeModel two;
  two.kind = model::ShapeKind::compound;
  Shape& pair = s.shape(two);
  ASSERT_TRUE(pair.add_child(s.shape(box_model({0.3, 0.1, 0.1})), {{-0.1, 0, 0}, quat_identity()}).ok());
  ASSERT_TRUE(pair.add_child(s.shape(sphere_model(0.1)), {{0.15, 0, 0}, quat_identity()}).ok());
  Random random(7, "heap");
  for (int i = 0; i < count; i++) {
    const Pose at{{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0.3 + 0.15 * i},
                  quat_axis(random.direction(), random.uniform(0, 3))};
    if (i % 3 == 0) s.add_single_part(box_model({0.2, 0.25, 0.15}), 1, at);
    if (i % 3 == 1) s.add_single_part(sphere_model(0.1), 0.5, at);
    if (i % 3 == 2) (void)**s.body("pair" + std::to_string(i)).add_part("p", pair, 1, at);
  }
  for (int i = 0; i < 3; i++) {
    Body& arm = make_arm(s, "arm" + std::to_string(i), {4, {0.3 * i - 0.3, 0.6, 0.1}, i != 2});
    s.set(arm.parts().back()->id(), "report_contacts", {1});
    s.inputs.emplace_back([&s, &arm](std::uint64_t tick) { set_wave_targets(s, arm, static_cast<double>(tick) / 60); });
  }
}

// The direct solver's state of joints is restored.
TEST(WorldCheckpoint, RestoresDirectlySolvedJoints) {
  ScriptedScene s;
  s.set(s.world.id(), "solver", {1});
  heap(s, 6);
  s.play(40);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(60);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(60), first);
  checkpoint.release(pages);
}

// The smoothing of targets begins before or after the checkpoint.
TEST(WorldCheckpoint, RestoresSmoothedTargets) {
  ScriptedScene s;
  heap(s, 3);
  s.inputs.emplace_back([&s](std::uint64_t tick) {
    for (const int arm : {0, 1}) {
      if (tick != (arm == 0 ? 20u : 60u)) continue;
      for (const auto& motor : s.world.find_body("arm" + std::to_string(arm))->motors()) {
        s.set(motor->id(), "target_smoothing", {0.1});
      }
    }
  });
  s.play(40);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(60);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(60), first);
  checkpoint.release(pages);
}

TEST(WorldCheckpoint, RestoresContactsOfAHeap) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "RestoresEnabledAndDisabledBodies executes the same code");
  ScriptedScene s;
  heap(s, 40);
  s.play(50);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  for (int round = 0; round < 4; round++) {
    checkpoint.capture(s.world, pages, nullptr, scratch);
    const std::uint64_t at = s.world.state_hash();
    const std::vector<std::uint64_t> first = s.hashes(90);
    checkpoint.restore(s.world, pages, scratch);
    EXPECT_EQ(s.world.state_hash(), at);
    EXPECT_EQ(s.hashes(90), first) << "round " << round;
    checkpoint.release(pages);
  }
}

// Disabling and enabling removes bodies from Bullet's world and adds them again, with new boxes and pairs.
TEST(WorldCheckpoint, RestoresEnabledAndDisabledBodies) {
  ScriptedScene s;
  heap(s, 25);
  Random random(3, "switches");
  std::vector<std::pair<std::size_t, double>> switches;
  switches.reserve(400);
  for (int i = 0; i < 400; i++) switches.emplace_back(random.next() % s.world.bodies().size(), random.uniform());
  s.inputs.emplace_back([&](std::uint64_t tick) {
    const auto [body, chance] = switches[tick];
    if (chance < 0.3) s.set(s.world.bodies()[body]->id(), "enabled", {chance < 0.15 ? 0. : 1.});
    if (chance > 0.95) s.world.bodies()[body]->recovery().reset();
    if (chance > 0.9) s.set(s.world.id(), "gravity", {chance, 0, -9});
    if (chance > 0.8 && chance < 0.9) s.world.bodies()[body]->set_pose({{0, 0, 10 * chance - 7}, quat_identity()});
  });
  s.play(40);
  PageStore pages;
  Archive scratch;
  std::vector<WorldCheckpoint> checkpoints(6);
  for (std::size_t i = 0; i < checkpoints.size(); i++) {
    checkpoints[i].capture(s.world, pages, i == 0 ? nullptr : &checkpoints[i - 1], scratch);
    s.play(20);
  }
  const std::vector<std::uint64_t> first = s.hashes(60);
  for (const std::size_t i : {5u, 2u, 4u, 0u, 3u, 1u}) {
    checkpoints[i].restore(s.world, pages, scratch);
    EXPECT_EQ(s.world.tick(), 40 + 20 * i);
    s.play(static_cast<int>(20 * (checkpoints.size() - i)));
    EXPECT_EQ(s.hashes(60), first) << "from checkpoint " << i;
  }
}

TEST(WorldCheckpoint, ContainsPendingForcesAndDirtyProperties) {
  ScriptedScene s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  Part& other = s.add_single_part(sphere_model(0.1), 1, {{1, 0, 0}, quat_identity()});
  s.play(3);
  ball.apply_force({1, 2, 3});
  s.set(ball.id(), "mass", {2});
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(5);
  other.apply_impulse({5, 0, 0});
  s.set(other.id(), "mass", {9});
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(5), first);
  EXPECT_EQ(other.linear_velocity(), Vec3(0)) << "forces pending at the restore are discarded";
  other.apply_impulse({0, 1, 0});
  s.play(1);
  EXPECT_EQ(other.linear_velocity(), Vec3(0, 1, 0)) << "also after a new force was applied";
}

// Random generators, interval timers and errors; members of groups are stepped as before.
TEST(WorldCheckpoint, RestoresBehaviors) {
  ScriptedScene s;
  Body& a = s.chain("a", {"p", "q"});
  s.chain("b", {"p", "q"});
  Probe& probe = s.probe(a);
  s.group("all");
  s.inputs.emplace_back([&](std::uint64_t tick) {
    s.set(probe.id(), "broken", {tick % 40 == 20 ? 1. : 0.});
    if (tick % 40 == 30) s.set(probe.id(), "active", {1});
  });
  s.play(25);
  ASSERT_FALSE(probe.error().empty());
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::string error = probe.error();
  BehaviorRig::consume_calls();
  const std::vector<std::uint64_t> first = s.hashes(70);
  const std::vector<std::string> calls = BehaviorRig::consume_calls();
  const double last = probe.last;
  s.world.behaviors().on_body_reset(a);
  s.play(3);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(probe.error(), error);
  BehaviorRig::consume_calls();
  EXPECT_EQ(s.hashes(70), first);
  EXPECT_EQ(BehaviorRig::consume_calls(), calls);
  EXPECT_EQ(probe.last, last);
}

// The memory of thirty checkpoints depends on the moving parts, not on the size of the world.
TEST(WorldCheckpoint, CheckpointsShareUnchangedMemory) {
  ScriptedScene s;
  for (int i = 0; i < 300; i++) s.add_single_part(sphere_model(0.1), 0, {{i * 1.0, 0, 0}, quat_identity()});
  s.add_single_part(sphere_model(0.1), 1, {{0, 9, 0}, quat_identity()}).set_velocity({1, 0, 0}, {});
  s.play(2);
  PageStore pages;
  Archive scratch;
  std::vector<WorldCheckpoint> checkpoints(31);
  checkpoints[0].capture(s.world, pages, nullptr, scratch);
  const std::size_t one = pages.bytes();
  for (std::size_t i = 1; i < checkpoints.size(); i++) {
    s.play(1);
    checkpoints[i].capture(s.world, pages, &checkpoints[i - 1], scratch);
  }
  EXPECT_LT(pages.bytes(), 4 * one);
  for (WorldCheckpoint& checkpoint : checkpoints) checkpoint.release(pages);
  EXPECT_EQ(pages.bytes(), 0u);
}

// Checkpoints of a scene at rest allocate nothing.
TEST(WorldCheckpoint, DoesNotAllocateOnceWarm) {
  ScriptedScene s;
  heap(s, 30);
  s.play(60);
  PageStore pages;
  Archive scratch;
  std::vector<WorldCheckpoint> checkpoints(3);
  std::size_t allocated = 0;
  for (std::size_t i = 0; i < 46; i++) {
    s.play(1);
    const std::size_t before = test::allocations();
    checkpoints[i % 3].release(pages);
    checkpoints[i % 3].capture(s.world, pages, i == 0 ? nullptr : &checkpoints[(i + 2) % 3], scratch);
    if (i >= 40) allocated += test::allocations() - before;
  }
  EXPECT_EQ(allocated, 0u);
}

}  // namespace
}  // namespace limber::sim
