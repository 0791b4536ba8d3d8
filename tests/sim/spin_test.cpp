// Fast rotation: driven rotors reach their speed, free bodies rotate by Euler's equations, a spinning top keeps its
// height, and clamping is reported.
#include "sim/bullet/rotation_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/threads/thread_pool.h"
#include "sim/stage.h"

namespace limber::sim::test {
namespace {

constexpr double kStandardGravity = 9.81;

/// A part on a revolute joint to another one, driven by a spin motor.
struct Rotor : WorldFixture {
  Rotor(double speed, double solver, const model::ShapeModel& model, double mass, const Vec3& at = Vec3(0))
      : robot(body("robot")),
        base(part(robot, box_model(Vec3(0.1)), 0, {{0, 0, -0.3}, quat_identity()})),
        rotor(part(robot, model, mass, {at, quat_identity()})),
        joint(*robot.add_joint("joint", base, rotor, model::JointType::continuous, Vec3(0), Vec3(0, 0, 1)).value()),
        motor(*robot.add_motor(joint).value()) {
    set(world.id(), "solver", {solver});
    set(motor.id(), "mode", {1});
    set(motor.id(), "speed", {speed});
  }
  double value() const { return number(joint.id(), "value"); }

  Body& robot;
  Part& base;
  Part& rotor;
  Joint& joint;
  Motor& motor;
};

TEST(Spin, DrivenRotorReachesItsSpeed) {
  for (const double solver : {0.0, 1.0}) {
    for (const int substeps : {1, 4}) {
      for (const double speed : {50.0, 150.0, -188.0, 200.0, 300.0, -500.0, 1000.0}) {
        Rotor s(speed, solver, round_model(model::ShapeKind::cylinder, 0.05, 0.02), 0.2);
        s.substeps(substeps);
        s.ticks(2);
        const double begin = s.value();
        s.ticks(60);
        EXPECT_NEAR(s.value() - begin, speed, 1e-3 * std::fabs(speed)) << solver << " " << substeps;
        EXPECT_NEAR(s.number(s.joint.id(), "speed"), speed, 1e-3 * std::fabs(speed)) << solver << " " << substeps;
        EXPECT_NEAR(s.vec(s.rotor.id(), "angular_velocity").z, speed, 1e-3 * std::fabs(speed));
        EXPECT_LT(std::fabs(s.vec(s.motor.id(), "applied_torque").z), 1e-3);
        EXPECT_EQ(s.number(s.rotor.id(), "rotation_clamped"), 0);
        EXPECT_EQ(s.world.stability().events(), 0u);
        EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
      }
    }
  }
}

/// A disc on a ball joint, its axis tilted up by `tilt`, in steady precession at spin `w`.
struct Top : WorldFixture {
  static constexpr double kRadius = 0.1, kHeight = 0.02, kArm = 0.2;

  Top(double w, double tilt, double solver)
      : robot(body("top")),
        base(part(robot, box_model(Vec3(0.02)), 0)),
        axis(std::cos(tilt), 0, std::sin(tilt)),
        disc(part(robot, round_model(model::ShapeKind::cylinder, kRadius, kHeight), 1,
                  {axis * kArm, quat_axis(Vec3(0, 1, 0), kPi / 2 - tilt)})),
        joint(*robot.add_joint("joint", base, disc, model::JointType::spherical, Vec3(0), Vec3(0, 0, 1)).value()) {
    set(world.id(), "solver", {solver});
    gravity({0, 0, -kStandardGravity});
    const Vec3 inertia = vec(disc.id(), "inertia");
    along = inertia.z;
    across = inertia.x + kArm * kArm;
    rate = precession(w, std::sin(tilt));
    // w is the total spin of the part about its own axis
    const Vec3 spin = axis * (w - rate * axis.z) + Vec3(0, 0, rate);
    const Vec3 velocity = glm::cross(spin, axis * kArm);
    set(disc.id(), "angular_velocity", {spin.x, spin.y, spin.z});
    set(disc.id(), "linear_velocity", {velocity.x, velocity.y, velocity.z});
  }
  // Rate W of steady precession, for a total spin w about the axis and c, the cosine of the angle to the vertical:
  // across·c·W² - along·w·W + m·g·arm = 0, with m = 1.
  double precession(double w, double c) const {
    const double torque = kStandardGravity * kArm;
    if (std::fabs(c) < 1e-9) return torque / (along * w);
    const double root = std::sqrt(along * w * along * w - 4 * across * c * torque);
    return (along * w - root) / (2 * across * c);
  }
  double energy() const {
    const Vec3 v = disc.linear_velocity();
    const Vec3 local = glm::conjugate(disc.principal_axes()) * disc.angular_velocity();
    const Vec3 inertia = vec(disc.id(), "inertia");
    return glm::dot(v, v) / 2 + glm::dot(inertia * local, local) / 2 + kStandardGravity * disc.center().z;
  }

