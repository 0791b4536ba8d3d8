// Kinematic parts: parts moved by their pose or velocity carry and push others, with predictions from closed forms.
#include <cmath>

#include "sim/bullet/island_world.h"
#include "sim/stage.h"

namespace limber::sim::test {
namespace {

constexpr double kCarryGravity = 9.81;
constexpr double kPlatformTick = 1.0 / 60;
constexpr Vec3 kDeck{4, 4, 0.2};
constexpr double kCrate = 0.2;

double kinematic_motion() { return static_cast<double>(PartMotion::kinematic); }

// A platform whose top is at z = 0, and a crate that stands on it.
struct CarryFixture : WorldFixture {
  explicit CarryFixture(const Vec3& at = {0, 0, 0}, bool direct = true, double mass = 0)
      : platform(add_single_part(box_model(kDeck), mass, deck({0, 0, 0}))),
        crate(add_single_part(box_model(Vec3(kCrate)), 1, {at + Vec3(0, 0, kCrate / 2), quat_identity()})) {
    gravity({0, 0, -kCarryGravity});
    set(world.id(), "solver", {direct ? 1.0 : 0.0});
    for (const Part* part : {&platform, &crate}) set(part->id(), "friction", {0.8});
  }
  static Pose deck(const Vec3& top, const Quat& rotation = quat_identity()) {
    return {top - Vec3(0, 0, kDeck.z / 2), rotation};
  }
  void declare_kinematic() { set(platform.id(), "motion", {kinematic_motion()}); }
  Part& platform;
  Part& crate;
};

// Position of a platform that accelerates at `a` for a second, moves on, and brakes in the same way.
double trapezoid(double t, double a) {
  const auto ramp = [a](double s) { return s < 0 ? 0 : s < 1 ? a * s * s / 2 : a * (s - 0.5); };
  return ramp(t) - ramp(t - 2);
}

TEST(Kinematic, PlatformCarriesACrateAlongALine) {
  for (const bool direct : {true, false}) {
    CarryFixture s({0, 0, 0}, direct);
    s.declare_kinematic();
    s.world.flush();
    for (int tick = 0; tick < 240; tick++) {
      s.platform.set_pose(CarryFixture::deck({trapezoid((tick + 1) * kPlatformTick, 0.4), 0, 0}));
      s.ticks(1);
      // the mean velocity of the tick
      const double moved = trapezoid((tick + 1) * kPlatformTick, 0.4) - trapezoid(tick * kPlatformTick, 0.4);
      EXPECT_NEAR(s.platform.linear_velocity().x, moved / kPlatformTick, 1e-4);
    }
    EXPECT_NEAR(s.platform.pose().position.x, trapezoid(4, 0.4), 1e-6);
    EXPECT_NEAR(s.crate.pose().position.x, trapezoid(4, 0.4), 1e-3) << direct;
    EXPECT_NEAR(s.crate.pose().position.z, kCrate / 2, 1e-3) << direct;
    // without a new pose it stands
    s.ticks(1);
    EXPECT_EQ(s.platform.linear_velocity(), Vec3(0));
  }
}

TEST(Kinematic, PlatformCarriesACrateAlongACircle) {
  CarryFixture s;
  s.declare_kinematic();
  const auto at = [](double t) {
    const double angle = trapezoid(t, 0.5);
    return Vec3(0.5 * std::cos(angle) - 0.5, 0.5 * std::sin(angle), 0);
  };
  for (int tick = 0; tick < 300; tick++) {
    s.platform.set_pose(CarryFixture::deck(at((tick + 1) * kPlatformTick)));
    s.ticks(1);
  }
  EXPECT_NEAR(s.crate.pose().position.x, at(5).x, 1e-3);
  EXPECT_NEAR(s.crate.pose().position.y, at(5).y, 1e-3);
}

// A crate on a turntable keeps its place on it: neither the straight steps of its motion nor friction let it drift.
TEST(Kinematic, TurntableCarriesACrate) {
  for (const bool direct : {true, false}) {
    for (const double acceleration : {0.3, 1.0}) {
      CarryFixture s({1, 0, 0}, direct);
      s.declare_kinematic();
      double angle = 0;
      for (int tick = 0; tick < 480; tick++) {
        angle = trapezoid((tick + 1) * kPlatformTick, acceleration);
        s.platform.set_pose(CarryFixture::deck({0, 0, 0}, quat_axis({0, 0, 1}, angle)));
        s.ticks(1);
      }
      EXPECT_NEAR(s.crate.pose().position.x, std::cos(angle), 1e-3) << direct << " " << acceleration;
      EXPECT_NEAR(s.crate.pose().position.y, std::sin(angle), 1e-3) << direct << " " << acceleration;
    }
  }
}

// The velocity that is written moves it on; the crate's speed at its place is w x r.
TEST(Kinematic, VelocityMovesThePlatform) {
  CarryFixture s({1, 0, 0});
  s.set(s.platform.id(), "angular_velocity", {0, 0, 0.5});
  s.ticks(240);
  EXPECT_NEAR(2 * std::atan2(s.platform.pose().rotation.z, s.platform.pose().rotation.w), 0.5 * 4, 1e-4);
  EXPECT_NEAR(glm::length(s.crate.linear_velocity()), 0.5, 1e-3);
  EXPECT_NEAR(s.crate.angular_velocity().z, 0.5, 1e-3);
  s.set(s.platform.id(), "angular_velocity", {0, 0, 0});
  s.ticks(1);
  EXPECT_EQ(s.platform.angular_velocity(), Vec3(0));
  s.set(s.platform.id(), "linear_velocity", {0, 0.25, 0});
  s.ticks(120);
  EXPECT_NEAR(s.platform.pose().position.y, 0.5, 1e-4);
}

// Contact force m·(g + a) while the platform accelerates upwards, and the crate stays on it.
TEST(Kinematic, ElevatorPressesWithItsAcceleration) {
  for (const bool direct : {true, false}) {
    for (const double a : {2.0, -2.0}) {
      CarryFixture s({0, 0, 0}, direct);
      s.declare_kinematic();
      double impulse = 0;
      for (int tick = 0; tick < 60; tick++) {
        const double before = s.crate.linear_velocity().z;
        const double z = a / 2 * std::pow((tick + 1) * kPlatformTick, 2);
        s.platform.set_pose(CarryFixture::deck({0, 0, z}));
        s.ticks(1);
        if (tick >= 30) impulse += s.crate.linear_velocity().z - before + kCarryGravity * kPlatformTick;
        EXPECT_NEAR(s.crate.pose().position.z, z + kCrate / 2, 1e-3) << direct << " " << a << " " << tick;
      }
      EXPECT_NEAR(impulse / 0.5, kCarryGravity + a, 0.05) << direct << " " << a;
    }
  }
}

// A wall that is moved pushes a crate before it, without entering it, and is not slowed down.
TEST(Kinematic, WallPushes) {
  for (const bool direct : {true, false}) {
    for (const double speed : {0.5, 6.0}) {
      WorldFixture s;
      s.set(s.world.id(), "solver", {direct ? 1.0 : 0.0});
      Part& wall = s.add_single_part(box_model({0.2, 2, 2}), 0, {{-0.5, 0, 0}, quat_identity()});
      Part& crate = s.add_single_part(box_model(Vec3(kCrate)), 50, {{0, 0, 0}, quat_identity()});
      s.set(wall.id(), "motion", {kinematic_motion()});
      for (int tick = 0; tick < 120; tick++) {
        wall.set_pose({{-0.5 + speed * (tick + 1) * kPlatformTick, 0, 0}, quat_identity()});
        s.ticks(1);
        EXPECT_GT(crate.pose().position.x, wall.pose().position.x + 0.1 + kCrate / 2 - 2e-3) << tick;
      }
      EXPECT_NEAR(crate.linear_velocity().x, speed, 1e-3 * speed) << direct << " " << speed;
      EXPECT_NEAR(wall.pose().position.x, -0.5 + speed * 2, 1e-5);
    }
  }
}

// A ball with restitution e that rests before a wall at speed u leaves it at (1 + e)·u.
TEST(Kinematic, PaddleHits) {
  for (const bool direct : {true, false}) {
    WorldFixture s;
    s.set(s.world.id(), "solver", {direct ? 1.0 : 0.0});
    Part& paddle = s.add_single_part(box_model({0.2, 2, 2}), 0, {{-0.5, 0, 0}, quat_identity()});
    Part& ball = s.add_single_part(sphere_model(0.1), 0.3, {{0, 0, 0}, quat_identity()});
    s.set(paddle.id(), "restitution", {1});
    s.set(ball.id(), "restitution", {0.5});
    s.set(paddle.id(), "linear_velocity", {2, 0, 0});
    s.ticks(40);
    EXPECT_NEAR(ball.linear_velocity().x, 1.5 * 2, 1e-3) << direct;
  }
}

TEST(Kinematic, CarriesAStack) {
  CarryFixture s;
  s.declare_kinematic();
  std::vector<Part*> stack{&s.crate};
  for (int i = 1; i < 3; i++) {
    stack.push_back(&s.add_single_part(box_model(Vec3(kCrate)), 1, {{0, 0, kCrate * (i + 0.5)}, quat_identity()}));
    s.set(stack.back()->id(), "friction", {0.8});
  }
  for (int tick = 0; tick < 240; tick++) {
    s.platform.set_pose(CarryFixture::deck({trapezoid((tick + 1) * kPlatformTick, 0.3), 0, 0}));
    s.ticks(1);
  }
  for (std::size_t i = 0; i < stack.size(); i++) {
    EXPECT_NEAR(stack[i]->pose().position.x, trapezoid(4, 0.3), 2e-3) << i;
    EXPECT_NEAR(stack[i]->pose().position.z, kCrate * (static_cast<double>(i) + 0.5), 2e-3) << i;
  }
}

// A part of mass 0 whose pose is set in consecutive ticks carries; a single change is a teleport, which doesn't.
TEST(Kinematic, PosesInConsecutiveTicksMoveAStaticPart) {
  CarryFixture s;
  for (int tick = 0; tick < 240; tick++) {
    s.platform.set_pose(CarryFixture::deck({trapezoid((tick + 1) * kPlatformTick, 0.4), 0, 0}));
    s.ticks(1);
  }
  // the first tick is a teleport, by 5e-5 m
  EXPECT_NEAR(s.crate.pose().position.x, trapezoid(4, 0.4), 1e-3);
  CarryFixture teleport;
  teleport.ticks(5);
  teleport.platform.set_pose(CarryFixture::deck({0.3, 0, 0}));
  teleport.ticks(1);
  EXPECT_EQ(teleport.platform.linear_velocity(), Vec3(0));
  EXPECT_NEAR(teleport.platform.pose().position.x, 0.3, 1e-6);
  teleport.ticks(60);
  EXPECT_NEAR(teleport.crate.pose().position.x, 0, 1e-4);
}

TEST(Kinematic, TeleportsWhileNoTimePassesAndByReset) {
  CarryFixture s;
  s.declare_kinematic();
  s.ticks(5);
  s.platform.set_pose(CarryFixture::deck({0.5, 0, 0}));
  s.world.flush();  // as while paused
  EXPECT_NEAR(static_cast<double>(s.platform.rigid().getWorldTransform().getOrigin().x()), 0.5, 1e-6);
  s.ticks(1);
  EXPECT_EQ(s.platform.linear_velocity(), Vec3(0));
  s.platform.body().recovery().reset();
  s.ticks(1);
  EXPECT_EQ(s.platform.linear_velocity(), Vec3(0));
  EXPECT_NEAR(s.platform.pose().position.x, 0, 1e-6);
  // farther than 500 m/s
  s.platform.set_pose(CarryFixture::deck({9, 0, 0}));
  s.ticks(1);
  EXPECT_EQ(s.platform.linear_velocity(), Vec3(0));
  EXPECT_NEAR(s.platform.pose().position.x, 9, 1e-5);
}

// Dynamic again, it has its earlier mass and the velocity of its motion.
TEST(Kinematic, SwitchesAtRunTime) {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.1), 3);
  s.set(part.id(), "linear_velocity", {1, 0, 0});
  s.ticks(60);
  EXPECT_NEAR(part.pose().position.x, 1, 1e-4);
  s.set(part.id(), "motion", {kinematic_motion()});
  s.ticks(30);
  EXPECT_NEAR(part.pose().position.x, 1, 1e-4);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
  part.apply_force({100, 0, 0});
  s.set(part.id(), "linear_velocity", {0, 2, 0});
  s.ticks(30);
  EXPECT_NEAR(part.pose().position.x, 1, 1e-4);
  EXPECT_NEAR(part.pose().position.y, 1, 1e-4);
  s.set(part.id(), "motion", {0});
  s.ticks(30);
  EXPECT_NEAR(part.pose().position.y, 2, 1e-4);
  EXPECT_EQ(part.mass(), 3);
  for (int i = 0; i < 60; i++) {
    part.apply_force({6, 0, 0});
    s.ticks(1);
  }
  EXPECT_NEAR(part.linear_velocity().x, 6.0 / 3, 1e-4);
  s.set(part.id(), "motion", {static_cast<double>(PartMotion::fixed)});
  s.ticks(1);
  EXPECT_EQ(part.linear_velocity(), Vec3(0));
}

