// Stability check: an unstable body is restored the first time, disabled the second time, and enabled by reset.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/arm.h"
#include "sim/bullet/island_world.h"
#include "sim/stage.h"
#include "support/skip.h"

namespace limber::sim {
namespace {

using namespace test;

bool all_finite(const WorldFixture& s) {
  for (const double v : s.store.transient_values()) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

std::string last_log_line() { return log_since(0).back().text; }

TEST(Health, RestoresThenDisablesThenResetEnables) {
  WorldFixture s;
  Part& ball = s.add_single_part(box_model({0.1, 0.2, 0.05}), 1, {{1, 2, 3}, quat_identity()});
  Part& other = s.add_single_part(sphere_model(0.1), 1, {{5, 0, 0}, quat_identity()});
  s.set(other.id(), "linear_velocity", {0, 1, 0});
  s.ticks(5);
  s.set(ball.id(), "linear_velocity", {600, 0, 0});
  s.ticks(1);
  EXPECT_EQ(last_log_line(),
            "body '" + ball.body().name() + "': part '" + ball.name() +
                "' is faster than 500 m/s; the body is restored to its last good pose, at rest; likely "
                "cause: a velocity, position, force or impulse that is too large; try a smaller one");
  EXPECT_EQ(s.world.stability().events(), 1u);
  EXPECT_EQ(ball.pose().position, Vec3(1, 2, 3));
  EXPECT_EQ(ball.linear_velocity(), Vec3(0));
  EXPECT_TRUE(ball.body().enabled());

  s.set(ball.id(), "angular_velocity", {700, 700, 700});
  s.ticks(1);
  EXPECT_EQ(last_log_line(),
            "body '" + ball.body().name() + "': part '" + ball.name() +
                "' tumbles faster than 1000 rad/s again; the body is disabled (reset or enabled = true enables it); "
                "likely cause: a velocity, position, force or impulse that is too large; try a smaller one");
  EXPECT_EQ(s.world.stability().events(), 2u);
  EXPECT_FALSE(ball.body().enabled());
  s.ticks(3);
  EXPECT_EQ(s.world.bullet().getNumCollisionObjects(), 1);
  // the others continue
  EXPECT_NEAR(other.pose().position.y, 10.0 / 60, 1e-5);

  ball.body().recovery().reset();
  s.set(ball.id(), "linear_velocity", {1, 0, 0});
  s.ticks(6);
  EXPECT_TRUE(ball.body().enabled());
  EXPECT_NEAR(ball.pose().position.x, 1.1, 1e-5);
  EXPECT_EQ(s.world.stability().events(), 2u);
}

// A body restored in the first substep of a tick falls in the remaining ones; in the only step, from the next
// tick on.
TEST(Health, RestoredBodyFallsLikeAnyOther) {
  for (const int substeps : {1, 4}) {
    WorldFixture s;
    s.set(s.world.id(), "substeps", {static_cast<double>(substeps)});
    s.set(s.world.id(), "gravity", {0, 0, -9.81});
    Part& ball = s.add_single_part(sphere_model(0.1), 1);
    s.set(ball.id(), "linear_velocity", {600, 0, 0});
    s.ticks(1);
    ASSERT_EQ(s.world.stability().events(), 1u);
    const double left = (substeps - 1.0) / substeps;
    EXPECT_NEAR(ball.linear_velocity().z, -9.81 / 60 * left, 1e-5) << substeps;
    s.ticks(1);
    EXPECT_NEAR(ball.linear_velocity().z, -9.81 / 60 * (1 + left), 1e-5) << substeps;
  }
}

TEST(Health, EachLimitIsAsDocumented) {
  const Vec3 along(0, 1, 0);
  const struct {
    const char* property;
    double good, bad;
    Vec3 direction;
  } cases[] = {{"linear_velocity", 499, 501, along},
               {"angular_velocity", 700, 1001, Vec3(0.6, 0, 0.8)},
               {"angular_velocity", 9999, 20001, along},
               {"position", 9990, 10001, along}};
  for (const auto& c : cases) {
    for (const double v : {c.good, c.bad}) {
      WorldFixture s;
      Part& box = s.add_single_part(box_model({0.1, 0.2, 0.05}), 1);
      s.ticks(1);
      const Vec3 value = c.direction * v;
      if (std::string_view(c.property) == "angular_velocity") {
        box.rigid().setAngularVelocity(bullet::to_bt(value));
      } else {
        s.set(box.id(), c.property, {value.x, value.y, value.z});
      }
      s.ticks(1);
      EXPECT_EQ(s.world.stability().events(), v == c.bad ? 1u : 0u) << c.property << " " << v;
    }
  }
}

// A chain of light links with a heavy end, which one iteration of the iterative solver can't hold.
TEST(Health, ReportsASeparatedJointWithItsCause) {
  WorldFixture s;
  s.set(s.world.id(), "solver", {0});
  s.iterations(1);
  s.gravity({0, 0, -9.81});
  Body& chain = s.body("chain");
  Part* above = &s.part(chain, box_model(Vec3(0.1)), 0);
  const auto add_link = [&](const char* name, double z, double mass) {
    Part& part = s.part(chain, box_model(Vec3(0.05, 0.05, 0.09)), mass, {{0, 0, z}, quat_identity()});
    (void)chain.add_joint(name, *above, part, model::JointType::spherical, Vec3(0, 0, z + 0.05), Vec3(0, 0, 1)).value();
    above = &part;
  };
  for (int i = 0; i < 8; i++) add_link(("link" + std::to_string(i)).c_str(), -0.1 * (i + 1), 0.01);
  add_link("load", -0.9, 100);
  for (int tick = 0; tick < 120 && s.world.stability().events() == 0; tick++) s.ticks(1);
  ASSERT_EQ(s.world.stability().events(), 1u);
  const std::string line = last_log_line();
  EXPECT_NE(line.find("body 'chain': joint 'l"), std::string::npos) << line;
  EXPECT_NE(line.find("' has come apart by 0."), std::string::npos) << line;
  EXPECT_NE(line.find("likely cause: mass ratio 10000:1 at joint 'load'; try substeps = 8"), std::string::npos) << line;
  EXPECT_TRUE(chain.enabled());
}

TEST(Health, PartsThatAreMovedApartRecoverWithoutAnEvent) {
  WorldFixture s;
  Body& pair = s.body("pair");
  Part& a = s.part(pair, box_model(Vec3(0.1)), 1);
  Part& b = s.part(pair, box_model(Vec3(0.1)), 1, {{0.1, 0, 0}, quat_identity()});
  Joint& joint = *pair.add_joint("joint", a, b, model::JointType::spherical, Vec3(0.05, 0, 0), Vec3(0, 0, 1)).value();
  s.ticks(1);
  s.set(b.id(), "position", {1.1, 0, 0});
  s.ticks(60);
  EXPECT_EQ(s.world.stability().events(), 0u);
  EXPECT_LT(joint.gap(), 0.01);
}

TEST(Health, SettingEnabledRestoresABody) {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  for (int i = 0; i < 2; i++) {
    s.ticks(1);
    s.set(ball.id(), "linear_velocity", {0, 0, 600});
    s.ticks(1);
  }
  EXPECT_FALSE(ball.body().enabled());
  s.set(ball.body().id(), "enabled", {1});
  s.set(ball.id(), "linear_velocity", {0, 0, 6});
  s.ticks(10);
  EXPECT_NEAR(ball.pose().position.z, 1, 1e-4);
}

TEST(Health, SurvivesHugeForcesAndTorques) {
  for (const double solver : {0.0, 1.0}) {
    for (const double amount : {1e12, 1e30, 1e300}) {
      for (const bool torque : {false, true}) {
        WorldFixture s;
        s.set(s.world.id(), "solver", {solver});
        s.gravity({0, 0, -9.81});
        s.floor();
        Body& arm = make_arm(s, "arm", {4, {0, 0, 0.5}, false});
        Body& near = make_arm(s, "near", {4, {0.08, 0, 0.5}, false});  // touching
        Body& far = make_arm(s, "far", {4, {9, 0, 0}, true});
        s.ticks(3);
        const double before = far.joints()[2]->value();
        torque ? arm.parts()[2]->apply_torque({amount, -amount, 1}) : arm.parts()[2]->apply_force({amount, -amount, 1});
        s.ticks(1);
        EXPECT_GE(s.world.stability().events(), 1u);
        EXPECT_TRUE(all_finite(s)) << amount;
        s.ticks(30);
        EXPECT_TRUE(all_finite(s)) << amount;
        EXPECT_NEAR(far.joints()[2]->value(), before, 1e-3);
        EXPECT_TRUE(far.enabled());
        // one impulse restores a body, but doesn't disable it
        EXPECT_TRUE(arm.enabled()) << amount;
        EXPECT_TRUE(near.enabled()) << amount;
      }
    }
  }
}

TEST(Health, PersistentForceDisablesTheBody) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {4});
  for (int i = 0; i < 5; i++) {
    arm.parts()[3]->apply_force({1e30, 0, 0});
    s.ticks(1);
  }
  EXPECT_FALSE(arm.enabled());
  EXPECT_EQ(s.world.stability().events(), 2u);
  EXPECT_TRUE(all_finite(s));
  arm.recovery().reset();
  s.ticks(60);
  EXPECT_TRUE(arm.enabled());
  for (const auto& joint : arm.joints()) EXPECT_NEAR(joint->value(), 0, 1e-3);
}

TEST(Health, InstabilityInTheFirstTickRestoresTheStartPose) {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 7}, quat_identity()});
  ball.apply_force({1e20, 0, 0});
  s.ticks(1);
  EXPECT_EQ(ball.pose().position, Vec3(0, 0, 7));
  EXPECT_TRUE(all_finite(s));
}

