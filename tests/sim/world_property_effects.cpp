// The effects of the properties of the world and of bodies, measured in the world.
#include <cmath>

#include "sim/bullet/island_world.h"
#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance, std::string_view label = "") {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(a[i], b[i], tolerance) << label << " axis " << i;
}

// Velocities are updated before positions: after n steps x = g·h²·n(n+1)/2, not g·t²/2.
double fall(double g, double h, int n) { return g * h * h * n * (n + 1) / 2; }

void gravity() {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 3);
  s.gravity({1.5, -2, 9.81});
  s.ticks(60);
  expect_near(ball.linear_velocity(), {1.5, -2, 9.81}, 1e-4);
}

void timestep() {
  for (const double dt : {1.0 / 60, 0.002, 0.05}) {
    WorldFixture s;
    Part& ball = s.add_single_part(sphere_model(0.1), 1);
    s.set(s.world.id(), "timestep", {dt});
    s.gravity({0, 0, -10});
    s.ticks(10);
    EXPECT_NEAR(s.world.time(), 10 * dt, 1e-12);
    EXPECT_NEAR(ball.pose().position.z, -fall(10, dt / 4, 40), 1e-4 * fall(10, dt / 4, 40));
  }
}

void substeps() {
  for (const int n : {1, 4, 7}) {
    WorldFixture s;
    Part& ball = s.add_single_part(sphere_model(0.1), 1);
    s.substeps(n);
    s.gravity({0, 0, -9.81});
    s.ticks(30);
    const double expected = fall(9.81, 1.0 / 60 / n, 30 * n);
    EXPECT_NEAR(ball.pose().position.z, -expected, 2e-6 * expected) << n;
    // the more substeps, the closer to g·t²/2
    EXPECT_NEAR(expected - 9.81 / 8, 9.81 / 4 / 60 / n, 1e-12);
  }
}

// Without gravity, a rotating joint stops if its motor holds it, and slows down otherwise.
void panic_motors() {
  for (const double motors : {0.0, 1.0}) {
    OneAxisFixture s(5);
    s.set(s.motor.id(), "mode", {1});
    s.set_motor("velocity", 2);
    s.set(s.world.id(), "panic_motors", {motors});
    s.ticks(30);
    EXPECT_NEAR(s.v(), 2, 1e-3);
    s.world.panic().begin();
    s.ticks(6);
    EXPECT_NEAR(s.v(), motors == 0 ? 0 : 2 * std::exp(-Panic::kDamping / 10), 0.02);
  }
}

// Largest gap of a chain with a heavy end, which few iterations can't hold.
double gap_of_chain(int iterations, double solver) {
  WorldFixture s;
  s.set(s.world.id(), "solver", {solver});
  s.iterations(iterations);
  s.gravity({0, 0, -9.81});
  Body& chain = s.body("chain");
  Part* last = &s.part(chain, sphere_model(0.05), 0);
  double gap = 0;
  std::vector<Joint*> joints;
  for (int i = 1; i <= 10; i++) {
    Part& link = s.part(chain, box_model({0.2, 0.1, 0.1}), i == 10 ? 20 : 1, {{0.2 * i, 0, 0}, quat_identity()});
    joints.push_back(chain
                         .add_joint("j" + std::to_string(i), *last, link, model::JointType::revolute,
                                    {0.2 * i - 0.1, 0, 0}, {0, 1, 0})
                         .value());
    last = &link;
  }
  for (int i = 0; i < 60; i++) {
    s.ticks(1);
    for (const Joint* joint : joints) gap = std::max(gap, glm::length(joint->constraint().pose().offsets()));
  }
  return gap;
}

void solver_iterations() {
  EXPECT_LT(gap_of_chain(200, 0), 0.2 * gap_of_chain(4, 0));
  WorldFixture s;
  s.iterations(17);
  s.ticks(1);
  EXPECT_EQ(s.world.bullet().getSolverInfo().m_numIterations, 17);
}

void solver() {
  // ten iterations can't hold a chain with a heavy end; the direct solver holds the joints exactly
  EXPECT_GT(gap_of_chain(10, 0), 0.003);
  EXPECT_LT(gap_of_chain(10, 1), 0.0005);
  WorldFixture s;
  const Property& property = World::table().at("solver");
  const double other = 2;
  const Result<SetOutcome> outcome = s.store.set(s.world.id(), property, {&other, 1});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error(), "/physics/sim/solver must be one of iterative, direct (got 2)");
}

void seed() {
  WorldFixture a;
  WorldFixture b;
  EXPECT_EQ(a.world.seed(), 1u);
  EXPECT_EQ(a.world.state_hash(), b.world.state_hash());
  b.set(b.world.id(), "seed", {12345678901});
  EXPECT_EQ(b.world.seed(), 12345678901u);
  EXPECT_NE(a.world.state_hash(), b.world.state_hash());
}

