// Tendons: closed forms of lengths, tensions and oscillations, with either solver; momentum, energy, stiffness, bad
// input, removal, copies, checkpoints.
#include "sim/tendons/tendon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"
#include "sim/tendons/tendon_list.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kPull = 9.81;

// A static ball at the origin, and balls that tendons connect.
struct TendonFixture : WorldFixture {
  explicit TendonFixture(bool direct = true) : robot(body("robot")), anchor(part(robot, sphere_model(0.05), 0)) {
    set(world.id(), "solver", {direct ? 1.0 : 0.0});
  }
  Part& ball(const Vec3& at, double mass = 1) { return part(robot, sphere_model(0.1), mass, {at, quat_identity()}); }
  Tendon& tendon(std::vector<Tendon::Point> points, double stiffness, double damping = 0) {
    const std::string name = "tendon" + std::to_string(world.tendons().list().size());
    Tendon& added = *world.tendons().add(robot, name, std::move(points)).value();
    set(added.id(), "stiffness", {stiffness});
    set(added.id(), "damping", {damping});
    return added;
  }
  std::string refusal(std::vector<Tendon::Point> points, const std::string& name = "cable") {
    const Result<Tendon*> added = world.tendons().add(robot, name, std::move(points));
    return added ? "" : added.error();
  }
  double energy() const { return number(world.id(), "kinetic_energy") + number(world.id(), "potential_energy"); }

  Body& robot;
  Part& anchor;
};

class TendonSolvers : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Both, TendonSolvers, testing::Bool(),
                         [](const auto& p) { return std::string(p.param ? "direct" : "iterative"); });

TEST_P(TendonSolvers, AHangingMassStretchesByItsWeight) {
  TendonFixture t(GetParam());
  t.gravity({0, 0, -kPull});
  Part& ball = t.ball({0, 0, -1}, 2);
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {}}}, 500, 40);
  t.ticks(600);
  EXPECT_NEAR(t.number(cable.id(), "length"), 1 + 2 * kPull / 500, 1e-5);
  EXPECT_NEAR(t.number(cable.id(), "force"), 2 * kPull, 1e-3);
  EXPECT_NEAR(t.number(cable.id(), "speed"), 0, 1e-5);
}

TEST_P(TendonSolvers, OscillatesWithThePeriodOfASpring) {
  TendonFixture t(GetParam());
  t.gravity({0, 0, -kPull});
  Part& ball = t.ball({0, 0, -1}, 2);
  const double stiffness = 400;
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {}}}, stiffness);
  t.set(cable.id(), "rest_length", {1 - 1.5 * 2 * kPull / stiffness});
  const double rest = 1 - 0.5 * 2 * kPull / stiffness;  // its mean length
  std::vector<double> passes;
  double before = ball.center().z + rest;
  double lowest = 0;
  for (int i = 0; i < 600; i++) {
    t.ticks(1);
    const double now = ball.center().z + rest;
    if (before > 0 && now <= 0) passes.push_back((i + before / (before - now)) / 60);
    if (i > 500) lowest = std::min(lowest, now);
    before = now;
  }
  ASSERT_GE(passes.size(), 10u);
  const double period = (passes.back() - passes.front()) / static_cast<double>(passes.size() - 1);
  EXPECT_NEAR(period, 2 * std::numbers::pi * std::sqrt(2 / stiffness), 0.01 * period);
  EXPECT_NEAR(lowest, -0.5 * 2 * kPull / stiffness, 0.02 * 0.5 * 2 * kPull / stiffness) << "the amplitude after 9 s";
}

// The cable pulls the middle point along both segments, so 2·T·sin(a) carries it.
TEST_P(TendonSolvers, APulleyCarriesTwiceTheTension) {
  TendonFixture t(GetParam());
  t.gravity({0, 0, -kPull});
  Part& pulley = t.ball({0, 0, -1}, 3);
  Tendon& cable = t.tendon({{&t.anchor, {-0.01, 0, 0}}, {&pulley, {}}, {&t.anchor, {0.01, 0, 0}}}, 2000, 100);
  t.ticks(900);
  const double half = t.number(cable.id(), "length") / 2;
  const double sine = -pulley.center().z / half;
  EXPECT_NEAR(t.number(cable.id(), "force") * 2 * sine, 3 * kPull, 2e-3);
  EXPECT_NEAR(t.number(cable.id(), "force"), 2000 * (2 * half - 2 * std::hypot(1, 0.01)), 0.05);
}