TEST(Kinematic, RejectsWhatCanNotMove) {
  WorldFixture s;
  Part& floor = s.floor();
  Part& block = s.add_single_part(box_model(Vec3(1)), 0);
  const double kinematic = kinematic_motion();
  const double dynamic = 0;
  EXPECT_FALSE(s.store.set(floor.id(), "motion", std::vector{kinematic}).ok());
  EXPECT_FALSE(s.store.set(block.id(), "motion", std::vector{dynamic}).ok());
  EXPECT_TRUE(s.store.set(block.id(), "motion", std::vector{kinematic}).ok());
  EXPECT_EQ(s.number(block.id(), "motion"), kinematic);
}

// A kinematic root swings a pendulum: in the frame of a root with the acceleration a the pendulum hangs at atan(a/g).
TEST(Kinematic, RootCarriesATree) {
  for (const bool direct : {true, false}) {
    WorldFixture s;
    s.gravity({0, 0, -kCarryGravity});
    s.set(s.world.id(), "solver", {direct ? 1.0 : 0.0});
    Body& robot = s.body("robot");
    Part& root = s.part(robot, sphere_model(0.05), 1);
    const double a = 3;
    const double angle = std::atan2(a, kCarryGravity);
    const Vec3 down(-std::sin(angle), 0, -std::cos(angle));
    Part& bob = s.part(robot, sphere_model(0.05), 1, {down, quat_identity()});
    Joint& joint = *robot.add_joint("joint", root, bob, model::JointType::revolute, Vec3(0), Vec3(0, 1, 0)).value();
    s.set(root.id(), "motion", {kinematic_motion()});
    for (int tick = 0; tick < 120; tick++) {
      const double t = (tick + 1) * kPlatformTick;
      root.set_pose({{a / 2 * t * t, 0, 0}, quat_identity()});
      s.ticks(1);
      EXPECT_LT(joint.gap(), 1e-3) << direct << " " << tick;
    }
    EXPECT_NEAR(s.number(joint.id(), "value"), 0, 0.02) << direct;
    EXPECT_NEAR(bob.linear_velocity().x, a * 2, 0.05) << direct;
  }
}

