// Contact forces, joint reactions, IMUs, zones, touch sensors, momentum and energy, against closed forms.
#include "sim/sensors/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/sensors/readouts.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kEarthG = 9.81;

struct SensorsFixture : WorldFixture {
  SensorsFixture() { gravity({0, 0, -kEarthG}); }
  Part& reporting(Part& part) {
    set(part.id(), "report_contacts", {1});
    return part;
  }
  Sensor& sensor(Part& part, SensorKind kind, const std::string& name = "sensor") {
    return *part.body().sensors().add(name, kind, part).value();
  }
  double timestep() const { return number(world.id(), "timestep"); }
  void solver(int direct) { set(world.id(), "solver", {static_cast<double>(direct)}); }
};

void expect_vec_near(const Vec3& value, const Vec3& expected, double tolerance) {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(value[i], expected[i], tolerance) << i;
}

// Contacts.

TEST(ContactForces, WeightOnFourFeetAddsUp) {
  SensorsFixture s;
  s.floor();
  Body& table = s.body("table");
  Part& top = s.part(table, box_model({1, 0.6, 0.1}), 7, {{0, 0, 0.55}, quat_identity()});
  std::vector<Part*> feet;
  for (const double x : {-0.4, 0.4}) {
    for (const double y : {-0.2, 0.2}) {
      Part& foot = s.reporting(s.part(table, box_model({0.1, 0.1, 0.5}), 0.5, {{x, y, 0.25}, quat_identity()}));
      feet.push_back(&foot);
      ASSERT_TRUE(table.add_joint("weld" + std::to_string(feet.size()), top, foot, model::JointType::fixed, {x, y, 0.5},
                                  {0, 0, 1}));
    }
  }
  // a load near one corner: the feet bear different shares
  Part& load = s.add_single_part(sphere_model(0.05), 4, {{0.3, 0.1, 0.65}, quat_identity()});
  s.set(load.id(), "rolling_friction", {0.1});
  s.ticks(180);
  double sum = 0;
  double least = 1e9;
  double most = 0;
  for (const Part* foot : feet) {
    const double force = s.number(foot->id(), "contact_normal_force");
    EXPECT_GT(s.number(foot->id(), "contact_count"), 0);
    sum += force;
    least = std::min(least, force);
    most = std::max(most, force);
  }
  EXPECT_NEAR(sum, 13 * kEarthG, 1e-3 * 13 * kEarthG);
  EXPECT_GT(most, least + kEarthG);
}

TEST(ContactForces, OnASlopeAreWeightTimesCosineAndSine) {
  for (const double angle : {0.1, 0.3}) {
    for (const int direct : {0, 1}) {
      SensorsFixture s;
      s.solver(direct);
      const Quat tilt = quat_axis({0, 1, 0}, angle);
      s.add_single_part(box_model({4, 4, 1}), 0, {tilt * Vec3(0, 0, -0.5), tilt});
      Part& box = s.reporting(s.add_single_part(box_model({0.4, 0.4, 0.2}), 3, {tilt * Vec3(0, 0, 0.1), tilt}));
      s.set(box.id(), "friction", {1});
      s.ticks(60);
      EXPECT_NEAR(s.number(box.id(), "contact_normal_force"), 3 * kEarthG * std::cos(angle), 0.02) << angle << direct;
      EXPECT_NEAR(s.number(box.id(), "contact_friction_force"), 3 * kEarthG * std::sin(angle), 0.02) << angle << direct;
      expect_vec_near(s.vec(box.id(), "contact_force"), {0, 0, 3 * kEarthG}, 0.02);
    }
  }
}

