// The direct solver against physics: what servos hold, stall at and reach, what joints keep together, what stands.
#include "sim/island_direct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "joint_rig.h"
#include "sim/raw_machines.h"
#include "stage.h"

namespace limber {
namespace {

// An arm of boxes, x and y in turn, standing on a base at the floor's height, without a floor.
RawScene arm(int parts, double ratio = 1) {
  RawScene s = raw_arm(parts, ratio, 10000, 0, false);
  s.floor = false;
  s.measure = true;
  return s;
}

RawFigures play(RawPlayer& player, int steps) {
  RawFigures all;
  for (int i = 0; i < steps; ++i) {
    player.step();
    all.take(player.figures());
  }
  return all;
}

TEST(IslandDirect, AnArmOfSeventeenPartsFollowsItsServosWhateverItsMasses) {
  for (const double ratio : {1.0, 13.0, 129.0}) {
    RawScene s = arm(17, ratio);
    for (RawJoint& j : s.joints) j.amplitude = 0.3;
    const auto player = RawPlayer::make(s, RawSolver::direct);
    const RawFigures f = play(*player, 360);
    EXPECT_LT(f.gap, 1.4e-3) << ratio;
    EXPECT_LT(f.servo_error, 0.07) << ratio;
    EXPECT_LT(player->direct().locked, 1e-6) << ratio;
    EXPECT_EQ(player->direct().direct, 360);
    EXPECT_EQ(player->direct().fallbacks, 0);
  }
}

// 35 kg; links and parts of 13:1 in turn, the last part on a tip plate of 129:1.
TEST(IslandDirect, ThePredecessorsRobotKeepsTogetherAndFollowsItsServos) {
  RawScene s = raw_robot(10000, 0.3);
  s.measure = true;
  double mass = 0;
  for (const RawPart& p : s.parts) mass += p.mass;
  EXPECT_NEAR(mass, 34.882, 1e-3);
  const auto player = RawPlayer::make(s, RawSolver::direct);
  const RawFigures f = play(*player, 120);
  EXPECT_LT(f.gap, 1.5e-3);
  EXPECT_LT(f.servo_error, 0.07);
  EXPECT_LT(player->direct().locked, 1e-6);
  EXPECT_EQ(player->direct().direct, 120);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

TEST(IslandDirect, AnUprightArmStandsForAMinute) {
  const auto player = RawPlayer::make(arm(17), RawSolver::direct);
  const RawFigures f = play(*player, 3600);
  EXPECT_LT(f.servo_error, 0.005);
  EXPECT_LT(f.gap, 1e-4);
}

TEST(IslandDirect, ATreeOnAFloatingHubHoldsTogether) {
  RawScene s = raw_tree(true);
  s.measure = true;
  const auto player = RawPlayer::make(s, RawSolver::direct);
  const RawFigures f = play(*player, 360);
  EXPECT_LT(f.gap, 0.9e-3);
  EXPECT_LT(f.servo_error, 0.07);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

// A beam of mass m on a hinge that is too weak to hold it: falling through the horizontal, the servo gives all it has.
TEST(IslandDirect, AServoStallsAtItsTorqueAndOneThatHoldsGivesTheLoads) {
  constexpr double kLoad = 2 * 9.81 * 0.5;  // m·g·l
  for (const double force : {100.0, 0.5 * kLoad}) {
    Rig rig;
    rig.world.set_direct(true);
    rig.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    btRigidBody& base = rig.ground();
    btRigidBody& beam = rig.part(2, Vec3(0.1, 0.1, 0.1), {{0.5, 0, 0}, quat_identity()});
    // the own axis, z of the frames, lies along the world's y
    const Pose frame{{0, 0, 0}, quat_axis({1, 0, 0}, -kPi / 2)};
    JointConstraint& hinge = rig.joint(base, beam, frame, {{-0.5, 0, 0}, frame.rotation});
    hinge.set_axis(5, servo_axis(free_axis(), 0, 1, force));
    rig.steps(force > kLoad ? 240 : 4);
    EXPECT_NEAR(std::fabs(hinge.applied_torque().z), std::min(force, kLoad), 0.01 * kLoad) << force;
  }
}

TEST(IslandDirect, ALimitStopsAndAServoDrivenPastItStaysThere) {
  RawScene s = arm(8);
  for (RawJoint& j : s.joints) {
    j.lower = -0.2;
    j.upper = 0.2;
    j.amplitude = 0.6;
    j.square = true;
  }
  const auto player = RawPlayer::make(s, RawSolver::direct);
  EXPECT_LT(play(*player, 240).limit_passed, 0.01);
}

// Without drives, friction or damping nothing gives a chain energy.
TEST(IslandDirect, APassiveChainDoesNotGainEnergy) {
  RawScene s = arm(8);
  s.gravity = {9.81, 0, 0};
  for (RawJoint& j : s.joints) j.force = 0;
  const double swing = 9.81 * 8 * 0.8;  // the chain's fall from lying to hanging
  for (const int rate : {60, 240}) {
    s.step = 1.0 / rate;
    const auto player = RawPlayer::make(s, RawSolver::direct);
    const double begun = player->energy().potential;
    player->step();
    RawEnergyMeter meter(*player);
    double highest = -swing;
    RawFigures f;
    for (int i = 0; i < 10 * rate; ++i) {
      player->step();
      f.take(player->figures());
      highest = std::max(highest, meter.take());
    }
    EXPECT_LT(f.gap, rate == 60 ? 0.02 : 4e-3) << rate;
    EXPECT_LT(highest - begun, 0.002 * swing) << rate;
    EXPECT_GT(highest - begun, -0.002 * swing) << rate;
  }
}

// Motors that let go of a lying arm several at a time, so that the responses between its contacts change step by step:
// no contact misses its law by much more than what is near may.
TEST(IslandDirect, WhereManyMotorsGiveWayContactsStillHold) {
  for (const double force : {1.0, 2.0, 5.0, 50.0}) {
    RawScene s = raw_arm(17, 1, force, 0.6, true);
    s.measure = true;
    const auto player = RawPlayer::make(s, RawSolver::direct);
    const RawFigures f = play(*player, 360);
    EXPECT_LT(player->direct().contact, 0.2) << force;
    EXPECT_LT(f.gap, 0.02) << force;
    EXPECT_EQ(player->direct().fallbacks, 0) << force;
  }
}

// Four legs of three joints each: they stand, every contact obeys its law.
TEST(IslandDirect, AHeavyTrunkStandsOnLightFeet) {
  const double masses[][2] = {{10, 0.5}, {50, 1}, {50, 0.1}};
  for (const auto& [trunk, leg] : masses) {
    RawScene s = raw_legs(trunk, leg, false);
    s.measure = true;
    const auto player = RawPlayer::make(s, RawSolver::direct);
    const RawFigures f = play(*player, 240);
    EXPECT_LT(f.gap, 2e-4) << trunk;
    EXPECT_LT(f.servo_error, 0.005) << trunk;
    EXPECT_LT(player->direct().contact, 1e-3) << trunk;
    EXPECT_NEAR(player->pose(0).position.z, 0.42, 2e-3) << trunk;
    EXPECT_EQ(player->direct().fallbacks + player->direct().plain, 0);
  }
}

// Eight links closed to a ring: one joint of it is held around the tree that the others make.
TEST(IslandDirect, ARingStaysClosed) {
  RawScene s;
  s.measure = true;
  s.parts.push_back({{0.1, 0.1, 0.1}, 0, {{0, 0, 0.5}, quat_identity()}});
  const double radius = 0.2 / (2 * std::sin(kPi / 8));
  const auto corner = [&](int i) { return radius * Vec3(0, std::sin(kPi / 4 * i), std::cos(kPi / 4 * i)); };
  for (int i = 0; i < 8; ++i) {
    s.parts.push_back(
        {{0.1, 0.2, 0.05}, 1, {0.5 * (corner(i) + corner(i + 1)), quat_axis({1, 0, 0}, -kPi / 4 * (i + 0.5))}});
    RawJoint j;
    j.axis = {1, 0, 0};
    j.parent = i;
    j.child = i + 1;
    j.place = corner(i);
    s.joints.push_back(j);
  }
  RawJoint last = s.joints.back();
  last.parent = 8;
  last.child = 1;
  last.place = corner(8);
  s.joints.push_back(last);
  const auto player = RawPlayer::make(s, RawSolver::direct);
  const RawFigures f = play(*player, 240);
  EXPECT_LT(f.gap, 0.02);
  EXPECT_GT(f.speed, 0.5);  // it does move
  EXPECT_LT(player->direct().contact, 1e-3);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

// two bodies of 1 kg and 0.01 kg·m², 0.2 m apart on a free hinge half-way, that spin against each other
struct Whip {
  Whip(double spin, bool stands) : parent(rig.part(stands ? 0 : 1, Vec3(stands ? 0 : 0.01))) {
    rig.world.set_direct(true);
    joint.set_axis(5, free_axis());
    if (!stands) move(parent, -0.1, spin);
    move(child, 0.1, -spin, stands ? -spin * 0.1 : 0);
  }
  // all go at (1, 2, 0) m/s and turn at 3 rad/s about their middle, but where one stands
  void move(btRigidBody& body, double arm, double spin, double along = 0) {
    const double all = along == 0 ? 1 : 0;
    body.setLinearVelocity(to_bt(all * Vec3(1, 2 + 3 * arm, 0) + Vec3(0, along, 0)));
    body.setAngularVelocity(to_bt(Vec3(0, 0, all * 3 + spin)));
  }
  Vec3 momentum() const { return from_bt(parent.getLinearVelocity() + child.getLinearVelocity()); }
  Vec3 middle() const { return from_bt(parent.getCenterOfMassPosition() + child.getCenterOfMassPosition()) / 2.0; }
  // about their middle, seen from where they stood at first: that is where impulses of the first step act
  Vec3 spin() const {
    return from_bt(btVector3(to_scalar(0.1), 0, 0).cross(child.getLinearVelocity() - parent.getLinearVelocity()) +
                   (parent.getAngularVelocity() + child.getAngularVelocity()) * to_scalar(0.01));
  }
  double opening() const { return from_bt(parent.getAngularVelocity() - child.getAngularVelocity()).z; }
  Rig rig;
  btRigidBody& parent;
  btRigidBody& child = rig.part(1, Vec3(0.01), {{0.2, 0, 0}, quat_identity()});
  JointConstraint& joint = rig.joint(parent, child, {{0.1, 0, 0}, quat_identity()}, {{-0.1, 0, 0}, quat_identity()});
};

// What is faster than a quarter of pi in a step Bullet turns by less. Beyond that the inner motion is less, as far as
// needed; what the whole does stays: 2 kg at (1, 2, 0) m/s, and 3 rad/s times 2·(0.01 + 1·0.1²) kg·m².
TEST(IslandDirect, WhatWhipsKeepsItsMomentum) {
  constexpr double kStep = 1.0 / 60;
  for (const double spin : {40.0, 100.0, 1000.0}) {
    SCOPED_TRACE(spin);
    Whip whip(spin, false);
    EXPECT_NEAR(whip.opening(), 2 * spin, 1e-3);
    whip.rig.steps(1, kStep);
    EXPECT_NEAR(glm::length(whip.momentum() - Vec3(2, 4, 0)), 0, 1e-4);
    EXPECT_NEAR(glm::length(whip.spin() - Vec3(0, 0, 0.12)), 0, 1e-4);
    EXPECT_NEAR(glm::length(whip.middle() - Vec3(0.1, 0, 0) - Vec3(1, 2, 0) * kStep), 0, 1e-5);
    const double most = kPi / 4 / kStep;
    EXPECT_NEAR(whip.opening() / 2, std::min(spin, most), 0.02 * most) << "slower ones as they are";
  }
}

TEST(IslandDirect, WhatWhipsOnSomethingThatStandsIsCalmedToo) {
  constexpr double kStep = 1.0 / 60;
  Whip whip(200, true);
  EXPECT_NEAR(whip.opening(), 200, 1e-3);
  whip.rig.steps(1, kStep);
  EXPECT_NEAR(whip.opening(), kPi / 4 / kStep, 0.01 * kPi / 4 / kStep);
}

// It turns by more in the step than bends know of. Its parts are moved together where the step ends, without a
// velocity: the middle of all goes where it was going.
TEST(IslandDirect, JointsMeetWhereWhatWhipsArrives) {
  constexpr double kStep = 1.0 / 60;
  for (const double spin : {100.0, 1000.0}) {
    SCOPED_TRACE(spin);
    Whip whip(spin, false);
    const auto middle = [&] {
      return from_bt(whip.parent.getCenterOfMassPosition() + whip.child.getCenterOfMassPosition()) * 0.5;
    };
    const Vec3 before = middle();
    whip.rig.steps(1, kStep);
    EXPECT_NEAR(glm::length(whip.joint.offsets()), 0, 2e-4);
    EXPECT_NEAR(glm::length(middle() - before - Vec3(1, 2, 0) * kStep), 0, 1e-5);
  }
}

// 300 such trees are in `limber bench solver`. Where nobody closes their joints seven of these part by more than 10 cm,
// stock's nearly all.
TEST(IslandDirect, RandomTreesOverAFloorArePartedLessThanStocks) {
  for (unsigned seed = 500; seed < 530; ++seed) {
    const RawScene s = raw_at_step(raw_random_tree(seed, true), 1.0 / 30);
    const double a = play(*RawPlayer::make(s, RawSolver::stock), 60).gap;
    const double b = play(*RawPlayer::make(s, RawSolver::direct), 60).gap;
    EXPECT_LE(b, std::min(0.1, 1.1 * a + 2e-3)) << seed;
  }
}

// One end of a beam is deep in the floor, the other is on a heavy part: pushed out, it turns, by 0.05 rad at most.
TEST(IslandDirect, RepairOfPenetrationTurnsLittleAndLeavesJointsClosed) {
  RawScene s;
  s.floor = true;
  s.gravity = Vec3(0);
  s.parts.push_back({{0.4, 0.1, 0.1}, 100, {{0.3, 0, 0.06}, quat_identity()}});
  s.parts.push_back({{0.4, 0.1, 0.1}, 1, {{0, 0, 0.06 - 0.2 * std::sin(1.2)}, quat_axis({0, 1, 0}, -1.2)}});
  RawJoint j;
  j.axis = {0, 1, 0};
  j.parent = 0;
  j.child = 1;
  j.place = {0.2 * std::cos(1.2), 0, 0.06};
  s.joints.push_back(j);
  const auto player = RawPlayer::make(s, RawSolver::direct);
  const Quat before = player->pose(1).rotation;
  player->step();
  const Quat turned = player->pose(1).rotation * glm::conjugate(before);
  EXPECT_GT(2 * std::fabs(turned.y), 0.04);
  EXPECT_LT(2 * std::fabs(turned.y), 0.051);
  EXPECT_LT(player->figures().gap, 3e-4);
}

// Where parts are moved together limits hold: without that these pass them by 0.4 rad.
TEST(IslandDirect, ClosingJointsDoesNotPassTheirLimits) {
  for (const unsigned seed : {520u, 544u, 552u}) {
    const RawScene s = raw_at_step(raw_random_tree(seed, true), 1.0 / 30);
    EXPECT_LT(play(*RawPlayer::make(s, RawSolver::direct), 90).limit_passed, 0.2) << seed;
  }
}

TEST(IslandDirect, RepeatsBitForBit) {
  std::vector<Vec3> first;
  for (int run = 0; run < 2; ++run) {
    RawScene s = arm(9);
    s.floor = true;
    for (RawJoint& j : s.joints) {
      j.force = 30;
      j.amplitude = 0.9;
      j.square = true;
    }
    const auto player = RawPlayer::make(s, RawSolver::direct);
    play(*player, 180);
    for (int i = 0; i <= 9; ++i) {
      const Vec3 place = player->pose(i).position;
      if (run == 0) {
        first.push_back(place);
      } else {
        EXPECT_EQ(place, first[static_cast<std::size_t>(i)]) << i;
      }
    }
  }
}

// A cube of 1 kg on a floor, and a heavy one on it: without joints, up to the mass that sweeps cannot carry.
TEST(IslandDirect, HeavyBodiesStandOnALightOne) {
  for (const double mass : {10.0, 100.0, 1000.0}) {
    test::Stage s;
    s.gravity({0, 0, -9.81});
    s.floor();
    Part& low = s.lone(test::box_model(Vec3(1)), 1, {{0, 0, 0.5}, quat_identity()});
    Part& top = s.lone(test::box_model(Vec3(1)), mass, {{0, 0, 1.5}, quat_identity()});
    s.set(low.body().id(), "can_sleep", {0});
    s.ticks(300);
    EXPECT_LT(glm::length(low.pose().position - Vec3(0, 0, 0.5)), 1e-4) << mass;
    EXPECT_LT(glm::length(top.pose().position - Vec3(0, 0, 1.5)), 1e-4) << mass;
    EXPECT_GT(s.number(s.world.id(), "islands_direct"), 1100);
    EXPECT_EQ(s.number(s.world.id(), "islands_iterative"), 0);
    EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
  }
}

// 27 boxes that touch are more rows than an island without joints may have.
TEST(IslandDirect, PilesStayWithTheIterativeSolver) {
  test::Stage s;
  s.gravity({0, 0, -9.81});
  s.floor();
  for (int i = 0; i < 27; i++) {
    s.lone(test::box_model(Vec3(0.2)), 1, {{i % 3 * 0.2, i / 3 % 3 * 0.2, 0.1 + i / 9 * 0.2}, quat_identity()});
  }
  s.ticks(10);
  EXPECT_EQ(s.number(s.world.id(), "islands_direct"), 0);
  EXPECT_EQ(s.number(s.world.id(), "islands_iterative"), 40);
  EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
}

}  // namespace
}  // namespace limber
