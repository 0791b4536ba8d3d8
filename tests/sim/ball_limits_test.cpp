// Limits of ball joints: cone, twist, angle of the whole rotation. Closed forms, with both solvers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "sim/bullet/joints/swing_twist.h"
#include "sim/solver/direct_solver.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim::test {
namespace {

constexpr double kDegree = kPi / 180;
constexpr double kHeld = 0.5 * kDegree;  // a limit holds at least as exactly
constexpr double kBallMass = 2;
constexpr double kBallArm = 0.5;
constexpr double kBallGravity = 9.81;
constexpr Vec3 kBallBox{0.1, 0.2, 0.3};

// A box on a static ball at the origin, its center `arm` along the joint's axis.
struct BallFixture : WorldFixture {
  explicit BallFixture(bool direct, double arm = kBallArm, const Vec3& axis = {1, 0, 0})
      : robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        child(part(robot, box_model(kBallBox), kBallMass, {arm * axis, quat_identity()})),
        joint(*robot.add_joint("joint", base, child, model::JointType::spherical, Vec3(0), axis).value()),
        motor(*robot.add_motor(joint).value()) {
    set(world.id(), "solver", {direct ? 1.0 : 0.0});
    set(motor.id(), "mode", {0});
  }
  void limit(const char* property, double value) { set(joint.id(), property, {value}); }
  double swing() const { return number(joint.id(), "swing"); }
  double twist() const { return number(joint.id(), "twist"); }
  double angle() const { return bullet::swing_twist(joint.constraint().pose().rotation()).angle; }
  void ticks_with_torque(int n, const Vec3& torque) {
    for (int i = 0; i < n; i++) {
      child.apply_torque(torque);
      ticks(1);
    }
  }
  // Kinetic energy, and the potential one of gravity along -z, J.
  double energy() const {
    const Vec3 spin = glm::conjugate(child.pose().rotation) * child.angular_velocity();
    const Vec3 moments = box_inertia(kBallMass, kBallBox);
    const Vec3 velocity = child.linear_velocity();
    return 0.5 * kBallMass * glm::dot(velocity, velocity) + 0.5 * glm::dot(spin, moments * spin) -
           kBallMass * glm::dot(vec(world.id(), "gravity"), child.pose().position);
  }

  Body& robot;
  Part& base;
  Part& child;
  Joint& joint;
  Motor& motor;
};

// The angle to a turn, such as a twist.
Quat turned(const Vec3& axis, double angle) { return quat_axis(normalized(axis), angle); }

TEST(SwingTwist, SeparatesBothRotations) {
  for (const double swing : {0.0, 0.3, 1.6, 3.0}) {
    for (const double twist : {-3.0, -0.7, 0.0, 1.2, 3.1}) {
      for (const double heading : {0.0, 1.0, 4.0}) {
        const Quat rotation = turned({std::cos(heading), std::sin(heading), 0}, swing) * turned({0, 0, 1}, twist);
        const bullet::SwingTwist found = bullet::swing_twist(rotation);
        EXPECT_NEAR(found.swing, swing, 1e-9);
        EXPECT_NEAR(found.twist, twist, 1e-9) << swing;
        EXPECT_NEAR(std::cos(found.angle / 2), std::abs(rotation.w), 1e-9);
      }
    }
  }
}

// The axes give the rates: each angle changes by axis·w·dt in a rotation by w·dt.
TEST(SwingTwist, HasAxesOfItsRates) {
  const Quat rotation = turned({0.4, -0.8, 0}, 1.1) * turned({0, 0, 1}, 0.6);
  const bullet::SwingTwist before = bullet::swing_twist(rotation);
  constexpr double kSmall = 1e-6;
  for (const Vec3& w : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.3, -0.5, 0.8)}) {
    const bullet::SwingTwist after = bullet::swing_twist(turned(w, kSmall * glm::length(w)) * rotation);
    EXPECT_NEAR((after.swing - before.swing) / kSmall, glm::dot(before.swing_axis, w), 1e-4);
    EXPECT_NEAR((after.twist - before.twist) / kSmall, glm::dot(before.twist_axis, w), 1e-4);
    EXPECT_NEAR((after.angle - before.angle) / kSmall, glm::dot(before.angle_axis, w), 1e-4);
  }
}