TEST(ContactForces, PointsHavePlaceNormalAndPartner) {
  SensorsFixture s;
  Part& floor = s.floor();
  Part& ball = s.reporting(s.add_single_part(sphere_model(0.1), 2, {{0.3, 0.4, 0.1}, quat_identity()}));
  s.ticks(60);
  const ContactPoints& points = s.world.sensing().contacts().points();
  ASSERT_EQ(points.of(ball.id()).size(), 1u);
  EXPECT_TRUE(points.of(floor.id()).empty()) << "the floor doesn't report";
  const ContactPoint& point = points.list()[points.of(ball.id())[0].point];
  EXPECT_TRUE(point.a == floor.id() && point.b == ball.id());
  expect_vec_near(point.position, {0.3, 0.4, 0}, 1e-3);
  expect_vec_near(point.normal, {0, 0, -1}, 1e-6);
  EXPECT_NEAR(point.impulse, 2 * kEarthG * s.timestep(), 1e-4);
  EXPECT_NEAR(points.impulse_between(ball.id(), floor.id()), point.impulse, 1e-12);
}

TEST(ContactForces, ForceTimesTimeIsTheChangeOfMomentum) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  Part& wall = s.add_single_part(box_model({0.2, 4, 4}), 0, {{1, 0, 0}, quat_identity()});
  s.set(wall.id(), "restitution", {1});
  Part& box = s.reporting(s.add_single_part(box_model(Vec3(0.3)), 3));
  s.set(box.id(), "restitution", {0.5});
  s.set(box.id(), "linear_velocity", {4, 0, 0});
  double impulse = 0;
  for (int i = 0; i < 40; i++) {
    s.ticks(1);
    impulse += s.number(box.id(), "contact_normal_force") * s.timestep();
  }
  EXPECT_LT(box.linear_velocity().x, -1.5);
  EXPECT_NEAR(impulse, 3 * (4 - box.linear_velocity().x), 1e-3);
}

TEST(ContactForces, RemainWhileAsleepAndVanishWithTheReport) {
  SensorsFixture s;
  s.floor();
  Part& box = s.reporting(s.add_single_part(box_model(Vec3(0.2)), 2, {{0, 0, 0.1}, quat_identity()}));
  s.ticks(300);
  ASSERT_TRUE(box.asleep());
  EXPECT_NEAR(s.number(box.id(), "contact_normal_force"), 2 * kEarthG, 0.01);
  s.set(box.id(), "report_contacts", {0});
  s.ticks(1);
  EXPECT_EQ(s.number(box.id(), "contact_normal_force"), 0);
}

TEST(ContactEvents, StayAndEndFollowTheBegin) {
  SensorsFixture s;
  Part& floor = s.floor();
  Part& ball = s.reporting(s.add_single_part(sphere_model(0.1), 2, {{0, 0, 0.11}, quat_identity()}));
  int begins = 0;
  int stays = 0;
  double stay_impulse = 0;
  for (int i = 0; i < 60; i++) {
    s.ticks(1);
    begins += static_cast<int>(s.world.sensing().contacts().events(ContactPhase::begin).size());
    for (const ContactEvent& event : s.world.sensing().contacts().events(ContactPhase::stay)) {
      EXPECT_EQ(event.part, ball.id());
      EXPECT_EQ(event.other, floor.id());
      stay_impulse = event.impulse;
      stays++;
    }
    EXPECT_TRUE(s.world.sensing().contacts().events(ContactPhase::end).empty());
  }
  EXPECT_EQ(begins, 1);
  EXPECT_GT(stays, 50);
  EXPECT_NEAR(stay_impulse, 2 * kEarthG * s.timestep(), 1e-4);
  s.set(ball.id(), "linear_velocity", {0, 0, 5});
  int ends = 0;
  for (int i = 0; i < 20; i++) {
    s.ticks(1);
    ends += static_cast<int>(s.world.sensing().contacts().events(ContactPhase::end).size());
  }
  EXPECT_EQ(ends, 1);
}

// Joints.

struct WeldedBeam : SensorsFixture {
  explicit WeldedBeam(const Vec3& axis = {0, 0, 1})
      : robot(body("robot")),
        base(part(robot, box_model(Vec3(0.1)), 0)),
        beam(part(robot, box_model({1, 0.1, 0.1}), 10, {{0.5, 0, 0}, quat_identity()})),
        weld(*robot.add_joint("weld", base, beam, model::JointType::fixed, {0, 0, 0}, axis).value()) {
    ticks(60);
  }
  Vec3 in_world(const char* property) {
    const std::vector<double> q = get(weld.id(), "rotation");
    return quat_at(q.data()) * vec(weld.id(), property);
  }
  Body& robot;
  Part& base;
  Part& beam;
  Joint& weld;
};

