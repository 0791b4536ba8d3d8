// Sleep: islands at rest are skipped by steps and wake on any influence in the same tick; slow motions never fall
// asleep.
#include "sim/bullet/sleep.h"

#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "sim/arm.h"
#include "sim/bullet/island_world.h"
#include "sim/collision/dispatcher.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kTick = 1.0 / 60;

int asleep(const WorldFixture& s) { return static_cast<int>(s.number(s.world.id(), "sleeping_parts")); }

// A stack of two boxes and a hinged arm, which fall asleep.
struct Resting : WorldFixture {
  Resting()
      : ground(floor()),
        low(add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()})),
        high(add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.3}, quat_identity()})),
        arm(make_arm(*this, "arm", {2, {2, 0, 0.05}})),
        motor(*arm.motors()[0]) {
    gravity({0, 0, -9.81});
    ticks(120);
  }
  Part& link() const { return *arm.parts()[1]; }

  Part& ground;
  Part& low;
  Part& high;
  Body& arm;
  Motor& motor;
};

TEST(Sleep, IslandsAtRestFallAsleepAndReportNoVelocity) {
  Resting s;
  EXPECT_EQ(asleep(s), 4);
  EXPECT_EQ(s.number(s.low.body().id(), "asleep"), 1);
  EXPECT_EQ(s.number(s.ground.body().id(), "asleep"), 0);
  for (Part* part : {&s.low, &s.high, &s.link()}) {
    EXPECT_EQ(part->linear_velocity(), Vec3(0));
    EXPECT_EQ(part->angular_velocity(), Vec3(0));
    EXPECT_EQ(part->rigid().getLinearVelocity(), btVector3(0, 0, 0));
  }
  for (const auto& joint : s.arm.joints()) EXPECT_EQ(s.number(joint->id(), "speed"), 0);
  EXPECT_NEAR(s.high.pose().position.z, 0.3, 1e-3);
}

TEST(Sleep, ReadoutsKeepTheirValues) {
  Resting s;
  const Pose pose = s.high.pose();
  const Vec3 torque = s.vec(s.motor.id(), "applied_torque");
  s.ticks(600);
  EXPECT_EQ(asleep(s), 4);
  EXPECT_EQ(s.high.pose().position, pose.position);
  EXPECT_EQ(s.high.pose().rotation, pose.rotation);
  EXPECT_EQ(s.vec(s.motor.id(), "applied_torque"), torque);
}

// A servo that holds a beam of 2 kg, half a meter from its axis, reports its load while it sleeps.
TEST(Sleep, ServoKeepsItsAppliedTorque) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& body = s.body("beam");
  Part& base = s.part(body, sphere_model(0.05), 0);
  Part& beam = s.part(body, box_model({0.8, 0.1, 0.1}), 2, {{0.5, 0, 0}, quat_identity()});
  Joint& hinge = *body.add_joint("hinge", base, beam, model::JointType::revolute, Vec3(0), {0, 1, 0}).value();
  Motor& motor = *body.add_motor(hinge).value();
  s.ticks(150);
  ASSERT_EQ(asleep(s), 1);
  EXPECT_NEAR(s.vec(motor.id(), "applied_torque").z, -9.81, 0.02);
  s.ticks(120);
  EXPECT_NEAR(s.vec(motor.id(), "applied_torque").z, -9.81, 0.02);
}

TEST(Sleep, SleepingPairsAreSkipped) {
  Resting s;
  const auto& dispatcher = static_cast<const collision::Dispatcher&>(*s.world.bullet().getDispatcher());
  std::uint64_t before = dispatcher.processed_pairs();
  s.ticks(10);
  EXPECT_EQ(dispatcher.processed_pairs() - before, 0u);
  // a ball rolls elsewhere: only its pair with the floor is processed, once in each substep
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{-3, 0, 0.1}, quat_identity()});
  ball.set_velocity({0, 1, 0}, {-10, 0, 0});
  before = dispatcher.processed_pairs();
  s.ticks(10);
  EXPECT_EQ(dispatcher.processed_pairs() - before, 40u);
  EXPECT_EQ(asleep(s), 4);
}

