// The armature of joints (rotor inertia), with closed forms of the motion.
#include <cmath>

#include "sim/stage.h"

namespace limber::sim::test {
namespace {

constexpr double kRotorGravity = 9.81;
constexpr double kRotorMass = 2;
constexpr Vec3 kRotorBox{0.1, 0.2, 0.6};

// A box on a static ball; its joint's axis is y. `arm`: from the pivot down to the box's center.
struct RotorFixture : WorldFixture {
  RotorFixture(bool direct, model::JointType type, double armature, double arm = 0)
      : robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        child(part(robot, box_model(kRotorBox), kRotorMass, {{0, 0, -arm}, quat_identity()})),
        joint(*robot.add_joint("joint", base, child, type, Vec3(0), Vec3(0, 1, 0)).value()) {
    set(world.id(), "solver", {direct ? 1.0 : 0.0});
    set(joint.id(), "armature", {armature});
  }
  Body& robot;
  Part& base;
  Part& child;
  Joint& joint;
};

TEST(Armature, AddsToTheInertiaAboutAHinge) {
  for (const bool direct : {true, false}) {
    for (const double armature : {0.0, 0.01, 0.5, 20.0}) {
      RotorFixture s(direct, model::JointType::revolute, armature);
      for (int i = 0; i < 60; i++) {
        s.child.apply_torque({0, 0.3, 0});
        s.ticks(1);
      }
      const double expected = 0.3 / (box_inertia(kRotorMass, kRotorBox).y + armature);
      EXPECT_NEAR(s.number(s.joint.id(), "speed"), expected, 1e-4 * expected) << direct << " " << armature;
    }
  }
}

TEST(Armature, AddsToTheMassAlongASlide) {
  for (const bool direct : {true, false}) {
    for (const double armature : {0.0, 0.5, 30.0}) {
      RotorFixture s(direct, model::JointType::prismatic, armature);
      for (int i = 0; i < 60; i++) {
        s.child.apply_force({0, 4, 0});
        s.ticks(1);
      }
      const double expected = 4 / (kRotorMass + armature);
      EXPECT_NEAR(s.number(s.joint.id(), "speed"), expected, 1e-4 * expected) << direct << " " << armature;
    }
  }
}

// A pendulum with a rotor: T = 2π·sqrt((I + a)/(m·g·l)), for small amplitudes, with I about the pivot.
TEST(Armature, SlowsAPendulum) {
  constexpr double kArm = 0.5;
  for (const bool direct : {true, false}) {
    for (const double armature : {0.0, 0.2, 2.0}) {
      RotorFixture s(direct, model::JointType::revolute, armature, kArm);
      s.gravity({0, 0, -kRotorGravity});
      s.substeps(16);
      const double inertia = box_inertia(kRotorMass, kRotorBox).y + kRotorMass * kArm * kArm + armature;
      const double period = 2 * kPi * std::sqrt(inertia / (kRotorMass * kRotorGravity * kArm));
      s.set(s.child.id(), "angular_velocity", {0, 0.05, 0});
      s.set(s.child.id(), "linear_velocity", {-0.05 * kArm, 0, 0});
      // the time between the zero crossings of the first and the fourth period
      double first = 0;
      double last = 0;
      int crossings = 0;
      double before = 0;
      for (int i = 0; i < 2000 && crossings < 7; i++) {
        s.ticks(1);
        const double now = s.number(s.joint.id(), "value");
        if (before * now < 0) {
          last = s.world.time() - 1.0 / 60 * now / (now - before);
          if (crossings++ == 0) first = last;
        }
        before = now;
      }
      ASSERT_EQ(crossings, 7);
      EXPECT_NEAR((last - first) / 3, period, 1e-3 * period) << direct << " " << armature;
    }
  }
}

// The rotor resists a servo as well: at its largest force the axis accelerates by force / (inertia + armature).
TEST(Armature, LoadsAServo) {
  for (const bool direct : {true, false}) {
    RotorFixture s(direct, model::JointType::revolute, 0.5);
    Motor& motor = *s.robot.add_motor(s.joint).value();
    s.set(motor.id(), "max_angular_force", {0, 0, 0.8});
    s.set(motor.id(), "target", {100});
    s.ticks(30);
    const double expected = 0.5 * 0.8 / (box_inertia(kRotorMass, kRotorBox).y + 0.5);
    EXPECT_NEAR(s.number(s.joint.id(), "speed"), expected, 2e-3 * expected) << direct;
  }
}

// The speed of an arm of two links with rotors, from rest under a torque on the last link, against the solution of
// the joint-space equation (M + a·1)·α = τ.
TEST(Armature, AddsToTheDiagonalOfTheJointSpaceInertia) {
  constexpr double kA = 0.07;
  constexpr double kTorque = 0.02;
  WorldFixture s;
  Body& robot = s.body("robot");
  Part* parent = &s.part(robot, sphere_model(0.05), 0);
  // links along x of length 1 and mass 1, which turn about z
  const double own = box_inertia(1, {1, 0.1, 0.1}).z;
  std::vector<Joint*> joints;
  for (int i = 0; i < 2; i++) {
    Part& link = s.part(robot, box_model({1, 0.1, 0.1}), 1, {{0.5 + i, 0, 0}, quat_identity()});
    joints.push_back(
        robot
            .add_joint("j" + std::to_string(i), *parent, link, model::JointType::revolute, Vec3(i, 0, 0), Vec3(0, 0, 1))
            .value());
    s.set(joints.back()->id(), "armature", {kA});
    parent = &link;
  }
  parent->apply_torque({0, 0, kTorque});
  s.ticks(1);
  // M of the straight arm, for the rates of the two hinges
  const double m22 = own + 0.25;
  const double m12 = own + 0.25 + 0.5;
  const double m11 = own + 0.25 + own + 2.25;
  // the torque on the second link acts on both coordinates
  const double determinant = (m11 + kA) * (m22 + kA) - m12 * m12;
  const double a1 = kTorque * ((m22 + kA) - m12) / determinant;
  const double a2 = kTorque * ((m11 + kA) - m12) / determinant;
  EXPECT_NEAR(s.number(joints[0]->id(), "speed"), a1 / 60, 1e-6);
  EXPECT_NEAR(s.number(joints[1]->id(), "speed"), a2 / 60, 1e-6);
}

}  // namespace
}  // namespace limber::sim::test
