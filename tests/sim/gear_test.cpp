// Gears: two joints coupled both ways, with either solver; torque balance, reflected inertia, redundancy, undo.
#include "sim/gears/gear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/arm.h"
#include "sim/bullet/island_world.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kGearMassA = 0.5;
constexpr double kGearMassB = 2;
constexpr Vec3 kGearSizeA{0.2, 0.3, 0.1};
constexpr Vec3 kGearSizeB{0.5, 0.3, 0.1};

std::string gear_log_since(std::uint64_t seen) {
  std::string text;
  for (const LogLine& line : log_since(seen)) text += line.text + "\n";
  return text;
}

// Two boxes on a static ball, each on a joint through its center; motors off.
struct GearedPair : WorldFixture {
  explicit GearedPair(bool direct = true, model::JointType type_a = model::JointType::revolute,
                      model::JointType type_b = model::JointType::revolute)
      : robot(body("robot")), base(part(robot, sphere_model(0.05), 0)) {
    set(world.id(), "solver", {direct ? 1.0 : 0.0});
    a = &add("a", {-1, 0, 0}, kGearSizeA, kGearMassA, type_a);
    b = &add("b", {1, 0, 0}, kGearSizeB, kGearMassB, type_b);
  }

  Joint& add(const std::string& name, const Vec3& at, const Vec3& size, double mass, model::JointType type) {
    Part& box = part(robot, box_model(size), mass, {at, quat_identity()});
    Joint& joint = *robot.add_joint(name, base, box, type, at, {0, 0, 1}).value();
    set(robot.add_motor(joint).value()->id(), "mode", {0});
    set_one(joint.id(), "linear_lower_limit", 2, type == model::JointType::prismatic ? 1 : 0);
    set_one(joint.id(), "linear_upper_limit", 2, type == model::JointType::prismatic ? -1 : 0);
    return joint;
  }
  Gear& gear(double ratio, std::optional<double> offset = {}) {
    return *world.gears().add("gear" + std::to_string(world.gears().list().size()), *a, *b, ratio, offset).value();
  }
  void servo(Joint& joint, double target, double torque) {
    const NodeId motor = joint.motor()->id();
    set(motor, "mode", {2});
    set(motor, "target", {target});
    set_one(motor, "max_angular_force", 2, torque);
  }
  // applies a torque or a force along z to the child of a joint, in every tick
  void loaded_ticks(int n, double on_a, double on_b) {
    const auto load = [](Joint& joint, double value) {
      const Vec3 z(0, 0, value);
      joint.type() == model::JointType::prismatic ? joint.child().apply_force(z) : joint.child().apply_torque(z);
    };
    for (int i = 0; i < n; i++) {
      load(*a, on_a);
      load(*b, on_b);
      world.step();
    }
  }
  double fallbacks() const { return number(world.id(), "solver_fallbacks"); }

  Body& robot;
  Part& base;
  Joint* a = nullptr;
  Joint* b = nullptr;
  const double inertia_a = box_inertia(kGearMassA, kGearSizeA).z;
  const double inertia_b = box_inertia(kGearMassB, kGearSizeB).z;
};

class GearSolvers : public testing::TestWithParam<bool> {
 protected:
  bool direct() const { return GetParam(); }
  // Largest position error.
  double tolerance() const { return direct() ? 1e-6 : 1e-4; }
};
INSTANTIATE_TEST_SUITE_P(Both, GearSolvers, testing::Bool(),
                         [](const auto& p) { return std::string(p.param ? "direct" : "iterative"); });

// Static equilibrium: tau_a + ratio·tau_b = 0.
TEST_P(GearSolvers, TorquesBalanceByTheRatio) {
  for (const double ratio : {2.0, -1.0, 0.3}) {
    GearedPair s(direct());
    s.gear(ratio);
    s.loaded_ticks(60, -ratio * 3, 3);
    EXPECT_NEAR(s.a->value(), 0, 1e-3) << ratio;
    EXPECT_NEAR(s.b->value(), 0, 1e-3) << ratio;
    EXPECT_EQ(s.fallbacks(), 0);
  }
}

// The inertia of b acts on a, times the square of the ratio.
TEST_P(GearSolvers, InertiaIsReflectedByTheSquareOfTheRatio) {
  for (const double ratio : {2.0, -1.0, 0.3}) {
    GearedPair s(direct());
    Gear& gear = s.gear(ratio);
    const double torque = 0.2;
    s.loaded_ticks(30, torque, 0);
    const double expected = torque / (s.inertia_a + ratio * ratio * s.inertia_b) * 0.5;
    EXPECT_NEAR(s.number(s.a->id(), "speed"), expected, 2e-3 * std::abs(expected)) << ratio;
    EXPECT_NEAR(s.number(s.b->id(), "speed"), ratio * expected, 2e-3 * std::abs(ratio * expected)) << ratio;
    EXPECT_NEAR(s.b->value(), ratio * s.a->value(), tolerance()) << ratio;
    // only the gear accelerates b
    EXPECT_NEAR(s.number(gear.id(), "force"), s.inertia_b * ratio * expected / 0.5, 0.01 * torque) << ratio;
  }
}

