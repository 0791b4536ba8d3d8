// Motion compared with closed formulas: tensors, pendulum, springs, servos, limits, momentum, mirrors.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/arm.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

// A link with a full tensor and its center away from the link's origin.
std::shared_ptr<const model::BodyModel> model_with_tensor(const Mat3& tensor, double mass, const Vec3& center) {
  auto model = std::make_shared<model::BodyModel>();
  model::LinkModel link;
  link.name = "link";
  link.inertial = {mass, center, tensor};
  model::PlacedShape ball;
  ball.shape = sphere_model(0.05);
  link.collisions = {ball};
  model->links = {link};
  return model;
}

TEST(Prediction, TorqueAcceleratesByTheTensor) {
  // symmetric, positive definite, and its moments fulfill the triangle inequality
  const Mat3 tensor(Vec3(0.5, 0.08, -0.05), Vec3(0.08, 0.6, 0.1), Vec3(-0.05, 0.1, 0.4));
  for (int axis = 0; axis < 3; axis++) {
    WorldFixture s;
    Body& body = **s.world.add_body(model_with_tensor(tensor, 2, {0.1, -0.2, 0.3}), "thing", {});
    Part& part = *body.root();
    const Quat turn = quat_axis(normalized({1, -2, 0.5}), 0.9);
    part.set_pose({{1, 2, 3}, turn});
    Vec3 torque(0);
    torque[axis] = 0.01;
    part.apply_torque(torque);
    s.ticks(1);
    const Vec3 in_link = glm::inverse(tensor) * (glm::conjugate(turn) * torque);
    const Vec3 expected = turn * in_link / 60.0;
    for (int i = 0; i < 3; i++) EXPECT_NEAR(part.angular_velocity()[i], expected[i], 2e-5 * glm::length(expected));
    // the center stays, and the link's origin follows from it
    const Vec3 center = Vec3(1, 2, 3) + turn * Vec3(0.1, -0.2, 0.3);
    EXPECT_LT(glm::length(part.center() - center), 1e-6);
  }
}

TEST(Prediction, PartReportsItsMomentsAndTheirAxes) {
  const Mat3 tensor(Vec3(0.5, 0.08, -0.05), Vec3(0.08, 0.6, 0.1), Vec3(-0.05, 0.1, 0.4));
  WorldFixture s;
  Part& part = *(**s.world.add_body(model_with_tensor(tensor, 2, {0.1, -0.2, 0.3}), "thing", {})).root();
  const Quat turn = quat_axis(normalized({1, -2, 0.5}), 0.9);
  part.set_pose({{1, 2, 3}, turn});
  s.set(part.id(), "mass", {6});  // its moments scale with it
  double moments[3], q[4];
  s.store.get(part.id(), Part::table().at("inertia"), moments);
  s.store.get(part.id(), Part::table().at("principal_axes"), q);
  const Mat3 axes = glm::mat3_cast(Quat(q[3], q[0], q[1], q[2]));
  const Mat3 in_world = axes * Mat3(moments[0], 0, 0, 0, moments[1], 0, 0, 0, moments[2]) * glm::transpose(axes);
  const Mat3 r = glm::mat3_cast(turn);
  const Mat3 expected = r * (3.0 * tensor) * glm::transpose(r);
  for (int i = 0; i < 3; i++) EXPECT_LT(glm::length(in_world[i] - expected[i]), 1e-6) << i;
}

TEST(Prediction, ForceAtAPointActsWithItsArm) {
  WorldFixture s;
  Part& box = s.add_single_part(box_model({0.4, 0.6, 0.2}), 3, {{1, 1, 1}, quat_identity()});
  const Vec3 arm(0.2, 0.1, -0.1);
  const Vec3 force(0.5, -0.3, 0.4);
  box.apply_force_at(force, Vec3(1, 1, 1) + arm);
  s.ticks(1);
  const Vec3 spin = glm::cross(arm, force) / box_inertia(3, {0.4, 0.6, 0.2}) / 60.0;
  EXPECT_LT(glm::length(box.angular_velocity() - spin), 1e-3 * glm::length(spin));
  EXPECT_LT(glm::length(box.linear_velocity() - force / 180.0), 1e-7);
  // a force ends with its tick; an impulse acts at once
  s.ticks(10);
  EXPECT_LT(glm::length(box.linear_velocity() - force / 180.0), 1e-7);
  box.apply_impulse_at({0.6, 0, 0}, box.center());
  s.ticks(1);
  EXPECT_LT(glm::length(box.linear_velocity() - force / 180.0 - Vec3(0.2, 0, 0)), 1e-6);
}