// The weight hangs at the lowest point of the cone about a horizontal axis, and the joint carries its moment.
TEST(BallLimits, APendulumLeansOnItsCone) {
  for (const bool direct : {true, false}) {
    for (const double cone : {0.1, 0.6, 1.2}) {
      SCOPED_TRACE(testing::Message() << direct << " " << cone);
      BallFixture s(direct);
      s.gravity({0, 0, -kBallGravity});
      s.limit("cone_limit", cone);
      s.set(s.motor.id(), "damping", {0.5});
      s.ticks(900);
      const Vec3 lowest = kBallArm * Vec3(std::cos(cone), 0, -std::sin(cone));
      EXPECT_NEAR(s.swing(), cone, kHeld);
      EXPECT_LT(glm::length(s.child.pose().position - lowest), kBallArm * kHeld);
      // in the joint's frame, whose x and y axes are perpendicular to the cone's axis
      const double moment = kBallMass * kBallGravity * kBallArm * std::cos(cone);
      EXPECT_NEAR(glm::length(s.vec(s.joint.id(), "reaction_torque")), moment, 0.01 * moment);
    }
  }
}

// The height of the pendulum's weight at rest follows the cone while it changes.
TEST(BallLimits, AConeThatOpensLowersThePendulum) {
  BallFixture s(true);
  s.gravity({0, 0, -kBallGravity});
  s.set(s.motor.id(), "damping", {2});
  for (const double cone : {0.2, 0.9, 0.4, 1.5}) {
    s.limit("cone_limit", cone);
    s.ticks(600);
    EXPECT_NEAR(s.swing(), cone, kHeld);
  }
  s.limit("cone_limit", kPi);
  s.ticks(900);
  EXPECT_NEAR(s.swing(), kPi / 2, 0.01);
}

// The limit reacts about the bisector of both z axes, so a torque about it is balanced, whatever the swing.
TEST(BallLimits, TheTwistStopsAtEitherLimit) {
  for (const bool direct : {true, false}) {
    for (const double swing : {0.0, 0.7, 2.0}) {
      SCOPED_TRACE(testing::Message() << direct << " " << swing);
      BallFixture s(direct, 0, {0, 0, 1});
      s.limit("twist_lower", -0.8);
      s.limit("twist_upper", 0.3);
      s.set(s.motor.id(), "damping", {0.1});
      s.child.set_pose({Vec3(0), turned({1, 0, 0}, swing)});
      for (const double side : {1.0, -1.0}) {
        for (int i = 0; i < 300; i++) {
          const Vec3 z = s.child.pose().rotation * Vec3(0, 0, 1);
          s.ticks_with_torque(1, side * 0.5 * normalized(Vec3(0, 0, 1) + z));
        }
        EXPECT_NEAR(s.twist(), side > 0 ? 0.3 : -0.8, kHeld);
        EXPECT_NEAR(s.swing(), swing, 0.3);
      }
    }
  }
}

TEST(BallLimits, EqualTwistLimitsLockTheTwist) {
  for (const bool direct : {true, false}) {
    BallFixture s(direct, 0, {0, 0, 1});
    s.limit("twist_lower", 0.2);
    s.limit("twist_upper", 0.2);
    s.set(s.motor.id(), "damping", {0.5});
    for (int i = 0; i < 240; i++) {
      s.child.apply_torque({std::sin(0.02 * i), std::cos(0.03 * i), 0.5});
      s.ticks(1);
      if (i > 60) {
        EXPECT_NEAR(s.twist(), 0.2, kHeld) << direct << " " << i;
      }
    }
    EXPECT_GT(s.swing(), 0.3);
  }
}