TEST(Sleep, CanSleepKeepsAnIslandAwake) {
  Resting s;
  s.set(s.high.body().id(), "can_sleep", {0});
  s.ticks(120);
  EXPECT_EQ(asleep(s), 2);
  EXPECT_FALSE(s.low.asleep());
  s.set(s.high.body().id(), "can_sleep", {1});
  s.ticks(90);
  EXPECT_EQ(asleep(s), 4);
}

// Influences that wake the stack, or the arm, in the same tick.
struct Influence {
  const char* name;
  std::function<void(Resting&)> apply;
  bool arm = false;  // true: the arm; false: the stack

  // NOLINTNEXTLINE(readability-identifier-naming): GoogleTest's name
  friend void PrintTo(const Influence& influence, std::ostream* out) { *out << influence.name; }
};

// NOLINTNEXTLINE(readability-function-size): a table
const std::vector<Influence>& influences() {
  static const auto of_low = [](const char* property, double value) {
    return [property, value](Resting& s) { s.set(s.low.id(), property, {value}); };
  };
  static const auto of_sim = [](const char* property, double value) {
    return [property, value](Resting& s) { s.set(s.world.id(), property, {value}); };
  };
  static const auto of_motor = [](const char* property, const std::vector<double>& value) {
    return [property, value](Resting& s) { s.set(s.motor.id(), property, value); };
  };
  static const std::vector<Influence> list = {
      {"force",
       [](Resting& s) {
         s.low.apply_force({0.1, 0, 0});
       }},
      {"torque",
       [](Resting& s) {
         s.high.apply_torque({0, 0, 0.01});
       }},
      {"impulse",
       [](Resting& s) {
         s.high.apply_impulse({0.001, 0, 0});
       }},
      {"mass", of_low("mass", 2)},
      {"friction", of_low("friction", 0.1)},
      {"rolling_friction", of_low("rolling_friction", 0.1)},
      {"spinning_friction", of_low("spinning_friction", 0.1)},
      {"friction_factor",
       [](Resting& s) {
         s.set(s.low.id(), "friction_direction", {1, 0, 0});
         s.set(s.low.id(), "friction_factor", {0.5});
       }},
      {"restitution", of_low("restitution", 0.1)},
      {"linear_damping", of_low("linear_damping", 0.1)},
      {"angular_damping", of_low("angular_damping", 0.1)},
      {"pose",
       [](Resting& s) {
         s.low.set_pose({{0, 0, 0.101}, quat_identity()});
       }},
      {"velocity",
       [](Resting& s) {
         s.high.set_velocity({0, 0, 0.1}, Vec3(0));
       }},
      {"reset", [](Resting& s) { s.low.body().recovery().reset(); }},
      {"gravity",
       [](Resting& s) {
         s.gravity({0, 0, -9});
       }},
      {"timestep", of_sim("timestep", 0.01)},
      {"substeps", of_sim("substeps", 5)},
      {"solver_iterations", of_sim("solver_iterations", 51)},
      {"solver", of_sim("solver", 0)},
      {"panic", [](Resting& s) { s.world.panic().begin(); }},
      {"may_not_sleep", [](Resting& s) { s.set(s.low.body().id(), "can_sleep", {0}); }},
      {"self_collision", [](Resting& s) { s.set(s.low.body().id(), "self_collision", {0}); }},
      {"neighbor_removed", [](Resting& s) { s.world.remove_body(s.low.body()); }},
      {"neighbor_disabled", [](Resting& s) { s.low.body().set_enabled(false); }},
      {"neighbor_moved",
       [](Resting& s) {
         s.low.set_pose({{5, 0, 0.1}, quat_identity()});
       }},
      {"floor_moved",
       [](Resting& s) {
         s.ground.set_pose({{0, 0, -0.1}, quat_identity()});
       }},
      {"floor_friction", [](Resting& s) { s.set(s.ground.id(), "friction", {0.1}); }},
      {"floor_removed", [](Resting& s) { s.world.remove_body(s.ground.body()); }},
      {"body_put_into_it",
       [](Resting& s) {
         s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.45}, quat_identity()});
       }},
      {"static_body_put_into_it",
       [](Resting& s) {
         s.add_single_part(sphere_model(0.1), 0, {{0, 0, 0.45}, quat_identity()});
       }},
      {"joint",
       [](Resting& s) {
         Part& part = s.part(s.high.body(), sphere_model(0.05), 1, {{0.5, 0, 0.3}, quat_identity()});
         (void)s.high.body().add_joint("new", s.high, part, model::JointType::fixed, {0.2, 0, 0.3}, {0, 0, 1});
       }},
      {"target", of_motor("target", {0.1}), true},
      {"mode", of_motor("mode", {0}), true},
      {"speed", of_motor("speed", {0.5}), true},
      {"max_force", of_motor("max_angular_force", {0, 0, 1}), true},
      {"damping", of_motor("damping", {1}), true},
      {"bounce", of_motor("bounce", {0.5}), true},
      {"limits",
       [](Resting& s) {
         s.set(s.arm.joints()[1]->id(), "angular_upper_limit", {0, 0, 0.5});
       },
       true},
      {"stop_cfm",
       [](Resting& s) {
         s.set(s.arm.joints()[0]->id(), "angular_stop_cfm", {0.1, 0, 0});
       },
       true},
      {"base_moved",
       [](Resting& s) {
         s.arm.parts()[0]->set_pose({{2, 0, 0.06}, quat_identity()});
       },
       true},
  };
  return list;
}

