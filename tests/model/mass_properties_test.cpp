// Mass properties compared with textbook formulas, and of meshes compared with primitives.
#include "model/mesh/mass_properties.h"

#include <gtest/gtest.h>

#include "import_text.h"
#include "solids.h"

namespace limber::model {
namespace {

void expect_tensor(const Mat3& a, const Mat3& b, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[i][k], b[i][k], tolerance) << i << k;
  }
}

ShapeModel shape(ShapeKind kind, double radius, double height) {
  ShapeModel s;
  s.kind = kind;
  s.radius = radius;
  s.height = height;
  return s;
}

/// Mass properties by summing small cubes, independent of any formula.
Inertial by_cubes(const std::function<bool(const Vec3&)>& inside, double half_size, int steps) {
  const double edge = 2 * half_size / steps;
  double mass = 0;
  Vec3 first(0);
  Mat3 second(0);
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      for (int k = 0; k < steps; ++k) {
        const Vec3 p = Vec3(i + 0.5, j + 0.5, k + 0.5) * edge - half_size;
        if (!inside(p)) continue;
        const double m = edge * edge * edge;
        mass += m;
        first += m * p;
        second += m * (glm::dot(p, p) * Mat3(1) - glm::outerProduct(p, p));
      }
    }
  }
  const Vec3 c = first / mass;
  return {mass, c, second - mass * (glm::dot(c, c) * Mat3(1) - glm::outerProduct(c, c))};
}

TEST(MassProperties, PrimitivesAgreeWithSmallCubes) {
  const double r = 0.5, h = 0.8;
  const auto across = [](const Vec3& p) { return std::hypot(p.x, p.y); };
  const auto check = [](const ShapeModel& s, const Inertial& cubes) {
    const Inertial exact = unit_inertial_of(s);
    EXPECT_NEAR(exact.mass / cubes.mass, 1, 0.005);
    test::expect_near(exact.center, cubes.center, 0.005);
    expect_tensor(exact.tensor, cubes.tensor, 0.01 * exact.tensor[0][0]);
  };
  check(shape(ShapeKind::sphere, r, 0), by_cubes([&](const Vec3& p) { return glm::length(p) < r; }, 1, 120));
  check(shape(ShapeKind::cylinder, r, h),
        by_cubes([&](const Vec3& p) { return across(p) < r && std::abs(p.z) < h / 2; }, 1, 120));
  check(shape(ShapeKind::capsule, r, h), by_cubes(
                                             [&](const Vec3& p) {
                                               const double z = std::max(0.0, std::abs(p.z) - h / 2);
                                               return std::hypot(across(p), z) < r;
                                             },
                                             1, 120));
  check(shape(ShapeKind::cone, r, h),
        by_cubes([&](const Vec3& p) { return std::abs(p.z) < h / 2 && across(p) < r * (0.5 - p.z / h); }, 1, 120));
}

TEST(MassProperties, BoxMatchesTheFormula) {
  ShapeModel s;
  s.size = {1, 2, 3};
  const Inertial box = unit_inertial_of(s);
  EXPECT_DOUBLE_EQ(box.mass, 6);
  EXPECT_DOUBLE_EQ(box.tensor[0][0], 6.0 / 12 * 13);
  EXPECT_DOUBLE_EQ(box.tensor[1][1], 6.0 / 12 * 10);
  EXPECT_DOUBLE_EQ(box.tensor[2][2], 6.0 / 12 * 5);
}

TEST(MassProperties, MeshOfATransformedBoxMatchesTheBox) {
  const Pose pose{{100, -50, 7}, quat_euler(0.3, -0.8, 2)};
  const test::Solid mesh = test::box({1, 2, 3}).moved(pose);
  ShapeModel s;
  s.size = {1, 2, 3};
  const Inertial expected = transformed(unit_inertial_of(s), pose);
  const Inertial found = unit_inertial_of(mesh.vertices, mesh.triangles);
  EXPECT_NEAR(found.mass, 6, 1e-10);
  test::expect_near(found.center, pose.position, 1e-9);
  expect_tensor(found.tensor, expected.tensor, 1e-9);
}

