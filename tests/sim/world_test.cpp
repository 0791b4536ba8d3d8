// The world: the state hash and its coverage, repeatability, shapes, clearing.
#include "sim/world/world.h"

#include <gtest/gtest.h>

#include <bit>

#include "sim/arm.h"
#include "sim/bullet/island_world.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

std::uint64_t hash_of_arms(int extra_flushes) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  for (int i = 0; i < 4; i++) make_arm(s, "arm" + std::to_string(i), {4, {0.15 * i, 0, 0.3}, i % 2 == 0});
  for (int tick = 0; tick < 90; tick++) {
    for (const auto& body : s.world.bodies()) set_wave_targets(s, *body, s.world.time());
    for (int i = 0; i < extra_flushes; i++) s.world.flush();
    s.ticks(1);
  }
  return s.world.state_hash();
}

TEST(WorldTest, EqualRunsHaveEqualHashes) {
  const std::uint64_t hash = hash_of_arms(0);
  EXPECT_EQ(hash_of_arms(0), hash);
  EXPECT_EQ(hash_of_arms(2), hash);  // computing the hash changes nothing
}

double next_bit(double v) { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) ^ 1u); }
btScalar next_bit(btScalar v) { return std::bit_cast<btScalar>(std::bit_cast<std::uint32_t>(v) ^ 1u); }

TEST(WorldTest, HashCoversEveryBitOfPosesAndVelocities) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {2});
  s.ticks(10);
  const std::uint64_t hash = s.world.state_hash();
  for (const auto& part : arm.parts()) {
    btRigidBody& r = part->rigid();
    const btTransform t = r.getWorldTransform();
    for (int i = 0; i < 3; i++) {
      btTransform moved = t;
      moved.getOrigin()[i] = next_bit(t.getOrigin()[i]);
      r.setWorldTransform(moved);
      EXPECT_NE(s.world.state_hash(), hash);
      for (int k = 0; k < 3; k++) {
        btTransform turned = t;
        turned.getBasis()[i][k] = next_bit(t.getBasis()[i][k]);
        r.setWorldTransform(turned);
        EXPECT_NE(s.world.state_hash(), hash);
      }
      r.setWorldTransform(t);
      if (part->is_static()) continue;
      const btVector3 v = r.getLinearVelocity();
      const btVector3 w = r.getAngularVelocity();
      btVector3 other = v;
      other[i] = next_bit(v[i]);
      r.setLinearVelocity(other);
      EXPECT_NE(s.world.state_hash(), hash);
      r.setLinearVelocity(v);
      other = w;
      other[i] = next_bit(w[i]);
      r.setAngularVelocity(other);
      EXPECT_NE(s.world.state_hash(), hash);
      r.setAngularVelocity(w);
    }
  }
  EXPECT_EQ(s.world.state_hash(), hash);
}

TEST(WorldTest, HashCoversEveryBitOfProperties) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {2});
  s.ticks(10);
  const std::uint64_t hash = s.world.state_hash();
  std::vector<NodeId> nodes = {s.world.id()};
  s.store.walk(arm.id(), [&](NodeId id) { nodes.push_back(id); });
  int numbers = 0;
  for (const NodeId id : nodes) {
    for (const Property& property : s.store.table(id).properties()) {
      // readouts follow from the other values; `paused` and `speed` belong to the clock
      const bool is_hashed = property.stored() && property.writable() && property.name != "paused" &&
                             property.name != "speed" && property.name != "history";
      if (!is_hashed || property.name == "seed" || property.name == "enabled") continue;
      for (std::uint32_t i = 0; i < property.width; i++) {
        double& v = s.store.mutable_values(id, property)[i];
        const double before = v;
        v = next_bit(v);
        EXPECT_NE(s.world.state_hash(), hash) << s.store.path(id) << "/" << property.name;
        v = before;
        numbers++;
      }
    }
  }
  EXPECT_GT(numbers, 200);
  EXPECT_EQ(s.world.state_hash(), hash);
  s.set(s.world.id(), "seed", {2});
  EXPECT_NE(s.world.state_hash(), hash);
  s.set(s.world.id(), "seed", {1});
  s.set(arm.id(), "enabled", {0});
  EXPECT_NE(s.world.state_hash(), hash);
}

