// Shapes: validation, and the mass distribution of each of the eight kinds.
#include "sim/shapes/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/shapes/geometry.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

// A cuboid as a mesh of points.
model::ShapeModel hull_model(const Vec3& size) {
  auto mesh = std::make_shared<model::MeshModel>();
  for (int i = 0; i < 8; i++) {
    mesh->hull.push_back(size * Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5));
  }
  mesh->vertices = mesh->hull;
  mesh->unit_inertial = {size.x * size.y * size.z, Vec3(0), Mat3(0)};
  const Vec3 moments = box_inertia(mesh->unit_inertial.mass, size);
  for (int i = 0; i < 3; i++) mesh->unit_inertial.tensor[i][i] = moments[i];
  mesh->closed = true;
  model::ShapeModel m;
  m.kind = model::ShapeKind::mesh;
  m.mesh = mesh;
  return m;
}

struct Solid {
  const char* name;
  model::ShapeModel model;
  double volume;
  Vec3 moments;   // of 1 kg, about the center of mass
  double center;  // height of the center of mass in the shape's frame
  double bottom;  // depth of the lowest point below the shape's origin
};

std::vector<Solid> solids() {
  const double r = 0.3;
  const double h = 0.8;
  const double cyl = kPi * r * r * h;
  const double ball = 4.0 / 3 * kPi * r * r * r;
  // a capsule: a cylinder and two half balls with centers of mass 3/8·r beyond its ends
  const double mc = cyl / (cyl + ball);
  const double mb = ball / (cyl + ball);
  const double across = mc * (3 * r * r + h * h) / 12 + mb * (0.4 * r * r + h * h / 4 + 0.375 * h * r);
  const double along = mc * r * r / 2 + mb * 0.4 * r * r;
  const double cone_across = 3.0 / 80 * (4 * r * r + h * h);
  return {
      {"sphere", sphere_model(r), ball, Vec3(0.4 * r * r), 0, r},
      {"box", box_model({0.2, 0.4, 0.6}), 0.048, box_inertia(1, {0.2, 0.4, 0.6}), 0, 0.3},
      {"cylinder", round_model(model::ShapeKind::cylinder, r, h), cyl,
       Vec3((3 * r * r + h * h) / 12, (3 * r * r + h * h) / 12, r * r / 2), 0, h / 2},
      {"capsule", round_model(model::ShapeKind::capsule, r, h), cyl + ball, {across, across, along}, 0, h / 2 + r},
      {"cone",
       round_model(model::ShapeKind::cone, r, h),
       cyl / 3,
       {cone_across, cone_across, 0.3 * r * r},
       -h / 4,
       h / 2},
      {"hull", hull_model({0.2, 0.4, 0.6}), 0.048, box_inertia(1, {0.2, 0.4, 0.6}), 0, 0.3},
  };
}

TEST(ShapeTest, MassIsDistributedOverTheVolume) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    for (int axis = 0; axis < 3; axis++) {
      WorldFixture s;
      Part& part = s.add_single_part(solid.model, 2);
      EXPECT_NEAR(part.geometry()->volume, solid.volume, 1e-6 * solid.volume);
      Vec3 torque(0);
      torque[axis] = 0.01;
      part.apply_torque(torque);
      s.ticks(1);
      const double expected = 0.01 / (2 * solid.moments[axis]) / 60;
      EXPECT_NEAR(part.angular_velocity()[axis], expected, 1e-4 * expected) << axis;
      EXPECT_NEAR(part.center().z, solid.center, 1e-6);
    }
  }
}

TEST(ShapeTest, EachKindRestsOnItsLowestPoint) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -9.81});
    Part& part = s.add_single_part(solid.model, 1, {{0, 0, solid.bottom + 0.005}, quat_identity()});
    s.ticks(30);
    EXPECT_NEAR(part.pose().position.z, solid.bottom, 0.003);
    EXPECT_LT(glm::length(part.linear_velocity()), 0.05);
  }
}

