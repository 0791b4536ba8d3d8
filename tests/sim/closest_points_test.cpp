// Closest points and depths of convex shapes: closed forms, and random pairs of every kind and size.
#include "sim/collision/closest_points.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

namespace limber::sim::collision {
namespace {

using bullet::to_bt;

btTransform at(const Vec3& position, const Quat& rotation = quat_identity()) { return to_bt(Pose{position, rotation}); }

void expect_points(const ClosestPoints& points, double distance, const Vec3& normal, const Vec3& on_b) {
  ASSERT_TRUE(points.found);
  EXPECT_NEAR(points.distance, distance, 2e-6);
  EXPECT_LT(glm::length(bullet::from_bt(points.normal) - normal), 2e-3);
  EXPECT_LT(glm::length(bullet::from_bt(points.point) - on_b), 5e-5);
}

TEST(ClosestPoints, OfASphereAboveABox) {
  const btSphereShape sphere(0.01F);
  const btBoxShape box(btVector3(0.1F, 0.02F, 0.03F));
  for (const double height : {0.01, 0.001, 1e-4, -1e-4, -0.001, -0.005, -0.012}) {
    expect_points(closest_points(sphere, at({0.05, 0.005, 0.04 + height}), box, at({0, 0, 0})), height, {0, 0, 1},
                  {0.05, 0.005, 0.03});
  }
}

// Bullet's own algorithm is wrong by 0.8 mm here.
TEST(ClosestPoints, OfASmallCylinderAndAParallelRod) {
  const btCylinderShapeZ cylinder(btVector3(0.01F, 0.01F, 0.01F));
  const btCapsuleShapeZ rod(0.005F, 1);
  for (const double x : {0.03, 0.02, 0.016, 0.0151, 0.0149, 0.012, 0.008}) {
    const ClosestPoints points = closest_points(cylinder, at({x, 0.0005, 0}), rod, at({0, 0, 0}));
    ASSERT_TRUE(points.found);
    const double distance = std::hypot(x, 0.0005);
    EXPECT_NEAR(points.distance, distance - 0.015, 1e-5) << x;
    EXPECT_NEAR(points.normal.x(), x / distance, 5e-3) << x;
  }
}

TEST(ClosestPoints, OfAWheelOnAFloor) {
  const btCylinderShapeZ wheel(btVector3(0.3F, 0.3F, 0.05F));
  const btBoxShape floor(btVector3(2, 2, 0.05F));
  for (const double height : {0.01, 5e-4, -0.001, -0.01}) {
    const ClosestPoints points =
        closest_points(wheel, at({0.123, 0, 0.35 + height}, quat_axis({1, 0, 0}, kPi / 2)), floor, at({0, 0, 0}));
    ASSERT_TRUE(points.found);
    EXPECT_NEAR(points.distance, height, 1e-5);
    EXPECT_NEAR(points.normal.z(), 1, 1e-6);
    EXPECT_NEAR(points.point.x(), 0.123, 1e-3);
  }
}

TEST(ClosestPoints, OfSpheresWithTheSameCenter) {
  const btSphereShape sphere(0.2F);
  const ClosestPoints points = closest_points(sphere, at({1, 2, 3}), sphere, at({1, 2, 3}));
  ASSERT_TRUE(points.found);
  EXPECT_NEAR(points.distance, -0.4, 0.02);
  EXPECT_NEAR(points.normal.length(), 1, 1e-5);
}

TEST(ClosestPoints, OfCrossedSegmentsThatMeet) {
  const btCapsuleShapeZ rod(0.01F, 1);
  const ClosestPoints points = closest_points(rod, at({0, 0, 0}), rod, at({0, 0, 0}, quat_axis({1, 0, 0}, kPi / 2)));
  ASSERT_TRUE(points.found);
  EXPECT_NEAR(points.distance, -0.02, 1e-3);
  EXPECT_NEAR(std::fabs(points.normal.x()), 1, 0.05);
}

struct RandomShapes {
  Random random{7};

  double between(double low, double high) { return random.uniform(low, high); }
  // margins are small, so that rounding hides no error
  std::unique_ptr<btConvexShape> shape(int kind, double size) {
    const auto s = static_cast<btScalar>(size * between(0.3, 3));
    const auto share = [&](double low, double high) { return static_cast<btScalar>(between(low, high)); };
    std::unique_ptr<btConvexShape> made;
    switch (kind) {
      case 0:
        return std::make_unique<btSphereShape>(s);
      case 1:
        return std::make_unique<btCapsuleShapeZ>(s * share(0.1, 1), s);
      case 2:
        made = std::make_unique<btBoxShape>(btVector3(s, s * share(0.1, 1), s * share(0.1, 1)));
        break;
      case 3:
        made = std::make_unique<btCylinderShapeZ>(btVector3(s, s, s * share(0.1, 2)));
        break;
      case 4:
        made = std::make_unique<btConeShapeZ>(s, s * share(0.3, 2));
        break;
      default: {
        auto hull = std::make_unique<btConvexHullShape>();
        for (int i = 0; i < 20; i++)
          hull->addPoint(to_bt(Vec3(between(-1, 1), between(-1, 1), between(-1, 1)) * static_cast<double>(s)), false);
        hull->recalcLocalAabb();
        made = std::move(hull);
      }
    }
    made->setMargin(s * btScalar(1e-3));
    return made;
  }
  btTransform rotation() { return at({0, 0, 0}, quat_axis(random.direction(), between(-3, 3))); }
};

Vec3 support(const btConvexShape& shape, const btTransform& pose, const btVector3& direction) {
  return bullet::from_bt(pose(shape.localGetSupportingVertex(direction * pose.getBasis())));
}

// For any direction, the gap between the support planes is at most the distance; for the right one it is the distance.
TEST(ClosestPoints, OfRandomPairsAreExact) {
  RandomShapes shapes;
  int wrong = 0;
  int penetrating = 0;
  constexpr int kPairs = 30000;
  for (int i = 0; i < kPairs; i++) {
    const double size = std::pow(10.0, shapes.between(-2.5, 0.5));
    const auto a = shapes.shape(i % 6, size);
    const auto b = shapes.shape(i / 6 % 6, size);
    btTransform pose_a = shapes.rotation();
    const btTransform pose_b = shapes.rotation();
    const Vec3 direction = shapes.random.direction();
    const double gap = shapes.between(-0.3, 0.3) * size * (i % 2 == 0 ? 1 : 0.05);
    const double now =
        glm::dot(direction, support(*a, pose_a, to_bt(-direction)) - support(*b, pose_b, to_bt(direction)));
    pose_a.setOrigin(to_bt(direction * (gap - now)));
    const ClosestPoints points = closest_points(*a, pose_a, *b, pose_b);
    ASSERT_TRUE(points.found);
    const Vec3 normal = bullet::from_bt(points.normal);
    const double between = glm::dot(normal, support(*a, pose_a, -points.normal) - support(*b, pose_b, points.normal));
    if (std::fabs(between - static_cast<double>(points.distance)) > 0.02 * size) wrong++;
    if (points.distance < 0) penetrating++;
    if (gap > 0) {
      EXPECT_GE(points.distance, gap - 0.01 * size);
    }
  }
  EXPECT_LE(wrong, 2);
  EXPECT_GT(penetrating, kPairs / 20);
}

}  // namespace
}  // namespace limber::sim::collision