TEST(JointReaction, OfAWeldedBeamIsItsWeightAndMoment) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, -3)}) {
    WeldedBeam s(axis);
    expect_vec_near(s.in_world("reaction_force"), {0, 0, 10 * kEarthG}, 1e-4 * 10 * kEarthG);
    expect_vec_near(s.in_world("reaction_torque"), {0, -5 * kEarthG, 0}, 1e-4 * 5 * kEarthG);
  }
}

TEST(JointReaction, IsWithinFivePercentWithTheIterativeSolver) {
  WeldedBeam s;
  s.solver(0);
  s.ticks(60);
  expect_vec_near(s.in_world("reaction_force"), {0, 0, 10 * kEarthG}, 0.05 * 10 * kEarthG);
  expect_vec_near(s.in_world("reaction_torque"), {0, -5 * kEarthG, 0}, 0.05 * 5 * kEarthG);
}

TEST(JointReaction, IncludesTheLoadOfATick) {
  WeldedBeam s;
  s.beam.apply_force({3, -4, 5});
  s.beam.apply_torque({1, 2, 3});
  s.ticks(1);
  expect_vec_near(s.in_world("reaction_force"), {-3, 4, 10 * kEarthG - 5}, 0.01);
  // moment of the load about the joint: (0.5, 0, 0) x (3, -4, 5) = (0, -2.5, -2)
  expect_vec_near(s.in_world("reaction_torque"), {-1, -2 + 2.5 - 5 * kEarthG, -3 + 2}, 0.01);
}

TEST(JointReaction, OfAnElbowIsThatOfAllPartsBehindIt) {
  SensorsFixture s;
  Body& robot = s.body("robot");
  Part& base = s.part(robot, box_model(Vec3(0.1)), 0);
  Part& upper = s.part(robot, box_model({1, 0.1, 0.1}), 4, {{0.5, 0, 0}, quat_identity()});
  Part& lower = s.part(robot, box_model({1, 0.1, 0.1}), 2, {{1.5, 0, 0}, quat_identity()});
  Joint& shoulder = *robot.add_joint("shoulder", base, upper, model::JointType::revolute, {0, 0, 0}, {0, 1, 0}).value();
  Joint& elbow = *robot.add_joint("elbow", upper, lower, model::JointType::revolute, {1, 0, 0}, {0, 1, 0}).value();
  for (Joint* joint : {&shoulder, &elbow}) ASSERT_TRUE(robot.add_motor(*joint));
  s.ticks(120);
  EXPECT_NEAR(glm::length(s.vec(elbow.id(), "reaction_force")), 2 * kEarthG, 1e-3);
  EXPECT_NEAR(glm::length(s.vec(shoulder.id(), "reaction_force")), 6 * kEarthG, 1e-3);
  // the own axis bears the motor's torque
  EXPECT_NEAR(s.vec(elbow.id(), "reaction_torque").z, -1 * kEarthG, 1e-3);
  EXPECT_NEAR(s.vec(shoulder.id(), "reaction_torque").z, -(0.5 * 4 + 1.5 * 2) * kEarthG, 1e-3);
  EXPECT_NEAR(s.vec(shoulder.id(), "reaction_torque").z, s.vec(shoulder.motor()->id(), "applied_torque").z, 1e-3);
}