struct SleepInfluence : testing::TestWithParam<Influence> {};

TEST_P(SleepInfluence, WakesInTheSameTick) {
  Resting s;
  ASSERT_EQ(asleep(s), 4);
  const Influence& influence = GetParam();
  const NodeId node = s.high.id();
  influence.apply(s);
  s.ticks(1);
  ASSERT_TRUE(s.store.alive(node));
  EXPECT_FALSE(influence.arm ? s.link().asleep() : s.high.asleep());
}

INSTANTIATE_TEST_SUITE_P(Each, SleepInfluence, testing::ValuesIn(influences()),
                         [](const auto& info) { return std::string(info.param.name); });

// Stacks jitter in the iterative solver, but must fall asleep.
TEST(Sleep, StacksOfThreeBoxesFallAsleep) {
  for (const double solver : {0.0, 1.0}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -9.81});
    s.set(s.world.id(), "solver", {solver});
    for (int i = 0; i < 3; i++) s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.101 + 0.2 * i}, quat_identity()});
    s.ticks(120);
    EXPECT_EQ(asleep(s), 3);
  }
}

TEST(Sleep, SettingTheSameValuesWakesNothing) {
  Resting s;
  for (int i = 0; i < 5; i++) {
    s.set(s.motor.id(), "target", {s.number(s.motor.id(), "target")});
    s.set(s.motor.id(), "mode", {s.number(s.motor.id(), "mode")});
    s.set(s.low.id(), "friction", {0.5});
    s.set(s.low.id(), "mass", {1});
    s.low.set_velocity(Vec3(0), Vec3(0));
    s.low.apply_force(Vec3(0));
    s.ground.set_pose(s.ground.pose());
    s.ticks(1);
    EXPECT_EQ(asleep(s), 4);
  }
}

TEST(Sleep, StackFallsWhenItsLowestBoxIsRemoved) {
  Resting s;
  const double before = s.high.pose().position.z;
  s.world.remove_body(s.low.body());
  s.ticks(6);
  // 24 substeps: velocities first, then positions
  EXPECT_NEAR(before - s.high.pose().position.z, 9.81 / 240 / 240 * 24 * 25 / 2, 1e-4);
}

TEST(Sleep, ImpactTransfersMomentumToASleepingBox) {
  WorldFixture s;
  s.floor();
  s.gravity({0, 0, -9.81});
  Part& box = s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()});
  s.ticks(90);
  ASSERT_EQ(asleep(s), 1);
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{-0.25, 0, 0.1}, quat_identity()});
  s.set(ball.id(), "friction", {0});
  ball.set_velocity({2, 0, 0}, Vec3(0));
  s.ticks(1);
  EXPECT_EQ(asleep(s), 1);
  s.ticks(2);
  EXPECT_EQ(asleep(s), 0);
  // inelastic: both continue at half the speed; the floor has decelerated the box for a tick or two
  EXPECT_GT(box.linear_velocity().x, 0.8);
  EXPECT_NEAR(box.linear_velocity().x + ball.linear_velocity().x, 2, 9.81 * 0.5 * 2.5 * kTick);
}