// Pacing is done by the clock: the tick itself is the same.
void pacing(const char* property, double value) {
  std::uint64_t hash[2] = {};
  for (int i = 0; i < 2; i++) {
    WorldFixture s;
    s.gravity({0, 0, -9.81});
    s.add_single_part(sphere_model(0.1), 1);
    if (i == 1) s.set(s.world.id(), property, {value});
    s.ticks(6);
    EXPECT_EQ(s.number(s.world.id(), "tick"), 6);
    EXPECT_NEAR(s.number(s.world.id(), "time"), 0.1, 1e-12);
    hash[i] = s.world.state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

// Two boxes on a hinge, bent by 0.7 rad, moving freely.
struct Pair : WorldFixture {
  Body& robot = body("robot");
  Part& a = part(robot, box_model(Vec3(0.2)), 2, {{1, 0, 0}, quat_identity()});
  Part& b = part(robot, box_model({0.2, 0.3, 0.1}), 1, {{1.5, 0, 0}, quat_identity()});
  Joint& hinge = *robot.add_joint("hinge", a, b, model::JointType::revolute, {1.25, 0, 0}, {0, 1, 0}).value();
  Pair() {
    const Pose pivot{{1.25, 0, 0}, quat_axis({0, 1, 0}, 0.7)};
    b.set_pose(pivot * Pose{{0.25, 0, 0}, quat_identity()});
    world.flush();
  }
};

void body_position() {
  Pair p;
  p.set(p.b.id(), "linear_velocity", {0.1, 0, 0});
  const Vec3 before = p.b.pose().position;
  p.set(p.robot.id(), "position", {-3, 4, 5});
  p.world.flush();
  expect_near(p.a.pose().position, {-3, 4, 5}, 1e-12);
  expect_near(p.b.pose().position, before + Vec3(-4, 4, 5), 1e-12);
  expect_near(bullet::from_bt(p.b.rigid().getWorldTransform().getOrigin()), before + Vec3(-4, 4, 5), 1e-6);
  EXPECT_NEAR(p.number(p.hinge.id(), "value"), 0.7, 1e-6);
  expect_near(p.b.linear_velocity(), {0.1, 0, 0}, 0);
}

void body_rotation() {
  Pair p;
  p.set(p.b.id(), "angular_velocity", {0, 0.3, 0});
  const Quat turn = quat_axis(normalized({1, 2, 3}), 2.1);
  const Vec3 arm = p.b.pose().position - p.a.pose().position;
  p.set(p.robot.id(), "rotation", {turn.x, turn.y, turn.z, turn.w});
  p.world.flush();
  expect_near(p.a.pose().position, {1, 0, 0}, 1e-12);
  expect_near(p.b.pose().position, Vec3(1, 0, 0) + turn * arm, 1e-12);
  EXPECT_NEAR(p.number(p.hinge.id(), "value"), 0.7, 1e-6);
  expect_near(p.b.angular_velocity(), {0, 0.3, 0}, 0);
}

void body_linear_velocity() {
  Pair p;
  p.set(p.robot.id(), "linear_velocity", {1, 2, 3});
  const Vec3 a = p.a.pose().position;
  const Vec3 b = p.b.pose().position;
  p.ticks(60);
  expect_near(p.a.pose().position - a, {1, 2, 3}, 2e-5);
  expect_near(p.b.pose().position - b, {1, 2, 3}, 2e-5);
  expect_near(p.vec(p.robot.id(), "linear_velocity"), {1, 2, 3}, 1e-5);
}

void body_angular_velocity() {
  Pair p;
  const Vec3 omega(0.2, -0.4, 1.1);
  p.set(p.robot.id(), "linear_velocity", {0.5, 0, 0});
  p.set(p.robot.id(), "angular_velocity", {omega.x, omega.y, omega.z});
  p.world.flush();
  for (const Part* part : {&p.a, &p.b}) {
    expect_near(part->angular_velocity(), omega, 1e-12);
    expect_near(part->linear_velocity(), Vec3(0.5, 0, 0) + glm::cross(omega, part->center() - p.a.center()), 1e-12);
  }
  // it rotates as a whole: the hinge doesn't move
  EXPECT_NEAR(p.hinge.constraint().rate(5), 0, 1e-6);
}

void body_enabled() {
  WorldFixture s;
  s.gravity({0, 0, -10});
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 5}, quat_identity()});
  s.ticks(6);
  s.set(ball.body().id(), "enabled", {0});
  const Pose at = ball.pose();
  s.ticks(30);
  EXPECT_EQ(ball.pose().position, at.position);
  s.set(ball.body().id(), "enabled", {1});
  s.ticks(6);
  // it continues from its state: twelve ticks of falling altogether
  EXPECT_NEAR(ball.pose().position.z, 5 - fall(10, 1.0 / 240, 48), 1e-5);
}