TEST_P(GearSolvers, OutputIsBackdrivable) {
  GearedPair s(direct());
  const double ratio = 4;
  s.gear(ratio);
  s.loaded_ticks(30, 0, 0.5);
  const double expected = 0.5 / (s.inertia_b + s.inertia_a / (ratio * ratio)) * 0.5;
  EXPECT_NEAR(s.number(s.b->id(), "speed"), expected, 2e-3 * expected);
}

TEST_P(GearSolvers, RackFollowsItsPinion) {
  GearedPair s(direct(), model::JointType::revolute, model::JointType::prismatic);
  const double radius = 0.05;
  s.gear(radius);
  s.loaded_ticks(30, 0.1, 0);
  const double expected = 0.1 / (s.inertia_a + radius * radius * kGearMassB) * 0.5;
  EXPECT_NEAR(s.number(s.a->id(), "speed"), expected, 2e-3 * expected);
  EXPECT_NEAR(s.b->value(), radius * s.a->value(), tolerance());
}

TEST_P(GearSolvers, ServoMovesBothJointsUnderLoad) {
  GearedPair s(direct());
  s.gear(2, 0.1);
  s.servo(*s.a, 0.5, 50);
  s.loaded_ticks(120, 0, -7);
  EXPECT_NEAR(s.a->value(), 0.5, direct() ? 1e-3 : 5e-3);
  EXPECT_NEAR(s.b->value(), 2 * s.a->value() + 0.1, direct() ? 1e-4 : 1e-3);
}

// a provides 1 N·m, b through the ratio -2 provides 2 more: a load of 2.9 is supported, 3.1 is not.
TEST_P(GearSolvers, TorquesOfBothMotorsAddUp) {
  for (const double load : {2.9, 3.1}) {
    GearedPair s(direct());
    s.gear(-2);
    s.servo(*s.a, 0, 1);
    s.servo(*s.b, 0, 1);
    s.loaded_ticks(60, load, 0);
    const bool holds = load < 3;
    EXPECT_EQ(std::abs(s.a->value()) < 0.02, holds) << load << ": " << s.a->value();
    EXPECT_NEAR(s.b->value(), -2 * s.a->value(), direct() ? 1e-4 : 1e-3);
    EXPECT_EQ(s.fallbacks(), 0);
  }
}

TEST_P(GearSolvers, LimitOfTheFollowerStopsTheLeader) {
  GearedPair s(direct());
  s.set(s.b->id(), "angular_lower_limit", {0, 0, -0.2});
  s.set(s.b->id(), "angular_upper_limit", {0, 0, 0.2});
  s.gear(2);
  s.servo(*s.a, 1, 5);
  s.ticks(120);
  EXPECT_NEAR(s.b->value(), 0.2, direct() ? 1e-3 : 1e-2);
  EXPECT_NEAR(s.a->value(), 0.1, direct() ? 1e-3 : 1e-2);
  EXPECT_EQ(s.fallbacks(), 0);
}

TEST_P(GearSolvers, SlipsBeyondMaxForce) {
  for (const double load : {0.9, 1.1}) {
    GearedPair s(direct());
    Gear& gear = s.gear(1);
    s.set(gear.id(), "max_force", {1});
    s.servo(*s.a, 0, 100);
    s.loaded_ticks(60, 0, load);
    EXPECT_EQ(std::abs(s.b->value()) < 0.02, load < 1) << load << ": " << s.b->value();
  }
}

