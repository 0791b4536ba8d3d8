// World transactions: forces, flags, added and removed objects, and Bullet's state, compared bit for bit.
#include "sim/state/world_transaction.h"

#include <gtest/gtest.h>

#include <functional>

#include "sim/arm.h"
#include "sim/counted_new.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

// A swinging arm and a flying ball: ten ticks, the call, and ten more ticks, then the state is hashed.
std::uint64_t hash_with(const std::function<void(WorldFixture&, Body& arm, Part& ball)>& call, bool commit) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm", {3, {0, 0, 0.05}});
  Part& ball = s.add_single_part(sphere_model(0.2), 1, {{-2, 0, 0.3}, quat_identity()});
  ball.set_velocity({1, 0.3, 0}, {0.1, 0.2, 0.3});
  for (int i = 0; i < 10; i++) s.world.step();
  ball.apply_force({0, 0, 1});  // pending when the call begins
  s.world.transaction().begin();
  call(s, arm, ball);
  if (commit) {
    s.world.transaction().commit();
  } else {
    s.world.transaction().rollback();
  }
  for (int i = 0; i < 10; i++) s.world.step();
  return s.world.state_hash();
}

struct WorldChange {
  const char* name;
  std::function<void(WorldFixture&, Body& arm, Part& ball)> call;
};

const std::vector<WorldChange>& world_changes() {
  static const std::vector<WorldChange> list = {
      {"force",
       [](WorldFixture&, Body&, Part& ball) {
         ball.apply_force_at({1, 2, 3}, {0, 0, 0});
       }},
      {"impulse",
       [](WorldFixture&, Body&, Part& ball) {
         ball.apply_impulse_at({1, 2, 3}, {0, 0, 1});
       }},
      {"clear", [](WorldFixture&, Body&, Part& ball) { ball.clear_forces(); }},
      {"pose",
       [](WorldFixture&, Body& arm, Part&) {
         arm.set_pose({{0, 1, 0}, quat_identity()});
       }},
      {"velocity",
       [](WorldFixture&, Body&, Part& ball) {
         ball.set_velocity({9, 9, 9}, {9, 9, 9});
       }},
      {"properties",
       [](WorldFixture& s, Body& arm, Part& ball) {
         s.set(ball.id(), "mass", {7});
         s.set(arm.motors()[0]->id(), "target", {0.5});
         s.set(s.world.id(), "gravity", {0, 0, 1});
       }},
      {"reset", [](WorldFixture&, Body& arm, Part& ball) { arm.recovery().reset(), ball.body().recovery().reset(); }},
      {"disable", [](WorldFixture&, Body& arm, Part&) { arm.set_enabled(false); }},
      {"remove", [](WorldFixture& s, Body& arm, Part&) { s.world.remove_body(arm); }},
      {"remove both",
       [](WorldFixture& s, Body& arm, Part& ball) { s.world.remove_body(arm), s.world.remove_body(ball.body()); }},
      {"copy", [](WorldFixture& s, Body& arm, Part&) { ASSERT_TRUE(s.world.copy_body(arm, "twin")); }},
      {"move, then copy",
       [](WorldFixture& s, Body& arm, Part&) {
         arm.set_pose({{0, 3, 0}, quat_identity()});
         ASSERT_TRUE(s.world.copy_body(arm, "twin"));
       }},
      {"a joint between parts that were moved",
       [](WorldFixture& s, Body&, Part& ball) {
         Shape& shape = **s.world.shapes().add("more", sphere_model(0.1));
         Part& part = **ball.body().add_part("more", shape, 1, {{0, 0, 4}, quat_identity()});
         ball.set_pose({{0, 0, 5}, quat_identity()});
         ball.set_velocity({1, 1, 1}, {1, 1, 1});
         Joint& joint = **ball.body().add_joint("j", ball, part, model::JointType::revolute, {0, 0, 4.5}, {0, 0, 1});
         ASSERT_TRUE(ball.body().add_motor(joint));
       }},
  };
  return list;
}

TEST(WorldTransaction, RollsBackBitForBit) {
  const auto nothing = [](WorldFixture&, Body&, Part&) {};
  const std::uint64_t expected = hash_with(nothing, true);
  EXPECT_EQ(hash_with(nothing, false), expected);
  for (const WorldChange& change : world_changes()) {
    EXPECT_EQ(hash_with(change.call, false), expected) << change.name;
    EXPECT_NE(hash_with(change.call, true), expected) << change.name;
  }
}

TEST(WorldTransaction, RollsBackAllChangesTogether) {
  const std::uint64_t expected = hash_with([](WorldFixture&, Body&, Part&) {}, true);
  EXPECT_EQ(hash_with(
                [](WorldFixture& s, Body& arm, Part& ball) {
                  for (const WorldChange& change : world_changes()) {
                    if (!s.store.alive(arm.id())) return;
                    change.call(s, arm, ball);
                  }
                },
                false),
            expected);
}

