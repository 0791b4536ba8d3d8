// Contact manifolds: complete in one step for every shape, on planes and boxes, at rest and sliding.
#include "sim/collision/manifold_builder.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/stage.h"

namespace limber::sim::manifold_test {
namespace {

using namespace test;

constexpr double kG = 9.81;

model::ShapeModel hull_model(const std::vector<Vec3>& points, const Vec3& box) {
  auto mesh = std::make_shared<model::MeshModel>();
  mesh->hull = mesh->vertices = points;
  mesh->unit_inertial = {1, Vec3(0), Mat3(0)};
  const Vec3 moments = box_inertia(1, box);
  for (int i = 0; i < 3; i++) mesh->unit_inertial.tensor[i][i] = moments[i];
  mesh->closed = true;
  model::ShapeModel m;
  m.kind = model::ShapeKind::mesh;
  m.mesh = mesh;
  return m;
}

model::ShapeModel hull_box(const Vec3& size) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; i++) points.push_back(size * Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5));
  return hull_model(points, size);
}

model::ShapeModel hull_prism(double radius, double height, int corners) {
  std::vector<Vec3> points;
  for (int i = 0; i < corners; i++) {
    const double angle = 2 * kPi * i / corners;
    for (const double z : {-height / 2, height / 2}) {
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  return hull_model(points, {2 * radius, 2 * radius, height});
}

struct Solid {
  const char* name;
  model::ShapeModel model;
  double half;  // height of its center above the surface
};

std::vector<Solid> standing_solids() {
  return {{"box", box_model({0.4, 0.4, 0.1}), 0.05},
          {"hull", hull_box({0.4, 0.4, 0.1}), 0.051},  // hulls are larger by a margin of 1 mm
          {"prism of 24 sides", hull_prism(0.2, 0.1, 24), 0.051},
          {"cylinder", round_model(model::ShapeKind::cylinder, 0.2, 0.1), 0.05}};
}

enum class Floor { plane, box, hull };
constexpr Floor kFloors[] = {Floor::plane, Floor::box, Floor::hull};

void add_floor(WorldFixture& s, Floor floor, double friction) {
  const Vec3 size(40, 40, 1);
  Part& part = floor == Floor::plane ? s.floor()
               : floor == Floor::box ? s.add_single_part(box_model(size), 0, {{0, 0, -0.5}, quat_identity()})
                                     : s.add_single_part(hull_box(size), 0, {{0, 0, -0.501}, quat_identity()});
  s.set(part.id(), "friction", {friction});
}

double tilt_degrees(const Part& part) {
  return std::acos(std::min(1.0, (part.pose().rotation * Vec3(0, 0, 1)).z)) * 180 / kPi;
}

// Dropped from heights for which the step of the impact starts at any distance.
TEST(ContactManifold, SolidsLandingFlatStayLevel) {
  for (const Solid& solid : standing_solids()) {
    for (const Floor floor : kFloors) {
      for (const double height : {0.05, 0.497, 1.0, 1.009}) {
        SCOPED_TRACE(::testing::Message()
                     << solid.name << " on floor " << static_cast<int>(floor) << " from " << height);
        WorldFixture s;
        s.gravity({0, 0, -kG});
        add_floor(s, floor, 1);
        Part& part = s.add_single_part(solid.model, 1, {{0, 0, height + solid.half}, quat_axis({0, 0, 1}, 0.3)});
        double lowest = 0;
        double max_tilt = 0;
        for (int i = 0; i < 40; i++) {
          s.ticks(1);
          lowest = std::min(lowest, part.pose().position.z - solid.half);
          max_tilt = std::max(max_tilt, tilt_degrees(part));
        }
        EXPECT_GT(lowest, -0.003);
        EXPECT_LT(max_tilt, 0.1);
        EXPECT_NEAR(part.pose().position.z, solid.half, 1e-3);
      }
    }
  }
}

// Pushed along a level floor they stop after v²/(2·mu·g), straight, without rotation or penetration.
TEST(ContactManifold, SlidingSolidsDoNotSinkOrTurn) {
  const double mu = 0.5;
  for (const Solid& solid : standing_solids()) {
    for (const Floor floor : kFloors) {
      for (const double v : {1.0, 5.0, 10.0}) {
        SCOPED_TRACE(::testing::Message() << solid.name << " on floor " << static_cast<int>(floor) << " at " << v);
        WorldFixture s;
        s.gravity({0, 0, -kG});
        add_floor(s, floor, mu);
        Part& part = s.add_single_part(solid.model, 1, {{0, 0, solid.half}, quat_identity()});
        s.set(part.id(), "friction", {1});
        s.set(part.id(), "linear_velocity", {v, 0, 0});
        double lowest = 0;
        double max_tilt = 0;
        const int ticks = static_cast<int>(60 * v / (mu * kG)) + 10;
        for (int i = 0; i < ticks; i++) {
          s.ticks(1);
          lowest = std::min(lowest, part.pose().position.z - solid.half);
          max_tilt = std::max(max_tilt, tilt_degrees(part));
        }
        const double distance = v * v / (2 * mu * kG);
        EXPECT_NEAR(part.pose().position.x, distance, 0.01 * distance + 0.01);
        EXPECT_NEAR(part.pose().position.y, 0, 0.002 * distance + 0.001);
        const Vec3 ahead = part.pose().rotation * Vec3(1, 0, 0);
        EXPECT_NEAR(std::atan2(ahead.y, ahead.x), 0, 0.005);
        EXPECT_GT(lowest, -1e-3);
        EXPECT_LT(max_tilt, 0.1);
      }
    }
  }
}

// Gravity is tilted instead of the floor: they slide with g·(sin t - mu·cos t).
TEST(ContactManifold, HullsSlideDownSlopes) {
  for (const Floor floor : kFloors) {
    for (const double degrees : {10.0, 20.0, 30.0, 40.0}) {
      for (const Solid& solid : standing_solids()) {
        SCOPED_TRACE(::testing::Message()
                     << solid.name << " on floor " << static_cast<int>(floor) << " at " << degrees);
        const double slope = degrees * kPi / 180;
        const double mu = 0.5 * std::tan(slope);
        WorldFixture s;
        s.gravity({kG * std::sin(slope), 0, -kG * std::cos(slope)});
        add_floor(s, floor, mu);
        Part& part = s.add_single_part(solid.model, 1, {{0, 0, solid.half}, quat_identity()});
        s.set(part.id(), "friction", {1});
        s.ticks(10);
        const double before = part.linear_velocity().x;
        s.ticks(60);
        const double expected = kG * (std::sin(slope) - mu * std::cos(slope));
        EXPECT_NEAR(part.linear_velocity().x - before, expected, 0.02 * expected);
      }
    }
  }
}

// A cylinder on its side and a cone touch along a line: they roll straight at any heading.
TEST(ContactManifold, CylindersRollStraight) {
  for (const Floor floor : kFloors) {
    for (const double heading : {0.0, 0.4, 1.1}) {
      SCOPED_TRACE(::testing::Message() << static_cast<int>(floor) << " heading " << heading);
      WorldFixture s;
      s.gravity({0, 0, -kG});
      add_floor(s, floor, 1);
      const Quat turn = quat_axis({0, 0, 1}, heading);
      Part& part = s.add_single_part(round_model(model::ShapeKind::cylinder, 0.1, 0.3), 1,
                                     {{0, 0, 0.1}, turn * quat_axis({1, 0, 0}, kPi / 2)});
      s.set(part.id(), "friction", {1});
      const Vec3 ahead = turn * Vec3(1, 0, 0);
      part.set_velocity(2.0 * ahead, turn * Vec3(0, 20, 0));
      s.ticks(60);
      EXPECT_NEAR(glm::dot(part.pose().position, ahead), 2, 0.02);
      EXPECT_NEAR(glm::dot(part.pose().position, turn * Vec3(0, 1, 0)), 0, 0.005);
      EXPECT_NEAR(part.pose().position.z, 0.1, 1e-3);
    }
  }
}

// A manifold contains the deepest point and those that span the largest area.
TEST(ContactManifold, SelectsTheDeepestAndTheWidestPoints) {
  btSphereShape shape(1);
  btRigidBody a(1, nullptr, &shape, btVector3(1, 1, 1));
  btRigidBody b(0, nullptr, &shape);
  btPersistentManifold manifold(&a, &b, 0, 0.02F, BT_LARGE_FLOAT);
  collision::ManifoldBuilder points(manifold, 0.01F);
  const btVector3 up(0, 0, 1);
  for (int i = 0; i < 16; i++) {
    const auto angle = static_cast<float>(2 * kPi * i / 16);
    points.add({std::cos(angle), std::sin(angle), 0}, up, i == 3 ? -0.002F : -0.001F);
  }
  points.add({0, 0, 0}, up, -0.001F);
  points.add({3, 3, 0}, up, 0.5F);  // beyond max_distance()
  points.write();
  ASSERT_EQ(manifold.getNumContacts(), 4);
  EXPECT_FLOAT_EQ(manifold.getContactPoint(0).getDistance(), -0.002F);
  double min_distance = 10;
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < i; k++) {
      const double distance = static_cast<double>(
          (manifold.getContactPoint(i).m_positionWorldOnB - manifold.getContactPoint(k).m_positionWorldOnB).length());
      min_distance = std::min(min_distance, distance);
    }
  }
  EXPECT_NEAR(min_distance, std::sqrt(2.0), 1e-3);  // a square
}

