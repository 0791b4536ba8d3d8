// Key states: what follows after one was brought back is what followed before, to the bit, in every tick.
#include "sim/world_key.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "base/random.h"
#include "sim/arm.h"
#include "sim/behavior_rig.h"
#include "sim/counted_new.h"

namespace limber {
namespace {

using namespace test;

// a show that plays by itself: what is done to the world before each tick depends on the tick alone
struct Played : BehaviorRig {
  std::vector<std::function<void(std::uint64_t tick)>> hands;

  void play(int count) {
    for (int i = 0; i < count; i++) {
      for (const auto& hand : hands) hand(world.tick());
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

// boxes, balls, compounds and chains fall into a heap, arms wave in it
void heap(Played& s, int count) {
  s.gravity({0, 0, -9.81});
  s.floor();
  ShapeModel two;
  two.kind = ShapeKind::compound;
  Shape& pair = s.shape(two);
  ASSERT_TRUE(pair.add_child(s.shape(box_model({0.3, 0.1, 0.1})), {{-0.1, 0, 0}, quat_identity()}).ok());
  ASSERT_TRUE(pair.add_child(s.shape(sphere_model(0.1)), {{0.15, 0, 0}, quat_identity()}).ok());
  Random random(7, "heap");
  for (int i = 0; i < count; i++) {
    const Pose at{{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0.3 + 0.15 * i},
                  quat_axis(random.direction(), random.uniform(0, 3))};
    if (i % 3 == 0) s.lone(box_model({0.2, 0.25, 0.15}), 1, at);
    if (i % 3 == 1) s.lone(sphere_model(0.1), 0.5, at);
    if (i % 3 == 2) (void)**s.body("pair" + std::to_string(i)).add_part("p", pair, 1, at);
  }
  for (int i = 0; i < 3; i++) {
    Body& arm = make_arm(s, "arm" + std::to_string(i), {4, {0.3 * i - 0.3, 0.6, 0.1}, i != 2});
    s.set(arm.parts().back()->id(), "report_contacts", {1});
    s.hands.emplace_back([&s, &arm](std::uint64_t tick) { wave(s, arm, static_cast<double>(tick) / 60); });
  }
}

// what the direct solver remembers of joints from step to step comes back with them
TEST(WorldKey, JointsSolvedDirectlyComeBackToTheBit) {
  Played s;
  s.set(s.world.id(), "solver", {1});
  heap(s, 6);
  s.play(40);
  PageStore pages;
  KeyBytes scratch;
  WorldKey key;
  key.take(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(60);
  key.bring_back(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(60), first);
  key.release(pages);
}

// targets that are smoothed from before the key state on, and from behind it on
TEST(WorldKey, SmoothedTargetsComeBackToTheBit) {
  Played s;
  heap(s, 3);
  s.hands.emplace_back([&s](std::uint64_t tick) {
    for (const int arm : {0, 1}) {
      if (tick != (arm == 0 ? 20u : 60u)) continue;
      for (const auto& motor : s.world.find_body("arm" + std::to_string(arm))->motors()) {
        s.set(motor->id(), "target_smoothing", {0.1});
      }
    }
  });
  s.play(40);
  PageStore pages;
  KeyBytes scratch;
  WorldKey key;
  key.take(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(60);
  key.bring_back(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(60), first);
  key.release(pages);
}

TEST(WorldKey, ContactsOfAHeapComeBackToTheBit) {
  Played s;
  heap(s, 40);
  s.play(50);
  PageStore pages;
  KeyBytes scratch;
  WorldKey key;
  for (int round = 0; round < 4; round++) {
    key.take(s.world, pages, nullptr, scratch);
    const std::uint64_t at = s.world.state_hash();
    const std::vector<std::uint64_t> first = s.hashes(90);
    key.bring_back(s.world, pages, scratch);
    EXPECT_EQ(s.world.state_hash(), at);
    EXPECT_EQ(s.hashes(90), first) << "round " << round;
    key.release(pages);
  }
}

// switching off and on takes bodies out of Bullet's world and in again, with new boxes and pairs
TEST(WorldKey, BodiesThatAreSwitchedComeBack) {
  Played s;
  heap(s, 25);
  Random random(3, "switches");
  std::vector<std::pair<std::size_t, double>> switches;
  switches.reserve(400);
  for (int i = 0; i < 400; i++) switches.emplace_back(random.next() % s.world.bodies().size(), random.uniform());
  s.hands.emplace_back([&](std::uint64_t tick) {
    const auto [body, chance] = switches[tick];
    if (chance < 0.3) s.set(s.world.bodies()[body]->id(), "enabled", {chance < 0.15 ? 0. : 1.});
    if (chance > 0.95) s.world.bodies()[body]->reset();
    if (chance > 0.9) s.set(s.world.id(), "gravity", {chance, 0, -9});
    if (chance > 0.8 && chance < 0.9) s.world.bodies()[body]->set_pose({{0, 0, 10 * chance - 7}, quat_identity()});
  });
  s.play(40);
  PageStore pages;
  KeyBytes scratch;
  std::vector<WorldKey> keys(6);
  for (std::size_t i = 0; i < keys.size(); i++) {
    keys[i].take(s.world, pages, i == 0 ? nullptr : &keys[i - 1], scratch);
    s.play(20);
  }
  const std::vector<std::uint64_t> first = s.hashes(60);
  for (const std::size_t i : {5u, 2u, 4u, 0u, 3u, 1u}) {
    keys[i].bring_back(s.world, pages, scratch);
    EXPECT_EQ(s.world.tick(), 40 + 20 * i);
    s.play(static_cast<int>(20 * (keys.size() - i)));
    EXPECT_EQ(s.hashes(60), first) << "from key " << i;
  }
}

TEST(WorldKey, WaitingForcesAndMarksAreOfIt) {
  Played s;
  Part& ball = s.lone(sphere_model(0.1), 1);
  Part& other = s.lone(sphere_model(0.1), 1, {{1, 0, 0}, quat_identity()});
  s.play(3);
  ball.apply_force({1, 2, 3});
  s.set(ball.id(), "mass", {2});
  PageStore pages;
  KeyBytes scratch;
  WorldKey key;
  key.take(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = s.hashes(5);
  other.apply_impulse({5, 0, 0});
  s.set(other.id(), "mass", {9});
  key.bring_back(s.world, pages, scratch);
  EXPECT_EQ(s.hashes(5), first);
  EXPECT_EQ(other.linear_velocity(), Vec3(0)) << "what waited for it when the key came back is gone";
  other.apply_impulse({0, 1, 0});
  s.play(1);
  EXPECT_EQ(other.linear_velocity(), Vec3(0, 1, 0)) << "also when something waits again";
}

// generator, beats, faults; and members of groups are stepped as they were
TEST(WorldKey, BehaviorsGoOnFromWhereTheyWere) {
  Played s;
  Body& a = s.chain("a", {"p", "q"});
  s.chain("b", {"p", "q"});
  Probe& probe = s.probe(a);
  s.group("all");
  s.hands.emplace_back([&](std::uint64_t tick) {
    s.set(probe.id(), "broken", {tick % 40 == 20 ? 1. : 0.});
    if (tick % 40 == 30) s.set(probe.id(), "active", {1});
  });
  s.play(25);
  ASSERT_FALSE(probe.error().empty());
  PageStore pages;
  KeyBytes scratch;
  WorldKey key;
  key.take(s.world, pages, nullptr, scratch);
  const std::string error = probe.error();
  BehaviorRig::take_diary();
  const std::vector<std::uint64_t> first = s.hashes(70);
  const std::vector<std::string> diary = BehaviorRig::take_diary();
  const double last = probe.last;
  s.world.behaviors().body_reset(a);
  s.play(3);
  key.bring_back(s.world, pages, scratch);
  EXPECT_EQ(probe.error(), error);
  BehaviorRig::take_diary();
  EXPECT_EQ(s.hashes(70), first);
  EXPECT_EQ(BehaviorRig::take_diary(), diary);
  EXPECT_EQ(probe.last, last);
}

// thirty of them are a film of what moves, not thirty worlds
TEST(WorldKey, KeysShareWhatRests) {
  Played s;
  for (int i = 0; i < 300; i++) s.lone(sphere_model(0.1), 0, {{i * 1.0, 0, 0}, quat_identity()});
  s.lone(sphere_model(0.1), 1, {{0, 9, 0}, quat_identity()}).set_velocity({1, 0, 0}, {});
  s.play(2);
  PageStore pages;
  KeyBytes scratch;
  std::vector<WorldKey> keys(31);
  keys[0].take(s.world, pages, nullptr, scratch);
  const std::size_t one = pages.bytes();
  for (std::size_t i = 1; i < keys.size(); i++) {
    s.play(1);
    keys[i].take(s.world, pages, &keys[i - 1], scratch);
  }
  EXPECT_LT(pages.bytes(), 4 * one);
  for (WorldKey& key : keys) key.release(pages);
  EXPECT_EQ(pages.bytes(), 0u);
}

// a scene that stands takes its keys without asking the system for memory
TEST(WorldKey, AllocatesNothingOnceWarm) {
  Played s;
  heap(s, 30);
  s.play(60);
  PageStore pages;
  KeyBytes scratch;
  std::vector<WorldKey> keys(3);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < 46; i++) {
    s.play(1);
    const std::size_t before = test::allocations();
    keys[i % 3].release(pages);
    keys[i % 3].take(s.world, pages, i == 0 ? nullptr : &keys[(i + 2) % 3], scratch);
    if (i >= 40) taken += test::allocations() - before;
  }
  EXPECT_EQ(taken, 0u);
}

}  // namespace
}  // namespace limber