// A gear is an internal force: a floating body keeps its momentum while its motor works.
TEST_P(GearSolvers, ConservesMomentumOfAFloatingBody) {
  WorldFixture s;
  s.set(s.world.id(), "solver", {direct() ? 1.0 : 0.0});
  Body& robot = s.body("robot");
  Part& base = s.part(robot, box_model({0.4, 0.4, 0.2}), 3);
  std::array<Joint*, 2> joints{};
  for (std::size_t i = 0; i < 2; i++) {
    const Vec3 at(i == 0 ? -0.4 : 0.4, 0, 0);
    Part& wheel = s.part(robot, box_model({0.2, 0.3, 0.1}), 1, {at, quat_identity()});
    joints[i] = robot.add_joint(i == 0 ? "a" : "b", base, wheel, model::JointType::revolute, at, {0, 0, 1}).value();
    s.set(robot.add_motor(*joints[i]).value()->id(), "mode", {0});
  }
  (void)s.world.gears().add("g", *joints[0], *joints[1], 2.0).value();
  s.set(joints[0]->motor()->id(), "mode", {1});
  s.set(joints[0]->motor()->id(), "speed", {3});
  s.set_one(joints[0]->motor()->id(), "max_angular_force", 2, 0.5);
  s.ticks(60);
  Vec3 momentum(0);
  double spin = 0;
  for (const auto& part : robot.parts()) {
    const btRigidBody& r = part->rigid();
    const Vec3 v = bullet::from_bt(r.getLinearVelocity());
    const double mass = 1 / static_cast<double>(r.getInvMass());
    momentum += mass * v;
    spin += static_cast<double>(r.getAngularVelocity().z()) / static_cast<double>(r.getInvInertiaDiagLocal().z()) +
            mass * glm::cross(bullet::from_bt(r.getCenterOfMassPosition()), v).z;
  }
  EXPECT_NEAR(joints[1]->value(), 2 * joints[0]->value(), 1e-3);
  EXPECT_GT(joints[0]->value(), 0.5);
  EXPECT_LT(glm::length(momentum), 1e-4);
  EXPECT_NEAR(spin, 0, direct() ? 1e-4 : 1e-3);
}

// Joints of one chain: four bodies, one of them twice where the joints are neighbors.
TEST(Gear, CouplesJointsOfOneChainExactly) {
  for (const int other : {2, 3, 5}) {
    WorldFixture s;
    s.gravity({0, 0, -9.81});
    Body& arm = make_arm(s, "arm");
    for (const auto& motor : arm.motors()) s.set(motor->id(), "mode", {0});
    const Joint& a = *arm.joints()[0];
    const Joint& b = *arm.joints()[static_cast<std::size_t>(other - 1)];
    (void)s.world.gears().add("g", *arm.joints()[0], *arm.joints()[static_cast<std::size_t>(other - 1)], -0.7).value();
    arm.parts().back()->set_velocity({0.5, 0.2, 0}, {0, 0, 0});
    double worst = 0;
    for (int i = 0; i < 60; i++) {
      s.world.step();
      worst = std::max(worst, std::abs(b.value() + 0.7 * a.value()));
    }
    EXPECT_LT(worst, 1e-4) << other;
    EXPECT_GT(std::abs(a.value()), 0.05) << other;
    EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0) << other;
  }
}

TEST(Gear, UnitesTheIslandsOfTwoBodies) {
  WorldFixture s;
  Body& left = make_arm(s, "left", {2});
  Body& right = make_arm(s, "right", {2, {5, 0, 0}});
  for (const auto& motor : right.motors()) s.set(motor->id(), "mode", {0});
  (void)s.world.gears().add("g", *left.joints()[1], *right.joints()[1], 2.0).value();
  s.set(left.motors()[1]->id(), "target", {0.3});
  s.ticks(90);
  EXPECT_NEAR(left.joints()[1]->value(), 0.3, 1e-3);
  EXPECT_NEAR(right.joints()[1]->value(), 0.6, 2e-3);
}

TEST(Gear, ReportsAndIgnoresARedundantGear) {
  GearedPair s;
  s.gear(2);
  Gear& again = s.gear(2);
  const std::uint64_t seen = log_newest();
  s.servo(*s.a, 0.4, 20);
  s.ticks(60);
  EXPECT_NE(gear_log_since(seen).find("gear 'gear1': other gears couple its joints with the same ratio already"),
            std::string::npos);
  EXPECT_TRUE(again.redundant());
  EXPECT_NEAR(s.b->value(), 0.8, 2e-3);
  s.world.gears().remove(*s.world.gears().find("gear0"));
  s.ticks(1);
  EXPECT_FALSE(again.redundant());
}

TEST(Gear, ReportsAndIgnoresAContradictoryGear) {
  GearedPair s;
  s.gear(2);
  s.gear(2, 0.5);
  const std::uint64_t seen = log_newest();
  s.servo(*s.a, 0.4, 20);
  s.ticks(60);
  EXPECT_NE(gear_log_since(seen).find("gear 'gear1': contradicts other gears"), std::string::npos);
  EXPECT_NEAR(s.b->value(), 0.8, 2e-3);
}

// Two ratios leave one position.
TEST_P(GearSolvers, TwoRatiosLockBothJoints) {
  GearedPair s(direct());
  s.gear(2);
  s.gear(-1);
  s.loaded_ticks(60, 3, 2);
  EXPECT_NEAR(s.a->value(), 0, direct() ? 1e-4 : 1e-2);
  EXPECT_NEAR(s.b->value(), 0, direct() ? 1e-4 : 1e-2);
  EXPECT_EQ(s.fallbacks(), 0);
}