  Body& robot;
  Part& base;
  Vec3 axis;
  Part& disc;
  Joint& joint;
  double along = 0, across = 0, rate = 0;
};

TEST(Spin, TopKeepsItsHeight) {
  for (const double tilt : {0.0, 0.5}) {
    for (const double w : {60.0, 100.0, 150.0, 180.0, 400.0, 1000.0}) {
      if (tilt > 0 && w < 90) continue;  // it would require 87 rad/s
      Top s(w, tilt, 1);
      const double start = s.disc.center().z;
      const double energy = s.energy();
      double turned = 0;
      double lowest = start, highest = start, gap = 0;
      double before = 0;
      for (int tick = 0; tick < 600; tick++) {
        s.ticks(1);
        const Vec3 at = s.disc.center();
        lowest = std::min(lowest, at.z);
        highest = std::max(highest, at.z);
        gap = std::max(gap, glm::length(s.vec(s.joint.id(), "offsets")));
        const double angle = std::atan2(at.y, at.x);
        turned += std::remainder(angle - before, 2 * kPi);
        before = angle;
      }
      EXPECT_NEAR(lowest, start, 0.01) << w;
      EXPECT_NEAR(highest, start, 0.01) << w;
      EXPECT_NEAR(turned / 10, s.rate, 0.01 * s.rate) << w;
      EXPECT_LT(gap, 1e-3);
      EXPECT_NEAR(s.energy(), energy, 0.01 + 1e-5 * energy) << w;
      EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
    }
  }
}

// Lagrange's top: angle from the vertical, its rate, and the azimuth, in small steps of the fourth-order Runge-Kutta
// method.
TEST(Spin, NutatingTopFollowsRungeKutta) {
  for (const double w : {80.0, 150.0, 600.0}) {
    Top s(w, 0.2, 1);
    s.set(s.disc.id(), "angular_velocity", {s.axis.x * w, s.axis.y * w, s.axis.z * w});
    s.set(s.disc.id(), "linear_velocity", {0, 0, 0});
    const double spin = s.along * w;
    const double up = spin * s.axis.z;  // momentum about the vertical
    using State = Vec3;                 // angle, rate, azimuth
    const auto rate = [&](const State& x) {
      const double sine = std::sin(x[0]);
      const double turn = (up - spin * std::cos(x[0])) / (s.across * sine * sine);
      const double pull = s.across * turn * turn * std::cos(x[0]) - spin * turn + kStandardGravity * Top::kArm;
      return State(x[1], sine * pull / s.across, turn);
    };
    State x(std::acos(s.axis.z), 0, 0);
    double worst = 0;
    for (int tick = 0; tick < 120; tick++) {
      s.ticks(1);
      constexpr int kParts = 100;
      for (int i = 0; i < kParts; i++) {
        const double h = 1.0 / 60 / kParts;
        const State a = rate(x);
        const State b = rate(x + a * (h / 2));
        const State c = rate(x + b * (h / 2));
        const State d = rate(x + c * h);
        x += (a + 2.0 * b + 2.0 * c + d) * (h / 6);
      }
      const Vec3 at =
          Top::kArm * Vec3(std::sin(x[0]) * std::cos(x[2]), std::sin(x[0]) * std::sin(x[2]), std::cos(x[0]));
      worst = std::max(worst, glm::length(s.disc.center() - at));
    }
    EXPECT_LT(worst, 0.005) << w;
  }
}

struct FreeBody : WorldFixture {
  FreeBody(const model::ShapeModel& model, const Vec3& w)
      : part(add_single_part(model, 1, {{0, 0, 1}, quat_identity()})) {
    set(part.id(), "angular_velocity", {w.x, w.y, w.z});
  }
  Vec3 local() const { return glm::conjugate(part.principal_axes()) * part.angular_velocity(); }
  double energy() const { return glm::dot(vec(part.id(), "inertia") * local(), local()) / 2; }
  Vec3 momentum() const { return part.principal_axes() * (vec(part.id(), "inertia") * local()); }