// Atwood's machine: the cable slides over two static points, so both masses have the same tension 2·m1·m2·g/(m1 + m2).
TEST_P(TendonSolvers, SlidesThroughItsPointsWithTheSameTension) {
  TendonFixture t(GetParam());
  t.gravity({0, 0, -kPull});
  Part& light = t.ball({-1, 0, -2}, 1);
  Part& heavy = t.ball({1, 0, -2}, 2);
  Tendon& cable = t.tendon({{&light, {}}, {&t.anchor, {-1, 0, 0}}, {&t.anchor, {1, 0, 0}}, {&heavy, {}}}, 1e5, 300);
  t.ticks(30);
  const double tension = 2 * 1 * 2 * kPull / 3;
  EXPECT_NEAR(t.number(cable.id(), "force"), tension, 0.01 * tension);
  EXPECT_NEAR(light.linear_velocity().z, kPull / 3 * 0.5, 0.01);
  EXPECT_NEAR(heavy.linear_velocity().z, -kPull / 3 * 0.5, 0.01);
}

TEST_P(TendonSolvers, ConservesMomentum) {
  TendonFixture t(GetParam());
  t.set(t.robot.id(), "self_collision", {0});
  Part& a = t.ball({0, 0, 1}, 1);
  Part& b = t.ball({1, 0, 1}, 2);
  Part& c = t.ball({1, 1, 1.5}, 0.5);
  Tendon& cable = t.tendon({{&a, {0.05, 0, 0.05}}, {&b, {0, 0, -0.1}}, {&c, {0, 0.1, 0}}}, 3000, 5);
  t.set(cable.id(), "rest_length", {1});
  t.set(cable.id(), "tension", {7});
  a.set_velocity({0, 1, 0}, {1, 2, 3});
  t.ticks(1);
  const Vec3 momentum = t.vec(t.world.id(), "momentum");
  const Vec3 angular = t.vec(t.world.id(), "angular_momentum");
  t.ticks(120);
  EXPECT_NEAR(glm::length(t.vec(t.world.id(), "momentum") - momentum), 0, 1e-4);
  EXPECT_NEAR(glm::length(t.vec(t.world.id(), "angular_momentum") - angular), 0, 0.01 * glm::length(angular));
}

TEST_P(TendonSolvers, ASlackCableExertsNothing) {
  TendonFixture t(GetParam());
  Part& ball = t.ball({0, 0, 1});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {}}}, 10, 100);
  t.set(cable.id(), "rest_length", {2});
  ball.set_velocity({0, 0, 0.5}, {0, 0, 0});
  t.ticks(60);
  EXPECT_EQ(t.number(cable.id(), "force"), 0);
  EXPECT_NEAR(ball.linear_velocity().z, 0.5, 1e-6);
  EXPECT_NEAR(t.number(cable.id(), "length"), 1.5, 1e-4);
  EXPECT_NEAR(t.number(cable.id(), "speed"), 0.5, 1e-6);
}

// A light ball on a very stiff cable, thrown so that the cable becomes taut and slack again and again.
TEST_P(TendonSolvers, StiffCablesGainNoEnergy) {
  for (const double stiffness : {1e3, 1e5, 1e6, 1e9}) {
    TendonFixture t(GetParam());
    Part& ball = t.ball({0, 0, 0.6}, 0.01);
    Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {0, 0, 0.1}}}, stiffness);
    t.set(cable.id(), "rest_length", {1});
    ball.set_velocity({0.7, 0, 2}, {0, 0, 0});
    const double energy = 0.5 * 0.01 * (0.49 + 4);
    for (int i = 0; i < 600; i++) {
      t.ticks(1);
      ASSERT_LT(t.energy(), 1.01 * energy) << stiffness << " at tick " << i;
      ASSERT_LT(t.number(cable.id(), "length"), stiffness > 1e4 ? 1.02 : 1.05) << stiffness << " at tick " << i;
    }
  }
}