TEST(WorldTest, HashCoversNamesAndOrderOfBodies) {
  const auto hash = [](const std::vector<std::string>& names) {
    WorldFixture s;
    for (const std::string& name : names) s.part(s.body(name), sphere_model(0.1), 1);
    s.world.flush();
    return s.world.state_hash();
  };
  EXPECT_EQ(hash({"a", "b"}), hash({"a", "b"}));
  EXPECT_NE(hash({"a", "b"}), hash({"b", "a"}));
  EXPECT_NE(hash({"a", "b"}), hash({"a", "c"}));
  EXPECT_NE(hash({"a", "b"}), hash({"a"}));
}

TEST(WorldTest, ClearLeavesAnEmptyUsableWorld) {
  WorldFixture s;
  const std::uint64_t empty = [&] {
    s.world.clear();
    return s.world.state_hash();
  }();
  for (int i = 0; i < 3; i++) {
    s.gravity({1, 2, 3});
    s.substeps(9);
    s.floor();
    make_arm(s, "arm");
    s.ticks(5);
    s.world.clear();
    s.world.restart_time();
    EXPECT_TRUE(s.world.bodies().empty());
    EXPECT_TRUE(s.world.shapes().list().empty());
    EXPECT_EQ(s.world.bullet().getNumCollisionObjects(), 0);
    EXPECT_EQ(s.world.state_hash(), empty);
    EXPECT_EQ(s.vec(s.world.id(), "gravity"), Vec3(0, 0, -9.81));
    EXPECT_EQ(s.number(s.world.id(), "substeps"), 4);
  }
}

TEST(WorldTest, TimeIsTicksTimesTimestep) {
  WorldFixture s;
  s.ticks(1000);
  EXPECT_EQ(s.world.time(), 1000 * s.world.timestep());
  const double before = s.world.time();
  s.set(s.world.id(), "timestep", {0.01});
  s.ticks(700);
  EXPECT_EQ(s.world.time(), before + 700 * s.world.timestep());
  s.world.restart_time(5, 2);
  s.ticks(300);
  EXPECT_EQ(s.world.time(), 2 + 300 * s.world.timestep());
}

TEST(WorldTest, ResetRequestIsConsumedOnce) {
  WorldFixture s;
  EXPECT_FALSE(std::exchange(s.world.requests().reset, false));
  ASSERT_TRUE(World::table().at("reset").invoke(&s.world, {}));
  EXPECT_TRUE(std::exchange(s.world.requests().reset, false));
  EXPECT_FALSE(std::exchange(s.world.requests().reset, false));
}

TEST(WorldTest, FlushAppliesValuesWithoutAdvancingTime) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm", {2});
  arm.set_pose({{0, 0, 5}, quat_identity()});
  s.world.flush();
  EXPECT_EQ(s.world.time(), 0);
  EXPECT_EQ(s.world.tick(), 0u);
  EXPECT_NEAR(s.vec(arm.joints()[1]->id(), "position").z, 5 + 0.5 - 0.125, 1e-6);
  EXPECT_EQ(arm.parts()[2]->linear_velocity(), Vec3(0));
}