// About an oblique axis, the rotation as a whole stops at its limit.
TEST(BallLimits, TheAngleOfTheRotationIsLimited) {
  for (const bool direct : {true, false}) {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), normalized(Vec3(0.5, 0, 1))}) {
      BallFixture s(direct, 0, {0, 0, 1});
      s.limit("rotation_limit", 0.9);
      s.set(s.motor.id(), "damping", {0.1});
      s.ticks_with_torque(400, 0.5 * axis);
      EXPECT_NEAR(s.angle(), 0.9, kHeld) << direct;
    }
  }
}

// A weight that circles on a cone about the vertical keeps its energy, and its angle: without the term for the
// curvature, it would drift outwards.
TEST(BallLimits, CirclingOnAConeKeepsItsEnergy) {
  for (const bool direct : {true, false}) {
    BallFixture s(direct, kBallArm, {0, 0, 1});
    constexpr double kCone = 0.6;
    constexpr double kSpeed = 4;  // rad/s about the vertical
    s.gravity({0, 0, -kBallGravity});
    s.limit("cone_limit", kCone);
    const Quat tilt = turned({0, 1, 0}, kCone);
    const Vec3 spin = Vec3(0, 0, kSpeed);
    const Vec3 center = tilt * Vec3(0, 0, kBallArm);
    s.child.set_pose({center, tilt});
    s.child.set_velocity(glm::cross(spin, center), spin);
    const double start = s.energy();
    const double kinetic = start - kBallMass * kBallGravity * kBallArm * std::cos(kCone);
    for (int i = 0; i < 300; i++) {
      s.ticks(1);
      EXPECT_NEAR(s.swing(), kCone, kHeld) << direct << " " << i;
      EXPECT_LT(s.energy(), start + 0.02 * kinetic) << direct << " " << i;
    }
    EXPECT_GT(s.energy(), start - 0.1 * kinetic) << direct;
  }
}

// A limit takes energy away from what runs into it, whatever the cone.
TEST(BallLimits, ImpactsDoNotAddEnergy) {
  for (const bool direct : {true, false}) {
    for (const double cone : {0.05, 0.5, 1.6, 2.5, 3.1}) {
      BallFixture s(direct);
      s.gravity({0, 0, -kBallGravity});
      s.limit("cone_limit", cone);
      s.limit("twist_lower", -0.4);
      s.limit("twist_upper", 0.6);
      s.limit("rotation_limit", 3);
      s.child.set_velocity({0, 1, 0}, {3, 0, 2});
      s.ticks(1);
      const double start = s.energy();
      double highest = start;
      for (int i = 0; i < 600; i++) {
        s.ticks(1);
        highest = std::max(highest, s.energy());
        EXPECT_LT(s.swing(), cone + 0.1) << i;
      }
      EXPECT_LT(highest, start + 0.02 * kBallMass * kBallGravity * kBallArm) << direct << " " << cone;
    }
  }
}

// Past a swing of π the twist has no value: its limits leave the joint alone there, and nothing jumps.
TEST(BallLimits, TheTwistIsFreeWhereItIsUndefined) {
  for (const double offset : {0.0, 1e-4, 0.02}) {
    BallFixture s(true, 0, {0, 0, 1});
    s.limit("twist_lower", -0.5);
    s.limit("twist_upper", 0.5);
    s.child.set_pose({Vec3(0), turned({1, 0, 0}, 2.5) * turned({0, 0, 1}, offset)});
    s.child.set_velocity({0, 0, 0}, {2, 0, 0});
    const double start = s.energy();
    for (int i = 0; i < 120; i++) {
      s.ticks(1);
      EXPECT_LT(s.energy(), 1.01 * start) << offset << " " << i;
    }
  }
}

// A servo that wants to leave the cone presses against it.
TEST(BallLimits, AServoStaysWithinTheCone) {
  for (const bool direct : {true, false}) {
    BallFixture s(direct, kBallArm, {0, 0, 1});
    s.gravity({0, 0, -kBallGravity});
    s.limit("cone_limit", 0.5);
    for (const char* property : {"angular_active", "angular_servo_active"}) s.set(s.motor.id(), property, {1, 1, 1});
    s.set(s.motor.id(), "max_angular_force", {40, 40, 40});
    s.set(s.motor.id(), "angular_servo_position", {1, 0, 0});
    s.ticks(300);
    EXPECT_NEAR(s.swing(), 0.5, kHeld) << direct;
    s.set(s.motor.id(), "angular_servo_position", {0.2, 0.1, 0});
    s.ticks(300);
    EXPECT_NEAR(std::cos(s.swing()), std::cos(0.2) * std::cos(0.1), 1e-3) << direct;
  }
}

