// Convex decomposition: exact where planes of the axes suffice, within bounds elsewhere, complete, and deterministic.
#include "model/pieces/decompose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "concave_solids.h"
#include "import_text.h"
#include "model/mesh/load.h"
#include "model/mesh/mass_properties.h"
#include "model/pieces/pieces.h"

namespace limber::model {
namespace {

double volume_of_hulls(const Decomposition& d) {
  double sum = 0;
  for (const Hull& hull : d.hulls) sum += volume_of(hull);
  return sum;
}

bool is_inside(const Decomposition& d, const Vec3& point, double tolerance) {
  return std::any_of(d.hulls.begin(), d.hulls.end(), [&](const Hull& hull) {
    const std::vector<FacePlane> planes = planes_of(hull);
    return std::all_of(planes.begin(), planes.end(), [&](const FacePlane& plane) {
      return glm::dot(plane.normal, point) <= plane.offset + tolerance;
    });
  });
}

// Points of the triangles are in a hull.
void expect_covered(const test::Solid& solid, const Decomposition& d) {
  for (std::size_t i = 0; i < solid.triangles.size(); i += 3) {
    const Vec3& a = solid.vertices[solid.triangles[i]];
    const Vec3& b = solid.vertices[solid.triangles[i + 1]];
    const Vec3& c = solid.vertices[solid.triangles[i + 2]];
    for (const Vec3& p : {a, (a + b) / 2.0, (a + b + c) / 3.0}) ASSERT_TRUE(is_inside(d, p, 1e-4)) << p.x << " " << p.y;
  }
}

TEST(Decompose, ConvexMeshesStayWhole) {
  for (const test::Solid& solid : {test::box({1, 2, 3}), test::capsule(0.3, 1), test::cylinder(1, 0.1)}) {
    const Decomposition d = decompose(solid.vertices, solid.triangles);
    EXPECT_EQ(d.hulls.size(), 1u);
    EXPECT_LT(d.filled_depth, 1e-5);
  }
}

TEST(Decompose, FindsTheBoxesOfAU) {
  const test::Solid u = test::u_profile();
  const Decomposition d = decompose(u.vertices, u.triangles);
  EXPECT_EQ(d.hulls.size(), 3u);
  EXPECT_LT(d.filled_depth, 1e-5);
  EXPECT_NEAR(volume_of_hulls(d), 7, 1e-5);
  EXPECT_TRUE(is_inside(d, {0.5, 2.9, 0.5}, 0));
  EXPECT_FALSE(is_inside(d, {1.5, 1.1, 0.5}, 0));
  expect_covered(u, d);
}

struct TorusCase {
  double radius, tube;
  Quat rotation;
};

std::vector<TorusCase> tori() {
  std::vector<TorusCase> out{{0.1, 0.02, quat_identity()}, {1, 0.2, quat_euler(0.4, 0.7, 0.2)}};
  for (const double tube : {0.05, 0.1, 0.25, 0.4}) out.push_back({1, tube, quat_identity()});
  return out;
}

// Random points are in a hull if they are in the torus, whose signed distance is √((√(x² + y²) − R)² + z²) − r.
void expect_same_points(const TorusCase& torus, const Decomposition& d) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double size = 2 * (torus.radius + torus.tube);
  // the mesh has 48 × 24 faces: its surface is inside of the torus by up to 1 % of the tube and 0.3 % of the ring
  const double chord = 0.02 * torus.tube + 0.004 * (torus.radius + torus.tube);
  int outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p(0.6 * size * uniform(random), 0.6 * size * uniform(random), 2 * torus.tube * uniform(random));
    const double distance = std::hypot(std::hypot(p.x, p.y) - torus.radius, p.z) - torus.tube;
    const bool inside = is_inside(d, torus.rotation * p, 0);
    if (distance < -chord) {
      ASSERT_TRUE(inside) << p.x << " " << p.y << " " << p.z;
    } else if (distance > 0.03 * size) {
      ASSERT_FALSE(inside) << p.x << " " << p.y << " " << p.z << " is " << distance << " outside";
      ++outside;
    }
  }
  EXPECT_GT(outside, 500);
}

// The volume of a torus is 2π²·R·r²; its hull has 7 to 1.4 times that.
TEST(Decompose, TorusIsWithinAFewPercent) {
  for (const TorusCase& c : tori()) {
    SCOPED_TRACE(fmt::format("{} {}", c.radius, c.tube));
    const test::Solid torus = test::torus(c.radius, c.tube).moved({Vec3(0), c.rotation});
    const Decomposition d = decompose(torus.vertices, torus.triangles);
    const double volume = unit_inertial_of(torus.vertices, torus.triangles).mass;
    EXPECT_NEAR(volume, 2 * kPi * kPi * c.radius * c.tube * c.tube, 0.02 * volume);
    EXPECT_LE(d.hulls.size(), 32u);
    EXPECT_GE(volume_of_hulls(d), 0.9999 * volume);
    EXPECT_LE(volume_of_hulls(d), 1.1 * volume);
    EXPECT_LE(d.filled_depth, 0.02 * 2 * (c.radius + c.tube));
    expect_covered(torus, d);
    expect_same_points(c, d);
  }
}