TEST(Tendon, AStiffPendulumKeepsItsHeight) {
  TendonFixture t;
  t.gravity({0, 0, -kPull});
  Part& ball = t.ball({1, 0, 0}, 1);
  t.tendon({{&t.anchor, {}}, {&ball, {}}}, 1e6);
  t.ticks(1);
  const double energy = t.energy();
  for (int i = 0; i < 1200; i++) {
    t.ticks(1);
    ASSERT_LT(t.energy(), energy + 0.01 * kPull) << i;
  }
}

// Many cables on the same light parts: each alone is soft for the step, all of them together are not.
TEST(Tendon, ManyCablesTogetherGainNoEnergy) {
  TendonFixture t;
  Part& a = t.ball({0, 0, 1}, 0.05);
  Part& b = t.ball({0, 0, 2}, 0.05);
  for (int i = 0; i < 40; i++) t.tendon({{&a, {}}, {&b, {}}}, 500);
  b.set_velocity({0, 0, 0.2}, {0, 0, 0});
  const double energy = 0.5 * 0.05 * 0.04;
  for (int i = 0; i < 600; i++) {
    t.ticks(1);
    ASSERT_LT(t.energy(), 1.01 * energy) << i;
  }
}

TEST(Tendon, WorksBetweenBodies) {
  TendonFixture t;
  Part& other = t.add_single_part(sphere_model(0.1), 1, {{0, 0, 1}, quat_identity()});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&other, {}}}, 0);
  t.set(cable.id(), "tension", {3});
  t.ticks(6);
  EXPECT_NEAR(other.linear_velocity().z, -0.3, 1e-5);
  t.world.remove_body(other.body());
  EXPECT_TRUE(t.world.tendons().list().empty());
  t.ticks(1);
}

TEST(Tendon, RejectsBadPoints) {
  TendonFixture t;
  Part& ball = t.ball({0, 0, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(t.refusal({{&ball, {}}}), "tendon 'robot/cable': needs 2 .. 64 points, not 1");
  EXPECT_EQ(t.refusal(std::vector<Tendon::Point>(300, {&ball, {}})),
            "tendon 'robot/cable': needs 2 .. 64 points, not 300");
  EXPECT_EQ(t.refusal({{&ball, {}}, {&t.anchor, {0, nan, 0}}}),
            "tendon 'robot/cable': point 2: its coordinates must be -10000 .. 10000 m");
  EXPECT_EQ(t.refusal({{&ball, {}}, {&ball, {0, 0, 1}}}), "tendon 'robot/cable': all points are on the part '" +
                                                              ball.name() + "'; a tendon connects at least two parts");
  EXPECT_NE(t.refusal({{&ball, {}}, {&t.anchor, {}}}, ""), "");
  EXPECT_EQ(t.refusal({{&ball, {}}, {&t.anchor, {}}}), "");
  EXPECT_EQ(t.refusal({{&ball, {}}, {&t.anchor, {}}}), "there is a tendon 'cable' already; names are unique");
}

// The ball is at the first point: only the second segment pulls it, for one substep; from then on both do.
TEST(Tendon, ASegmentWithoutLengthHasNoDirection) {
  TendonFixture t;
  Part& ball = t.ball({0, 0, 1});
  Tendon& cable = t.tendon({{&t.anchor, {0, 0, 1}}, {&ball, {}}, {&t.anchor, {}}}, 100);
  t.set(cable.id(), "tension", {2});
  t.ticks(6);
  EXPECT_NEAR(ball.linear_velocity().z, -2.0 / 240, 1e-4);
}

TEST(Tendon, ACopyHasItsOwnParts) {
  TendonFixture t;
  Part& ball = t.ball({0, 0, 1});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {}}}, 123);
  t.set(cable.id(), "rest_length", {0.5});
  Body& copy = *t.world.copy_body(t.robot, "copy").value();
  const Tendon* const copied = t.world.tendons().find(copy, cable.name());
  ASSERT_NE(copied, nullptr);
  EXPECT_EQ(copied->points()[1].part, copy.find_part(ball.name()));
  EXPECT_EQ(t.number(copied->id(), "stiffness"), 123);
  EXPECT_EQ(t.number(copied->id(), "rest_length"), 0.5);
  t.world.remove_body(copy);
  EXPECT_EQ(t.world.tendons().list().size(), 1u);
}

