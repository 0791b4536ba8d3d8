// Rig: a world with balls, and access to the forces that behaviors apply in one step, before Bullet's step.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sim/stage.h"

namespace limber::sim::test {

struct Rig : WorldFixture {
  /// Steps all behaviors once, without physics: forces accumulate until they are read.
  void step_behaviors() { world.behaviors().step(world.timestep()); }
  Vec3 force(const Part& part) { return world.force_accumulators().wrench(part.accumulator_index()).force; }
  Vec3 torque(const Part& part) { return world.force_accumulators().wrench(part.accumulator_index()).torque; }
  void clear(Part& part) { part.clear_forces(); }

  Part& ball(Body& body, const Vec3& at, double mass = 1) {
    return part(body, sphere_model(0.01), mass, {at, quat_identity()});
  }
  /// A body of one ball.
  Part& single_ball(const Vec3& at, double mass = 1) {
    return add_single_part(sphere_model(0.01), mass, {at, quat_identity()});
  }

  Behavior& add(Body& body, const std::string& type, BehaviorSetup setup = {}) {
    Result<Behavior*> added = world.behaviors().add(body, type, type + std::to_string(count_++), std::move(setup));
    EXPECT_TRUE(added.ok()) << added.error();
    return **added;
  }
  BehaviorGroup& add_group(const std::string& type, GroupSetup setup = {}) {
    Result<BehaviorGroup*> added = world.behaviors().add_group(type, type + std::to_string(count_++), std::move(setup));
    EXPECT_TRUE(added.ok()) << added.error();
    return **added;
  }

  /// Random numbers of the test itself, independent of the tested code.
  double draw(double a, double b) { return std::uniform_real_distribution<double>(a, b)(draws_); }
  Vec3 draw3(double a, double b) {
    const double x = draw(a, b);
    const double y = draw(a, b);
    return {x, y, draw(a, b)};
  }
  static std::vector<double> list(const Vec3& v) { return {v.x, v.y, v.z}; }

 private:
  std::mt19937 draws_{7};
  int count_ = 0;
};

inline void expect_near(const Vec3& actual, const Vec3& expected, double tolerance, const std::string& label = "") {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(actual[i], expected[i], tolerance) << label << " axis " << i;
}

}  // namespace limber::sim::test
