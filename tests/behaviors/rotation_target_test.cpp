// rotation_target: target = θ + clamp(wrap(target − θ), −speed, speed) on each servo or spring axis, wrapped on free
// axes only.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kServo = 2, kSpring = 3, kOff = 0;

/// A hinge about z at an angle, with its motor in a given mode and a behavior.
struct Hinge : OneAxisFixture {
  explicit Hinge(double angle, double mode = kServo) : OneAxisFixture(5) {
    set(motor.id(), "mode", {mode});
    set_value(angle);
    world.flush();
    behavior = *world.behaviors().add(robot, "RotationTargetBehavior", "lead");
  }
  double servo() const { return vec(motor.id(), "angular_servo_position").z; }
  double rest() const { return vec(motor.id(), "angular_spring_rest_length").z; }
  void set_target(double target) {
    set(behavior->id(), "target", {0, 0, target});
    world.behaviors().step(world.timestep());
  }
  Behavior* behavior = nullptr;
};

TEST(RotationTarget, SetsTheServoOneStepAheadOfTheJoint) {
  Hinge hinge(0.5);
  hinge.set_target(2);
  EXPECT_NEAR(hinge.servo(), 0.6, 1e-6);
  hinge.set_target(-2);
  EXPECT_NEAR(hinge.servo(), 0.4, 1e-6);
  hinge.set_target(0.53);
  EXPECT_NEAR(hinge.servo(), 0.53, 1e-6);
  hinge.set(hinge.behavior->id(), "speed", {0.25});
  hinge.set_target(2);
  EXPECT_NEAR(hinge.servo(), 0.75, 1e-6);
}

TEST(RotationTarget, TakesTheShorterWayOnlyOnFreeAxes) {
  Hinge turning(3);
  turning.limits(1, -1);  // free
  turning.world.flush();
  turning.set_target(-3);
  EXPECT_NEAR(turning.servo(), 3.1, 1e-6);
  Hinge limited(3);
  limited.limits(-3.5, 3.5);
  limited.world.flush();
  limited.set_target(-3);
  EXPECT_NEAR(limited.servo(), 2.9, 1e-6);
}

TEST(RotationTarget, HalfATurnRotatesPositively) {
  Hinge hinge(0);
  hinge.limits(1, -1);
  hinge.world.flush();
  hinge.set(hinge.behavior->id(), "speed", {10});
  hinge.set_target(-kPi);
  EXPECT_NEAR(hinge.servo(), kPi, 1e-6);
}

TEST(RotationTarget, MovesTheRestPositionOfASpring) {
  Hinge hinge(0.5, kSpring);
  const double servo = hinge.servo();
  hinge.set_target(2);
  EXPECT_NEAR(hinge.rest(), 0.6, 1e-6);
  EXPECT_EQ(hinge.servo(), servo);
}

TEST(RotationTarget, IgnoresAxesInModeOffOrSpin) {
  for (const double mode : {kOff, 1.0}) {
    Hinge hinge(0.5, mode);
    const double servo = hinge.servo();
    const double rest = hinge.rest();
    hinge.set_target(2);
    EXPECT_EQ(hinge.servo(), servo) << mode;
    EXPECT_EQ(hinge.rest(), rest) << mode;
  }
}

TEST(RotationTarget, HandlesEachAxisByItsMode) {
  WorldFixture s;
  Body& body = s.body("b");
  Part& base = s.part(body, sphere_model(0.1), 0);
  Part& tip = s.part(body, sphere_model(0.1), 1);
  Joint& joint = **body.add_joint("ball", base, tip, model::JointType::spherical, Vec3(0), Vec3(0, 0, 1));
  Motor& motor = **body.add_motor(joint);
  s.set(motor.id(), "mode", {0});
  s.set(motor.id(), "angular_active", {1, 0, 0});
  s.set(motor.id(), "angular_servo_active", {1, 0, 0});
  s.set(motor.id(), "angular_spring_active", {0, 1, 0});
  s.set(motor.id(), "angular_servo_position", {7, 7, 7});
  s.set(motor.id(), "angular_spring_rest_length", {8, 8, 8});
  Behavior& b = **s.world.behaviors().add(body, "rotation_target", "lead");
  s.set(b.id(), "target", {1, -1, 1});
  s.world.behaviors().step(1.0 / 60);
  expect_near(s.vec(motor.id(), "angular_servo_position"), {0.1, 7, 7}, 1e-6);
  expect_near(s.vec(motor.id(), "angular_spring_rest_length"), {8, -0.1, 8}, 1e-6);
}

TEST(RotationTarget, SelectedJointsMeanTheirMotors) {
  WorldFixture s;
  Body& body = s.body("b");
  std::vector<Part*> parts = {&s.part(body, sphere_model(0.1), 0)};
  for (const char* name : {"one", "two", "three", "bare"}) {
    parts.push_back(&s.part(body, sphere_model(0.1), 1, {{static_cast<double>(parts.size()), 0, 0}, quat_identity()}));
    Joint& joint = **body.add_joint(name, *parts[parts.size() - 2], *parts.back(), model::JointType::revolute,
                                    parts.back()->pose().position, Vec3(0, 0, 1));
    if (std::string_view(name) == "bare") continue;
    ASSERT_TRUE(body.add_motor(joint).ok());
  }
  const auto names = [&](std::optional<std::vector<std::string>> joints,
                         std::optional<std::vector<std::string>> motors) {
    BehaviorSetup setup;
    if (joints) setup.joints = Selection(*joints);
    if (motors) setup.motors = Selection(*motors);
    const Result<Behavior*> b = s.world.behaviors().add(body, "rotation_target", "lead", setup);
    if (!b) return b.error();
    std::string list;
    for (const Motor* motor : (*b)->motors()) list += motor->name() + " ";
    s.world.behaviors().remove(**b);
    return list;
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(names({}, {}), "one two three ");
  EXPECT_EQ(names(Words{"three", "one"}, {}), "one three ");
  EXPECT_EQ(names({}, Words{"t*"}), "two three ");
  EXPECT_EQ(names(Words{"one"}, Words{"three"}), "one three ");
  EXPECT_EQ(names(Words{"bare"}, {}), "joint 'b/bare' has no motor; add one with add_motor");
  EXPECT_EQ(names(Words{"b*"}, {}), "");
}

// The lag of the servo doesn't accumulate: the joint arrives and stays.
TEST(RotationTarget, JointReachesTheTarget) {
  Hinge hinge(0);
  hinge.limits(-3, 3);
  hinge.set(hinge.behavior->id(), "target", {0, 0, 1.2});
  hinge.ticks(120);
  EXPECT_NEAR(hinge.x(), 1.2, 1e-3);
  EXPECT_NEAR(hinge.v(), 0, 1e-3);
}

}  // namespace
}  // namespace limber::sim