// A chain of ball joints hangs over its cones: each link may turn by the cone against the previous one.
TEST(BallLimits, AChainBendsByOneConePerJoint) {
  WorldFixture s;
  s.gravity({0, 0, -kBallGravity});
  constexpr int kLinks = 6;
  constexpr double kLength = 0.2;
  constexpr double kCone = 0.15;
  Body& chain = s.body("chain");
  Part* last = &s.part(chain, box_model({0.05, 0.05, 0.05}), 0);
  std::vector<Joint*> joints;
  for (int i = 0; i < kLinks; i++) {
    Part& link = s.part(chain, box_model({kLength, 0.03, 0.03}), 0.2, {{(i + 0.5) * kLength, 0, 0}, quat_identity()});
    joints.push_back(chain
                         .add_joint("joint" + std::to_string(i), *last, link, model::JointType::spherical,
                                    {i * kLength, 0, 0}, {1, 0, 0})
                         .value());
    Motor& motor = *chain.add_motor(*joints.back()).value();
    s.set(motor.id(), "mode", {0});
    s.set(motor.id(), "damping", {0.05});
    s.set(joints.back()->id(), "cone_limit", {kCone});
    last = &link;
  }
  s.ticks(1200);
  Vec3 end(0);
  for (int i = 1; i <= kLinks; i++) end += kLength * Vec3(std::cos(i * kCone), 0, -std::sin(i * kCone));
  for (const Joint* joint : joints) EXPECT_NEAR(s.number(joint->id(), "swing"), kCone, kHeld);
  EXPECT_LT(glm::length(last->pose() * Vec3(kLength / 2, 0, 0) - end), 0.01);
}

TEST(BallLimits, ACopyMovesTheSameWay) {
  BallFixture s(true);
  s.gravity({0, 0, -kBallGravity});
  s.limit("cone_limit", 0.4);
  s.limit("twist_lower", -0.1);
  s.limit("twist_upper", 0.1);
  s.limit("rotation_limit", 2);
  s.ticks(40);
  Body& copy = *s.world.copy_body(s.robot, "copy").value();
  const Joint& joint = *copy.joints().front();
  for (const char* property : {"cone_limit", "twist_lower", "twist_upper", "rotation_limit"})
    EXPECT_EQ(s.number(joint.id(), property), s.number(s.joint.id(), property));
  s.ticks(120);
  EXPECT_NEAR(s.number(joint.id(), "swing"), s.swing(), 1e-4);
  EXPECT_NEAR(s.swing(), 0.4, kHeld);
}

// A limit that repairs its error has a state, which checkpoints contain: a weight was pushed past its cone.
TEST(BallLimits, CheckpointsContainTheirState) {
  for (const bool direct : {true, false}) {
    BallFixture s(direct);
    s.gravity({0, 0, -kBallGravity});
    s.ticks(30);
    s.limit("cone_limit", 0.3);
    s.limit("twist_lower", 0.1);
    s.limit("twist_upper", 0.2);
    s.ticks(5);
    const auto hashes = [&s] {
      std::vector<std::uint64_t> list;
      for (int i = 0; i < 40; i++) {
        s.ticks(1);
        list.push_back(s.world.state_hash());
      }
      return list;
    };
    PageStore pages;
    Archive scratch;
    WorldCheckpoint checkpoint;
    checkpoint.capture(s.world, pages, nullptr, scratch);
    const std::vector<std::uint64_t> first = hashes();
    checkpoint.restore(s.world, pages, scratch);
    EXPECT_EQ(hashes(), first) << direct;
    checkpoint.release(pages);
  }
}

}  // namespace
}  // namespace limber::sim::test