TEST(JointReaction, OfARotorIsCentripetal) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  Body& robot = s.body("robot");
  Part& base = s.part(robot, box_model(Vec3(0.1)), 0);
  Part& arm = s.part(robot, sphere_model(0.1), 3, {{0.5, 0, 0}, quat_identity()});
  Joint& hinge = *robot.add_joint("hinge", base, arm, model::JointType::revolute, {0, 0, 0}, {0, 0, 1}).value();
  s.set(arm.id(), "linear_velocity", {0, 1, 0});
  s.set(arm.id(), "angular_velocity", {0, 0, 2});
  s.ticks(10);
  for (int i = 0; i < 30; i++) {
    const Vec3 before = arm.center();
    s.ticks(1);
    // in a substep the force acts in the pose at its start
    const Vec3 outward = quat_axis({0, 0, 1}, -2 * s.h() / 2) * normalized(before + arm.center());
    expect_vec_near(s.vec(hinge.id(), "reaction_force"), -3 * 0.5 * 4 * outward, 0.005);
    expect_vec_near(s.vec(hinge.id(), "reaction_torque"), {0, 0, 0}, 1e-3);
  }
}

TEST(JointReaction, OfATeleportedBodyStartsAtZero) {
  WeldedBeam s;
  s.robot.set_pose({{0, 0, 3}, quat_identity()});
  s.world.flush();
  EXPECT_EQ(s.vec(s.weld.id(), "reaction_force"), Vec3(0));
  s.set(s.robot.id(), "enabled", {0});
  s.ticks(1);
  EXPECT_EQ(s.vec(s.weld.id(), "reaction_force"), Vec3(0));
}

// IMU.

TEST(Imu, AtRestReadsGravityUpwards) {
  SensorsFixture s;
  s.floor();
  const Quat tilt = quat_axis({1, 0, 0}, kPi / 2);
  Part& box = s.add_single_part(box_model(Vec3(0.2)), 2, {{0, 0, 0.1}, tilt});
  Part& wall = s.add_single_part(box_model(Vec3(0.2)), 0, {{2, 0, 0}, tilt});
  Sensor& on_box = s.sensor(box, SensorKind::imu);
  Sensor& on_wall = s.sensor(wall, SensorKind::imu);
  Sensor& turned = s.sensor(wall, SensorKind::imu, "turned");
  s.set(turned.id(), "rotation", {0, 0, std::sin(kPi / 4), std::cos(kPi / 4)});
  s.ticks(240);
  // the link's y points up
  expect_vec_near(s.vec(on_box.id(), "specific_force"), {0, kEarthG, 0}, 1e-3);
  expect_vec_near(s.vec(on_box.id(), "angular_velocity"), {0, 0, 0}, 1e-3);
  expect_vec_near(s.vec(on_wall.id(), "specific_force"), {0, kEarthG, 0}, 1e-6);
  expect_vec_near(s.vec(turned.id(), "specific_force"), {kEarthG, 0, 0}, 1e-6);
}

TEST(Imu, InFreeFallReadsZero) {
  SensorsFixture s;
  Part& box = s.add_single_part(box_model({0.1, 0.2, 0.4}), 2);
  Sensor& imu = s.sensor(box, SensorKind::imu);
  s.set(box.id(), "angular_velocity", {1, 2, 3});
  for (int i = 0; i < 60; i++) {
    s.ticks(1);
    expect_vec_near(s.vec(imu.id(), "specific_force"), {0, 0, 0}, 1e-3);
    expect_vec_near(box.pose().rotation * s.vec(imu.id(), "angular_velocity"), box.angular_velocity(), 1e-5);
  }
}

TEST(Imu, ReadsForcePerMassInItsOwnAxes) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  const Quat turn = quat_axis(normalized(Vec3(1, 2, 3)), 0.7);
  Part& ball = s.add_single_part(sphere_model(0.1), 2, {{0, 0, 0}, turn});
  Sensor& imu = s.sensor(ball, SensorKind::imu);
  ball.apply_force({6, 0, -2});
  s.ticks(1);
  expect_vec_near(turn * s.vec(imu.id(), "specific_force"), {3, 0, -1}, 1e-4);
  // an impulse acts at once: its mean over the tick
  ball.apply_impulse({0, 0.5, 0});
  s.ticks(1);
  expect_vec_near(turn * s.vec(imu.id(), "specific_force"), Vec3(0, 0.25, 0) / s.timestep(), 1e-3);
  s.ticks(1);
  expect_vec_near(s.vec(imu.id(), "specific_force"), {0, 0, 0}, 1e-4);
}