TEST_P(GearSolvers, ReportsLockedJoints) {
  GearedPair s(direct());
  for (Joint* joint : {s.a, s.b}) {
    s.set(joint->id(), "angular_lower_limit", {0, 0, 0});
    s.set(joint->id(), "angular_upper_limit", {0, 0, 0});
  }
  s.gear(2, 0.3);
  const std::uint64_t seen = log_newest();
  s.loaded_ticks(60, 3, 2);
  EXPECT_NEAR(s.a->value(), 0, 0.2);
  EXPECT_TRUE(std::isfinite(s.b->value()));
  EXPECT_NE(gear_log_since(seen).find("gear 'gear0': joint 'robot/b' is"), std::string::npos) << gear_log_since(seen);
  EXPECT_EQ(s.fallbacks(), 0);
  if (!direct()) return;
  EXPECT_NEAR(s.a->value(), 0, 1e-4);
  EXPECT_NEAR(s.b->value(), 0, 1e-4);
}

TEST(Gear, IsRemovedWithTheBodyOfAJoint) {
  WorldFixture s;
  Body& left = make_arm(s, "left", {1});
  Body& right = make_arm(s, "right", {1, {5, 0, 0}});
  const NodeId id = s.world.gears().add("g", *left.joints()[0], *right.joints()[0], 1).value()->id();
  s.ticks(2);
  EXPECT_EQ(s.world.bullet().getNumConstraints(), 3);
  s.world.remove_body(right);
  EXPECT_FALSE(s.store.alive(id));
  s.ticks(2);
  EXPECT_EQ(s.world.bullet().getNumConstraints(), 1);
}

TEST(Gear, IsInactiveWhileItOrItsBodyIsDisabled) {
  GearedPair s;
  Gear& gear = s.gear(1);
  s.set(gear.id(), "enabled", {0});
  s.loaded_ticks(10, 1, 0);
  EXPECT_EQ(s.b->value(), 0);
  s.set(s.robot.id(), "enabled", {0});
  s.set(gear.id(), "enabled", {1});
  s.ticks(2);
  EXPECT_EQ(s.world.bullet().getNumConstraints(), 0);
  s.robot.recovery().reset();
  s.ticks(2);
  EXPECT_EQ(s.world.bullet().getNumConstraints(), 3);
}

TEST(Gear, RejectsUnsuitableJoints) {
  GearedPair s;
  Part& ball = s.part(s.robot, sphere_model(0.1), 1, {{0, 0, 3}, quat_identity()});
  Joint& spherical =
      *s.robot.add_joint("ball", s.base, ball, model::JointType::spherical, {0, 0, 3}, {0, 0, 1}).value();
  EXPECT_EQ(s.world.gears().add("g", *s.a, spherical, 1).error(),
            "gear 'g': joint 'robot/ball' is spherical; a gear needs a revolute, continuous or prismatic joint");
  EXPECT_EQ(s.world.gears().add("g", *s.a, *s.a, 1).error(), "gear 'g': needs two different joints");
  EXPECT_FALSE(s.world.gears().add("g", *s.a, *s.b, 0));
  EXPECT_FALSE(s.world.gears().add("g", *s.a, *s.b, std::nan("")));
  Gear& gear = s.gear(2);
  const double zero = 0;
  EXPECT_FALSE(s.store.set(gear.id(), Gear::table().at("ratio"), {&zero, 1}));
}

// A checkpoint restores warm impulses and whether the gear is in the world.
TEST_P(GearSolvers, CheckpointRestoresItExactly) {
  GearedPair s(direct());
  Gear& gear = s.gear(-0.6);
  s.servo(*s.a, 0.8, 2);
  const auto play = [&](int ticks) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < ticks; i++) {
      if (s.world.tick() % 17 == 0) s.set(gear.id(), "enabled", {s.world.tick() % 34 == 0 ? 1.0 : 0.0});
      s.loaded_ticks(1, 0, 0.3);
      hashes.push_back(s.world.state_hash());
    }
    return hashes;
  };
  (void)play(10);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = play(50);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(play(50), first);
  checkpoint.release(pages);
}

TEST(Gear, IsRolledBackByAFailedCall) {
  const auto hash = [](int change) {
    GearedPair s;
    Gear& gear = s.gear(2);
    s.loaded_ticks(10, 1, 0);
    s.world.transaction().begin();
    if (change == 1) (void)s.world.gears().add("new", *s.b, *s.a, -1, 0.5);
    if (change == 2) s.world.gears().remove(gear);
    if (change == 3) s.world.remove_body(s.robot);
    if (change == 4) s.set(gear.id(), "ratio", {3});
    s.world.transaction().rollback();
    s.loaded_ticks(10, 1, 0);
    EXPECT_EQ(s.world.gears().list().size(), 1u);
    return s.world.state_hash();
  };
  for (int change = 1; change <= 4; change++) EXPECT_EQ(hash(change), hash(0)) << change;
}

}  // namespace
}  // namespace limber::sim