TEST(ShapeTest, CompoundIsTheSumOfItsChildren) {
  // two cubes of 0.2 m, centers 0.6 m apart along x: parallel axis theorem
  WorldFixture s;
  model::ShapeModel compound;
  compound.kind = model::ShapeKind::compound;
  Shape& dumbbell = *s.world.shapes().add("dumbbell", compound).value();
  Shape& cube = s.shape(box_model(Vec3(0.2)));
  for (const double x : {-0.3, 0.3}) ASSERT_TRUE(dumbbell.add_child(cube, {{x, 0, 0.1}, quat_identity()}));
  Body& body = s.body("body");
  Part& part = *body.add_part("part", dumbbell, 4, {{0, 0, 0}, quat_identity()}).value();
  const double own = 4.0 / 12 * 2 * 0.04;
  const Vec3 moments(own, own + 4 * 0.09, own + 4 * 0.09);
  EXPECT_NEAR(part.center().z, 0.1, 1e-9);
  part.apply_torque({0.01, 0.02, -0.03});
  s.ticks(1);
  for (int i = 0; i < 3; i++) {
    EXPECT_NEAR(part.angular_velocity()[i], Vec3(0.01, 0.02, -0.03)[i] / moments[i] / 60, 1e-7);
  }
  // its ends touch the floor, its middle doesn't
  part.set_pose({{0, 0, 0}, quat_identity()});
  part.set_velocity(Vec3(0), Vec3(0));
  Part& between = s.add_single_part(sphere_model(0.15), 1, {{0, 0, 0.1}, quat_identity()});
  Part& above = s.add_single_part(sphere_model(0.1), 1, {{0.3, 0, 0.29}, quat_identity()});
  s.ticks(2);
  EXPECT_LT(glm::length(between.pose().position - Vec3(0, 0, 0.1)), 1e-5);
  EXPECT_GT(above.pose().position.z, 0.2901);
}

TEST(ShapeTest, PlanePassesThroughItsPart) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.add_single_part(plane_model({0, 0, 5}), 0, {{0, 0, 2}, quat_identity()});
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{3, -4, 2.15}, quat_identity()});
  s.ticks(60);
  EXPECT_NEAR(ball.pose().position.z, 2.1, 0.002);
  EXPECT_EQ(s.number(ball.id(), "friction"), 0.5);
}

TEST(ShapeTest, RejectsInvalidShapes) {
  const double nan = std::nan("");
  const auto text = [](const model::ShapeModel& m) {
    const Result<void> r = check_shape(m);
    return r ? std::string("none") : r.error();
  };
  EXPECT_EQ(text(sphere_model(-1)), "a sphere needs a radius of 0.0001 .. 10000 m, not -1");
  EXPECT_EQ(text(sphere_model(nan)), "a sphere needs a radius of 0.0001 .. 10000 m, not nan");
  EXPECT_EQ(text(box_model({1, 0, 1})), "a box needs a size of 0.0001 .. 10000 m, not 0");
  EXPECT_EQ(text(box_model({1, 1, 1e5})), "a box needs a size of 0.0001 .. 10000 m, not 100000");
  EXPECT_EQ(text(round_model(model::ShapeKind::cylinder, 0, 1)),
            "a cylinder needs a radius of 0.0001 .. 10000 m, not 0");
  EXPECT_EQ(text(round_model(model::ShapeKind::capsule, 1, 0)), "a capsule needs a height of 0.0001 .. 10000 m, not 0");
  EXPECT_EQ(text(round_model(model::ShapeKind::cone, 1, nan)), "a cone needs a height of 0.0001 .. 10000 m, not nan");
  EXPECT_EQ(text(plane_model(Vec3(0))), "a plane needs a normal that is not zero");
  EXPECT_EQ(text(plane_model({0, nan, 1})), "a plane needs a normal that is not zero");
  model::ShapeModel mesh;
  mesh.kind = model::ShapeKind::mesh;
  EXPECT_EQ(text(mesh), "a convex mesh needs at least 4 points");
  for (const Solid& solid : solids()) EXPECT_EQ(text(solid.model), "none") << solid.name;
  WorldFixture s;
  EXPECT_EQ(s.world.shapes().add("ball", sphere_model(0)).error(),
            "shape 'ball': a sphere needs a radius of 0.0001 .. 10000 m, not 0");
  EXPECT_TRUE(s.world.shapes().list().empty());
}

TEST(ShapeTest, OnlyCompoundsHaveChildren) {
  WorldFixture s;
  model::ShapeModel compound;
  compound.kind = model::ShapeKind::compound;
  Shape& both = *s.world.shapes().add("both", compound).value();
  Shape& ball = *s.world.shapes().add("ball", sphere_model(0.1)).value();
  Shape& plane = *s.world.shapes().add("plane", plane_model()).value();
  EXPECT_EQ(ball.add_child(both, {}).error(), "shape 'ball' is not a compound; create one with sim:add_compound_shape");
  EXPECT_EQ(both.add_child(both, {}).error(), "compound 'both' can't contain itself");
  EXPECT_EQ(both.add_child(plane, {}).error(), "compound 'both' can't contain a plane");
  EXPECT_TRUE(both.placed().empty());
  ASSERT_TRUE(both.add_child(ball, {{1, 0, 0}, quat_identity()}));
  Shape& nested = *s.world.shapes().add("nested", compound).value();
  ASSERT_TRUE(nested.add_child(both, {{0, 1, 0}, quat_axis({0, 0, 1}, kPi / 2)}));
  ASSERT_EQ(nested.placed().size(), 1u);
  EXPECT_LT(glm::length(nested.placed()[0].origin.position - Vec3(0, 2, 0)), 1e-12);
}

}  // namespace
}  // namespace limber::sim