// A plate of 1 m with a hole of 6 cm: the hole is 0.4 % of the volume, but a peg must fit into it.
TEST(Decompose, SmallHolesOfLargePlatesStayFree) {
  const test::Solid plate = test::plate_with_hole({0.6, 0.5}, {0.66, 0.56}, 0.1);
  const Decomposition d = decompose(plate.vertices, plate.triangles);
  EXPECT_LE(d.hulls.size(), 8u);
  EXPECT_NEAR(volume_of_hulls(d), 0.1 * (1 - 0.0036), 1e-5);
  for (const double x : {0.605, 0.63, 0.655}) {
    for (const double y : {0.505, 0.53, 0.555}) EXPECT_FALSE(is_inside(d, {x, y, 0.05}, 0)) << x << " " << y;
  }
  expect_covered(plate, d);
}

TEST(Decompose, BoundsTheNumberOfPieces) {
  const test::Solid torus = test::torus(1, 0.25);
  double before = 10;
  for (const std::size_t pieces : {1, 2, 4, 8}) {
    const Decomposition d = decompose(torus.vertices, torus.triangles, {pieces, 0.02});
    EXPECT_LE(d.hulls.size(), pieces);
    EXPECT_LE(volume_of_hulls(d), before + 1e-9);
    before = volume_of_hulls(d);
    expect_covered(torus, d);
  }
}

// Cells inside of a solid, whose corners touch no surface: a cube with a hollow at each of its sides.
TEST(Decompose, FillsTheInteriorOfSolids) {
  const test::Solid cup = test::revolved({{0, 0}, {1, 0}, {1, 2}, {0.5, 2}, {0.5, 1}, {0, 1}}, 4);
  const Decomposition d = decompose(cup.vertices, cup.triangles);
  expect_covered(cup, d);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.49, 0.49);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(uniform(random), uniform(random), 0.5 + uniform(random));
    EXPECT_TRUE(is_inside(d, p, 1e-6)) << p.x << " " << p.y << " " << p.z;
  }
}

bool same(const Decomposition& a, const Decomposition& b) {
  return a.filled_depth == b.filled_depth && a.hulls.size() == b.hulls.size() &&
         std::equal(a.hulls.begin(), a.hulls.end(), b.hulls.begin(), [](const Hull& x, const Hull& y) {
           return x.vertices == y.vertices && x.triangles == y.triangles;
         });
}

TEST(Decompose, IsTheSameForAnyOrderAndThread) {
  const test::Solid torus = test::torus(1, 0.3, 24, 12);
  test::Solid shuffled = torus;
  std::vector<std::size_t> order(torus.triangles.size() / 3);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937 random(7);
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) shuffled.triangles[3 * i + k] = torus.triangles[3 * order[i] + (k + i) % 3];
  }
  Decomposition first, second;
  std::thread a([&] { first = decompose(torus.vertices, torus.triangles); });
  std::thread b([&] { second = decompose(shuffled.vertices, shuffled.triangles); });
  a.join();
  b.join();
  EXPECT_GT(first.hulls.size(), 4u);
  EXPECT_TRUE(same(first, second));
  EXPECT_TRUE(same(first, decompose(torus.vertices, torus.triangles)));
}

TEST(Decompose, MeshesKeepTheirSurfaceAndMass) {
  const auto mesh = mesh_from_bytes(test::binary_stl(test::u_profile()), MeshFormat::stl, Vec3(1), "u");
  ASSERT_TRUE(mesh);
  const auto cut = decomposed(*mesh);
  ASSERT_EQ(cut->pieces.size(), 3u);
  for (const PlacedShape& piece : cut->pieces) EXPECT_EQ(piece.shape.kind, ShapeKind::box);
  EXPECT_EQ(cut->triangles, (*mesh)->triangles);
  EXPECT_NEAR(cut->unit_inertial.mass, 7, 1e-6);
  EXPECT_EQ(cut->unit_inertial.tensor, (*mesh)->unit_inertial.tensor);
  EXPECT_TRUE(decomposed(*mesh_from_bytes(test::binary_stl(test::box(Vec3(1))), MeshFormat::stl, Vec3(1), "b"))
                  ->pieces.empty());
}

TEST(Decompose, ReportsMeshesThatAreOpenOrTooLarge) {
  test::Solid open = test::u_profile();
  open.triangles.resize(open.triangles.size() - 3);
  const auto holed = decomposed(*mesh_from_bytes(test::binary_stl(open), MeshFormat::stl, Vec3(1), "u"));
  EXPECT_TRUE(holed->pieces.empty());
  ASSERT_EQ(holed->collision_problems.size(), 1u);
  EXPECT_EQ(holed->collision_problems[0].text, "is open, so that its hollows are unknown; it collides as its hull");
  const test::Solid large = test::torus(1, 0.25, 300, 170);
  const auto whole = decomposed(*mesh_from_bytes(test::binary_stl(large), MeshFormat::stl, Vec3(1), "t"));
  EXPECT_TRUE(whole->pieces.empty());
  ASSERT_EQ(whole->collision_problems.size(), 1u);
  EXPECT_EQ(whole->collision_problems[0].text,
            "has 102000 triangles, too many to decompose (at most 100000); it collides as its hull");
}

}  // namespace
}  // namespace limber::model