// Slow motions must not fall asleep: each must have moved as far as predicted.
TEST(SlowMotion, SpinOfAHundredthRadianPerSecond) {
  OneAxisFixture s(5);
  s.set(s.motor.id(), "mode", {1});
  s.set_motor("velocity", 0.01);
  s.ticks(600);
  EXPECT_NEAR(s.x(), 0.1, 1e-3);
}

TEST(SlowMotion, SpinBelowTheRestToleranceContinues) {
  OneAxisFixture s(5);
  s.set(s.motor.id(), "mode", {1});
  s.set_motor("velocity", 4e-6);
  s.ticks(300);
  EXPECT_NEAR(s.x(), 2e-5, 2e-6);
  EXPECT_EQ(asleep(s), 0);
}

TEST(SlowMotion, SpinAgainstALimitSleepsOnlyAtSpeedZero) {
  OneAxisFixture s(5);
  s.limits(-0.1, 0.1);
  s.set(s.motor.id(), "mode", {1});
  s.set_motor("velocity", 1);
  s.ticks(120);
  EXPECT_EQ(asleep(s), 0);
  s.set_motor("velocity", 0);
  s.ticks(120);
  EXPECT_EQ(asleep(s), 1);
}

TEST(SlowMotion, ServoWithATinySpeedLimitMoves) {
  OneAxisFixture s(5);
  s.set(s.motor.id(), "mode", {2});
  s.set_motor("velocity", 5e-5);
  s.set(s.motor.id(), "target", {1});
  s.ticks(1200);
  EXPECT_NEAR(s.x(), 20 * 5e-5, 2e-4);
  EXPECT_EQ(asleep(s), 0);
}

TEST(SlowMotion, FollowsARampOfAMillimeterPerSecond) {
  OneAxisFixture s(2);
  s.gravity({0, 0, -9.81});
  s.set_one(s.motor.id(), "linear_active", 2, 1);
  s.set_one(s.motor.id(), "linear_servo_active", 2, 1);
  for (int i = 1; i <= 300; i++) {
    s.set_motor("servo_position", 1e-3 * i * kTick);
    s.ticks(1);
  }
  EXPECT_NEAR(s.x(), 5e-3, 1e-4);
}

TEST(SlowMotion, PendulumSwingsThroughItsTurningPoint) {
  // 20 m long, released 0.5 mm from its lowest point
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& body = s.body("pendulum");
  Part& pivot = s.part(body, sphere_model(0.1), 0);
  const double angle = 5e-4 / 20;
  Part& bob = s.part(body, sphere_model(0.1), 1, {{20 * std::sin(angle), 0, -20 * std::cos(angle)}, quat_identity()});
  (void)body.add_joint("hinge", pivot, bob, model::JointType::revolute, Vec3(0), {0, 1, 0});
  const double period = 2 * kPi * std::sqrt(20 / 9.81);
  s.ticks(static_cast<int>(period / 2 / kTick));
  EXPECT_NEAR(bob.center().x, -5e-4, 1e-4);
  s.ticks(static_cast<int>(period / 2 / kTick));
  EXPECT_NEAR(bob.center().x, 5e-4, 1e-4);
}

TEST(SlowMotion, SpringOscillatesThroughItsTurningPoint) {
  OneAxisFixture s(5);
  s.set_one(s.motor.id(), "angular_spring_active", 2, 1);
  const double period = 20;
  s.set_motor("spring_stiffness", s.inertia() * std::pow(2 * kPi / period, 2));
  s.set_motor("spring_rest_length", 0.02);
  s.ticks(600);
  EXPECT_NEAR(s.x(), 0.04, 4e-4);
  s.ticks(600);
  EXPECT_NEAR(s.x(), 0, 4e-4);
}

TEST(SlowMotion, BallFallsFromItsApex) {
  WorldFixture s;
  s.gravity({0, 0, -0.01});
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  ball.set_velocity({0, 0, 0.01}, Vec3(0));
  s.ticks(120);
  EXPECT_NEAR(ball.pose().position.z, 0, 1e-3);
  EXPECT_NEAR(ball.linear_velocity().z, -0.01, 1e-5);
}

