// Ellipsoids: their surface, mass properties, and contacts.
#include <cmath>

#include "sim/shapes/ellipsoid_shape.h"
#include "stage.h"

namespace limber::sim {
namespace {

model::ShapeModel ellipsoid_model(const Vec3& radii) {
  model::ShapeModel m;
  m.kind = model::ShapeKind::ellipsoid;
  m.size = 2.0 * radii;
  return m;
}

TEST(Ellipsoid, SupportPointsAreExact) {
  const Vec3 radii(0.3, 0.2, 0.1);
  const EllipsoidShape shape(radii);
  for (const Vec3 direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 2, 3), Vec3(-3, 0.1, 0.5)}) {
    const Vec3 unit = normalized(direction);
    const Vec3 point = bullet::from_bt(shape.localGetSupportingVertex(bullet::to_bt(unit)));
    const Vec3 scaled = point / radii;
    EXPECT_NEAR(glm::length(scaled), 1, 1e-6);
    // the normal of the surface at the point is the direction
    EXPECT_GT(glm::dot(normalized(scaled / radii), unit), 1 - 1e-6);
    const btVector3 core = shape.localGetSupportingVertexWithoutMargin(bullet::to_bt(unit));
    EXPECT_LT(glm::length(bullet::from_bt(core) + unit * static_cast<double>(shape.getMargin()) - point), 1e-3);
  }
}

TEST(Ellipsoid, BoundingBoxIsExact) {
  const Vec3 radii(0.3, 0.2, 0.1);
  const EllipsoidShape shape(radii);
  btVector3 low, high;
  shape.getAabb(bullet::to_bt(Pose{{1, 2, 3}, quat_axis({0, 0, 1}, kPi / 4)}), low, high);
  const double half = std::sqrt((0.09 + 0.04) / 2);
  EXPECT_LT(glm::length(bullet::from_bt(high) - Vec3(1 + half, 2 + half, 3.1)), 1e-6);
  EXPECT_LT(glm::length(bullet::from_bt(low) - Vec3(1 - half, 2 - half, 2.9)), 1e-6);
}

TEST(Ellipsoid, MassPropertiesAreExact) {
  test::WorldFixture s;
  const Part& egg = s.add_single_part(ellipsoid_model({0.3, 0.2, 0.1}), 5);
  const Vec3 inertia = s.vec(egg.id(), "inertia");
  EXPECT_NEAR(inertia.x, 0.04 + 0.01, 1e-6);
  EXPECT_NEAR(inertia.y, 0.09 + 0.01, 1e-6);
  EXPECT_NEAR(inertia.z, 0.09 + 0.04, 1e-6);
}

TEST(Ellipsoid, RejectsInvalidRadii) {
  test::WorldFixture s;
  const auto shape = s.world.shapes().add("egg", ellipsoid_model({0.1, 0, 0.1}));
  ASSERT_FALSE(shape.ok());
  EXPECT_NE(shape.error().find("an ellipsoid needs a radius of 0.0001 .. 10000 m, not 0"), std::string::npos)
      << shape.error();
}

// On a plane, on a box, on another ellipsoid and on a sphere.
TEST(Ellipsoid, RestsOnOtherShapes) {
  for (const int support : {0, 1, 2, 3}) {
    test::WorldFixture s;
    s.gravity({0, 0, -9.81});
    const Vec3 below(0, 0, -0.5);
    if (support == 0) s.floor();
    if (support == 1) s.add_single_part(test::box_model({2, 2, 1}), 0, {below, quat_identity()});
    if (support == 2) s.add_single_part(ellipsoid_model({0.8, 0.7, 0.5}), 0, {below, quat_identity()});
    if (support == 3) s.add_single_part(test::sphere_model(0.5), 0, {below, quat_identity()});
    Part& egg = s.add_single_part(ellipsoid_model({0.3, 0.2, 0.1}), 1, {{0, 0, 0.12}, quat_identity()});
    s.set(egg.id(), "rolling_friction", {0.01});
    s.ticks(120);
    EXPECT_NEAR(egg.pose().position.z, 0.1, 5e-4) << support;
    EXPECT_LT(glm::length(egg.linear_velocity()), 1e-2) << support;
  }
}

TEST(Ellipsoid, RollsOntoItsBroadSide) {
  test::WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Part& egg = s.add_single_part(ellipsoid_model({0.3, 0.2, 0.1}), 1, {{0, 0, 0.3}, quat_axis({1, 0, 0}, 1.2)});
  s.set(egg.id(), "angular_damping", {0.5});
  s.ticks(900);
  EXPECT_NEAR(egg.pose().position.z, 0.1, 1e-3);
  EXPECT_GT(std::abs((egg.pose().rotation * Vec3(0, 0, 1)).z), 0.99);
}

}  // namespace
}  // namespace limber::sim
