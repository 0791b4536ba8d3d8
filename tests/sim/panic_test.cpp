// A panic: how fast the energy goes, how slowly things sink, and that nothing of what was set is lost.
#include "sim/panic.h"

#include <algorithm>
#include <cmath>

#include "sim/arm.h"
#include "sim/behavior_rig.h"

namespace limber::test {
namespace {

constexpr double kTick = 1.0 / 60;

// of all that moves, J
double moving_energy(const Stage& s) {
  double sum = 0;
  for (const auto& body : s.world.bodies()) {
    for (const auto& part : body->parts()) {
      if (part->is_static()) continue;
      const Vec3 v = part->linear_velocity();
      const Vec3 w = glm::conjugate(part->principal_axes()) * part->angular_velocity();
      sum += 0.5 * part->mass() * glm::dot(v, v) + 0.5 * glm::dot(s.vec(part->id(), "inertia"), w * w);
    }
  }
  return sum;
}

double moving_mass(const Stage& s) {
  double sum = 0;
  for (const auto& body : s.world.bodies()) {
    for (const auto& part : body->parts()) sum += part->mass();
  }
  return sum;
}

// what panic.h promises
double most_energy(double at_first, double moved_mass, double time) {
  const double root = std::sqrt(at_first) * std::exp(-Panic::kBrake * time) + Panic::kSink * std::sqrt(moved_mass / 2);
  return root * root;
}

// two arms that thrash on a floor among spinning balls; one hangs free, one has springs
struct Wild : Stage {
  Wild() {
    gravity({0, 0, -9.81});
    floor();
    make_arm(*this, "fixed");
    Body& free = make_arm(*this, "free", {5, {2, 0, 1}, false});
    for (const auto& motor : free.motors()) {
      set(motor->id(), "mode", {3});
      set_one(motor->id(), "angular_spring_stiffness", 2, 50);
    }
    for (int i = 0; i < 6; i++) {
      Part& ball = lone(sphere_model(0.1), 1, {{0.3 * i, 3, 1.0 + i}, quat_identity()});
      ball.set_velocity({6.0 - i, 2.0 * i, 3}, {20, -30, 10.0 * i});
    }
    for (int i = 0; i < 40; i++) {
      wave(*this, *world.find_body("fixed"), 4 * i * kTick);
      for (const auto& part : free.parts()) part->apply_torque({3 * std::sin(i), 2, -2 * std::cos(2 * i)});
      world.step();
    }
  }
};

TEST(Panic, SpeedsFallAlikeAndAsFastAsItSays) {
  Stage s;
  Part& ball = s.lone(sphere_model(0.1), 2);
  ball.set_velocity({3, -4, 12}, {5, 6, -7});
  s.ticks(1);
  s.world.panic().begin();
  s.ticks(30);
  const double left = std::exp(-Panic::kBrake * 30 * kTick);
  for (int i = 0; i < 3; i++) {
    EXPECT_NEAR(ball.linear_velocity()[i], left * Vec3(3, -4, 12)[i], 1e-4);
    EXPECT_NEAR(ball.angular_velocity()[i], left * Vec3(5, 6, -7)[i], 1e-4);
  }
}

// v := (v − g·h)·e with g = kBrake·kSink at most: comes to rest at −g·h·e/(1 − e)
TEST(Panic, WhatFallsSinksAtOneSpeedWhateverGravityIs) {
  for (const double gravity : {9.81, 1000.0, 0.3}) {
    Stage s;
    s.gravity({0, 0, -gravity});
    Part& ball = s.lone(sphere_model(0.1), 2, {{0, 0, 50}, quat_identity()});
    s.ticks(10);
    s.world.panic().begin();
    s.ticks(180);
    const double e = std::exp(-Panic::kBrake * s.h());
    const double weight = std::min(gravity, Panic::kBrake * Panic::kSink);
    EXPECT_NEAR(ball.linear_velocity().z, -weight * s.h() * e / (1 - e), 1e-4) << gravity;
    EXPECT_LT(std::abs(ball.linear_velocity().z), Panic::kSink);
    s.world.panic().end();
    const double before = ball.linear_velocity().z;
    s.ticks(1);
    EXPECT_NEAR(ball.linear_velocity().z, before - gravity * kTick, 1e-3) << "all of it again";
  }
}

TEST(Panic, TheEnergyStaysBelowTheBoundWhateverMotorsDo) {
  for (const double motors : {0.0, 1.0}) {
    Wild s;
    s.set(s.world.id(), "panic_motors", {motors});
    const double before = moving_energy(s);
    ASSERT_GT(before, 50);
    s.world.panic().begin();
    for (int i = 1; i <= 120; i++) {
      wave(s, *s.world.find_body("fixed"), 4 * i * kTick);  // who goes on playing changes nothing
      for (const auto& part : s.world.find_body("free")->parts()) part->apply_force({100, 0, 200});
      s.ticks(1);
      EXPECT_LE(moving_energy(s), 1.01 * most_energy(before, moving_mass(s), i * kTick)) << i;
    }
    EXPECT_LT(moving_energy(s), 0.01 * before) << motors;
  }
}

TEST(Panic, HeldMotorsKeepThePoseLimpOnesGiveWay) {
  for (const double motors : {0.0, 1.0}) {
    Stage s;
    s.gravity({0, 0, -9.81});
    Body& arm = make_arm(s, "arm");
    s.set(arm.motors()[0]->id(), "target", {1.2});
    s.ticks(120);
    const double before = arm.joints()[0]->value();
    ASSERT_NEAR(before, 1.2, 0.05);
    s.set(s.world.id(), "panic_motors", {motors});
    s.world.panic().begin();
    s.set(arm.motors()[0]->id(), "target", {-1});
    s.ticks(motors == 0 ? 1200 : 120);
    const double moved = arm.joints()[0]->value() - before;
    if (motors == 0) {
      EXPECT_NEAR(moved, 0, 0.005) << "for as long as it takes";
    } else {
      EXPECT_GT(moved, 0.1) << "it sinks";
    }
    s.world.panic().end();
    s.ticks(240);
    EXPECT_NEAR(std::remainder(arm.joints()[0]->value() + 1, 2 * kPi), 0, 0.05)
        << "what was set meanwhile counts from the end on";
  }
}

TEST(Panic, ThingsStandOnThings) {
  Stage s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Part& below = s.lone(box_model({0.4, 0.4, 0.2}), 2, {{0, 0, 0.1}, quat_identity()});
  Part& above = s.lone(box_model({0.2, 0.2, 0.2}), 1, {{0, 0, 0.3}, quat_identity()});
  s.ticks(60);
  const double heights[] = {below.pose().position.z, above.pose().position.z};
  s.world.panic().begin();
  s.ticks(300);
  EXPECT_NEAR(below.pose().position.z, heights[0], 1e-3);
  EXPECT_NEAR(above.pose().position.z, heights[1], 1e-3);
}

TEST(Panic, NothingThatWasSetIsChanged) {
  Wild s;
  const auto kept = [&] { return std::vector<double>(s.store.kept().begin(), s.store.kept().end()); };
  const std::vector<double> before = kept();
  const std::uint64_t hash = s.world.state_hash();
  s.world.panic().begin();
  EXPECT_EQ(s.number(s.world.id(), "panicked"), 1);
  EXPECT_NE(s.world.state_hash(), hash) << "the same world goes on otherwise";
  s.world.panic().end();
  EXPECT_EQ(s.number(s.world.id(), "panicked"), 0);
  EXPECT_EQ(s.world.state_hash(), hash);
  s.world.panic().begin();
  s.ticks(30);
  EXPECT_EQ(kept(), before);
}

TEST(Panic, BehaviorsRestAndGoOn) {
  BehaviorRig rig;
  Body& body = rig.chain("b", {"ball"});
  Behavior& probe = *rig.list().add(body, "probe", "probe").value();
  rig.ticks(3);
  const double drawn = static_cast<Probe&>(probe).last;
  rig.world.panic().begin();
  body.parts()[0]->apply_impulse({5, 0, 0});
  rig.ticks(60);
  EXPECT_EQ(std::ranges::count(Probe::diary, "step b/probe"), 3);
  EXPECT_EQ(static_cast<Probe&>(probe).last, drawn);
  EXPECT_EQ(rig.number(probe.id(), "active"), 1);
  EXPECT_EQ(rig.vec(body.parts()[0]->id(), "linear_velocity").x, 0) << "a blow is lost";
  rig.world.panic().end();
  rig.ticks(1);
  EXPECT_EQ(std::ranges::count(Probe::diary, "step b/probe"), 4);
}

}  // namespace
}  // namespace limber::test
