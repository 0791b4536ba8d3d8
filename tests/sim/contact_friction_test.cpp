// Contact friction: isotropic friction in both solvers; rolling and spinning friction; anisotropic friction.
#include "sim/collision/contact_friction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/stage.h"

namespace limber::sim::friction_test {
namespace {

using namespace test;

constexpr double kG = 9.81;
constexpr int kHeadings = 12;

Vec3 direction(double heading) { return {std::cos(heading), std::sin(heading), 0}; }

enum class Kind { iterative, direct, joined };  // joined: locked to another part, in the direct solver
constexpr Kind kKinds[] = {Kind::iterative, Kind::direct, Kind::joined};

// A block on a plane.
struct SlidingBlock : WorldFixture {
  explicit SlidingBlock(Kind kind, double mu, const Vec3& g = {0, 0, -kG}) {
    set(world.id(), "solver", {kind == Kind::iterative ? 0.0 : 1.0});
    gravity(g);
    floor();
    Body& body_of_block = body("block");
    block = &part(body_of_block, box_model({0.4, 0.4, 0.1}), 1, {{0, 0, 0.05}, quat_identity()});
    set(block->id(), "friction", {mu});
    if (kind != Kind::joined) return;
    Part& attached = part(body_of_block, box_model({0.1, 0.1, 0.02}), 1, {{0, 0, 0.06}, quat_identity()});
    (void)body_of_block.add_joint("lock", *block, attached, model::JointType::fixed, {0, 0, 0.05}, {0, 0, 1}).value();
  }
  Part* block;
};

TEST(ContactFriction, SlidingFrictionIsIsotropic) {
  const double mu = 0.4;
  for (const Kind kind : kKinds) {
    for (int i = 0; i < kHeadings; i++) {
      const double heading = 2 * kPi * i / kHeadings;
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " heading " << heading);
      SlidingBlock s(kind, mu);
      for (const auto& part : s.block->body().parts()) part->set_velocity(3.0 * direction(heading), Vec3(0));
      s.ticks(30);
      const Vec3 v = s.block->linear_velocity();
      EXPECT_NEAR(glm::dot(v, direction(heading)), 3 - mu * kG * 0.5, 0.01);
      EXPECT_NEAR(glm::dot(v, direction(heading + kPi / 2)), 0, 0.01);
      EXPECT_NEAR(s.block->angular_velocity().z, 0, 0.01);
    }
  }
}

// A block rests on a slope of 0.98 times the friction limit and slides on one of 1.05 times, at every heading.
TEST(ContactFriction, StaticFrictionIsIsotropic) {
  const double mu = 0.5;
  for (const Kind kind : kKinds) {
    for (int i = 0; i < kHeadings; i++) {
      const double heading = 2 * kPi * i / kHeadings + 0.1;
      for (const double factor : {0.98, 1.05}) {
        SCOPED_TRACE(::testing::Message()
                     << "kind " << static_cast<int>(kind) << " heading " << heading << ' ' << factor);
        const double slope = std::atan(factor * mu);
        SlidingBlock s(kind, mu, kG * (std::sin(slope) * direction(heading) - Vec3(0, 0, std::cos(slope))));
        s.ticks(60);
        const double expected = factor < 1 ? 0 : kG * (std::sin(slope) - mu * std::cos(slope));
        EXPECT_NEAR(glm::dot(s.block->linear_velocity(), direction(heading)), expected, 0.02 * expected + 5e-3);
      }
    }
  }
}

// A sliding block has no static friction across the slip: moving across a slope on which it could rest, it turns
// downhill.
// Compared with the equation of motion, dv/dt = g·sin·down - mu·g·cos·v/|v|, in small steps.
TEST(ContactFriction, SlidingBlockTurnsDownhill) {
  const double mu = 0.5;
  const double slope = 0.3;
  for (const Kind kind : kKinds) {
    for (const double heading : {0.0, 0.7}) {
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " heading " << heading);
      const Vec3 down = direction(heading);
      const Vec3 across = direction(heading + kPi / 2);
      SlidingBlock s(kind, mu, kG * (std::sin(slope) * down - Vec3(0, 0, std::cos(slope))));
      for (const auto& part : s.block->body().parts()) part->set_velocity(4.0 * across, Vec3(0));
      Vec3 expected = 4.0 * across;
      for (int i = 0; i < 5000; i++) {
        expected += 1e-4 * (kG * std::sin(slope) * down - mu * kG * std::cos(slope) * glm::normalize(expected));
      }
      s.ticks(30);
      const Vec3 v = s.block->linear_velocity();
      EXPECT_NEAR(glm::dot(v, down), glm::dot(expected, down), 0.03);
      EXPECT_NEAR(glm::dot(v, across), glm::dot(expected, across), 0.03);
      EXPECT_GT(glm::dot(v, down), 0.5);
    }
  }
}

