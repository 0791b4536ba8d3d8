// Meshes with pieces collide, are seen and weigh as their pieces do: things pass through their hollows.
#include <gtest/gtest.h>

#include "model/concave_solids.h"
#include "model/mesh/load.h"
#include "model/pieces/decompose.h"
#include "sim/sensors/part_tree.h"
#include "sim/sensors/sensing.h"
#include "sim/shapes/geometry.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

model::ShapeModel shape_of(std::shared_ptr<const model::MeshModel> mesh) {
  model::ShapeModel out;
  out.kind = model::ShapeKind::mesh;
  out.mesh = std::move(mesh);
  return out;
}

model::ShapeModel torus(bool concave, double radius = 1, double tube = 0.25) {
  const auto mesh = model::mesh_from_bytes(model::test::binary_stl(model::test::torus(radius, tube)),
                                           model::MeshFormat::stl, Vec3(1), "torus");
  return shape_of(concave ? model::decomposed(*mesh) : *mesh);
}

// A square ring of four boxes, each an object; its hole is 1 m wide.
model::ShapeModel frame() {
  std::string text;
  int vertices = 0;
  const auto add = [&](const Vec3& size, const Vec3& at) {
    const model::test::Solid box = model::test::box(size).moved({at, quat_identity()});
    text += fmt::format("o side{}\n", vertices);
    for (const Vec3& v : box.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (std::size_t i = 0; i < box.triangles.size(); i += 3)
      text += fmt::format("f {} {} {}\n", static_cast<int>(box.triangles[i]) - 8,
                          static_cast<int>(box.triangles[i + 1]) - 8, static_cast<int>(box.triangles[i + 2]) - 8);
    vertices += 8;
  };
  for (const double x : {-0.75, 0.75}) add({0.5, 2, 0.5}, {x, 0, 0});
  for (const double y : {-0.75, 0.75}) add({1, 0.5, 0.5}, {0, y, 0});
  return shape_of(*model::mesh_from_bytes(text, model::MeshFormat::obj, Vec3(1), "frame"));
}

TEST(Pieces, ABallFallsThroughAFrameOfSeveralObjects) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Part& ring = s.add_single_part(frame(), 0, {{0, 0, 2}, quat_identity()});
  ASSERT_EQ(ring.geometry()->children.size(), 4u);
  EXPECT_NEAR(ring.geometry()->volume, 1.5, 1e-9);
  Part& through = s.add_single_part(sphere_model(0.45), 1, {{0, 0, 4}, quat_identity()});
  Part& large = s.add_single_part(sphere_model(0.6), 1, {{0, 0, 6}, quat_identity()});
  s.ticks(240);
  EXPECT_LT(through.pose().position.z, -10);
  // it touches the upper edges at ±0.5 m, rounded by 1 mm: the center is √(0.601² − 0.501²) above their centers
  EXPECT_NEAR(large.pose().position.z, 2.249 + std::sqrt(0.601 * 0.601 - 0.501 * 0.501), 1e-3);
}

TEST(Pieces, ARodPassesThroughADecomposedTorus) {
  for (const bool concave : {true, false}) {
    WorldFixture s;
    s.gravity({0, 0, -9.81});
    s.add_single_part(torus(concave), 0);
    Part& rod = s.add_single_part(round_model(model::ShapeKind::capsule, 0.3, 1), 1, {{0, 0, 2}, quat_identity()});
    s.ticks(60);
    if (concave) {
      EXPECT_NEAR(rod.pose().position.z, 2 - 9.81 / 2, 0.05) << "free fall";
    } else {
      EXPECT_GT(rod.pose().position.z, 0.5) << "the hull fills the hole";
    }
  }
}

// The hole has a radius of 80 mm.
TEST(Pieces, APegFallsThroughASmallRing) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.add_single_part(torus(true, 0.1, 0.02), 0);
  Part& peg = s.add_single_part(round_model(model::ShapeKind::capsule, 0.07, 0.1), 1, {{0, 0, 0.3}, quat_identity()});
  s.ticks(60);
  EXPECT_NEAR(peg.pose().position.z, 0.3 - 9.81 / 2, 0.05) << "free fall";
}

TEST(Pieces, ADecomposedTorusFallsOverAPost) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  s.add_single_part(round_model(model::ShapeKind::cylinder, 0.2, 1), 0, {{0, 0, 0.5}, quat_identity()});
  Part& ring = s.add_single_part(torus(true), 5, {{0.3, 0, 2}, quat_identity()});
  s.ticks(600);
  EXPECT_NEAR(ring.pose().position.z, 0.25, 0.02);
  EXPECT_LT(glm::length(Vec3(ring.pose().position.x, ring.pose().position.y, 0)), 0.6);
}

// A torus about z of 1 kg: I_z = R² + 3/4·r², I_x = R²/2 + 5/8·r². The mesh has 48 × 24 faces.
TEST(Pieces, MassPropertiesAreThoseOfTheSurface) {
  WorldFixture s;
  const Part& ring = s.add_single_part(torus(true), 1);
  const Vec3 moments = ring.geometry()->unit_inertia;
  EXPECT_NEAR(moments.z, 1 + 0.75 * 0.0625, 0.01);
  EXPECT_NEAR(moments.x, 0.5 + 0.625 * 0.0625, 0.01);
  EXPECT_NEAR(ring.geometry()->volume, 2 * kPi * kPi * 0.0625, 0.02);
}

TEST(Pieces, RaysAndOverlapsSeeTheHole) {
  WorldFixture s;
  s.add_single_part(torus(true), 0);
  s.ticks(1);
  PartTree& parts = s.world.sensing().parts();
  EXPECT_FALSE(parts.ray({0, 0, 3}, {0, 0, -1}, 10));
  const std::optional<RayHit> hit = parts.ray({1, 0, 3}, {0, 0, -1}, 10);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 2.75, 0.02) << "2 % of a piece";
  // from the center outwards it meets the inner side, not the hull
  const std::optional<RayHit> inner = parts.ray({0, 0, 0}, {1, 0, 0}, 10);
  ASSERT_TRUE(inner);
  EXPECT_NEAR(inner->distance, 0.75, 0.06);
}

// Continuous collision: a ball of 1 cm at 100 m/s passes through the hole and is stopped by the ring.
TEST(Pieces, FastBallsHitThePiecesOnly) {
  WorldFixture s;
  s.add_single_part(torus(true, 0.1, 0.02), 0);
  Part& through = s.add_single_part(sphere_model(0.01), 0.01, {{0, 0, 1}, quat_identity()});
  Part& stopped = s.add_single_part(sphere_model(0.01), 0.01, {{0.1, 0, 1}, quat_identity()});
  through.set_velocity({0, 0, -100}, Vec3(0));
  stopped.set_velocity({0, 0, -100}, Vec3(0));
  s.ticks(3);
  EXPECT_NEAR(through.pose().position.z, 1 - 5, 0.01);
  EXPECT_GT(stopped.pose().position.z, 0.02);
}

}  // namespace
}  // namespace limber::sim