// A rotating root carries a locked arm: the tip moves at w x r, and the joint's angle stays.
TEST(Kinematic, RotatingRootCarriesAnArm) {
  for (const bool direct : {true, false}) {
    WorldFixture s;
    s.set(s.world.id(), "solver", {direct ? 1.0 : 0.0});
    Body& robot = s.body("robot");
    Part& root = s.part(robot, sphere_model(0.05), 1);
    Part& arm = s.part(robot, box_model({1, 0.1, 0.1}), 1, {{0.5, 0, 0}, quat_identity()});
    Joint& joint = *robot.add_joint("joint", root, arm, model::JointType::revolute, Vec3(0), Vec3(0, 1, 0)).value();
    Motor& motor = *robot.add_motor(joint).value();
    s.set(motor.id(), "target", {0.3});
    s.set(root.id(), "motion", {kinematic_motion()});
    s.ticks(60);
    s.set(root.id(), "angular_velocity", {0, 0, 3});
    s.ticks(120);
    EXPECT_NEAR(s.number(joint.id(), "value"), 0.3, 2e-3) << direct;
    EXPECT_NEAR(s.number(joint.id(), "speed"), 0, 2e-3) << direct;
    EXPECT_NEAR(arm.angular_velocity().z, 3, 0.01) << direct;
    EXPECT_NEAR(glm::length(arm.linear_velocity()), 3 * 0.5 * std::cos(0.3), 0.01) << direct;
    EXPECT_LT(joint.gap(), 1e-3) << direct;
  }
}