  Part& part;
};

TEST(Spin, FreeBodySpinsAboutAPrincipalAxis) {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    for (const double w : {50.0, 300.0, -1000.0, 3000.0}) {
      FreeBody s(box_model({0.1, 0.2, 0.05}), axis * w);
      const bool stable = axis.x == 0;
      const int ticks = stable ? 60 : 1;
      s.ticks(ticks);
      const Quat expected = quat_axis(axis, w * ticks / 60);
      const double off = 2 * std::acos(std::min(1.0, std::fabs(glm::dot(expected, s.part.pose().rotation))));
      EXPECT_LT(off, 2e-3 + 1e-6 * std::fabs(w)) << w << " " << axis.x << axis.y << axis.z;
      EXPECT_NEAR(glm::dot(s.part.angular_velocity(), axis), w, 1e-4 * std::fabs(w));
      EXPECT_EQ(s.world.stability().events(), 0u);
    }
  }
}

TEST(Spin, TumblingBodyConservesEnergyAndMomentum) {
  for (const Vec3& w :
       {Vec3(3, 0.3, 0.2), Vec3(8, 0.2, 0.1), Vec3(-5, 20, 7), Vec3(200, 30, -90), Vec3(400, 300, 500)}) {
    FreeBody s(box_model({0.1, 0.2, 0.05}), w);
    const double energy = s.energy();
    const Vec3 momentum = s.momentum();
    double worst_energy = 0, worst_momentum = 0;
    for (int tick = 0; tick < 600; tick++) {
      s.ticks(1);
      worst_energy = std::max(worst_energy, std::fabs(s.energy() / energy - 1));
      worst_momentum = std::max(worst_momentum, glm::length(s.momentum() - momentum) / glm::length(momentum));
    }
    EXPECT_LT(worst_energy, 1e-3);
    EXPECT_LT(worst_momentum, glm::length(w) > 5 ? 1e-3 : 0.02);
    EXPECT_EQ(s.number(s.part.id(), "rotation_clamped"), 0);
  }
}

// A floating platform with a driven rotor: its slow rotation across the rotor's axis precesses by the rotor's momentum,
// and the total momentum is conserved.
TEST(Spin, PlatformWithARotorPrecesses) {
  for (const double w : {100.0, 400.0, 1000.0}) {
    WorldFixture s;
    Body& robot = s.body("robot");
    Part& platform = s.part(robot, box_model(Vec3(0.2)), 2);
    Part& rotor =
        s.part(robot, round_model(model::ShapeKind::cylinder, 0.05, 0.02), 0.2, {{0, 0, 0.2}, quat_identity()});
    Joint& joint =
        *robot.add_joint("joint", platform, rotor, model::JointType::continuous, Vec3(0, 0, 0.2), Vec3(0, 0, 1))
             .value();
    Motor& motor = *robot.add_motor(joint).value();
    s.set(motor.id(), "mode", {1});
    s.set(motor.id(), "speed", {w});
    s.set(rotor.id(), "angular_velocity", {1, 0, w});
    const Vec3 middle(0, 0, 0.2 * 0.2 / 2.2);
    const auto at_rate = [&](Part& part) {
      const Vec3 v = glm::cross(Vec3(1, 0, 0), part.center() - middle);
      s.set(part.id(), "linear_velocity", {v.x, v.y, v.z});
    };
    s.set(platform.id(), "angular_velocity", {1, 0, 0});
    at_rate(platform);
    at_rate(rotor);
    const Vec3 i_platform = s.vec(platform.id(), "inertia");
    const Vec3 i_rotor = s.vec(rotor.id(), "inertia");
    const double reduced = 2 * 0.2 / 2.2;
    const double across = i_platform.x + i_rotor.x + reduced * 0.2 * 0.2;
    const auto momentum = [&] {
      Vec3 sum(0);
      for (Part* part : {&platform, &rotor}) {
        const Vec3 local = glm::conjugate(part->principal_axes()) * part->angular_velocity();
        sum += part->principal_axes() * (s.vec(part->id(), "inertia") * local);
        sum += part->mass() * glm::cross(part->center(), part->linear_velocity());
      }
      return sum;
    };
    const Vec3 before = momentum();
    double turned = 0, angle = 0, min_value = 9, max_value = 0;
    for (int tick = 0; tick < 120; tick++) {
      s.ticks(1);
      const Vec3 local = glm::conjugate(platform.pose().rotation) * platform.angular_velocity();
      const double now = std::atan2(local.y, local.x);
      turned += std::remainder(now - angle, 2 * kPi);
      angle = now;
      min_value = std::min(min_value, std::hypot(local.x, local.y));
      max_value = std::max(max_value, std::hypot(local.x, local.y));
    }
    const double expected = i_rotor.z * w / across;  // in the platform, which doesn't rotate about z
    EXPECT_NEAR(turned / 2, expected, 0.02 * expected);
    EXPECT_NEAR(min_value, 1, 0.03);
    EXPECT_NEAR(max_value, 1, 0.03);
    EXPECT_LT(glm::length(momentum() - before), 0.01 * glm::length(before));
    EXPECT_NEAR(s.number(joint.id(), "speed"), w, 1e-3 * w);
  }
}

TEST(Spin, UnbalancedBladeReachesItsSpeed) {
  for (const double solver : {0.0, 1.0}) {
    for (const double speed : {100.0, 400.0, 1000.0}) {
      Rotor s(speed, solver, box_model({0.3, 0.02, 0.02}), 0.05, {0.15, 0, 0});
      s.ticks(2);
      const double begin = s.value();
      double gap = 0;
      for (int tick = 0; tick < 60; tick++) {
        s.ticks(1);
        gap = std::max(gap, glm::length(s.vec(s.joint.id(), "offsets")));
      }
      EXPECT_NEAR(s.value() - begin, speed, 1e-3 * speed) << solver;
      EXPECT_LT(gap, solver == 0 && speed < 200 ? 0.05 : 1e-4);
      EXPECT_EQ(s.world.stability().events(), 0u);
    }
  }
}

TEST(Spin, LimitsAndServosHoldAtSpeed) {
  Rotor s(1000, 1, round_model(model::ShapeKind::cylinder, 0.05, 0.02), 0.2);
  s.set(s.joint.id(), "angular_lower_limit", {0, 0, -200});
  s.set(s.joint.id(), "angular_upper_limit", {0, 0, 200});
  double max_value = 0;
  for (int tick = 0; tick < 60; tick++) {
    s.ticks(1);
    max_value = std::max(max_value, s.value());
  }
  EXPECT_NEAR(max_value, 200, 0.01);
  EXPECT_NEAR(s.value(), 200, 0.01);
  s.set(s.motor.id(), "mode", {2});
  s.set(s.motor.id(), "target", {-150});
  s.ticks(1);
  const double begin = s.value();
  s.ticks(6);
  EXPECT_NEAR(begin - s.value(), 100, 0.5);
  s.ticks(30);
  EXPECT_NEAR(s.value(), -150, 0.01);
}

// Two jointed parts that rotate quickly in opposite directions are clamped, which is reported once.
TEST(Spin, ReportsTheClamp) {
  WorldFixture s;
  Body& chain = s.body("chain");
  Part& a = s.part(chain, box_model({0.2, 0.05, 0.05}), 1);
  Part& b = s.part(chain, box_model({0.2, 0.05, 0.05}), 1, {{0.2, 0, 0}, quat_identity()});
  Joint& joint = *chain.add_joint("joint", a, b, model::JointType::continuous, Vec3(0.1, 0, 0), Vec3(0, 0, 1)).value();
  s.set(a.id(), "angular_velocity", {0, 0, -400});
  s.set(b.id(), "angular_velocity", {0, 0, 400});
  s.set(a.id(), "linear_velocity", {0, 40, 0});
  s.set(b.id(), "linear_velocity", {0, 40, 0});
  const std::uint64_t begin = log_newest();
  s.ticks(1);
  EXPECT_NEAR(s.number(a.id(), "rotation_clamped"), 400 - kPi / 4 * 240, 10);
  s.ticks(10);
  int warnings = 0;
  for (const LogLine& line : log_since(begin)) {
    if (line.text.find("since it exceeds 45 degrees per substep") == std::string::npos) continue;
    EXPECT_NE(line.text.find("about 9 substeps would allow it"), std::string::npos) << line.text;
    warnings++;
  }
  EXPECT_EQ(warnings, 1);
  s.ticks(120);
  EXPECT_EQ(s.number(a.id(), "rotation_clamped"), 0);
  EXPECT_LT(glm::length(s.vec(joint.id(), "offsets")), 0.001);
}

// Far from its base, from rest, and hit from the side: errors of the joint's locks must not grow with the spin.
TEST(Spin, RotorOnALightBaseKeepsItsJointClosed) {
  for (const double speed : {100.0, 300.0, 1000.0}) {
    WorldFixture s;
    Body& robot = s.body("robot");
    Part& base = s.part(robot, box_model(Vec3(0.15)), 1);
    const Pose at{Vec3(0.3, 0, 0), quat_axis(Vec3(0, 1, 0), kPi / 2)};
    Part& rotor = s.part(robot, round_model(model::ShapeKind::cylinder, 0.05, 0.02), 0.2, at);
    Joint& joint = *robot.add_joint("joint", base, rotor, model::JointType::continuous, Vec3(0), Vec3(1, 0, 0)).value();
    Motor& motor = *robot.add_motor(joint).value();
    motor.set_mode(MotorMode::spin);
    s.set(motor.id(), "speed", {speed});
    s.set(rotor.id(), "angular_velocity", {0, 5, 0});
    s.ticks(60);
    EXPECT_LT(glm::length(s.vec(joint.id(), "offsets")), 1e-4) << speed;
    EXPECT_NEAR(s.number(joint.id(), "speed"), speed, 1e-3 * speed);
    EXPECT_LT(std::hypot(base.angular_velocity().y, base.angular_velocity().z), 5) << speed;
    EXPECT_EQ(s.world.stability().events(), 0u);
    EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
  }
}

// The state is identical to the bit for any number of threads.
TEST(Spin, DoesNotDependOnThreads) {
  const auto hash = [](int threads) {
    log_to_stderr(false);
    Store store;
    WorldSetup setup;
    if (threads > 1) setup.thread_pool = std::make_shared<ThreadPool>(threads);
    World world(store, setup);
    Shape& disc = *world.shapes().add("disc", round_model(model::ShapeKind::cylinder, 0.05, 0.02)).value();
    Shape& box = *world.shapes().add("box", box_model({0.1, 0.2, 0.05})).value();
    for (int i = 0; i < 40; i++) {
      const Vec3 at(i, 0, 0);
      Body& body = *world.add_body("body" + std::to_string(i)).value();
      Part& base = *body.add_part("base", box, i % 2 == 0 ? 0 : 1, {at, quat_identity()}).value();
      Part& rotor =
          *body.add_part("rotor", disc, 0.2, {at + Vec3(0.3, 0, 0), quat_axis(Vec3(0, 1, 0), kPi / 2)}).value();
      const model::JointType type = i % 4 < 2 ? model::JointType::spherical : model::JointType::continuous;
      Joint& joint = *body.add_joint("joint", base, rotor, type, at, Vec3(1, 0, 0)).value();
      if (type == model::JointType::continuous) {
        Motor& motor = *body.add_motor(joint).value();
        motor.set_mode(MotorMode::spin);
        (void)store.set(motor.id(), Motor::table().at("speed"), std::vector<double>{40.0 * i});
      }
      rotor.set_velocity(Vec3(0), Vec3(25 * i, 1, 0));
      Part& free = *body.add_part("free", box, 1, {at + Vec3(0, 5, 0), quat_identity()}).value();
      free.set_velocity(Vec3(0), Vec3(3 * i, 10 * i, i));
    }
    for (int tick = 0; tick < 30; tick++) world.step();
    EXPECT_EQ(world.stability().events(), 0u) << log_since(0).back().text;
    log_to_stderr(true);
    return world.state_hash();
  };
  const std::uint64_t alone = hash(1);
  EXPECT_EQ(hash(2), alone);
  EXPECT_EQ(hash(3), alone);
}

// A velocity that is set may have any value; the number of substeps must not overflow (a sanitizer would report it).
TEST(FreeMotion, SupportsAnySpeed) {
  for (const double speed : {1e3, 1e9, 1e18, 1e30}) {
    Quat rotation = quat_identity();
    Vec3 w = Vec3(1, 0.5, -0.2) * speed;
    bullet::integrate_free_rotation(Vec3(1, 2, 3), rotation, w, 1.0 / 240);
    EXPECT_TRUE(is_finite(rotation)) << speed;
    EXPECT_NEAR(glm::length(rotation), 1, 1e-12) << speed;
    EXPECT_TRUE(is_finite(w)) << speed;
  }
}

}  // namespace
}  // namespace limber::sim::test