TEST(MassProperties, MeshOfACylinderApproximatesTheCylinder) {
  const test::Solid mesh = test::cylinder(0.4, 1.2, 400);
  const Inertial found = unit_inertial_of(mesh.vertices, mesh.triangles);
  const Inertial exact = unit_inertial_of(shape(ShapeKind::cylinder, 0.4, 1.2));
  EXPECT_NEAR(found.mass / exact.mass, 1, 1e-4);
  expect_tensor(found.tensor, exact.tensor, 2e-4 * exact.tensor[0][0]);
}

TEST(MassProperties, InsideOutMeshHasANegativeVolume) {
  test::Solid mesh = test::box({1, 1, 1});
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) std::swap(mesh.triangles[i], mesh.triangles[i + 1]);
  EXPECT_NEAR(unit_inertial_of(mesh.vertices, mesh.triangles).mass, -1, 1e-12);
}

TEST(MassProperties, ClosedRequiresEveryEdgeTwice) {
  test::Solid mesh = test::box({1, 1, 1});
  EXPECT_TRUE(is_closed(mesh.triangles));
  std::vector<unsigned> open(mesh.triangles.begin(), mesh.triangles.end() - 3);
  EXPECT_FALSE(is_closed(open));
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  EXPECT_FALSE(is_closed(mesh.triangles));
  EXPECT_FALSE(is_closed({}));
}

TEST(MassProperties, SumOfTwoHalvesIsTheWhole) {
  ShapeModel half, whole;
  half.size = {1, 2, 1.5};
  whole.size = {1, 2, 3};
  const Inertial parts[] = {transformed(unit_inertial_of(half), {{0, 0, 0.75}, quat_identity()}),
                            transformed(unit_inertial_of(half), {{0, 0, -0.75}, quat_axis({0, 0, 1}, kPi)})};
  const Inertial sum = combined(parts);
  EXPECT_NEAR(sum.mass, 6, 1e-12);
  test::expect_near(sum.center, {0, 0, 0}, 1e-12);
  expect_tensor(sum.tensor, unit_inertial_of(whole).tensor, 1e-12);
}

TEST(MassProperties, PrincipalAxesReconstructTheTensor) {
  const Mat3 turn = glm::mat3_cast(quat_euler(0.4, 1.1, -2));
  const Mat3 tensor = turn * Mat3(3, 0, 0, 0, 1e-9, 0, 0, 0, 2) * glm::transpose(turn);
  const PrincipalAxes p = principal_axes(tensor);
  test::expect_near(p.moments, {1e-9, 2, 3}, 1e-14);
  const Mat3 again = p.axes * Mat3(p.moments.x, 0, 0, 0, p.moments.y, 0, 0, 0, p.moments.z) * glm::transpose(p.axes);
  expect_tensor(again, tensor, 1e-14);
  EXPECT_NEAR(glm::determinant(p.axes), 1, 1e-14);
  test::expect_near(principal_axes(Mat3(5)).moments, {5, 5, 5}, 0);
}

TEST(MassProperties, ReportsImpossibleTensors) {
  const auto fault = [](double x, double y, double z) { return tensor_error(Mat3(x, 0, 0, 0, y, 0, 0, 0, z)); };
  EXPECT_EQ(fault(1, 1, 1), "");
  EXPECT_EQ(fault(1, 1, 2), "");
  EXPECT_EQ(fault(1, 1, 2.01), "");
  EXPECT_NE(fault(1, 1, 2.1), "");
  EXPECT_NE(fault(0, 0, 0), "");
  EXPECT_NE(fault(-1, 1, 1), "");
  EXPECT_NE(fault(NAN, 1, 1), "");
}

TEST(MassProperties, RaisesSmallMoments) {
  bool raised = false;
  const Mat3 rod = regularized_tensor(Mat3(1, 0, 0, 0, 1, 0, 0, 0, 1e-5), raised);
  EXPECT_TRUE(raised);
  EXPECT_NEAR(rod[2][2], 1e-3, 1e-15);
  const Mat3 dust = regularized_tensor(Mat3(1e-9), raised);
  EXPECT_TRUE(raised);
  EXPECT_NEAR(dust[0][0], 1e-6, 1e-18);
  const Mat3 fine(1, 0.1, 0, 0.1, 1, 0, 0, 0, 0.5);
  EXPECT_EQ(regularized_tensor(fine, raised), fine);
  EXPECT_FALSE(raised);
}

}  // namespace
}  // namespace limber::model