TEST(Imu, OffTheCenterReadsTheAccelerationOfItsPlace) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  Part& ball = s.add_single_part(sphere_model(0.1), 2);
  Sensor& imu = s.sensor(ball, SensorKind::imu);
  s.set(imu.id(), "position", {0.5, 0, 0});
  s.set(ball.id(), "angular_velocity", {0, 0, 8});
  s.ticks(20);
  expect_vec_near(s.vec(imu.id(), "specific_force"), {-64 * 0.5, 0, 0}, 1e-3);
  expect_vec_near(s.vec(imu.id(), "angular_velocity"), {0, 0, 8}, 1e-5);
  const double inertia = 0.4 * 2 * 0.01;
  ball.apply_torque({0, 0, 30 * inertia});
  const double before = ball.angular_velocity().z;
  s.ticks(1);
  const double mean_square = before * before + before * 30 * s.timestep() + 300 * s.timestep() * s.timestep();
  expect_vec_near(s.vec(imu.id(), "specific_force"), {-0.5 * mean_square, 0.5 * 30, 0}, 0.01);
}

TEST(Imu, OnATurntableReadsTheCentripetalAcceleration) {
  SensorsFixture s;
  Body& robot = s.body("robot");
  Part& base = s.part(robot, box_model(Vec3(0.1)), 0);
  Part& disc = s.part(robot, round_model(model::ShapeKind::cylinder, 1, 0.1), 5);
  Joint& hinge = *robot.add_joint("hinge", base, disc, model::JointType::revolute, {0, 0, 0}, {0, 0, 1}).value();
  Motor& motor = *robot.add_motor(hinge).value();
  s.set(motor.id(), "mode", {1});
  s.set_one(motor.id(), "angular_velocity", 2, 5);
  Sensor& imu = s.sensor(disc, SensorKind::imu);
  s.set(imu.id(), "position", {0, 0.8, 0});
  s.ticks(60);
  expect_vec_near(s.vec(imu.id(), "specific_force"), {0, -25 * 0.8, kEarthG}, 1e-3);
}

// Zones and touch.

TEST(Zone, ReportsPartsThatEnterAndLeave) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  Part& post = s.add_single_part(sphere_model(0.1), 0);
  Sensor& zone = s.sensor(post, SensorKind::zone);
  s.set(zone.id(), "position", {0, 0, 1});
  s.set(zone.id(), "radius", {0.5});
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{-1.2, 0, 1}, quat_identity()});
  s.set(ball.id(), "linear_velocity", {1, 0, 0});
  int entered = 0;
  int left = 0;
  for (int i = 1; i <= 150; i++) {
    s.ticks(1);
    const double center = std::fabs(ball.pose().position.x);
    const bool inside = center - 0.1 <= 0.5;
    EXPECT_EQ(s.number(zone.id(), "count"), inside ? 1 : 0) << i;
    EXPECT_NEAR(s.number(zone.id(), "distance"), inside ? std::max(center - 0.1, 0.0) : 0.5, 1e-6);
    EXPECT_EQ(zone.other(), inside ? ball.id() : NodeId{});
    for (const ZoneEvent& event : s.world.sensing().zone_events(true)) {
      EXPECT_EQ(event.zone, zone.id());
      EXPECT_EQ(event.part, ball.id());
      EXPECT_NEAR(ball.pose().position.x, -0.6, 1.0 / 60);
      entered++;
    }
    for (const ZoneEvent& event : s.world.sensing().zone_events(false)) {
      EXPECT_EQ(event.part, ball.id());
      EXPECT_NEAR(ball.pose().position.x, 0.6, 1.1 / 60);
      left++;
    }
  }
  EXPECT_EQ(entered, 1);
  EXPECT_EQ(left, 1);
}