// A torque-free uneven box tumbles and conserves its angular momentum.
TEST(Prediction, TumblingBoxConservesAngularMomentum) {
  const Vec3 size(0.1, 0.3, 0.5);
  WorldFixture s;
  s.substeps(16);
  Part& box = s.add_single_part(box_model(size), 2);
  s.set(box.id(), "angular_velocity", {0.3, 3, 0.3});  // about the middle axis: unstable
  const auto momentum = [&] {
    const Quat q = box.pose().rotation;
    return q * (box_inertia(2, size) * (glm::conjugate(q) * box.angular_velocity()));
  };
  const Vec3 before = momentum();
  double min_rate = 3;
  for (int i = 0; i < 180; i++) {
    s.ticks(1);
    min_rate = std::min(min_rate, (glm::conjugate(box.pose().rotation) * box.angular_velocity()).y);
  }
  EXPECT_LT(min_rate, -2);  // it turned over
  EXPECT_LT(glm::length(momentum() - before), 0.02 * glm::length(before));
}

// A box on a hinge through a point above it.
struct Pendulum : WorldFixture {
  static constexpr double kLength = 0.8, kMass = 1.5;
  static constexpr Vec3 kBox{0.1, 0.2, 0.3};
  Body& robot = body("robot");
  Part& base = part(robot, sphere_model(0.05), 0, {{0, 0, 1}, quat_identity()});
  Part& bob = part(robot, box_model(kBox), kMass, {{0, 0, 1 - kLength}, quat_identity()});
  Joint& hinge = *robot.add_joint("hinge", base, bob, model::JointType::revolute, {0, 0, 1}, {0, 1, 0}).value();
  double inertia = kMass * kLength * kLength + box_inertia(kMass, kBox).y;

  void swing_out(double angle) {
    const Pose pivot{{0, 0, 1}, quat_axis({0, 1, 0}, angle)};
    bob.set_pose(pivot * Pose{{0, 0, -kLength}, quat_identity()});
  }
  /// Mean period of several swings, from interpolated upward zero crossings.
  double period(int swings, double about = 0) {
    double last = hinge.value() - about;
    double first_crossing = -1;
    for (int tick = 1; tick < 20000; tick++) {
      ticks(1);
      const double now = hinge.value() - about;
      if (last < 0 && now >= 0) {
        const double at = world.time() - now / (now - last) / 60;
        if (first_crossing < 0) {
          first_crossing = at;
        } else if (--swings == 0) {
          return at - first_crossing;
        }
      }
      last = now;
    }
    return -1;
  }
};

TEST(Prediction, PendulumSwingsWithItsPeriod) {
  for (const double angle : {0.05, 0.5, 1.0}) {
    Pendulum p;
    p.gravity({0, 0, -9.81});
    p.swing_out(angle);
    const double a2 = angle * angle;
    const double small = 2 * kPi * std::sqrt(p.inertia / (Pendulum::kMass * 9.81 * Pendulum::kLength));
    const double exact = small * (1 + a2 / 16 + 11 * a2 * a2 / 3072 + 173 * a2 * a2 * a2 / 737280);
    EXPECT_NEAR(p.period(5) / 5, exact, 1e-3 * exact) << angle;
  }
}

TEST(Prediction, SpringOscillatesAndDeflectsByItsFormula) {
  for (const double stiffness : {2.0, 20.0, 100.0}) {
    Pendulum p;
    Motor& motor = *p.robot.add_motor(p.hinge).value();
    p.set(motor.id(), "mode", {3});
    p.set_one(motor.id(), "angular_spring_stiffness", 2, stiffness);
    p.swing_out(0.3);
    const double expected = 2 * kPi * std::sqrt(p.inertia / stiffness);
    EXPECT_NEAR(p.period(5) / 5, expected, 0.005 * expected) << stiffness;

    // released level, gravity's torque along its arm: k·a = m·g·l·cos(a), with the rest position level
    Pendulum q;
    Motor& holds = *q.robot.add_motor(q.hinge).value();
    q.set(holds.id(), "mode", {3});
    q.set(holds.id(), "target", {-kPi / 2});
    q.set_one(holds.id(), "angular_spring_stiffness", 2, stiffness);
    q.set_one(holds.id(), "angular_spring_damping", 2, 2 * std::sqrt(stiffness * q.inertia));
    q.swing_out(-kPi / 2);
    q.gravity({0, 0, -1});
    q.ticks(1200);
    const double load = Pendulum::kMass * Pendulum::kLength;
    double sag = 0;
    for (int i = 0; i < 200; i++) sag += 0.5 * (load * std::cos(sag) / stiffness - sag);
    EXPECT_NEAR(q.hinge.value() + kPi / 2, sag, 0.01 * sag) << stiffness;
  }
}

