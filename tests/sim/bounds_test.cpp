// Boxes around shapes, compared with the extremes of points that are sampled on their surfaces.
#include "sim/shapes/bounds.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

namespace limber::sim {
namespace {

using model::ShapeKind;

// points on the surface, dense enough for the tolerance of the test
std::vector<Vec3> surface_points(const model::ShapeModel& shape) {
  std::vector<Vec3> points;
  constexpr int kSteps = 720;
  for (int i = 0; i < kSteps; i++) {
    const double a = 2 * std::numbers::pi * i / kSteps;
    const Vec3 around(shape.radius * std::cos(a), shape.radius * std::sin(a), 0);
    const Vec3 half(0, 0, shape.height / 2);
    if (shape.kind == ShapeKind::cylinder) points.push_back(around + half);
    if (shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone) points.push_back(around - half);
    if (shape.kind != ShapeKind::sphere && shape.kind != ShapeKind::capsule && shape.kind != ShapeKind::ellipsoid)
      continue;
    for (int k = 0; k <= kSteps / 2; k++) {
      const double b = std::numbers::pi * k / (kSteps / 2) - std::numbers::pi / 2;
      const Vec3 point = std::cos(b) * around + Vec3(0, 0, shape.radius * std::sin(b));
      if (shape.kind == ShapeKind::ellipsoid) {
        points.push_back(point / shape.radius * shape.size / 2.0);
      } else {
        points.push_back(shape.kind == ShapeKind::sphere ? point : point + (b > 0 ? half : -half));
      }
    }
  }
  if (shape.kind == ShapeKind::cone) points.emplace_back(0, 0, shape.height / 2);
  for (int corner = 0; corner < 8 && shape.kind == ShapeKind::box; corner++) {
    points.push_back(shape.size / 2.0 *
                     Vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1));
  }
  return points;
}

TEST(Bounds, ContainAllPointsOfAShapeAndTouchThem) {
  Random random(7, "bounds");
  for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::box, ShapeKind::cylinder, ShapeKind::capsule,
                               ShapeKind::cone, ShapeKind::ellipsoid}) {
    for (int i = 0; i < 6; i++) {
      model::ShapeModel shape;
      shape.kind = kind;
      shape.radius = 0.3;
      shape.height = 0.9;
      shape.size = {0.2, 0.5, 0.9};
      const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Pose pose{{1, -2, 3}, i == 0 ? quat_identity() : quat_axis(normalized(axis), random.uniform(-3, 3))};
      Vec3 low(1e9), high(-1e9);
      for (const Vec3& point : surface_points(shape)) {
        low = glm::min(low, pose * point);
        high = glm::max(high, pose * point);
      }
      const Bounds bounds = bounds_of(shape, pose);
      for (int c = 0; c < 3; c++) {
        EXPECT_NEAR(bounds.low[c], low[c], 1e-4) << static_cast<int>(kind) << " " << i << " " << c;
        EXPECT_NEAR(bounds.high[c], high[c], 1e-4) << static_cast<int>(kind) << " " << i << " " << c;
      }
    }
  }
}

TEST(Bounds, PlanesHaveNone) {
  model::ShapeModel plane;
  plane.kind = ShapeKind::plane;
  EXPECT_TRUE(bounds_of(plane, {}).empty());
  EXPECT_EQ(Bounds().size(), Vec3(0));
}

TEST(Bounds, OverlapNeedsMoreThanAFace) {
  const Bounds box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(box.overlaps(box.moved({0.9, 0.9, -0.9})));
  EXPECT_FALSE(box.overlaps(box.moved({1, 0, 0})));
  EXPECT_FALSE(box.overlaps(box.moved({0.5, 0.5, 1.5})));
}

TEST(Bounds, VisualsCountOnlyWithoutCollisionShapes) {
  model::BodyModel model;
  model::LinkModel link;
  model::PlacedShape small;
  small.shape.size = {1, 1, 1};
  model::PlacedShape large;
  large.shape.size = {3, 3, 3};
  link.visuals = {large};
  model.links = {link};
  EXPECT_EQ(bounds_of(model).size(), Vec3(3));
  model.links[0].collisions = {small};
  EXPECT_EQ(bounds_of(model).size(), Vec3(1));
}

}  // namespace
}  // namespace limber::sim
