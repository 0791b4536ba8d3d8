// Conveyors: parts with a surface velocity, with closed forms of the slip.
#include <cmath>

#include "sim/stage.h"

namespace limber::sim::test {
namespace {

constexpr double kBeltGravity = 9.81;

// A crate put on a belt of speed v is accelerated by mu·g until it has that speed, after slipping by v²/(2·mu·g).
TEST(SurfaceVelocity, BeltAcceleratesACrate) {
  for (const bool direct : {true, false}) {
    for (const double v : {0.5, 1.5}) {
      for (const double mu : {0.25, 0.64}) {
        WorldFixture s;
        s.set(s.world.id(), "solver", {direct ? 1.0 : 0.0});
        s.gravity({0, 0, -kBeltGravity});
        // a belt that lies across: its frame is turned, so that its x is the world's y
        Part& belt = s.add_single_part(box_model({20, 2, 0.2}), 0, {{0, 0, -0.1}, quat_axis({0, 0, 1}, kPi / 2)});
        Part& crate = s.add_single_part(box_model({0.4, 0.4, 0.1}), 2, {{0, 0, 0.05}, quat_identity()});
        s.set(belt.id(), "friction", {mu});
        s.set(crate.id(), "friction", {1});
        s.ticks(10);
        s.set(belt.id(), "surface_velocity", {v, 0, 0});
        const int ticks = 240;
        s.ticks(ticks);
        EXPECT_NEAR(crate.linear_velocity().y, v, 1e-3) << direct << " " << v << " " << mu;
        EXPECT_NEAR(crate.linear_velocity().x, 0, 1e-3);
        const double slip = v * ticks / 60 - crate.pose().position.y;
        EXPECT_NEAR(slip, v * v / (2 * mu * kBeltGravity), 0.02 * v * v + 1e-3) << direct << " " << v << " " << mu;
        EXPECT_EQ(belt.linear_velocity(), Vec3(0));
      }
    }
  }
}

// A cart whose surface moves backwards relative to itself drives on a floor at that speed.
TEST(SurfaceVelocity, DrivesADynamicPart) {
  WorldFixture s;
  s.gravity({0, 0, -kBeltGravity});
  s.floor();
  Part& crawler = s.add_single_part(box_model({0.4, 0.4, 0.1}), 2, {{0, 0, 0.05}, quat_identity()});
  s.set(crawler.id(), "surface_velocity", {-0.6, 0, 0});
  s.ticks(120);
  EXPECT_NEAR(crawler.linear_velocity().x, 0.6, 1e-3);
  s.set(crawler.id(), "surface_velocity", {0, 0, 0});
  s.ticks(60);
  EXPECT_NEAR(crawler.linear_velocity().x, 0, 1e-3);
}

TEST(SurfaceVelocity, WakesACrate) {
  WorldFixture s;
  s.gravity({0, 0, -kBeltGravity});
  Part& belt = s.add_single_part(box_model({20, 2, 0.2}), 0, {{0, 0, -0.1}, quat_identity()});
  Part& crate = s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()});
  s.ticks(200);
  ASSERT_TRUE(crate.asleep());
  s.set(belt.id(), "surface_velocity", {0.2, 0, 0});
  s.ticks(60);
  EXPECT_NEAR(crate.linear_velocity().x, 0.2, 1e-3);
}

// gravity_factor scales the fall of the bodies that have it, and of no others.
TEST(GravityFactor, ScalesTheFall) {
  WorldFixture s;
  s.gravity({0, 0, -kBeltGravity});
  Part& plain = s.add_single_part(sphere_model(0.1), 1);
  std::vector<std::pair<double, Part*>> parts;
  for (const double factor : {0.0, 0.5, 1.0, -2.0}) {
    Part& part =
        s.add_single_part(sphere_model(0.1), 3, {{static_cast<double>(parts.size()) + 1, 0, 0}, quat_identity()});
    s.set(part.body().id(), "gravity_factor", {factor});
    parts.emplace_back(factor, &part);
  }
  s.ticks(60);
  EXPECT_NEAR(plain.linear_velocity().z, -kBeltGravity, 1e-4);
  for (const auto& [factor, part] : parts) EXPECT_NEAR(part->linear_velocity().z, -kBeltGravity * factor, 1e-4);
  // after a change of the world's gravity and of the mass as well
  s.gravity({1, 0, 0});
  s.set(parts[1].second->id(), "mass", {7});
  s.ticks(60);
  for (const auto& [factor, part] : parts) EXPECT_NEAR(part->linear_velocity().x, factor, 1e-4);
}

// A factor of 1 changes nothing, to the bit.
TEST(GravityFactor, OfOneChangesNothing) {
  std::vector<Vec3> ends;
  for (const bool set : {false, true}) {
    WorldFixture s;
    s.gravity({0.3, 0, -kBeltGravity});
    Part& part = s.add_single_part(box_model({0.2, 0.3, 0.4}), 3);
    if (set) {
      s.set(part.body().id(), "gravity_factor", {0});
      s.world.flush();
      s.set(part.body().id(), "gravity_factor", {1});
    }
    s.ticks(60);
    ends.push_back(part.pose().position);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

// A sleeping ball that loses its weight stays; one that gets a negative weight rises.
TEST(GravityFactor, Wakes) {
  WorldFixture s;
  s.gravity({0, 0, -kBeltGravity});
  s.floor();
  Part& crate = s.add_single_part(box_model(Vec3(0.2)), 1, {{0, 0, 0.1}, quat_identity()});
  s.ticks(200);
  ASSERT_TRUE(crate.asleep());
  s.set(crate.body().id(), "gravity_factor", {-1});
  s.ticks(60);
  EXPECT_NEAR(crate.linear_velocity().z, kBeltGravity, 0.1);
}

}  // namespace
}  // namespace limber::sim::test