TEST(WorldTest, JointReadoutsAreRightHanded) {
  WorldFixture s;
  Body& robot = s.body("robot");
  Part& base = s.part(robot, sphere_model(0.05), 0, {{1, 0, 0}, quat_identity()});
  Part& arm = s.part(robot, box_model({0.4, 0.1, 0.1}), 1, {{1.3, 0, 0}, quat_identity()});
  Joint& joint = *robot.add_joint("joint", base, arm, model::JointType::revolute, {1.1, 0, 0}, {0, 0, 1}).value();
  const Pose pivot{{1.1, 0, 0}, quat_axis({0, 0, 1}, 0.6)};
  arm.set_pose(pivot * Pose{{0.2, 0, 0}, quat_identity()});
  s.set(arm.id(), "angular_velocity", {0, 0, 2});
  const Vec3 speed = glm::cross(Vec3(0, 0, 2), arm.pose().position - pivot.position);
  s.set(arm.id(), "linear_velocity", {speed.x, speed.y, speed.z});
  s.world.flush();
  EXPECT_NEAR(s.number(joint.id(), "value"), 0.6, 1e-6);
  EXPECT_NEAR(s.number(joint.id(), "speed"), 2, 1e-5);
  EXPECT_NEAR(s.vec(joint.id(), "angles").z, 0.6, 1e-6);
  EXPECT_NEAR(s.vec(joint.id(), "relrot").z, 0.6, 1e-6);
  EXPECT_LT(glm::length(s.vec(joint.id(), "offsets")), 1e-6);
  EXPECT_LT(glm::length(s.vec(joint.id(), "position") - Vec3(1.1, 0, 0)), 1e-6);
  EXPECT_LT(glm::length(s.vec(joint.id(), "axis") - Vec3(0, 0, 1)), 1e-6);
  const std::vector<double> q = s.get(joint.id(), "rotation");
  EXPECT_NEAR(q[2], std::sin(0.3), 1e-6);
  EXPECT_NEAR(q[3], std::cos(0.3), 1e-6);
}

// A joint between two bodies of which one can't rotate about any axis, which the direct solver doesn't support.
TEST(WorldTest, CountsStepsLeftToTheIterativeSolver) {
  WorldFixture s;
  s.set(s.world.id(), "solver", {1});
  Body& robot = s.body("robot");
  Part& a = s.part(robot, box_model(Vec3(0.2)), 1);
  Part& b = s.part(robot, box_model(Vec3(0.2)), 1, {{0.3, 0, 0}, quat_identity()});
  (void)robot.add_joint("hinge", a, b, model::JointType::revolute, {0.15, 0, 0}, {0, 1, 0}).value();
  s.ticks(2);
  EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 0);
  b.rigid().setAngularFactor(btVector3(0, 0, 0));
  s.ticks(2);
  EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), 8);  // 2 ticks of 4 steps
}

// A joint that is rotated to a singular position is left to the iterative solver for that step, with its whole
// island.
TEST(WorldTest, ASingularJointFallsBackToTheIterativeSolver) {
  std::vector<Vec3> swept;
  for (const double solver : {0.0, 1.0}) {
    WorldFixture s;
    s.set(s.world.id(), "solver", {solver});
    s.set(s.world.id(), "substeps", {1});
    Body& robot = s.body("robot");
    Part& a = s.part(robot, box_model(Vec3(0.2)), 1);
    Part& b = s.part(robot, box_model(Vec3(0.2)), 1, {{0.3, 0, 0}, quat_identity()});
    (void)robot.add_joint("weld", a, b, model::JointType::fixed, {0.15, 0, 0}, {0, 1, 0}).value();
    Body& other = s.body("other");
    Part& c = s.part(other, box_model(Vec3(0.2)), 1, {{0, 0, 0.19}, quat_identity()});
    Part& d = s.part(other, box_model(Vec3(0.2)), 1, {{0.3, 0, 0.6}, quat_identity()});
    (void)other.add_joint("hinge", c, d, model::JointType::revolute, {0.15, 0, 0.4}, {0, 1, 0}).value();
    b.set_pose({{0.3, 0, 0}, quat_axis({0, 0, 1}, kPi / 2)});
    s.ticks(1);
    EXPECT_EQ(s.number(s.world.id(), "solver_fallbacks"), solver);
    if (solver == 0) swept = {a.linear_velocity(), b.linear_velocity(), c.linear_velocity(), d.linear_velocity()};
    EXPECT_EQ(a.linear_velocity(), swept[0]) << solver;
    EXPECT_EQ(b.linear_velocity(), swept[1]) << solver;
    EXPECT_EQ(c.linear_velocity(), swept[2]) << solver;
    EXPECT_EQ(d.linear_velocity(), swept[3]) << solver;
  }
}

}  // namespace
}  // namespace limber::sim
