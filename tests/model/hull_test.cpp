// Hulls compared with solids of known hull, and checked against every point of the cloud.
#include "model/mesh/hull.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/random.h"
#include "model/mesh/mass_properties.h"
#include "solids.h"

namespace limber::model {
namespace {

double uniform(Random& random) { return static_cast<double>(random.next() >> 11) * 0x1p-53; }

std::vector<Vec3> cloud(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    // separate statements, because the evaluation order of arguments is unspecified
    const double x = uniform(random);
    const double y = uniform(random);
    const double z = uniform(random);
    points.push_back(Vec3(x, y, z) * 2.0 - 1.0);
  }
  return points;
}

/// Largest signed distance of a point above a face plane of the hull: at most 0 if the hull contains all points.
double max_height_above(const Hull& hull, const std::vector<Vec3>& points) {
  double max_height = -1e9;
  for (std::size_t i = 0; i < hull.triangles.size(); i += 3) {
    const Vec3& a = hull.vertices[hull.triangles[i]];
    const Vec3 n =
        normalized(glm::cross(hull.vertices[hull.triangles[i + 1]] - a, hull.vertices[hull.triangles[i + 2]] - a));
    for (const Vec3& p : points) max_height = std::max(max_height, glm::dot(n, p - a));
  }
  return max_height;
}

/// Largest distance of a point outside the hull, by brute force over all triangles. A point is inside if the triangles'
/// solid angles add up to 4π (Van Oosterom, Strackee 1983), which is robust against slivers.
double farthest_outside(const Hull& hull, const std::vector<Vec3>& points) {
  double farthest = 0;
  for (const Vec3& p : points) {
    double solid_angle = 0;
    double nearest = 1e9;
    for (std::size_t i = 0; i < hull.triangles.size(); i += 3) {
      const Vec3 a = hull.vertices[hull.triangles[i]] - p;
      const Vec3 b = hull.vertices[hull.triangles[i + 1]] - p;
      const Vec3 c = hull.vertices[hull.triangles[i + 2]] - p;
      const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
      solid_angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                    x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
      nearest = std::min(nearest, triangle_distance(Vec3(0), a, b, c));
    }
    if (solid_angle < 2 * kPi) farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(Hull, IgnoresPointsInsideAndOnTheFacesOfACube) {
  std::vector<Vec3> points = cloud(1, 500);
  for (int x = 0; x <= 10; ++x) {
    for (int y = 0; y <= 10; ++y) points.emplace_back(x / 5.0 - 1, y / 5.0 - 1, 1);
  }
  const test::Solid cube = test::box({2, 2, 2});
  points.insert(points.end(), cube.vertices.begin(), cube.vertices.end());
  const Hull hull = convex_hull(points);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_EQ(hull.triangles.size(), 36u);
  EXPECT_NEAR(unit_inertial_of(hull.vertices, hull.triangles).mass, 8, 1e-12);
}

TEST(Hull, ContainsEveryPointAndIsClosed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Vec3> points = cloud(seed, 400);
    const Hull hull = convex_hull(points);
    EXPECT_LT(max_height_above(hull, points), 1e-5) << seed;
    EXPECT_TRUE(is_closed(hull.triangles)) << seed;
    // Euler: V - E + F = 2 with E = 3F/2
    EXPECT_EQ(hull.triangles.size() / 3, 2 * hull.vertices.size() - 4) << seed;
  }
}

TEST(Hull, OfASphereHasTheVolumeOfTheSphere) {
  // the hull of points on a sphere has less volume than 4π/3; about 0.1 % less for 5000 distributed points
  std::vector<Vec3> points;
  const double golden = kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < 5000; ++i) {
    const double z = 1 - (2 * i + 1) / 5000.0;
    const double r = std::sqrt(1 - z * z);
    points.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  const Hull hull = convex_hull(points);
  EXPECT_EQ(hull.vertices.size(), 5000u);
  const double volume = unit_inertial_of(hull.vertices, hull.triangles).mass;
  EXPECT_LT(volume, 4 * kPi / 3);
  EXPECT_GT(volume, 4 * kPi / 3 * 0.998);
}

TEST(Hull, ThickensFlatStraightAndSinglePointClouds) {
  // a square of 1 m: 0.1 % to each side
  const std::vector<Vec3> square{{0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}, {0.5, 0.5, 3}};
  const Hull plate = convex_hull(square);
  EXPECT_EQ(plate.vertices.size(), 8u);
  EXPECT_NEAR(unit_inertial_of(plate.vertices, plate.triangles).mass, 0.002, 1e-9);
  const std::vector<Vec3> line{{0, 0, 0}, {0, 2, 0}, {0, 1, 0}};
  const Hull rod = convex_hull(line);
  EXPECT_EQ(rod.vertices.size(), 8u);
  EXPECT_NEAR(unit_inertial_of(rod.vertices, rod.triangles).mass, 2 * 0.004 * 0.004, 1e-9);
  const std::vector<Vec3> point{{5, 5, 5}, {5, 5, 5}};
  const Hull dot = convex_hull(point);
  EXPECT_NEAR(unit_inertial_of(dot.vertices, dot.triangles).mass, 8e-12, 1e-14);
  EXPECT_TRUE(convex_hull(std::vector<Vec3>{}).vertices.empty());
}

TEST(Hull, HasAVolumeForSmallCloudsFarFromTheOrigin) {
  for (const double away : {1.0, 100.0, 1e4, 1e6}) {
    std::vector<Vec3> points = cloud(5, 50);
    for (Vec3& p : points) p = 0.01 * p + Vec3(away, -away, away);
    const Hull hull = convex_hull(points);
    EXPECT_GE(hull.vertices.size(), 8u) << away;
    EXPECT_GT(unit_inertial_of(hull.vertices, hull.triangles).mass, 0) << away;
  }
}

TEST(Hull, HandlesNearlyFlatAndRepeatedPoints) {
  Random random(7);
  for (const double thickness : {1e-3, 1e-5, 1e-6, 1e-7, 1e-9, 0.0}) {
    std::vector<Vec3> points = cloud(3, 300);
    for (Vec3& p : points) p.z *= thickness;
    const std::vector<Vec3> again = points;
    points.insert(points.end(), again.begin(), again.end());
    const Hull hull = convex_hull(points);
    EXPECT_TRUE(is_closed(hull.triangles)) << thickness;
    EXPECT_GT(unit_inertial_of(hull.vertices, hull.triangles).mass, 0) << thickness;
    // compares distances from the surface, because the planes of slivers are unreliable
    EXPECT_LT(farthest_outside(hull, points), 1e-5) << thickness;
  }
}

TEST(ReducedHull, RespectsItsLimitsAndReturnsTheExactError) {
  const test::Solid solids[] = {test::capsule(0.1, 0.5, 64), test::cylinder(0.3, 0.1, 200), test::capsule(1, 0, 48)};
  for (const test::Solid& s : solids) {
    const Hull whole = convex_hull(s.vertices);
    const Hull hull = reduced_hull(whole);
    EXPECT_GE(hull.vertices.size(), 16u);
    EXPECT_LE(hull.vertices.size(), 64u);
    EXPECT_NEAR(farthest_outside(hull, s.vertices), hull.error, 1e-6);
    EXPECT_TRUE(is_closed(hull.triangles));
    double size = 0;
    for (const Vec3& v : s.vertices) size = std::max({size, std::abs(v.x) * 2, std::abs(v.y) * 2, std::abs(v.z) * 2});
    if (hull.vertices.size() < 64) {
      EXPECT_LE(hull.error, 0.02 * size + 1e-9);
    }
    // every vertex is a point of the cloud
    for (const Vec3& v : hull.vertices) {
      EXPECT_NE(std::find(s.vertices.begin(), s.vertices.end(), v), s.vertices.end());
    }
  }
}

TEST(ReducedHull, KeepsAllOfFewVertices) {
  const Hull hull = reduced_hull(test::box({1, 2, 3}).vertices);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_EQ(hull.error, 0);
}

TEST(ReducedHull, KeepsUpTo255VerticesIfAllowed) {
  const HullLimits limits{255, 255, 0};
  const test::Solid ball = test::capsule(1, 0, 20);
  const std::size_t all = convex_hull(ball.vertices).vertices.size();
  ASSERT_LT(all, 255u);
  EXPECT_EQ(reduced_hull(ball.vertices, limits).vertices.size(), all);
  EXPECT_EQ(reduced_hull(test::capsule(1, 0, 64).vertices, limits).vertices.size(), 255u);
}

TEST(ReducedHull, IsDeterministic) {
  const std::vector<Vec3> points = cloud(9, 1000);
  const Hull a = reduced_hull(points);
  const Hull b = reduced_hull(points);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(TriangleDistance, MeasuresToCornersEdgesAndInterior) {
  const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  EXPECT_EQ(nearest_on_triangle({0.5, 0.5, 3}, a, b, c), Vec3(0.5, 0.5, 0));
  EXPECT_DOUBLE_EQ(triangle_distance({0.5, 0.5, 3}, a, b, c), 3);
  EXPECT_DOUBLE_EQ(triangle_distance({-3, -4, 0}, a, b, c), 5);
  EXPECT_DOUBLE_EQ(triangle_distance({1, -2, 0}, a, b, c), 2);
  EXPECT_DOUBLE_EQ(triangle_distance({2, 2, 0}, a, b, c), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(triangle_distance({5, 0, 4}, a, b, c), 5);
  EXPECT_DOUBLE_EQ(triangle_distance({0, 6, 3}, a, b, c), 5);
}

}  // namespace
}  // namespace limber::model