TEST(Prediction, ServoMovesHoldsAndStalls) {
  Pendulum p;
  Motor& motor = *p.robot.add_motor(p.hinge).value();
  p.set(motor.id(), "speed", {1.5});
  p.set(motor.id(), "target", {1.2});
  for (int i = 1; i <= 40; i++) {
    p.ticks(1);
    EXPECT_NEAR(p.hinge.value(), 1.5 * i / 60, 0.01);
  }
  p.ticks(60);
  EXPECT_NEAR(p.hinge.value(), 1.2, 1e-4);
  EXPECT_NEAR(p.number(p.hinge.id(), "speed"), 0, 1e-4);

  // with gravity it bears m·g·l·sin(a) at rest, and reports it: torque on the child, right-handed
  p.gravity({0, 0, -9.81});
  p.ticks(120);
  EXPECT_NEAR(p.hinge.value(), 1.2, 1e-3);
  const double load = Pendulum::kMass * 9.81 * Pendulum::kLength * std::sin(p.hinge.value());
  EXPECT_NEAR(p.vec(motor.id(), "applied_torque").z, load, 0.01 * load);

  // with less it can't hold, and falls with the difference
  p.set_one(motor.id(), "max_angular_force", 2, 0.6 * load);
  p.ticks(3);
  EXPECT_NEAR(p.number(p.hinge.id(), "speed"), -0.4 * load / p.inertia * 3 / 60, 0.05 * load / p.inertia * 3 / 60);
}

TEST(Prediction, LimitsHoldOnEachAxisAndBeyondPi) {
  for (int axis = 3; axis < 6; axis++) {
    for (const double at : {4.5, 9.0}) {
      for (const double direction : {1.0, -1.0}) {
        OneAxisFixture a(axis);
        direction > 0 ? a.limits(-0.5, at) : a.limits(-at, 0.5);
        a.ticks_with_load(600, direction * 0.2);
        EXPECT_NEAR(a.x(), direction * at, 2e-3) << axis;
        a.ticks_with_load(900, -direction * 0.2);
        EXPECT_NEAR(a.x(), -direction * 0.5, 2e-3) << axis;
      }
    }
  }
}

TEST(Prediction, LimitedServoTakesTheAllowedDirection) {
  OneAxisFixture a(5);
  a.limits(-2.5, 2.5);
  a.set_motor("active", 1);
  a.set_motor("servo_active", 1);
  a.set_motor("velocity", 3);
  a.set_motor("servo_position", 2.4);
  a.ticks(120);
  EXPECT_NEAR(a.x(), 2.4, 1e-3);
  a.set_motor("servo_position", -2.4);  // over pi it would be nearer
  a.ticks(60);
  EXPECT_NEAR(a.x(), 2.4 - 3, 0.1);
  a.ticks(120);
  EXPECT_NEAR(a.x(), -2.4, 1e-3);
}

// A floating arm moves violently by its servos: internal forces change neither its center nor its momentum.
TEST(Prediction, FloatingBodyConservesMomentum) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {5, {0, 0, 0}, false});
  const auto momentum = [&] {
    Vec3 linear(0);
    Vec3 angular(0);
    for (const auto& part : arm.parts()) {
      const double m = s.number(part->id(), "mass");
      const Vec3 size = part.get() == arm.root() ? Vec3(0.2, 0.2, 0.1) : Vec3(0.1, 0.08, 0.2);
      const Quat q = part->pose().rotation;
      linear += m * part->linear_velocity();
      angular += m * glm::cross(part->center(), part->linear_velocity()) +
                 q * (box_inertia(m, size) * (glm::conjugate(q) * part->angular_velocity()));
    }
    return std::pair(linear, angular);
  };
  s.set(arm.id(), "linear_velocity", {0.3, -0.2, 0.1});
  s.world.flush();
  const auto [linear, angular] = momentum();
  double max_rate = 0;
  for (int i = 0; i < 180; i++) {
    set_wave_targets(s, arm, s.world.time());
    s.ticks(1);
    for (const auto& part : arm.parts()) max_rate = std::max(max_rate, glm::length(part->angular_velocity()));
  }
  EXPECT_GT(max_rate, 1);  // it moved violently
  const auto [linear_after, angular_after] = momentum();
  EXPECT_LT(glm::length(linear_after - linear), 1e-4);
  EXPECT_LT(glm::length(angular_after - angular), 5e-3);
}

TEST(Prediction, MirroredRobotsMoveMirrored) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& left = make_arm(s, "left", {5, {0, 3, 0}, true, 1, 0.05});
  Body& right = make_arm(s, "right", {5, {0, -3, 0}, true, -1, 0.05});
  for (int i = 0; i < 120; i++) {
    set_wave_targets(s, left, s.world.time());
    set_wave_targets(s, right, s.world.time());
    s.ticks(1);
  }
  for (std::size_t i = 0; i < left.parts().size(); i++) {
    const Vec3 a = left.parts()[i]->pose().position;
    const Vec3 b = right.parts()[i]->pose().position;
    EXPECT_LT(glm::length(a - Vec3(b.x, -b.y, b.z)), 1e-4) << i;
  }
  EXPECT_GT(glm::length(left.parts().back()->pose().position - Vec3(0, 3.25, 1.25)), 0.1);
}

}  // namespace
}  // namespace limber::sim