// A kinematic body: its motors do nothing, and its joints read the poses that are set.
TEST(Kinematic, WholeBodiesFollowTheirPoses) {
  WorldFixture s;
  Body& robot = s.body("robot");
  Part& root = s.part(robot, sphere_model(0.05), 1);
  Part& arm = s.part(robot, box_model({1, 0.1, 0.1}), 1, {{0.5, 0, 0}, quat_identity()});
  Joint& joint = *robot.add_joint("joint", root, arm, model::JointType::revolute, Vec3(0), Vec3(0, 0, 1)).value();
  Motor& motor = *robot.add_motor(joint).value();
  s.set(robot.id(), "motion", {kinematic_motion()});
  s.set(motor.id(), "target", {1});
  s.ticks(30);
  EXPECT_EQ(arm.motion(), PartMotion::kinematic);
  EXPECT_NEAR(s.number(joint.id(), "value"), 0, 1e-6);
  const double angle = 0.4;
  arm.set_pose({{0.5 * std::cos(angle), 0.5 * std::sin(angle), 0}, quat_axis({0, 0, 1}, angle)});
  s.ticks(1);
  EXPECT_NEAR(s.number(joint.id(), "value"), angle, 1e-5);
  robot.set_pose({{2, 0, 0}, quat_identity()});
  s.ticks(1);
  EXPECT_NEAR(root.linear_velocity().x, 2 / kPlatformTick, 1e-3);
  EXPECT_NEAR(s.number(joint.id(), "value"), angle, 1e-5);
}

