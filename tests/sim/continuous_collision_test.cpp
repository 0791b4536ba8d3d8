// Fast bodies don't pass through others: time of impact in closed form, and shots of every shape at every other one.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/threads/thread_pool.h"
#include "sim/collision/time_of_impact.h"
#include "sim/stage.h"
#include "support/skip.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>

namespace limber::sim::continuous_test {
namespace {

using namespace test;
using bullet::to_bt;
using collision::Sweep;
using collision::time_of_impact;

Sweep sweep(const btCollisionShape& shape, const Vec3& position, const Vec3& motion, const Vec3& rotation = Vec3(0)) {
  Sweep s;
  s.shape = &shape;
  s.start = to_bt(Pose{position, quat_identity()});
  s.linear = to_bt(motion);
  s.angular = to_bt(rotation);
  s.radius = collision::inner_radius(shape);
  return s;
}

TEST(TimeOfImpact, OfASphereAndAPlane) {
  const btSphereShape ball(0.1F);
  const btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const Sweep floor = sweep(plane, {0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(time_of_impact(sweep(ball, {0, 0, 1}, {5, 0, -2}), floor), 0.9 / 2, 1e-3);
  EXPECT_NEAR(time_of_impact(floor, sweep(ball, {0, 0, 1}, {5, 0, -2})), 0.9 / 2, 1e-3);
  EXPECT_EQ(time_of_impact(sweep(ball, {0, 0, 1}, {5, 0, -0.89}), floor), 1);
  EXPECT_EQ(time_of_impact(sweep(ball, {0, 0, 1}, {0, 0, 3}), floor), 1);
}

TEST(TimeOfImpact, OfTwoBallsThatMove) {
  const btSphereShape ball(0.1F);
  // sqrt((1 - 3 t)² + 0.1²) = 0.2
  const double expected = (1 - std::sqrt(0.03)) / 3;
  EXPECT_NEAR(time_of_impact(sweep(ball, {0, 0, 0}, {2, 0, 0}), sweep(ball, {1, 0.1, 0}, {-1, 0, 0})), expected, 2e-3);
  EXPECT_EQ(time_of_impact(sweep(ball, {0, 0, 0}, {2, 0, 0}), sweep(ball, {1, 0.201, 0}, {-1, 0, 0})), 1);
}

TEST(TimeOfImpact, OfARodThatRotatesIntoABall) {
  const btBoxShape rod(btVector3(1, 0.01F, 0.01F));
  const btSphereShape ball(0.05F);
  // the rod reaches the ball at an angle of 30 degrees minus that of their radii
  const double angle = kPi / 6 - std::asin(0.06 / 0.8);
  const Sweep target = sweep(ball, Vec3(std::cos(kPi / 6), std::sin(kPi / 6), 0) * 0.8, {0, 0, 0});
  EXPECT_NEAR(time_of_impact(sweep(rod, {0, 0, 0}, {0, 0, 0}, {0, 0, kPi / 4}), target), angle / (kPi / 4), 5e-3);
  EXPECT_EQ(time_of_impact(sweep(rod, {0, 0, 0}, {0, 0, 0}, {0, 0, -kPi / 4}), target), 1);
}

TEST(TimeOfImpact, OfCompoundsAndTrianglesFromBothSides) {
  const btSphereShape ball(0.1F);
  btCompoundShape dumbbell;
  btSphereShape end(0.1F);
  for (const double x : {-1.0, 1.0}) dumbbell.addChildShape(to_bt(Pose{{x, 0, 0}, quat_identity()}), &end);
  EXPECT_NEAR(time_of_impact(sweep(dumbbell, {0, 0, 0}, {0, 0, 2}), sweep(ball, {1, 0, 1}, {0, 0, 0})), 0.4, 2e-3);
  EXPECT_EQ(time_of_impact(sweep(dumbbell, {0, 0, 0}, {0, 0, 2}), sweep(ball, {0, 0, 1}, {0, 0, 0})), 1);

  btTriangleMesh triangles;
  triangles.addTriangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const btBvhTriangleMeshShape mesh(&triangles, true);
  for (const double side : {1.0, -1.0}) {
    EXPECT_NEAR(time_of_impact(sweep(ball, {0, 0, side}, {0, 0, -2 * side}), sweep(mesh, {0, 0, 0}, {0, 0, 0})), 0.45,
                2e-3);
    EXPECT_EQ(time_of_impact(sweep(ball, {1.5, 0, side}, {0, 0, -2 * side}), sweep(mesh, {0, 0, 0}, {0, 0, 0})), 1);
  }
}

TEST(TimeOfImpact, HappensOnlyBeforeAShapeStops) {
  const btSphereShape ball(0.1F);
  Sweep mover = sweep(ball, {0, 0, 0}, {2, 0, 0});
  mover.stop = 0.3F;
  EXPECT_EQ(time_of_impact(mover, sweep(ball, {1, 0, 0}, {0, 0, 0})), 1);
  EXPECT_NEAR(time_of_impact(mover, sweep(ball, {1, 0, 0}, {-0.4, 0, 0})), 0.5, 2e-3) << "the other one moves on";
}

TEST(InnerRadius, OfEachShape) {
  EXPECT_FLOAT_EQ(collision::inner_radius(btSphereShape(0.2F)), 0.2F);
  EXPECT_FLOAT_EQ(collision::inner_radius(btBoxShape(btVector3(0.3F, 0.1F, 0.2F))), 0.1F);
  EXPECT_FLOAT_EQ(collision::inner_radius(btCylinderShapeZ(btVector3(0.3F, 0.3F, 0.1F))), 0.1F);
  EXPECT_FLOAT_EQ(collision::inner_radius(btCapsuleShapeZ(0.05F, 1)), 0.05F);
  EXPECT_FLOAT_EQ(collision::inner_radius(btConeShapeZ(3, 4)), 12.0F / 8) << "in a triangle of 3, 4 and 5";
}

model::ShapeModel projectile(int kind) {
  switch (kind) {
    case 0:
      return sphere_model(0.01);
    case 1:
      return box_model({0.02, 0.02, 0.02});
    case 2:
      return round_model(model::ShapeKind::capsule, 0.01, 0.04);
    case 3:
      return round_model(model::ShapeKind::cylinder, 0.01, 0.02);
    default:
      return round_model(model::ShapeKind::cone, 0.01, 0.02);
  }
}

model::ShapeModel target(int kind) {
  switch (kind) {
    case 0:
      return box_model({0.01, 1, 1});
    case 1:
      return round_model(model::ShapeKind::capsule, 0.005, 1);
    default:
      return sphere_model(0.05);
  }
}

struct Shot {
  Part* ball;
  double speed;
  std::string name;
  bool hit = false;
};

/// Shoots every shape at every target. Each one loses speed at the target, before it could be behind it.
void shoot(double restitution, double mass) {
  WorldFixture s;
  std::vector<Shot> shots;
  for (int i = 0; i < 150; i++) {
    const int kind = i % 5;
    const int aim = i / 5 % 3;
    const double speed = std::vector<double>{2, 10, 50, 200, 490}[static_cast<std::size_t>(i / 15 % 5)];
    const double spin = i / 75 * 150;
    const Vec3 lane(0, i % 15 * 4, i / 15 * 4);
    Part& plate = s.add_single_part(target(aim), mass, {lane + Vec3(3, 0, 0), quat_identity()});
    Part& ball = s.add_single_part(projectile(kind), 0.01, {lane + Vec3(0, 0.0005 * (i % 7), 0), quat_identity()});
    s.set(plate.id(), "restitution", {1});
    s.set(ball.id(), "restitution", {restitution});
    s.set(ball.id(), "linear_velocity", {speed, 0, 0});
    s.set(ball.id(), "angular_velocity", {0, spin, 0});
    shots.push_back({&ball, speed, fmt::format("shape {}, target {}, {} m/s, {} rad/s", kind, aim, speed, spin)});
  }
  for (int tick = 0; tick < 95; tick++) {
    s.ticks(1);
    for (Shot& shot : shots) {
      shot.hit = shot.hit || s.vec(shot.ball->id(), "linear_velocity").x < 0.97 * shot.speed;
      if (shot.hit) continue;
      EXPECT_LT(shot.ball->pose().position.x, 3.06) << shot.name;
    }
  }
  for (const Shot& shot : shots) EXPECT_TRUE(shot.hit) << shot.name;
}

TEST(ContinuousCollision, NothingPassesThroughAStaticPart) { shoot(0, 0); }
TEST(ContinuousCollision, NothingPassesThroughAStaticPartWhenItBounces) { shoot(0.5, 0); }
TEST(ContinuousCollision, NothingPassesThroughAMovablePart) { shoot(0, 100); }
TEST(ContinuousCollision, NothingPassesThroughAMovablePartWhenItBounces) { shoot(0.5, 100); }

TEST(ContinuousCollision, BodiesThatMissAreNotDeflected) {
  WorldFixture s;
  s.add_single_part(box_model({0.01, 1, 1}), 0, {{3, 0.5, 0}, quat_identity()});
  for (const double restitution : {0.0, 0.5}) {
    Part& ball = s.add_single_part(sphere_model(0.01), 0.01, {{0, -0.0115, restitution}, quat_identity()});
    s.set(ball.id(), "restitution", {restitution});
    s.set(ball.id(), "linear_velocity", {150, 0, 0});
  }
  s.ticks(3);
  for (const auto& body : s.world.bodies()) {
    if (body->root()->is_static()) continue;
    EXPECT_NEAR(body->root()->pose().position.x, 7.5, 1e-5) << "150 m/s for 3/60 s";
    EXPECT_NEAR(body->root()->pose().position.y, -0.0115, 1e-6);
  }
}

TEST(ContinuousCollision, FastBallsBounceOffEachOther) {
  WorldFixture s;
  const auto add = [&](double x, double speed) -> Part& {
    Part& ball = s.add_single_part(sphere_model(0.02), 0.1, {{x, 0, 0}, quat_identity()});
    s.set(ball.id(), "restitution", {1});
    s.set(ball.id(), "linear_velocity", {speed, 0, 0});
    return ball;
  };
  Part& left = add(-2.3, 400);
  Part& right = add(3.1, -300);
  s.ticks(3);
  EXPECT_LT(left.pose().position.x, right.pose().position.x);
  EXPECT_NEAR(s.vec(left.id(), "linear_velocity").x, -300, 0.5);
  EXPECT_NEAR(s.vec(right.id(), "linear_velocity").x, 400, 0.5);
}

// Ten bounces between two plates take the time of the flight, and at most a substep more for each bounce.
TEST(ContinuousCollision, ABouncingBallLosesLessThanASubstepPerBounce) {
  WorldFixture s;
  for (const double x : {-0.5, 0.5}) {
    Part& plate = s.add_single_part(box_model({0.01, 1, 1}), 0, {{x, 0, 0}, quat_identity()});
    s.set(plate.id(), "restitution", {1});
  }
  Part& ball = s.add_single_part(sphere_model(0.01), 0.01);
  s.set(ball.id(), "restitution", {1});
  s.set(ball.id(), "linear_velocity", {60, 0, 0});
  s.ticks(60);
  const Vec3 v = s.vec(ball.id(), "linear_velocity");
  EXPECT_NEAR(std::fabs(v.x), 60, 1) << "contacts are slightly soft";
  EXPECT_LT(std::fabs(ball.pose().position.x), 0.5);
}

TEST(ContinuousCollision, AJointedHammerStopsAsAWhole) {
  WorldFixture s;
  Body& hammer = s.body("hammer");
  Part& hub = s.part(hammer, sphere_model(0.02), 0);
  const auto add_link = [&](Part& parent, double from, double to) -> Part& {
    Part& link = s.part(hammer, round_model(model::ShapeKind::capsule, 0.01, to - from - 0.04), 0.5,
                        {{(from + to) / 2, 0, 0}, quat_axis({0, 1, 0}, kPi / 2)});
    (void)hammer
        .add_joint("hinge" + link.name(), parent, link, model::JointType::continuous, Vec3(from, 0, 0), Vec3(0, 0, 1))
        .value();
    s.set(link.id(), "angular_velocity", {0, 0, 40});
    s.set(link.id(), "linear_velocity", {0, 40 * (from + to) / 2, 0});
    return link;
  };
  Part& head = add_link(add_link(hub, 0, 0.5), 0.5, 1);
  s.add_single_part(box_model({4, 0.01, 0.2}), 0, {{0, 0.3, 0}, quat_identity()});
  for (int i = 0; i < 120; i++) {
    s.ticks(1);
    EXPECT_LT(widest_gap(hammer), 5e-3);
    EXPECT_LT(head.pose().position.y, 0.3) << "below the plate";
  }
}

// A kinematic paddle, which nothing stops, hits balls at rest.
TEST(ContinuousCollision, AKinematicPaddlePassesNoBall) {
  for (const double speed : {3.0, 20.0, 120.0}) {
    for (const double restitution : {0.0, 1.0}) {
      WorldFixture s;
      Part& ball = s.add_single_part(sphere_model(0.02), 0.1, {{1, 0, 0}, quat_identity()});
      Part& paddle = s.add_single_part(box_model({0.02, 0.5, 0.5}), 0);
      for (Part* part : {&ball, &paddle}) s.set(part->id(), "restitution", {restitution});
      for (int tick = 0; tick < 60; tick++) {
        s.set(paddle.id(), "linear_velocity", {speed, 0, 0});
        s.ticks(1);
        EXPECT_GT(ball.pose().position.x, paddle.pose().position.x) << speed << ' ' << restitution;
      }
      // a predicted contact may absorb a part of the bounce
      EXPECT_GT(s.vec(ball.id(), "linear_velocity").x, 0.98 * speed);
    }
  }
}

TEST(ContinuousCollision, IsTheSameForAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    Store store;
    WorldSetup setup;
    if (threads > 1) setup.thread_pool = std::make_shared<ThreadPool>(threads);
    World world(store, setup);
    Body& body = *world.add_body("cloud").value();
    Shape& ball = *world.shapes().add("ball", sphere_model(0.02)).value();
    for (int i = 0; i < 300; i++) {
      const Vec3 place(i % 7, i / 7 % 7, i / 49);
      Part& part = *body.add_part("p" + std::to_string(i), ball, 0.1, {place, quat_identity()}).value();
      const Vec3 v = (Vec3(3, 3, 3) - place) * 60.0;
      (void)store.set(part.id(), "linear_velocity", std::vector<double>{v.x, v.y, v.z});
      (void)store.set(part.id(), "restitution", std::vector<double>{i % 2 * 0.9});
    }
    for (int i = 0; i < 20; i++) world.step();
    return world.state_hash();
  };
  const std::uint64_t one = hash(1);
  EXPECT_EQ(hash(2), one);
  EXPECT_EQ(hash(3), one);
}

}  // namespace
}  // namespace limber::sim::continuous_test