// Simulates eight boxes, eight balls and two arms that overlap. Returns the largest distance from the origin and the
// largest height after four seconds, m.
std::pair<double, double> separate_overlapping(double solver, double height) {
  WorldFixture s;
  s.set(s.world.id(), "solver", {solver});
  s.gravity({0, 0, -9.81});
  s.floor();
  for (int i = 0; i < 8; i++) {
    s.add_single_part(box_model({0.4, 0.3, 0.2}), 1, {{0, 0, height}, quat_identity()});
    s.add_single_part(sphere_model(0.2), 1, {{0, 0, height}, quat_identity()});
  }
  Body& arm = make_arm(s, "arm", {4, {0, 0, 0.3}, false});
  Body& twin = **s.world.copy_body(arm, "twin");
  s.ticks(240);
  EXPECT_TRUE(all_finite(s));
  EXPECT_LT(s.world.stability().events(), 2u);
  EXPECT_GT(glm::length(arm.pose().position - twin.pose().position), 0.01);
  double farthest = 0;
  double highest = 0;
  for (const auto& body : s.world.bodies()) {
    if (body->root()->is_static()) continue;
    EXPECT_GT(body->pose().position.z, -0.2);
    highest = std::max(highest, body->pose().position.z);
    farthest = std::max(farthest, glm::length(body->pose().position));
  }
  return {farthest, highest};
}