TEST(SlowMotion, DiscRollsAMillimeterPerSecond) {
  WorldFixture s;
  s.floor();
  s.gravity({0, 0, -9.81});
  const model::ShapeModel coin = round_model(model::ShapeKind::cylinder, 0.05, 0.04);
  Part& disc = s.add_single_part(coin, 0.1, {{0, 0, 0.05}, quat_axis({1, 0, 0}, kPi / 2)});
  s.set(disc.id(), "friction", {0.1});
  s.ticks(5);
  disc.set_velocity({1e-3, 0, 0}, {0, 0.02, 0});
  const double from = disc.pose().position.x;
  s.ticks(300);
  EXPECT_GT(disc.pose().position.x - from, 2e-3);
  EXPECT_EQ(asleep(s), 0);
}

TEST(SlowMotion, DriftContinuesWithoutGravity) {
  WorldFixture s;
  Part& part = s.add_single_part(box_model(Vec3(0.1)), 1);
  part.set_velocity({1e-6, 0, 0}, {0, 0, 1e-6});
  s.ticks(300);
  EXPECT_NEAR(part.pose().position.x, 5e-6, 1e-8);
  EXPECT_EQ(asleep(s), 0);
  // without any motion nothing is lost by sleeping
  part.set_velocity(Vec3(0), Vec3(0));
  s.ticks(90);
  EXPECT_EQ(asleep(s), 1);
}

// Bodies that fall into a heap, are hit, and fall asleep again.
std::uint64_t hash_of_heap(int threads, std::vector<int>* sleeping = nullptr) {
  Store store;
  WorldSetup setup;
  if (threads > 1) setup.thread_pool = std::make_shared<ThreadPool>(threads);
  World world(store, setup);
  log_to_stderr(false);
  Shape& plane = *world.shapes().add("plane", plane_model()).value();
  Shape& box = *world.shapes().add("box", box_model(Vec3(0.2))).value();
  (void)(*world.add_body("floor").value()).add_part("p", plane, 0, {});
  std::vector<Part*> parts;
  for (int i = 0; i < 90; i++) {
    const int row = i / 9 % 5;
    const int layer = i / 45;
    const Vec3 at(0.5 * (i % 9), 0.5 * row, 0.1 + 0.205 * layer);
    parts.push_back(
        world.add_body("b" + std::to_string(i)).value()->add_part("p", box, 1, {at, quat_identity()}).value());
  }
  std::uint64_t hash = 0;
  for (int i = 0; i < 250; i++) {
    if (i == 150) parts[40]->set_velocity({3, 1, 0}, Vec3(0));
    world.step();
    hash = hash * 31 + world.motion_hash().compute();
    if (sleeping != nullptr) sleeping->push_back(world.bullet().sleep().sleeping());
  }
  log_to_stderr(true);
  return hash ^ world.state_hash();
}

TEST(Sleep, DoesNotDependOnThreads) {
  std::vector<int> sleeping;
  const std::uint64_t hash = hash_of_heap(1, &sleeping);
  EXPECT_EQ(sleeping[149], 90);
  EXPECT_LT(sleeping[155], 90);
  EXPECT_GT(sleeping[155], 60);
  EXPECT_EQ(hash_of_heap(2), hash);
  EXPECT_EQ(hash_of_heap(3), hash);
}

TEST(Sleep, CopyOfASleepingBodyIsAwake) {
  Resting s;
  Body& copy = *s.world.copy_body(s.high.body(), "copy").value();
  copy.set_pose({{0, 0, 2}, quat_identity()});
  s.ticks(6);
  EXPECT_NEAR(copy.pose().position.z, 2 - 9.81 / 240 / 240 * 24 * 25 / 2, 1e-4);
  EXPECT_EQ(asleep(s), 4);
  s.set(s.high.body().id(), "can_sleep", {0});
  EXPECT_FALSE(s.world.copy_body(s.high.body(), "other").value()->can_sleep());
}

TEST(Sleep, FailedCallWakesNothing) {
  Resting s;
  s.world.transaction().begin();
  Part& part = s.part(s.high.body(), sphere_model(0.05), 1, {{0.5, 0, 0.3}, quat_identity()});
  (void)s.high.body().add_joint("new", s.high, part, model::JointType::fixed, {0.2, 0, 0.3}, {0, 0, 1});
  s.low.apply_force({1, 0, 0});
  s.set(s.motor.id(), "target", {1});
  s.set(s.low.id(), "position", {0, 0, 1});
  s.world.transaction().rollback();
  s.ticks(2);
  EXPECT_EQ(asleep(s), 4);
}

}  // namespace
}  // namespace limber::sim