TEST(WorldTransaction, RollsBackRequests) {
  WorldFixture s;
  s.world.transaction().begin();
  s.world.requests().end_panic();
  EXPECT_FALSE(s.world.transaction().is_empty());
  s.world.transaction().rollback();
  EXPECT_FALSE(std::exchange(s.world.requests().panic_end, false));
}

TEST(WorldTransaction, RestoresARemovedBodyAtItsIndex) {
  WorldFixture s;
  Body& one = **s.world.add_body("one");
  Body& two = **s.world.add_body("two");
  ASSERT_TRUE(s.world.add_body("three"));
  const NodeId id = two.id();
  s.world.transaction().begin();
  s.world.remove_body(two);
  EXPECT_FALSE(s.store.alive(id));
  EXPECT_EQ(s.world.find_body("two"), nullptr);
  EXPECT_EQ(s.world.bodies().size(), 2u);
  ASSERT_TRUE(s.world.add_body("two"));  // its name is free
  s.world.remove_body(one);
  s.world.transaction().rollback();
  EXPECT_EQ(s.world.body_names(), (std::vector<std::string_view>{"one", "two", "three"}));
  EXPECT_EQ(s.world.find_body("two")->id(), id);
}

TEST(WorldTransaction, CommittedRemovalIsFinal) {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.2), 1, {{0, 0, 0}, quat_identity()});
  s.world.step();
  const NodeId id = ball.body().id();
  const std::size_t slots = s.store.view()->slot_count;
  s.world.transaction().begin();
  s.world.remove_body(ball.body());
  s.world.transaction().commit();
  EXPECT_FALSE(s.store.alive(id));
  EXPECT_TRUE(s.world.bodies().empty());
  s.world.step();
  ASSERT_TRUE(s.world.add_body("next"));
  EXPECT_EQ(s.store.view()->slot_count, slots);  // reuses the slots of the removed body
}

TEST(WorldTransaction, RemovesAddedObjectsNewestFirst) {
  WorldFixture s;
  s.world.transaction().begin();
  Shape& shape = **s.world.shapes().add("ball", sphere_model(0.1));
  Body& body = **s.world.add_body("body");
  Part& a = **body.add_part("a", shape, 1, {{0, 0, 0}, quat_identity()});
  Part& b = **body.add_part("b", shape, 1, {{0, 0, 1}, quat_identity()});
  ASSERT_TRUE(body.add_motor(**body.add_joint("j", a, b, model::JointType::revolute, {0, 0, 0.5}, {0, 0, 1})));
  b.apply_force({1, 0, 0});
  s.world.transaction().rollback();
  EXPECT_TRUE(s.world.bodies().empty());
  EXPECT_TRUE(s.world.shapes().list().empty());
  s.world.step();
}

TEST(WorldTransaction, RemovesAddedChildrenOfACompound) {
  WorldFixture s;
  model::ShapeModel model;
  model.kind = model::ShapeKind::compound;
  Shape& both = **s.world.shapes().add("both", model);
  Shape& ball = **s.world.shapes().add("ball", sphere_model(0.1));
  ASSERT_TRUE(both.add_child(ball, {}));
  s.world.transaction().begin();
  s.world.transaction().save(both);
  ASSERT_TRUE(both.add_child(ball, {{1, 0, 0}, quat_identity()}));
  s.world.transaction().rollback();
  EXPECT_EQ(both.child_count(), 1u);
}

TEST(WorldTransaction, UndoFunctionsOfOtherModulesRunNewestFirst) {
  WorldFixture s;
  std::vector<std::size_t> order;
  const auto step = [](void* owner, std::size_t value) {
    static_cast<std::vector<std::size_t>*>(owner)->push_back(value);
  };
  s.world.transaction().record(step, &order, 9);  // no effect outside of a call
  s.world.transaction().begin();
  for (std::size_t i = 1; i <= 3; i++) s.world.transaction().record(step, &order, i);
  s.world.transaction().rollback();
  EXPECT_EQ(order, (std::vector<std::size_t>{3, 2, 1}));
}

TEST(WorldTransaction, DoesNotAllocateOnceWarm) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {6, {0, 0, 0.05}});
  const Property& target = Motor::table().at("target");
  const auto call = [&](int i) {
    s.world.transaction().begin();
    const double value = 0.3 * std::sin(0.05 * i);
    for (const auto& motor : arm.motors()) (void)s.store.set(motor->id(), target, {&value, 1});
    for (const auto& part : arm.parts()) {
      part->apply_force({0.1, 0, 0});
      part->set_velocity({0, 0, value}, {0, 0, 0});
    }
    if (i % 2 == 0) {
      s.world.transaction().commit();
    } else {
      s.world.transaction().rollback();
    }
    s.world.step();
  };
  for (int i = 0; i < 60; i++) call(i);
  const std::size_t before = allocations();
  for (int i = 60; i < 160; i++) call(i);
  EXPECT_EQ(allocations() - before, 0u);
}

}  // namespace
}  // namespace limber::sim