TEST(Tendon, DisabledBodiesAndTendonsDontPull) {
  TendonFixture t;
  Part& other = t.add_single_part(sphere_model(0.1), 1, {{0, 0, 1}, quat_identity()});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&other, {}}}, 0);
  t.set(cable.id(), "tension", {3});
  t.set(t.robot.id(), "enabled", {0});
  t.ticks(6);
  EXPECT_EQ(other.linear_velocity().z, 0);
  EXPECT_EQ(t.number(cable.id(), "force"), 0);
  t.set(t.robot.id(), "enabled", {1});
  t.set(cable.id(), "enabled", {0});
  t.ticks(6);
  EXPECT_EQ(other.linear_velocity().z, 0);
  t.set(cable.id(), "enabled", {1});
  t.ticks(6);
  EXPECT_NEAR(other.linear_velocity().z, -0.3, 1e-5);
}

// Six parts at rest fall asleep together; a change of the tension wakes them.
TEST(Tendon, ATensionWakesItsParts) {
  TendonFixture t;
  Part& a = t.ball({0, 0, 1});
  Part& b = t.ball({0, 0, 2});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&a, {}}, {&b, {}}}, 100, 10);
  t.set(cable.id(), "rest_length", {3});
  t.ticks(400);
  EXPECT_TRUE(b.asleep());
  t.set(cable.id(), "tension", {1});
  t.ticks(2);
  EXPECT_FALSE(a.asleep());
  EXPECT_LT(b.linear_velocity().z, -0.01);
}

TEST(Tendon, AFailedCallRestoresARemovedOne) {
  TendonFixture t;
  Part& ball = t.ball({0, 0, 1});
  Tendon& cable = t.tendon({{&t.anchor, {}}, {&ball, {}}}, 20);
  t.set(cable.id(), "rest_length", {0.8});
  t.ticks(3);
  const std::uint64_t hash = t.world.state_hash();
  t.world.transaction().begin();
  t.world.tendons().remove(cable);
  (void)t.world.tendons().add(t.robot, "more", {{&t.anchor, {}}, {&ball, {}}}).value();
  EXPECT_EQ(t.world.tendons().list().size(), 1u);
  t.world.transaction().rollback();
  ASSERT_EQ(t.world.tendons().list().size(), 1u);
  EXPECT_EQ(t.world.state_hash(), hash);
  EXPECT_EQ(t.world.tendons().find(t.robot, cable.name()), &cable);
  t.world.transaction().begin();
  t.world.remove_body(t.robot);
  EXPECT_TRUE(t.world.tendons().list().empty());
  t.world.transaction().rollback();
  EXPECT_EQ(t.world.state_hash(), hash);
  EXPECT_EQ(t.world.tendons().find(t.robot, cable.name()), &cable);
  t.ticks(3);
  EXPECT_GT(t.number(cable.id(), "force"), 0);
}

TEST(Tendon, CheckpointsRestoreItsMotion) {
  TendonFixture t;
  t.gravity({0, 0, -kPull});
  Part& ball = t.ball({0.3, 0, -1});
  t.tendon({{&t.anchor, {}}, {&ball, {0, 0, 0.1}}}, 2000, 1);
  t.ticks(20);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(t.world, pages, nullptr, scratch);
  t.ticks(20);
  const std::uint64_t hash = t.world.state_hash();
  checkpoint.restore(t.world, pages, scratch);
  t.ticks(20);
  EXPECT_EQ(t.world.state_hash(), hash);
}

}  // namespace
}  // namespace limber::sim