TEST(Kinematic, WakesWhatItTouches) {
  CarryFixture s;
  s.declare_kinematic();
  s.ticks(200);
  ASSERT_TRUE(s.crate.asleep());
  s.set(s.platform.id(), "linear_velocity", {0.2, 0, 0});
  s.ticks(60);
  EXPECT_FALSE(s.crate.asleep());
  // it slips until it has the platform's speed
  EXPECT_NEAR(s.crate.pose().position.x, 0.2 - 0.2 * 0.2 / (2 * 0.64 * kCarryGravity), 1e-3);
  s.set(s.platform.id(), "linear_velocity", {0, 0, 0});
  s.ticks(200);
  EXPECT_TRUE(s.crate.asleep());
}

// A wall reaches a sleeping crate.
TEST(Kinematic, WakesWhatItReaches) {
  WorldFixture s;
  s.gravity({0, 0, -kCarryGravity});
  s.floor();
  Part& wall = s.add_single_part(box_model({0.2, 2, 0.2}), 0, {{-1, 0, 0.2}, quat_identity()});
  Part& crate = s.add_single_part(box_model(Vec3(kCrate)), 1, {{0, 0, kCrate / 2}, quat_identity()});
  s.ticks(200);
  ASSERT_TRUE(crate.asleep());
  s.set(wall.id(), "linear_velocity", {1, 0, 0});
  s.ticks(120);
  EXPECT_NEAR(crate.pose().position.x, 1.1 + kCrate / 2, 5e-3);
}

// A copy of a moving platform moves on like it.
TEST(Kinematic, CopiesMoveOn) {
  CarryFixture s;
  s.set(s.platform.id(), "linear_velocity", {0.5, 0, 0});
  s.ticks(30);
  Body& copy = *s.world.copy_body(s.platform.body(), "copy").value();
  copy.set_pose(CarryFixture::deck({s.platform.pose().position.x, 9, 0}));
  s.ticks(30);
  EXPECT_NEAR(copy.root()->pose().position.x, 0.5, 1e-3);
  EXPECT_NEAR(copy.root()->linear_velocity().x, 0.5, 1e-6);
}

}  // namespace
}  // namespace limber::sim::test
