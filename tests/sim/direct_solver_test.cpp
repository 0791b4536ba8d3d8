// DirectSolver against physics: servo loads and stall torques, joint gaps, standing bodies.
#include "sim/solver/direct_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/raw/machines.h"
#include "joint_rig.h"
#include "stage.h"

namespace limber::sim {
namespace {

// An arm of boxes, x and y alternating, on a base at the floor's height, without a floor.
RawScene arm(int parts, double ratio = 1) {
  RawScene s = raw_arm(parts, ratio, 10000, 0, false);
  s.floor = false;
  s.measure = true;
  return s;
}

RawMeasurements play(RawSimulation& player, int steps) {
  RawMeasurements all;
  for (int i = 0; i < steps; ++i) {
    player.step();
    all.accumulate_max(player.measurements());
  }
  return all;
}

TEST(DirectSolver, LongArmOfAnyMassesFollowsItsServos) {
  for (const double ratio : {1.0, 13.0, 129.0}) {
    RawScene s = arm(17, ratio);
    for (RawJoint& j : s.joints) j.amplitude = 0.3;
    const auto player = RawSimulation::make(s, RawSolver::direct);
    const RawMeasurements f = play(*player, 360);
    EXPECT_LT(f.gap, 1.4e-3) << ratio;
    EXPECT_LT(f.servo_error, 0.07) << ratio;
    EXPECT_LT(player->direct().unbounded, 1e-6) << ratio;
    EXPECT_EQ(player->direct().direct, 360);
    EXPECT_EQ(player->direct().fallbacks, 0);
  }
}

// The first step asks most motors of the lower half for more than their torque, at the base for three times as much,
// but only two must yield. Motors of 3·10⁵ N·m can't carry the arm either, so more of them yield again and again.
TEST(DirectSolver, LongArmWhoseMotorsYieldRecovers) {
  for (const auto& [force, max_error] : {std::pair(1e6, 0.1), std::pair(3e5, 2.5)}) {
    RawScene s = raw_arm(170, 1, force, 0.3, false);
    s.measure = true;
    const auto player = RawSimulation::make(s, RawSolver::direct);
    const RawMeasurements f = play(*player, 360);
    EXPECT_TRUE(f.finite) << force;
    EXPECT_LT(f.gap, 1.5e-3) << force;
    EXPECT_LT(f.servo_error, max_error) << force;
    EXPECT_LT(player->direct().bounded, 1e-3) << force;
    EXPECT_EQ(player->direct().direct, 360) << force;
    EXPECT_EQ(player->direct().fallbacks, 0) << force;
  }
}

// 35 kg; links and parts with alternating mass ratios of 13:1, and a tip plate with 129:1.
TEST(DirectSolver, PredecessorsRobotFollowsItsServos) {
  RawScene s = raw_robot(10000, 0.3);
  s.measure = true;
  double mass = 0;
  for (const RawPart& p : s.parts) mass += p.mass;
  EXPECT_NEAR(mass, 34.882, 1e-3);
  const auto player = RawSimulation::make(s, RawSolver::direct);
  const RawMeasurements f = play(*player, 120);
  EXPECT_LT(f.gap, 1.5e-3);
  EXPECT_LT(f.servo_error, 0.07);
  EXPECT_LT(player->direct().unbounded, 1e-6);
  EXPECT_EQ(player->direct().direct, 120);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

TEST(DirectSolver, UprightArmStandsForAMinute) {
  const auto player = RawSimulation::make(arm(17), RawSolver::direct);
  const RawMeasurements f = play(*player, 3600);
  EXPECT_LT(f.servo_error, 0.005);
  EXPECT_LT(f.gap, 1e-4);
}

TEST(DirectSolver, FloatingTreeKeepsItsJointsClosed) {
  RawScene s = raw_tree(true);
  s.measure = true;
  const auto player = RawSimulation::make(s, RawSolver::direct);
  const RawMeasurements f = play(*player, 360);
  EXPECT_LT(f.gap, 0.9e-3);
  EXPECT_LT(f.servo_error, 0.07);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

// A beam of mass m on a hinge that is too weak to hold it: while it falls through the horizontal, the servo applies its
// full torque.
TEST(DirectSolver, ServoAppliesTheLoadOrItsLimit) {
  constexpr double kLoad = 2 * 9.81 * 0.5;  // m·g·l
  for (const double force : {100.0, 0.5 * kLoad}) {
    Rig rig;
    rig.world.set_direct(true);
    rig.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    btRigidBody& base = rig.ground();
    btRigidBody& beam = rig.part(2, Vec3(0.1, 0.1, 0.1), {{0.5, 0, 0}, quat_identity()});
    // the own axis, z of the frames, is along the world's y
    const Pose frame{{0, 0, 0}, quat_axis({1, 0, 0}, -kPi / 2)};
    bullet::JointConstraint& hinge = rig.joint(base, beam, frame, {{-0.5, 0, 0}, frame.rotation});
    hinge.set_axis(5, servo_axis(free_axis(), 0, 1, force));
    rig.steps(force > kLoad ? 240 : 4);
    EXPECT_NEAR(std::fabs(hinge.drives().applied_torque().z), std::min(force, kLoad), 0.01 * kLoad) << force;
  }
}

TEST(DirectSolver, LimitStopsAServo) {
  RawScene s = arm(8);
  for (RawJoint& j : s.joints) {
    j.lower = -0.2;
    j.upper = 0.2;
    j.amplitude = 0.6;
    j.square = true;
  }
  const auto player = RawSimulation::make(s, RawSolver::direct);
  EXPECT_LT(play(*player, 240).limit_violation, 0.01);
}

// Without drives, friction and damping a chain never gains energy.
TEST(DirectSolver, PassiveChainDoesNotGainEnergy) {
  RawScene s = arm(8);
  s.gravity = {9.81, 0, 0};
  for (RawJoint& j : s.joints) j.force = 0;
  const double swing = 9.81 * 8 * 0.8;  // energy between the lying and the hanging chain
  for (const int rate : {60, 240}) {
    s.step = 1.0 / rate;
    const auto player = RawSimulation::make(s, RawSolver::direct);
    const double start_energy = player->energy().potential;
    player->step();
    RawEnergyMeter meter(*player);
    double highest = -swing;
    RawMeasurements f;
    for (int i = 0; i < 10 * rate; ++i) {
      player->step();
      f.accumulate_max(player->measurements());
      highest = std::max(highest, meter.measure());
    }
    EXPECT_LT(f.gap, rate == 60 ? 0.02 : 4e-3) << rate;
    EXPECT_LT(highest - start_energy, 0.002 * swing) << rate;
    EXPECT_GT(highest - start_energy, -0.002 * swing) << rate;
  }
}

// Several motors of a lying arm yield at a time, so that the responses of its contacts change step by step: no contact
// may violate its conditions by much more than the relaxed tolerance.
TEST(DirectSolver, ContactsHoldWhileManyMotorsYield) {
  for (const double force : {1.0, 2.0, 5.0, 50.0}) {
    RawScene s = raw_arm(17, 1, force, 0.6, true);
    s.measure = true;
    const auto player = RawSimulation::make(s, RawSolver::direct);
    const RawMeasurements f = play(*player, 360);
    EXPECT_LT(player->direct().coupled, 0.2) << force;
    EXPECT_LT(f.gap, 0.02) << force;
    EXPECT_EQ(player->direct().fallbacks, 0) << force;
  }
}

// Four legs of three joints each stand, and every contact satisfies its conditions.
TEST(DirectSolver, HeavyTrunkStandsOnLightFeet) {
  const double masses[][2] = {{10, 0.5}, {50, 1}, {50, 0.1}};
  for (const auto& [trunk, leg] : masses) {
    RawScene s = raw_legs(trunk, leg, false);
    s.measure = true;
    const auto player = RawSimulation::make(s, RawSolver::direct);
    const RawMeasurements f = play(*player, 240);
    EXPECT_LT(f.gap, 2e-4) << trunk;
    EXPECT_LT(f.servo_error, 0.005) << trunk;
    EXPECT_LT(player->direct().coupled, 1e-3) << trunk;
    EXPECT_NEAR(player->pose(0).position.z, 0.42, 2e-3) << trunk;
    EXPECT_EQ(player->direct().fallbacks + player->direct().plain, 0);
  }
}

// Eight links closed to a ring: one joint is a coupled row around the tree of the others.
TEST(DirectSolver, RingStaysClosed) {
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
    j.position = corner(i);
    s.joints.push_back(j);
  }
  RawJoint last = s.joints.back();
  last.parent = 8;
  last.child = 1;
  last.position = corner(8);
  s.joints.push_back(last);
  const auto player = RawSimulation::make(s, RawSolver::direct);
  const RawMeasurements f = play(*player, 240);
  EXPECT_LT(f.gap, 0.02);
  EXPECT_GT(f.speed, 0.5);  // it is not stuck
  EXPECT_LT(player->direct().coupled, 1e-3);
  EXPECT_EQ(player->direct().fallbacks, 0);
}

// two bodies of 1 kg and 0.01 kg·m², 0.2 m apart, with a free hinge between them, rotating in opposite directions
struct SpinningPair {
  SpinningPair(double spin, bool parent_is_static)
      : parent(rig.part(parent_is_static ? 0 : 1, Vec3(parent_is_static ? 0 : 0.01))) {
    rig.world.set_direct(true);
    joint.set_axis(5, free_axis());
    if (!parent_is_static) move(parent, -0.1, spin);
    move(child, 0.1, -spin, parent_is_static ? -spin * 0.1 : 0);
  }
  // with a floating parent, both also move at (1, 2, 0) m/s and rotate at 3 rad/s about their common center
  void move(btRigidBody& body, double arm, double spin, double along = 0) {
    const double all = along == 0 ? 1 : 0;
    body.setLinearVelocity(bullet::to_bt(all * Vec3(1, 2 + 3 * arm, 0) + Vec3(0, along, 0)));
    body.setAngularVelocity(bullet::to_bt(Vec3(0, 0, all * 3 + spin)));
  }
  Vec3 momentum() const { return bullet::from_bt(parent.getLinearVelocity() + child.getLinearVelocity()); }
  Vec3 common_center() const {
    return bullet::from_bt(parent.getCenterOfMassPosition() + child.getCenterOfMassPosition()) / 2.0;
  }
  // about the initial common center, where the impulses of the first step act
  Vec3 spin() const {
    return bullet::from_bt(
        btVector3(bullet::to_scalar(0.1), 0, 0).cross(child.getLinearVelocity() - parent.getLinearVelocity()) +
        (parent.getAngularVelocity() + child.getAngularVelocity()) * bullet::to_scalar(0.01));
  }
  double relative_spin() const { return bullet::from_bt(parent.getAngularVelocity() - child.getAngularVelocity()).z; }
  Rig rig;
  btRigidBody& parent;
  btRigidBody& child = rig.part(1, Vec3(0.01), {{0.2, 0, 0}, quat_identity()});
  bullet::JointConstraint& joint =
      rig.joint(parent, child, {{0.1, 0, 0}, quat_identity()}, {{-0.1, 0, 0}, quat_identity()});
};

// Bullet clamps rotations beyond a quarter of pi per step. Beyond it the solver scales down the inner motion only; the
// rigid motion of the whole stays: 2 kg at (1, 2, 0) m/s, and 3 rad/s times 2·(0.01 + 1·0.1²) kg·m².
TEST(DirectSolver, SpinClampConservesMomentum) {
  constexpr double kStep = 1.0 / 60;
  for (const double spin : {40.0, 100.0, 1000.0}) {
    SCOPED_TRACE(spin);
    SpinningPair pair(spin, false);
    EXPECT_NEAR(pair.relative_spin(), 2 * spin, 1e-3);
    pair.rig.steps(1, kStep);
    EXPECT_NEAR(glm::length(pair.momentum() - Vec3(2, 4, 0)), 0, 1e-4);
    EXPECT_NEAR(glm::length(pair.spin() - Vec3(0, 0, 0.12)), 0, 1e-4);
    EXPECT_NEAR(glm::length(pair.common_center() - Vec3(0.1, 0, 0) - Vec3(1, 2, 0) * kStep), 0, 1e-5);
    const double max_rate = kPi / 4 / kStep;
    EXPECT_NEAR(pair.relative_spin() / 2, std::min(spin, max_rate), 0.02 * max_rate)
        << "slower rotations are not changed";
  }
}

TEST(DirectSolver, ClampsSpinOfAttachedTrees) {
  constexpr double kStep = 1.0 / 60;
  SpinningPair pair(200, true);
  EXPECT_NEAR(pair.relative_spin(), 200, 1e-3);
  pair.rig.steps(1, kStep);
  EXPECT_NEAR(pair.relative_spin(), kPi / 4 / kStep, 0.01 * kPi / 4 / kStep);
}

// The rotation is clamped, so the drift correction doesn't apply. The parts are moved together at the end of the step
// without a velocity: the common center continues on its path.
TEST(DirectSolver, ClosesJointsOfClampedBodies) {
  constexpr double kStep = 1.0 / 60;
  for (const double spin : {100.0, 1000.0}) {
    SCOPED_TRACE(spin);
    SpinningPair pair(spin, false);
    const auto middle = [&] {
      return bullet::from_bt(pair.parent.getCenterOfMassPosition() + pair.child.getCenterOfMassPosition()) * 0.5;
    };
    const Vec3 before = middle();
    pair.rig.steps(1, kStep);
    EXPECT_NEAR(glm::length(pair.joint.pose().offsets()), 0, 2e-4);
    EXPECT_NEAR(glm::length(middle() - before - Vec3(1, 2, 0) * kStep), 0, 1e-5);
  }
}

// `limber_measure solver` runs 300 such trees. Without closing the joints, seven of these drift apart by more than 10
// cm, and nearly all of stock Bullet's.
TEST(DirectSolver, RandomTreesKeepTheirJointsClosed) {
  for (unsigned seed = 500; seed < 530; ++seed) {
    const RawScene s = raw_with_step(raw_random_tree(seed, true), 1.0 / 30);
    const double a = play(*RawSimulation::make(s, RawSolver::stock), 60).gap;
    const double b = play(*RawSimulation::make(s, RawSolver::direct), 60).gap;
    EXPECT_LE(b, std::min(0.1, 1.1 * a + 2e-3)) << seed;
  }
}

// One end of a beam is deep in the floor, the other one is on a heavy part: the repair may rotate it by at most 0.05
// rad.
TEST(DirectSolver, RepairOfPenetrationKeepsJointsClosed) {
  RawScene s;
  s.floor = true;
  s.gravity = Vec3(0);
  s.parts.push_back({{0.4, 0.1, 0.1}, 100, {{0.3, 0, 0.06}, quat_identity()}});
  s.parts.push_back({{0.4, 0.1, 0.1}, 1, {{0, 0, 0.06 - 0.2 * std::sin(1.2)}, quat_axis({0, 1, 0}, -1.2)}});
  RawJoint j;
  j.axis = {0, 1, 0};
  j.parent = 0;
  j.child = 1;
  j.position = {0.2 * std::cos(1.2), 0, 0.06};
  s.joints.push_back(j);
  const auto player = RawSimulation::make(s, RawSolver::direct);
  const Quat before = player->pose(1).rotation;
  player->step();
  const Quat turned = player->pose(1).rotation * glm::conjugate(before);
  EXPECT_GT(2 * std::fabs(turned.y), 0.04);
  EXPECT_LT(2 * std::fabs(turned.y), 0.051);
  EXPECT_LT(player->measurements().gap, 3e-4);
}

// Closing joints respects limits; otherwise they would be exceeded by 0.4 rad.
TEST(DirectSolver, ClosingJointsRespectsLimits) {
  for (const unsigned seed : {520u, 544u, 552u}) {
    const RawScene s = raw_with_step(raw_random_tree(seed, true), 1.0 / 30);
    EXPECT_LT(play(*RawSimulation::make(s, RawSolver::direct), 90).limit_violation, 0.2) << seed;
  }
}

TEST(DirectSolver, IsDeterministic) {
  std::vector<Vec3> first;
  for (int run = 0; run < 2; ++run) {
    RawScene s = arm(9);
    s.floor = true;
    for (RawJoint& j : s.joints) {
      j.force = 30;
      j.amplitude = 0.9;
      j.square = true;
    }
    const auto player = RawSimulation::make(s, RawSolver::direct);
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

// A cube of 1 kg on a floor with a heavy one on it, without joints, up to a mass that sweeps can't support.
TEST(DirectSolver, HeavyBodiesStandOnALightOne) {
  for (const double mass : {10.0, 100.0, 1000.0}) {
    test::WorldFixture s;
    s.gravity({0, 0, -9.81});
    s.floor();
    Part& low = s.add_single_part(test::box_model(Vec3(1)), 1, {{0, 0, 0.5}, quat_identity()});
    Part& top = s.add_single_part(test::box_model(Vec3(1)), mass, {{0, 0, 1.5}, quat_identity()});
    s.set(low.body().id(), "can_sleep", {0});
    s.ticks(300);
    EXPECT_LT(glm::length(low.pose().position - Vec3(0, 0, 0.5)), 1e-4) << mass;
    EXPECT_LT(glm::length(top.pose().position - Vec3(0, 0, 1.5)), 1e-4) << mass;
    EXPECT_GT(s.number(s.world.id(), "islands_direct"), 1100);
    EXPECT_EQ(s.number(s.world.id(), "islands_iterative"), 0);
    EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
  }
}

// 27 touching boxes have more rows than the direct solver accepts for an island without joints.
TEST(DirectSolver, LeavesPilesToTheIterativeSolver) {
  test::WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  for (int i = 0; i < 27; i++) {
    s.add_single_part(test::box_model(Vec3(0.2)), 1,
                      {{i % 3 * 0.2, i / 3 % 3 * 0.2, 0.1 + i / 9 * 0.2}, quat_identity()});
  }
  s.ticks(10);
  EXPECT_EQ(s.number(s.world.id(), "islands_direct"), 0);
  EXPECT_EQ(s.number(s.world.id(), "islands_iterative"), 40);
  EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
}

}  // namespace
}  // namespace limber::sim
