// Panic: decay of the energy, terminal speed, and preservation of all settings.
#include "sim/world/panic.h"

#include <algorithm>
#include <cmath>

#include "sim/arm.h"
#include "sim/behavior_rig.h"

namespace limber::sim::test {
namespace {

constexpr double kTick = 1.0 / 60;

// Kinetic energy of all movable parts, J.
double moving_energy(const WorldFixture& s) {
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

double moving_mass(const WorldFixture& s) {
  double sum = 0;
  for (const auto& body : s.world.bodies()) {
    for (const auto& part : body->parts()) sum += part->mass();
  }
  return sum;
}

// The bound documented in panic.h.
double energy_bound(double at_first, double moved_mass, double time) {
  const double root =
      std::sqrt(at_first) * std::exp(-Panic::kDamping * time) + Panic::kTerminalSpeed * std::sqrt(moved_mass / 2);
  return root * root;
}

// Two arms that thrash on a floor among spinning balls; one hangs freely, one has springs.
struct ThrashingScene : WorldFixture {
  ThrashingScene() {
    gravity({0, 0, -9.81});
    floor();
    make_arm(*this, "fixed");
    Body& free = make_arm(*this, "free", {5, {2, 0, 1}, false});
    for (const auto& motor : free.motors()) {
      set(motor->id(), "mode", {3});
      set_one(motor->id(), "angular_spring_stiffness", 2, 50);
    }
    for (int i = 0; i < 6; i++) {
      Part& ball = add_single_part(sphere_model(0.1), 1, {{0.3 * i, 3, 1.0 + i}, quat_identity()});
      ball.set_velocity({6.0 - i, 2.0 * i, 3}, {20, -30, 10.0 * i});
    }
    for (int i = 0; i < 40; i++) {
      set_wave_targets(*this, *world.find_body("fixed"), 4 * i * kTick);
      for (const auto& part : free.parts()) part->apply_torque({3 * std::sin(i), 2, -2 * std::cos(2 * i)});
      world.step();
    }
  }
};

TEST(Panic, SpeedsDecayAtTheDocumentedRate) {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 2);
  ball.set_velocity({3, -4, 12}, {5, 6, -7});
  s.ticks(1);
  s.world.panic().begin();
  s.ticks(30);
  const double left = std::exp(-Panic::kDamping * 30 * kTick);
  for (int i = 0; i < 3; i++) {
    EXPECT_NEAR(ball.linear_velocity()[i], left * Vec3(3, -4, 12)[i], 1e-4);
    EXPECT_NEAR(ball.angular_velocity()[i], left * Vec3(5, 6, -7)[i], 1e-4);
  }
}

// v := (v − g·h)·e with g <= kDamping·kTerminalSpeed: converges to −g·h·e/(1 − e).
TEST(Panic, FallingPartsReachTheTerminalSpeedAtAnyGravity) {
  for (const double gravity : {9.81, 1000.0, 0.3}) {
    WorldFixture s;
    s.gravity({0, 0, -gravity});
    Part& ball = s.add_single_part(sphere_model(0.1), 2, {{0, 0, 50}, quat_identity()});
    s.ticks(10);
    s.world.panic().begin();
    s.ticks(180);
    const double e = std::exp(-Panic::kDamping * s.h());
    const double weight = std::min(gravity, Panic::kDamping * Panic::kTerminalSpeed);
    EXPECT_NEAR(ball.linear_velocity().z, -weight * s.h() * e / (1 - e), 1e-4) << gravity;
    EXPECT_LT(std::abs(ball.linear_velocity().z), Panic::kTerminalSpeed);
    s.world.panic().end();
    const double before = ball.linear_velocity().z;
    s.ticks(1);
    EXPECT_NEAR(ball.linear_velocity().z, before - gravity * kTick, 1e-3) << "full gravity again";
  }
}

TEST(Panic, EnergyStaysBelowTheBoundWithAnyMotors) {
  for (const double motors : {0.0, 1.0}) {
    ThrashingScene s;
    s.set(s.world.id(), "panic_motors", {motors});
    const double before = moving_energy(s);
    ASSERT_GT(before, 50);
    s.world.panic().begin();
    for (int i = 1; i <= 120; i++) {
      set_wave_targets(s, *s.world.find_body("fixed"), 4 * i * kTick);  // animating the motors changes nothing
      for (const auto& part : s.world.find_body("free")->parts()) part->apply_force({100, 0, 200});
      s.ticks(1);
      EXPECT_LE(moving_energy(s), 1.01 * energy_bound(before, moving_mass(s), i * kTick)) << i;
    }
    EXPECT_LT(moving_energy(s), 0.01 * before) << motors;
  }
}

TEST(Panic, HeldMotorsKeepThePoseLimpOnesDoNot) {
  for (const double motors : {0.0, 1.0}) {
    WorldFixture s;
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
      EXPECT_NEAR(moved, 0, 0.005) << "held for any time";
    } else {
      EXPECT_GT(moved, 0.1) << "it sinks";
    }
    s.world.panic().end();
    s.ticks(240);
    EXPECT_NEAR(std::remainder(arm.joints()[0]->value() + 1, 2 * kPi), 0, 0.05)
        << "values set during the panic apply after it";
  }
}

TEST(Panic, StacksRemainStanding) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Part& below = s.add_single_part(box_model({0.4, 0.4, 0.2}), 2, {{0, 0, 0.1}, quat_identity()});
  Part& above = s.add_single_part(box_model({0.2, 0.2, 0.2}), 1, {{0, 0, 0.3}, quat_identity()});
  s.ticks(60);
  const double heights[] = {below.pose().position.z, above.pose().position.z};
  s.world.panic().begin();
  s.ticks(300);
  EXPECT_NEAR(below.pose().position.z, heights[0], 1e-3);
  EXPECT_NEAR(above.pose().position.z, heights[1], 1e-3);
}

TEST(Panic, KeepsAllSettings) {
  ThrashingScene s;
  const auto settings = [&] {
    return std::vector<double>(s.store.persistent_values().begin(), s.store.persistent_values().end());
  };
  const std::vector<double> before = settings();
  const std::uint64_t hash = s.world.state_hash();
  s.world.panic().begin();
  EXPECT_EQ(s.number(s.world.id(), "panicked"), 1);
  EXPECT_NE(s.world.state_hash(), hash) << "the panic is part of the state";
  s.world.panic().end();
  EXPECT_EQ(s.number(s.world.id(), "panicked"), 0);
  EXPECT_EQ(s.world.state_hash(), hash);
  s.world.panic().begin();
  s.ticks(30);
  EXPECT_EQ(settings(), before);
}

TEST(Panic, BehaviorsPauseAndContinue) {
  BehaviorRig rig;
  Body& body = rig.chain("b", {"ball"});
  Behavior& probe = *rig.list().add(body, "probe", "probe").value();
  rig.ticks(3);
  const double last_draw = static_cast<Probe&>(probe).last;
  rig.world.panic().begin();
  body.parts()[0]->apply_impulse({5, 0, 0});
  rig.ticks(60);
  EXPECT_EQ(std::ranges::count(Probe::calls, "step b/probe"), 3);
  EXPECT_EQ(static_cast<Probe&>(probe).last, last_draw);
  EXPECT_EQ(rig.number(probe.id(), "active"), 1);
  EXPECT_EQ(rig.vec(body.parts()[0]->id(), "linear_velocity").x, 0) << "impulses are discarded";
  rig.world.panic().end();
  rig.ticks(1);
  EXPECT_EQ(std::ranges::count(Probe::calls, "step b/probe"), 4);
}

}  // namespace
}  // namespace limber::sim::test