// A ball that rolls on a floor decelerates by mu·g/(1.4·r), straight at any heading; one on a slope within the limit of
// rolling friction (tan < mu/r) stays.
TEST(ContactFriction, RollingFrictionIsIsotropic) {
  const double r = 0.2;
  const double mu = 0.02;
  for (const Kind kind : {Kind::iterative, Kind::direct}) {
    for (int i = 0; i < kHeadings; i++) {
      const double heading = 2 * kPi * i / kHeadings + 0.1;
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " heading " << heading);
      WorldFixture s;
      s.set(s.world.id(), "solver", {kind == Kind::iterative ? 0.0 : 1.0});
      s.floor();
      s.gravity({0, 0, -kG});
      Part& ball = s.add_single_part(sphere_model(r), 100, {{0, 0, r}, quat_identity()});
      s.set(ball.id(), "friction", {1});
      s.set(ball.id(), "rolling_friction", {mu});
      const Vec3 ahead = direction(heading);
      ball.set_velocity(2.0 * ahead, glm::cross(Vec3(0, 0, 1), ahead) * (2 / r));
      s.ticks(60);
      EXPECT_NEAR(glm::dot(ball.linear_velocity(), ahead), 2 - mu * kG / (1.4 * r), 0.01);
      EXPECT_NEAR(glm::dot(ball.linear_velocity(), direction(heading + kPi / 2)), 0, 0.005);
      for (const double factor : {0.95, 1.1}) {
        ball.set_pose({{0, 0, r}, quat_identity()});
        ball.set_velocity(Vec3(0), Vec3(0));
        const double slope = std::atan(factor * mu / r);
        s.gravity(kG * (std::sin(slope) * ahead - Vec3(0, 0, std::cos(slope))));
        s.ticks(60);
        const double expected = factor < 1 ? 0 : kG * (std::sin(slope) - mu / r * std::cos(slope)) / 1.4;
        EXPECT_NEAR(glm::dot(ball.linear_velocity(), ahead), expected, 0.05 * expected + 1e-3) << factor;
      }
    }
  }
}

// A ball that spins in place: torque mu·m·g against I = 2/5·m·r².
TEST(ContactFriction, SpinningFrictionDeceleratesSpin) {
  const double r = 0.2;
  for (const double mu : {0.0, 0.005, 0.01}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -kG});
    Part& ball = s.add_single_part(sphere_model(r), 50, {{0, 0, r}, quat_identity()});
    s.set(ball.id(), "friction", {1});
    s.set(ball.id(), "spinning_friction", {mu});
    ball.set_velocity(Vec3(0), {0, 0, 20});
    s.ticks(60);
    EXPECT_NEAR(ball.angular_velocity().z, 20 - mu * kG / (0.4 * r * r), 0.1) << mu;
  }
}

// A sledge: little friction along its runners, full friction across; the direction rotates with it.
TEST(ContactFriction, AnisotropicFrictionIsWeakerAlongItsDirection) {
  const double mu = 0.5;
  for (const Kind kind : kKinds) {
    for (const double turned : {0.0, 0.6}) {
      for (const double angle : {0.0, kPi / 2}) {
        SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " turned " << turned << ' ' << angle);
        SlidingBlock s(kind, mu);
        s.set(s.block->id(), "friction_direction", {2, 0, 0});
        s.set(s.block->id(), "friction_factor", {0.1});
        for (const auto& part : s.block->body().parts()) {
          part->set_pose({part->pose().position, quat_axis({0, 0, 1}, turned)});
          part->set_velocity(3.0 * direction(turned + angle), Vec3(0));
        }
        s.ticks(30);
        const double strength = angle == 0 ? 0.1 * mu : mu;
        EXPECT_NEAR(glm::dot(s.block->linear_velocity(), direction(turned + angle)), 3 - strength * kG * 0.5, 0.02);
        EXPECT_NEAR(glm::dot(s.block->linear_velocity(), direction(turned + angle + kPi / 2)), 0, 0.02);
      }
    }
  }
}

// In other directions the force of maximum dissipation acts: -N·(mu1²·v1, mu2²·v2)/√(mu1²·v1² + mu2²·v2²).
TEST(ContactFriction, AnisotropicFrictionIsAnEllipse) {
  for (const Kind kind : kKinds) {
    SlidingBlock s(kind, 0.4);
    s.set(s.block->id(), "friction_direction", {1, 0, 0});
    s.set(s.block->id(), "friction_factor", {0.5});
    Vec3 expected = 3.0 * direction(0.8);
    for (const auto& part : s.block->body().parts()) part->set_velocity(expected, Vec3(0));
    for (int i = 0; i < 3000; i++) {
      const Vec3 pull(0.04 * expected.x, 0.16 * expected.y, 0);
      const double power = std::sqrt(glm::dot(pull, expected));
      expected -= 1e-4 * kG / power * pull;
    }
    s.ticks(18);
    EXPECT_NEAR(s.block->linear_velocity().x, expected.x, 0.03) << static_cast<int>(kind);
    EXPECT_NEAR(s.block->linear_velocity().y, expected.y, 0.03) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace limber::sim::friction_test
