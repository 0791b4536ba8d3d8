// Meshes of several objects: the pieces that they collide as, and their mass properties.
#include "model/pieces/pieces.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files.h"
#include "import_text.h"
#include "model/import.h"
#include "model/mesh/load.h"
#include "model/mesh/mass_properties.h"
#include "model/overlap.h"
#include "model/pieces/decompose.h"
#include "solids.h"

namespace limber::model {
namespace {

std::string lines_of(const test::Solid& solid, const std::string& header, unsigned& vertices) {
  std::string out = header;
  for (const Vec3& v : solid.vertices) out += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (std::size_t i = 0; i < solid.triangles.size(); i += 3) {
    out += fmt::format("f {} {} {}\n", solid.triangles[i] + vertices + 1, solid.triangles[i + 1] + vertices + 1,
                       solid.triangles[i + 2] + vertices + 1);
  }
  vertices += static_cast<unsigned>(solid.vertices.size());
  return out;
}

// An OBJ file in which each solid is an object.
std::string objects(const std::vector<test::Solid>& solids) {
  std::string out;
  unsigned vertices = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) out += lines_of(solids[i], fmt::format("o piece_{}\n", i), vertices);
  return out;
}

std::shared_ptr<const MeshModel> load(const std::string& bytes, MeshFormat format = MeshFormat::obj) {
  const auto mesh = mesh_from_bytes(bytes, format, Vec3(1), "m");
  EXPECT_TRUE(mesh) << mesh.error();
  return mesh ? *mesh : std::make_shared<const MeshModel>();
}

test::Solid box_at(const Vec3& size, const Vec3& at) { return test::box(size).moved({at, quat_identity()}); }

// A U of three boxes that touch.
std::vector<test::Solid> u_shape() {
  return {box_at({3, 1, 1}, {0, 0, 0.5}), box_at({1, 1, 2}, {-1, 0, 2}), box_at({1, 1, 2}, {1, 0, 2})};
}

TEST(MeshPieces, ObjectsOfObjFilesBecomePieces) {
  const auto mesh = load(objects(u_shape()));
  ASSERT_EQ(mesh->pieces.size(), 3u);
  const Vec3 centers[] = {{0, 0, 0.5}, {-1, 0, 2}, {1, 0, 2}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh->pieces[i].shape.kind, ShapeKind::box);
    test::expect_near(mesh->pieces[i].origin.position, centers[i], 1e-9, "center");
  }
  EXPECT_FALSE(mesh->primitive);
  EXPECT_TRUE(mesh->closed);
  EXPECT_TRUE(mesh->collision_problems.empty());
  EXPECT_EQ(decomposed(mesh), mesh) << "its objects are convex";
  EXPECT_NEAR(mesh->hull_volume, 7, 1e-9) << "the sum of the pieces, not the hull of 9 m³";
  // mass properties of three boxes, by the parallel axis theorem
  EXPECT_NEAR(mesh->unit_inertial.mass, 7, 1e-9);
  const double center = (3 * 0.5 + 2 * 2 * 2) / 7;
  test::expect_near(mesh->unit_inertial.center, {0, 0, center}, 1e-9, "center of mass");
  const auto square = [](double x) { return x * x; };
  const double about_y =
      3 * (9 + 1) / 12.0 + 3 * square(center - 0.5) + 2 * (2 * (1 + 4) / 12.0 + 2 * (1 + square(2 - center)));
  EXPECT_NEAR(mesh->unit_inertial.tensor[1][1], about_y, 1e-9);
}

TEST(MeshPieces, GroupsAreObjectsAlsoIfInterleaved) {
  unsigned vertices = 0;
  std::string text = lines_of(box_at(Vec3(1), {0, 0, 0}), "g a\n", vertices);
  text += lines_of(box_at(Vec3(1), {5, 0, 0}), "g b\n", vertices);
  text += lines_of(box_at(Vec3(1), {0, 0, 3}), "g a\n", vertices);
  const auto mesh = load(text);
  EXPECT_EQ(mesh->pieces.size(), 2u) << "both boxes of a are one object";
  EXPECT_TRUE(mesh->closed);
  EXPECT_NEAR(mesh->hull_volume, 4 + 1, 1e-9);
}

TEST(MeshPieces, OneObjectIsOneHull) {
  test::Solid both = box_at(Vec3(1), {0, 0, 0});
  both.add(box_at(Vec3(1), {3, 0, 0}));
  const auto plain = load(test::obj(both));
  const auto named = load("o one\n" + test::obj(both));
  for (const auto& mesh : {plain, named}) {
    EXPECT_TRUE(mesh->pieces.empty());
    EXPECT_NEAR(mesh->hull_volume, 4, 1e-9);
  }
  EXPECT_EQ(plain->hull, named->hull);
}