// A body that must not sleep is stepped even if it is at rest.
void body_motion() {
  WorldFixture s;
  s.gravity({0, 0, -10});
  Body& body = s.body("pair");
  for (const double x : {0.0, 1.0}) s.part(body, sphere_model(0.1), 1, {{x, 0, 0}, quat_identity()});
  s.set(body.id(), "motion", {1});
  s.set(body.id(), "linear_velocity", {0, 1, 0});
  s.ticks(60);
  for (const auto& part : body.parts()) {
    EXPECT_NEAR(part->pose().position.y, 1, 1e-5);
    EXPECT_EQ(part->pose().position.z, 0);
  }
  s.set(body.id(), "motion", {0});
  s.ticks(60);
  for (const auto& part : body.parts()) EXPECT_NEAR(part->linear_velocity().z, -10, 1e-4);
}

void body_gravity_factor() {
  for (const double factor : {0.0, 0.5, -1.0}) {
    WorldFixture s;
    s.gravity({0, 0, -10});
    Part& ball = s.add_single_part(sphere_model(0.1), 2);
    s.set(ball.body().id(), "gravity_factor", {factor});
    s.ticks(60);
    EXPECT_NEAR(ball.linear_velocity().z, -10 * factor, 1e-4);
  }
}

void body_can_sleep() {
  for (const bool can_sleep : {true, false}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -10});
    Part& box = s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()});
    s.set(box.body().id(), "can_sleep", {can_sleep ? 1.0 : 0.0});
    s.ticks(90);
    EXPECT_EQ(box.asleep(), can_sleep);
    EXPECT_EQ(s.number(s.world.id(), "sleeping_parts"), can_sleep ? 1 : 0);
  }
}

// A ball on a static ball of the same body, and one of another body, which always collides.
void body_self_collision() {
  WorldFixture s;
  s.gravity({0, 0, -10});
  Body& body = s.body("two");
  s.part(body, sphere_model(0.1), 0);
  Part& ball = s.part(body, sphere_model(0.1), 1, {{0, 0, 0.2}, quat_identity()});
  s.ticks(60);
  EXPECT_NEAR(ball.pose().position.z, 0.2, 0.002);
  const double rest = ball.pose().position.z;
  s.set(body.id(), "self_collision", {0});
  s.ticks(6);
  // the previous contact no longer holds it
  EXPECT_NEAR(ball.pose().position.z, rest - fall(10, 1.0 / 240, 24), 1e-5);
  Body& copy = **s.world.copy_body(body, "copy");
  copy.set_pose({{3, 0, 0}, quat_identity()});
  Part& dropped = *copy.parts()[1];
  const double from = dropped.pose().position.z;
  Part& foreign = s.add_single_part(sphere_model(0.1), 1, {{3, 0, 0.2}, quat_identity()});
  s.ticks(6);
  EXPECT_LT(dropped.pose().position.z, from - fall(10, 1.0 / 240, 24));
  EXPECT_NEAR(foreign.pose().position.z, 0.2, 0.01);
}

}  // namespace

void add_world_effects(PropertyEffects& effects) {
  effects[{"World", "gravity"}] = gravity;
  effects[{"World", "panic_motors"}] = panic_motors;
  effects[{"World", "timestep"}] = timestep;
  effects[{"World", "substeps"}] = substeps;
  effects[{"World", "solver_iterations"}] = solver_iterations;
  effects[{"World", "solver"}] = solver;
  effects[{"World", "seed"}] = seed;
  effects[{"World", "paused"}] = [] { pacing("paused", 1); };
  effects[{"World", "speed"}] = [] { pacing("speed", 7); };
  effects[{"World", "history"}] = [] { pacing("history", 7); };
}

void add_body_effects(PropertyEffects& effects) {
  effects[{"Body", "position"}] = body_position;
  effects[{"Body", "rotation"}] = body_rotation;
  effects[{"Body", "linear_velocity"}] = body_linear_velocity;
  effects[{"Body", "angular_velocity"}] = body_angular_velocity;
  effects[{"Body", "motion"}] = body_motion;
  effects[{"Body", "gravity_factor"}] = body_gravity_factor;
  effects[{"Body", "enabled"}] = body_enabled;
  effects[{"Body", "self_collision"}] = body_self_collision;
  effects[{"Body", "can_sleep"}] = body_can_sleep;
}

}  // namespace limber::sim::test
