// Rig: a stage with balls to push, and what behaviours ask of them in one step, read before Bullet sees it.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sim/stage.h"

namespace limber::test {

struct Rig : Stage {
  /// One step of all behaviours, without physics: loads add up until `loads` is read.
  void act() { world.behaviors().step(world.timestep()); }
  Vec3 force(const Part& part) { return world.loads().load(part.load_place()).force; }
  Vec3 torque(const Part& part) { return world.loads().load(part.load_place()).torque; }
  void clear(Part& part) { part.clear_forces(); }

  Part& ball(Body& body, const Vec3& at, double mass = 1) {
    return part(body, sphere_model(0.01), mass, {at, quat_identity()});
  }
  /// A body of one ball.
  Part& loose(const Vec3& at, double mass = 1) { return lone(sphere_model(0.01), mass, {at, quat_identity()}); }

  Behavior& add(Body& body, const std::string& type, BehaviorSetup setup = {}) {
    Result<Behavior*> made = world.behaviors().add(body, type, type + std::to_string(count_++), std::move(setup));
    EXPECT_TRUE(made.ok()) << made.error();
    return **made;
  }
  BehaviorGroup& add_group(const std::string& type, GroupSetup setup = {}) {
    Result<BehaviorGroup*> made = world.behaviors().add_group(type, type + std::to_string(count_++), std::move(setup));
    EXPECT_TRUE(made.ok()) << made.error();
    return **made;
  }

  /// Draws of the test's own, never of the code that is tested.
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

inline void expect_near(const Vec3& is, const Vec3& wanted, double tolerance, const std::string& what = "") {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(is[i], wanted[i], tolerance) << what << " axis " << i;
}

}  // namespace limber::test