TEST(ContactManifold, TransfersImpulsesOfMatchingPoints) {
  btSphereShape shape(1);
  btRigidBody a(1, nullptr, &shape, btVector3(1, 1, 1));
  btRigidBody b(0, nullptr, &shape);
  btPersistentManifold manifold(&a, &b, 0, 0.02F, BT_LARGE_FLOAT);
  const btVector3 up(0, 0, 1);
  const auto add_all = [&](float x) {
    collision::ManifoldBuilder points(manifold, 0.01F);
    for (int i = 0; i < 4; i++) points.add({x + static_cast<float>(i % 2), static_cast<float>(i / 2), 0}, up, 0);
    points.write();
  };
  add_all(0);
  for (int i = 0; i < 4; i++) manifold.getContactPoint(i).m_appliedImpulse = static_cast<float>(i + 1);
  const auto impulse_at = [&](float x, float y) {
    for (int i = 0; i < manifold.getNumContacts(); i++) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      if ((point.m_localPointA - btVector3(x, y, 0)).length() < 1e-3F) return point.m_appliedImpulse;
    }
    return -1.0F;
  };
  const float corner = impulse_at(1, 1);
  EXPECT_GT(corner, 0);
  a.getWorldTransform().setOrigin({5, 0, 0});  // it slides far, and its corners remain the same points
  add_all(5);
  ASSERT_EQ(manifold.getNumContacts(), 4);
  EXPECT_EQ(impulse_at(1, 1), corner);
}

}  // namespace
}  // namespace limber::sim::manifold_test
