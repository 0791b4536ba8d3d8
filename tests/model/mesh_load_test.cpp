// Valid and invalid mesh files of each format, generated from known solids.
#include "model/mesh/load.h"

#include <gtest/gtest.h>

#include "import_text.h"
#include "solids.h"

namespace limber::model {
namespace {

using MeshResult = Result<std::shared_ptr<const MeshModel>>;

MeshModel loaded(const MeshResult& result) {
  if (result) return **result;
  ADD_FAILURE() << result.error();
  return {};
}

MeshModel load(const std::string& bytes, MeshFormat format, const Vec3& scale = Vec3(1)) {
  return loaded(mesh_from_bytes(bytes, format, scale, "m"));
}

std::string fault(const std::string& bytes, MeshFormat format, const Vec3& scale = Vec3(1)) {
  const MeshResult result = mesh_from_bytes(bytes, format, scale, "m");
  return result ? "loaded" : result.error();
}

Vec3 size_of(const MeshModel& mesh) {
  Vec3 low = mesh.vertices.at(0), high = low;
  for (const Vec3& v : mesh.vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  return high - low;
}

void expect_box(const MeshModel& mesh, const Vec3& size, const std::string& label) {
  EXPECT_EQ(mesh.vertices.size(), 8u) << label;
  EXPECT_EQ(mesh.triangles.size(), 36u) << label;
  EXPECT_TRUE(mesh.closed) << label;
  test::expect_near(size_of(mesh), size, 1e-6, label);
  EXPECT_NEAR(mesh.unit_inertial.mass, size.x * size.y * size.z, 1e-5) << label;
  ASSERT_TRUE(mesh.primitive) << label;
  EXPECT_EQ(mesh.primitive->shape.kind, ShapeKind::box) << label;
}

TEST(MeshLoad, AllFormatsGiveTheSameBox) {
  const test::Solid box = test::box({1, 2, 3});
  expect_box(load(test::binary_stl(box), MeshFormat::stl), {1, 2, 3}, "binary STL");
  expect_box(load(test::binary_stl(box, "solid but binary"), MeshFormat::stl), {1, 2, 3}, "binary STL that says solid");
  expect_box(load(test::binary_stl(box) + "more", MeshFormat::stl), {1, 2, 3}, "binary STL with a tail");
  expect_box(load(test::ascii_stl(box), MeshFormat::stl), {1, 2, 3}, "ASCII STL");
  expect_box(load(test::obj(box), MeshFormat::obj), {1, 2, 3}, "OBJ");
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    expect_box(load(test::dae(box, 1, up, ""), MeshFormat::dae), {1, 2, 3}, up);
  }
}

TEST(MeshLoad, AppliesColladaUnitsAndNodes) {
  const test::Solid box = test::box({1, 2, 3});
  expect_box(load(test::dae(box, 0.5, "Z_UP", ""), MeshFormat::dae), {0.5, 1, 1.5}, "unit");
  const MeshModel placed =
      load(test::dae(box, 1, "Z_UP", "<translate>10 0 0</translate><scale>2 1 -1</scale>"), MeshFormat::dae);
  expect_box(placed, {2, 2, 3}, "node");
  test::expect_near(placed.unit_inertial.center, {10, 0, 0}, 1e-5);
}

TEST(MeshLoad, ScalingAndMirroringKeepTheOrientation) {
  const test::Solid box = test::box({1000, 2000, 3000});
  const Vec3 scales[] = {{0.001, 0.001, 0.001}, {-0.001, 0.001, 0.001}, {-0.001, -0.001, -0.001}};
  for (const Vec3& scale : scales) {
    const MeshModel mesh = load(test::binary_stl(box), MeshFormat::stl, scale);
    expect_box(mesh, {1, 2, 3}, "scaled");
    double volume = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const Vec3& a = mesh.vertices[mesh.triangles[i]];
      volume += glm::dot(a, glm::cross(mesh.vertices[mesh.triangles[i + 1]], mesh.vertices[mesh.triangles[i + 2]])) / 6;
    }
    EXPECT_NEAR(volume, 6, 1e-5);
  }
}

TEST(MeshLoad, MirroredOpenMeshesFaceTheOtherWay) {
  // an open sheet has no inside: only the winding defines its front
  test::Solid sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.triangles = {0, 1, 2};
  const auto front_normal = [](const MeshModel& m) {
    const Vec3& a = m.vertices[m.triangles[0]];
    return normalized(glm::cross(m.vertices[m.triangles[1]] - a, m.vertices[m.triangles[2]] - a));
  };
  const std::string node = "<scale>1 1 -1</scale>";
  EXPECT_EQ(front_normal(load(test::binary_stl(sheet), MeshFormat::stl)), Vec3(0, 0, 1));
  EXPECT_EQ(front_normal(load(test::binary_stl(sheet), MeshFormat::stl, {1, 1, -1})), Vec3(0, 0, -1));
  EXPECT_EQ(front_normal(load(test::dae(sheet, 1, "Z_UP", ""), MeshFormat::dae)), Vec3(0, 0, 1));
  EXPECT_EQ(front_normal(load(test::dae(sheet, 1, "Z_UP", node), MeshFormat::dae)), Vec3(0, 0, -1));
  EXPECT_EQ(front_normal(load(test::dae(sheet, 1, "Z_UP", node), MeshFormat::dae, {1, 1, -1})), Vec3(0, 0, 1));
}

TEST(MeshLoad, FlipsInsideOutMeshes) {
  test::Solid box = test::box({1, 2, 3});
  for (std::size_t i = 0; i < box.triangles.size(); i += 3) std::swap(box.triangles[i], box.triangles[i + 1]);
  expect_box(load(test::binary_stl(box), MeshFormat::stl), {1, 2, 3}, "inside out");
}

TEST(MeshLoad, OpenMeshesUseTheHullsVolume) {
  test::Solid box = test::box({1, 2, 3});
  box.triangles.resize(box.triangles.size() - 6);
  const MeshModel mesh = load(test::binary_stl(box), MeshFormat::stl);
  EXPECT_FALSE(mesh.closed);
  EXPECT_NEAR(mesh.unit_inertial.mass, 6, 1e-5);
}

TEST(MeshLoad, HollowMeshesUseTheirOwnVolume) {
  // a box with a box-shaped cavity; the cavity's faces are oriented inwards
  test::Solid shell = test::box({1, 1, 1});
  test::Solid hole = test::box({0.8, 0.8, 0.8});
  for (std::size_t i = 0; i < hole.triangles.size(); i += 3) std::swap(hole.triangles[i], hole.triangles[i + 1]);
  shell.add(hole);
  const MeshModel mesh = load(test::binary_stl(shell), MeshFormat::stl);
  EXPECT_TRUE(mesh.closed);
  EXPECT_NEAR(mesh.unit_inertial.mass, 1 - 0.512, 1e-5);
  EXPECT_NEAR(mesh.unit_inertial.tensor[0][0], 1.0 / 6 - 0.512 * 0.64 / 6, 1e-5);
}

TEST(MeshLoad, ReducesHulls) {
  const MeshModel mesh = load(test::binary_stl(test::cylinder(0.5, 2, 500)), MeshFormat::stl);
  EXPECT_EQ(mesh.vertices.size(), 1002u);
  EXPECT_GE(mesh.hull.size(), 16u);
  EXPECT_LE(mesh.hull.size(), 64u);
  EXPECT_GT(mesh.hull_error, 0);
  EXPECT_LE(mesh.hull_error, 0.02 * 2);
}

TEST(MeshLoad, FlatMeshesGetAThinHull) {
  test::Solid sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.quad(0, 1, 2, 3);
  const MeshModel mesh = load(test::binary_stl(sheet), MeshFormat::stl);
  EXPECT_FALSE(mesh.closed);
  EXPECT_EQ(mesh.hull.size(), 8u);
  EXPECT_NEAR(mesh.unit_inertial.mass, 0.002, 1e-8);
}

TEST(MeshLoad, ReadsUnusualObjFiles) {
  const std::string quad_negative = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf -5 -4 -3 -2\nf 1 2 5\n";
  const MeshModel mesh = load(quad_negative, MeshFormat::obj);
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.triangles.size(), 9u);
}