TEST(Touch, MeasuresTheForceInItsRegion) {
  SensorsFixture s;
  s.floor();
  Body& table = s.body("table");
  Part& plank = s.part(table, box_model({2, 0.2, 0.1}), 6, {{0, 0, 0.05}, quat_identity()});
  Sensor& whole = s.sensor(plank, SensorKind::touch, "whole");
  Sensor& left = s.sensor(plank, SensorKind::touch, "left");
  s.set(left.id(), "position", {-1, 0, -0.05});
  s.set(left.id(), "radius", {0.5});
  s.ticks(120);
  EXPECT_EQ(s.number(plank.id(), "report_contacts"), 1);
  EXPECT_NEAR(s.number(whole.id(), "force"), 6 * kEarthG, 0.01);
  EXPECT_NEAR(s.number(left.id(), "force"), 3 * kEarthG, 0.01);
  EXPECT_EQ(s.number(left.id(), "count"), 2);
}

// Momentum and energy.

TEST(Momentum, OfABodyIsTheSumOfItsParts) {
  SensorsFixture s;
  Body& pair = s.body("pair");
  Part& a = s.part(pair, sphere_model(0.1), 2, {{0, 0, 1}, quat_identity()});
  Part& b = s.part(pair, sphere_model(0.1), 3, {{1, 0, 1}, quat_identity()});
  s.part(pair, sphere_model(0.1), 0, {{5, 5, 5}, quat_identity()});
  s.set(a.id(), "linear_velocity", {0, 3, 0});
  s.set(b.id(), "linear_velocity", {0, -2, 0});
  s.set(b.id(), "angular_velocity", {0, 0, 10});
  s.world.flush();
  const double spin = 0.4 * 3 * 0.01 * 10;
  EXPECT_NEAR(s.number(pair.id(), "mass"), 5, 1e-6);
  expect_vec_near(s.vec(pair.id(), "center_of_mass"), {0.6, 0, 1}, 1e-6);
  expect_vec_near(s.vec(pair.id(), "momentum"), {0, 0, 0}, 1e-6);
  expect_vec_near(s.vec(pair.id(), "angular_momentum"), {0, 0, -6 + spin}, 1e-6);
  EXPECT_NEAR(s.number(pair.id(), "kinetic_energy"), 9 + 6 + 0.5 * spin * 10, 1e-5);
  EXPECT_NEAR(s.number(pair.id(), "potential_energy"), 5 * kEarthG, 1e-4);
  expect_vec_near(s.vec(s.world.id(), "momentum"), {0, 0, 0}, 1e-6);
  expect_vec_near(s.vec(s.world.id(), "angular_momentum"), {0, 0, -6 + spin}, 1e-6);
  EXPECT_NEAR(s.number(s.world.id(), "kinetic_energy"), 15 + 0.5 * spin * 10, 1e-5);
  EXPECT_NEAR(s.number(s.world.id(), "potential_energy"), 5 * kEarthG, 1e-4);
  s.set(pair.id(), "enabled", {0});
  s.world.flush();
  EXPECT_EQ(s.number(s.world.id(), "kinetic_energy"), 0);
}

TEST(Momentum, IsThatOfATumblingBox) {
  SensorsFixture s;
  s.gravity({0, 0, 0});
  const Vec3 size(0.2, 0.4, 0.6);
  const Quat turn = quat_axis(normalized(Vec3(1, -2, 3)), 0.9);
  Part& box = s.add_single_part(box_model(size), 3, {{1, 2, 3}, turn});
  const Vec3 spin(4, 5, -6);
  const Vec3 world_spin = turn * spin;
  s.set(box.id(), "angular_velocity", {world_spin.x, world_spin.y, world_spin.z});
  s.world.flush();
  const Vec3 expected = turn * (box_inertia(3, size) * spin);
  expect_vec_near(s.vec(box.body().id(), "angular_momentum"), expected, 1e-5);
  EXPECT_NEAR(s.number(box.body().id(), "kinetic_energy"), 0.5 * glm::dot(world_spin, expected), 1e-5);
  s.ticks(120);
  expect_vec_near(s.vec(box.body().id(), "angular_momentum"), expected, 1e-3);
}

}  // namespace
}  // namespace limber::sim