// Exporters write an object for each material: such patches of one surface are no solids of their own.
TEST(MeshPieces, PatchesOfOneSurfaceStayTogether) {
  const test::Solid box = test::box({1, 2, 3});
  std::string text;
  for (const Vec3& v : box.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (std::size_t i = 0; i < box.triangles.size(); i += 3)
    text += fmt::format("g face{}\nf {} {} {}\n", i / 6, box.triangles[i] + 1, box.triangles[i + 1] + 1,
                        box.triangles[i + 2] + 1);
  EXPECT_TRUE(load(text)->pieces.empty());
  ASSERT_TRUE(load(text)->primitive);
  unsigned vertices = 8;
  const auto with_lid = load(text + lines_of(box_at(Vec3(1), {0, 0, 5}), "g lid\n", vertices));
  EXPECT_EQ(with_lid->pieces.size(), 2u);
  EXPECT_TRUE(with_lid->closed);
  EXPECT_NEAR(with_lid->unit_inertial.mass, 7, 1e-9);
}

TEST(MeshPieces, OpenObjectsCountAsTheirHulls) {
  test::Solid open = box_at(Vec3(1), {0, 0, 0});
  open.triangles.resize(open.triangles.size() - 3);
  const auto mesh = load(objects({open, box_at(Vec3(2), {5, 0, 0})}));
  ASSERT_EQ(mesh->pieces.size(), 2u);
  EXPECT_FALSE(mesh->closed);
  EXPECT_NEAR(mesh->unit_inertial.mass, 9, 1e-9);
  EXPECT_NEAR(mesh->unit_inertial.center.x, 40.0 / 9, 1e-9);
}

TEST(MeshPieces, ObjectsInsideOthersAreNoPieces) {
  const auto shell =
      load(objects({box_at(Vec3(2), {0, 0, 0}), box_at(Vec3(1), {0, 0, 0}), box_at(Vec3(1), {4, 0, 0})}));
  EXPECT_EQ(shell->pieces.size(), 2u);
  EXPECT_TRUE(load(objects({box_at(Vec3(2), {0, 0, 0}), box_at(Vec3(1), {0, 0, 0})}))->pieces.empty());
  const auto twins = load(objects({box_at(Vec3(2), {0, 0, 0}), box_at(Vec3(2), {0, 0, 0})}));
  EXPECT_TRUE(twins->pieces.empty());
}

TEST(MeshPieces, ReportsTooManyObjects) {
  std::vector<test::Solid> many;
  for (int i = 0; i < static_cast<int>(kMaxPieces); ++i) many.push_back(box_at(Vec3(1), {2.0 * i, 0, 0}));
  EXPECT_EQ(load(objects(many))->pieces.size(), kMaxPieces);
  many.push_back(box_at(Vec3(1), {0, 5, 0}));
  const auto mesh = load(objects(many));
  EXPECT_TRUE(mesh->pieces.empty());
  ASSERT_EQ(mesh->collision_problems.size(), 1u);
  EXPECT_EQ(mesh->collision_problems[0].text, "has 65 objects, more than 64; it collides as one hull");
}

TEST(MeshPieces, ScalesMirrorsAndPlacesPieces) {
  const auto mesh = mesh_from_bytes(objects(u_shape()), MeshFormat::obj, {2, 1, -1}, "m");
  ASSERT_TRUE(mesh);
  ASSERT_EQ((*mesh)->pieces.size(), 3u);
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 14, 1e-9);
  PlacedShape placed;
  placed.shape.kind = ShapeKind::mesh;
  placed.shape.mesh = *mesh;
  placed.origin = {{0, 10, 0}, quat_axis({0, 0, 1}, kPi / 2)};
  const std::vector<PlacedShape> convex = convex_shapes(placed);
  ASSERT_EQ(convex.size(), 3u);
  test::expect_near(convex[1].origin.position, {0, 8, -2}, 1e-9, "the left prong");
}

// MuJoCo makes one hull of each mesh.
TEST(MeshPieces, MeshesOfMjcfFilesAreOneHull) {
  const test::Files files;
  files.write("u.obj", objects(u_shape()));
  const std::string path =
      files.write("u.xml",
                  "<mujoco><asset><mesh file='u.obj'/></asset><worldbody><body><freejoint/>"
                  "<geom type='mesh' mesh='u'/><geom type='mesh' mesh='u' pos='9 0 0'/></body></worldbody></mujoco>");
  const auto model = import_model(path);
  ASSERT_TRUE(model) << model.error();
  const std::vector<PlacedShape>& shapes = (*model)->links.at(0).collisions;
  ASSERT_EQ(shapes.size(), 2u);
  for (const PlacedShape& shape : shapes) {
    EXPECT_EQ(convex_shapes(shape).size(), 1u);
    EXPECT_NEAR(shape.shape.mesh->hull_volume, 9, 1e-6);
  }
}

// A ball between the prongs of the U overlaps with its hull, but with none of its pieces.
TEST(MeshPieces, OverlapsLeaveTheHollowFree) {
  PlacedShape u, ball;
  u.shape.kind = ShapeKind::mesh;
  u.shape.mesh = load(objects(u_shape()));
  ball.shape.kind = ShapeKind::sphere;
  ball.shape.radius = 0.45;
  ball.origin.position = {0, 0, 2};
  const auto count = [&] {
    const std::vector<PlacedShape> a{u}, b{ball};
    const std::vector<OverlapPart> parts{{a, Pose{}}, {b, Pose{}}};
    return find_overlaps(parts, [](auto, auto) { return true; }).found.size();
  };
  EXPECT_EQ(count(), 0u);
  ball.origin.position.x = 0.2;
  EXPECT_EQ(count(), 1u);
}

}  // namespace
}  // namespace limber::model