TEST(MeshLoad, RejectsInvalidFilesWithAFix) {
  const test::Solid box = test::box({1, 2, 3});
  const std::string stl = test::binary_stl(box);
  const std::string ascii = test::ascii_stl(box);
  std::string huge = stl;
  huge.replace(80, 4, "\xFF\xFF\xFF\xFF");
  std::string nan = ascii;
  nan.replace(nan.find("vertex ") + 7, 4, "nan ");
  struct Case {
    const char* name;
    std::string bytes;
    MeshFormat format;
    const char* says;
  };
  const Case cases[] = {{"empty", "", MeshFormat::stl, "empty"},
                        {"garbage", "this is no mesh", MeshFormat::stl, "can't be read"},
                        {"cut binary", stl.substr(0, 300), MeshFormat::stl, "can't be read"},
                        {"huge count", huge, MeshFormat::stl, "can't be read"},
                        {"cut ASCII", ascii.substr(0, ascii.size() / 2), MeshFormat::stl, "endsolid"},
                        {"not finite", nan, MeshFormat::stl, "finite"},
                        {"obj lines only", "v 0 0 0\nv 1 0 0\nl 1 2\n", MeshFormat::obj, "."},
                        {"obj index", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", MeshFormat::obj, "."},
                        {"no collada", "<COLLADA/>", MeshFormat::dae, "."},
                        {"stl as dae", stl, MeshFormat::dae, "Collada"}};
  for (const Case& c : cases) {
    const std::string text = fault(c.bytes, c.format);
    EXPECT_NE(text, "loaded") << c.name;
    EXPECT_NE(text.find(c.says), std::string::npos) << c.name << ": " << text;
    EXPECT_NE(text.find(". "), std::string::npos) << "no fix: " << text;
  }
  EXPECT_NE(fault(stl, MeshFormat::stl, {1e9, 1, 1}).find("scale"), std::string::npos);
}

TEST(MeshLoad, DetectsFormatsByExtensionInAnyCase) {
  EXPECT_EQ(*mesh_format_of("a/b.STL"), MeshFormat::stl);
  EXPECT_EQ(*mesh_format_of("b.Obj"), MeshFormat::obj);
  EXPECT_EQ(*mesh_format_of("x.y.dae"), MeshFormat::dae);
  EXPECT_EQ(*mesh_format_of("x.glTF"), MeshFormat::gltf);
  EXPECT_EQ(*mesh_format_of("x.GLB"), MeshFormat::glb);
  EXPECT_EQ(*mesh_format_of("x.ply"), MeshFormat::ply);
  for (const char* path : {"stl", "x.stlx", "x.xyz", "", ".", "x.stl/y"}) EXPECT_FALSE(mesh_format_of(path)) << path;
}

TEST(MeshLoad, ErrorsNameTheFile) {
  const MeshResult missing = load_mesh("no/such/mesh.stl", Vec3(1));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("no/such/mesh.stl"), std::string::npos);
}

}  // namespace
}  // namespace limber::model