// The balls' directions are random, so several heights are tested.
TEST(Health, DeepOverlapsSeparateWithoutExplosion) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of contacts execute the same code");
  for (const double solver : {0.0, 1.0}) {
    std::vector<double> farthest;
    std::vector<double> highest;
    for (int i = 0; i < 9; ++i) {
      const auto [far, high] = separate_overlapping(solver, 0.5 + 0.01 * i);
      farthest.push_back(far);
      highest.push_back(high);
    }
    for (std::vector<double>* values : {&farthest, &highest}) std::sort(values->begin(), values->end());
    EXPECT_LT(farthest[4], 80) << "balls may roll away at 20 m/s, not fly, solver " << solver;
    EXPECT_LT(highest[4], 2) << solver;
    EXPECT_LT(highest[8], solver > 0 ? 60 : 2) << solver;
  }
}

// The arm starts inside a static box with its motors running: no motion satisfies its joints, motors and contacts
// together. Contact rows that the joints can't satisfy yield by their minimal softness.
TEST(Health, ArmInsideAWallStaysTogetherInBothSolvers) {
  struct Wall {
    double side, x;
  };
  std::vector<Wall> walls;
  for (const double side : {0.6, 0.8, 1.0, 1.1}) {
    for (const double x : {0.0, 0.04, 0.08, 0.13}) walls.push_back({side, x});
  }
  for (const double solver : {0.0, 1.0}) {
    double fallbacks = 0;
    std::uint64_t instabilities = 0;
    for (const Wall wall : walls) {
      WorldFixture s;
      s.set(s.world.id(), "solver", {solver});
      s.set(s.world.id(), "substeps", {1});
      s.gravity({0, 0, -9.81});
      s.add_single_part(box_model(Vec3(wall.side)), 0, {{wall.x, 0.13, 0.3}, quat_identity()});
      Body& arm = make_arm(s, "arm", {17, {0, 0, 0.1}, true});
      const std::uint64_t begin = log_newest();
      for (int tick = 0; tick < 120; tick++) {
        set_wave_targets(s, arm, tick / 15.0);
        s.ticks(1);
      }
      EXPECT_TRUE(all_finite(s));
      // joints that come apart inside the wall are reported too; only instabilities by speed count here
      for (const auto& line : log_since(begin)) {
        const bool event = line.text.find("likely cause") != std::string::npos;
        instabilities += event && line.text.find("has come apart") == std::string::npos ? 1 : 0;
      }
      fallbacks += s.number(s.world.id(), "solver_fallbacks");
    }
    EXPECT_EQ(instabilities, 0u);
    EXPECT_EQ(fallbacks, 0);
  }
}

