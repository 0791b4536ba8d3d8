// Recognition of meshes that are boxes, spheres or capsules, and of meshes that are not.
#include "model/mesh/fit_primitive.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "import_text.h"
#include "solids.h"

namespace limber::model {
namespace {

std::optional<PlacedShape> recognize(const test::Solid& s) { return recognize_primitive(convex_hull(s.vertices)); }

std::array<double, 3> sorted(const Vec3& v) {
  std::array<double, 3> a{v.x, v.y, v.z};
  std::sort(a.begin(), a.end());
  return a;
}

TEST(ShapeRecognition, RecognizesBoxesInAnyPose) {
  const Vec3 size{0.1, 0.25, 0.4};
  const Pose poses[] = {{}, {{1, 2, 3}, quat_identity()}, {{-1, 0, 2}, quat_euler(0.5, 1, -2)}};
  for (const Pose& pose : poses) {
    const test::Solid mesh = test::box(size).moved(pose);
    const std::optional<PlacedShape> found = recognize(mesh);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->shape.kind, ShapeKind::box);
    const auto a = sorted(found->shape.size), b = sorted(size);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
    // each vertex of the mesh is a corner of the box
    for (const Vec3& v : mesh.vertices) {
      const Vec3 in_box = glm::abs(found->origin.inverse() * v) * 2.0;
      test::expect_near(in_box, found->shape.size, 1e-9);
    }
  }
}

TEST(ShapeRecognition, KeepsTheAxesOfAnUprightBox) {
  const std::optional<PlacedShape> found = recognize(test::box({0.1, 0.25, 0.4}).moved({{1, 2, 3}, quat_identity()}));
  ASSERT_TRUE(found);
  test::expect_near(found->shape.size, {0.1, 0.25, 0.4}, 1e-12);
  EXPECT_NEAR(test::angle_between(found->origin.rotation, quat_identity()), 0, 1e-7);
  test::expect_near(found->origin.position, {1, 2, 3}, 1e-12);
}

TEST(ShapeRecognition, RecognizesFinelyMeshedBoxes) {
  test::Solid mesh = test::box({1, 1, 2});
  for (int i = 1; i < 20; ++i) {
    for (int k = 1; k < 20; ++k) mesh.vertices.emplace_back(i / 20.0 - 0.5, k / 20.0 - 0.5, 1);
  }
  const std::optional<PlacedShape> found = recognize(mesh);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->shape.kind, ShapeKind::box);
}

TEST(ShapeRecognition, RecognizesCapsulesAndSpheres) {
  const Pose pose{{0.3, -0.2, 1}, quat_euler(1, -0.6, 0.2)};
  const std::optional<PlacedShape> capsule = recognize(test::capsule(0.05, 0.3).moved(pose));
  ASSERT_TRUE(capsule);
  EXPECT_EQ(capsule->shape.kind, ShapeKind::capsule);
  EXPECT_NEAR(capsule->shape.radius, 0.05, 1e-6);
  EXPECT_NEAR(capsule->shape.height, 0.3, 1e-6);
  test::expect_near(capsule->origin.position, pose.position, 1e-6);
  const Vec3 axis = pose.rotation * Vec3(0, 0, 1);
  EXPECT_NEAR(std::abs(glm::dot(capsule->origin.rotation * Vec3(0, 0, 1), axis)), 1, 1e-9);

  const std::optional<PlacedShape> sphere = recognize(test::capsule(0.2, 0, 32).moved(pose));
  ASSERT_TRUE(sphere);
  EXPECT_EQ(sphere->shape.kind, ShapeKind::sphere);
  EXPECT_NEAR(sphere->shape.radius, 0.2, 1e-6);
}

TEST(ShapeRecognition, RejectsOtherSolids) {
  EXPECT_FALSE(recognize(test::cylinder(0.1, 0.5, 48)));
  EXPECT_FALSE(recognize(test::cylinder(0.1, 0.5, 6)));
  // a box with a corner cut off, a wedge, an octahedron (with its vertices on a sphere)
  test::Solid cut = test::box({1, 1, 1});
  cut.vertices[7] = {0.4, 0.4, 0.4};
  EXPECT_FALSE(recognize(cut));
  EXPECT_FALSE(recognize(test::cylinder(0.5, 1, 3)));
  EXPECT_FALSE(recognize(test::revolved({{0, -1}, {1, 0}, {0, 1}}, 4)));
  // a parallelepiped: eight vertices, three face normals, not orthogonal
  test::Solid sheared = test::box({1, 1, 1});
  for (Vec3& v : sheared.vertices) v.x += 0.1 * v.z;
  EXPECT_FALSE(recognize(sheared));
  // a capsule with one flattened cap
  test::Solid flat = test::capsule(0.1, 0.4);
  for (Vec3& v : flat.vertices) v.z = std::min(v.z, 0.25);
  EXPECT_FALSE(recognize(flat));
}

}  // namespace
}  // namespace limber::model