TEST(Health, RejectsNanValues) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {2});
  s.ticks(1);
  const std::uint64_t hash = s.world.state_hash();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const std::vector<double> v = {bad, 0, 0};
    const std::vector<double> q = {0, bad, 0, 1};
    for (const char* property : {"position", "linear_velocity", "angular_velocity"}) {
      EXPECT_FALSE(s.store.set(arm.id(), property, v)) << property;
      EXPECT_FALSE(s.store.set(arm.parts()[1]->id(), property, v)) << property;
    }
    EXPECT_FALSE(s.store.set(arm.id(), "rotation", q));
    EXPECT_FALSE(s.store.set(arm.parts()[1]->id(), "rotation", q));
    EXPECT_FALSE(s.store.set(arm.motors()[0]->id(), "target", {&bad, 1}));
  }
  s.world.flush();
  EXPECT_EQ(s.world.state_hash(), hash);
}

TEST(Health, SurvivesExtremeValuesOfAllProperties) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Body& arm = make_arm(s, "arm", {5, {0, 0, 0.5}, true});
  // sets each property of every node to both ends of its range, one after the other
  for (const bool high : {false, true}) {
    std::vector<NodeId> nodes;
    s.store.walk(arm.id(), [&](NodeId id) { nodes.push_back(id); });
    for (const NodeId id : nodes) {
      for (const Property& property : s.store.table(id).properties()) {
        if (!property.writable() || property.type == PropertyType::quat || property.name == "enabled") continue;
        (void)s.store.set(id, property, std::vector<double>(property.width, high ? property.max : property.min));
      }
      s.ticks(1);
      ASSERT_TRUE(all_finite(s)) << s.store.path(id);
    }
  }
  s.ticks(10);
  EXPECT_TRUE(all_finite(s));
}

}  // namespace
}  // namespace limber::sim
