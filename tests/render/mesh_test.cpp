// Meshes are closed, oriented outwards, and have the size of their shape.
#include "ui/render/mesh.h"

#include <algorithm>
#include <cstring>
#include <numbers>

#include "render/stage.h"

namespace limber::render::test {
namespace {

struct Solid {
  std::vector<Vec3> points;  // three per triangle
  std::vector<Vec3> normals;

  double volume() const {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); i += 3)
      sum += glm::dot(points[i], glm::cross(points[i + 1], points[i + 2])) / 6;
    return sum;
  }
  Vec3 area() const {  // vector area; zero for a closed surface
    Vec3 sum(0);
    for (std::size_t i = 0; i < points.size(); i += 3)
      sum += glm::cross(points[i + 1] - points[i], points[i + 2] - points[i]);
    return sum;
  }
  Vec3 half_size() const {
    Vec3 max_extent(0);
    for (const Vec3& p : points) max_extent = glm::max(max_extent, glm::abs(p));
    return max_extent;
  }
};

// applies the vertex shader's formula
Solid solid(const MeshVertices& vertices, const MeshSize& size) {
  Solid out;
  for (const MeshVertex& v : vertices) {
    const Vec3 corner(v.corner[0], v.corner[1], v.corner[2]);
    const Vec3 normal(v.normal[0], v.normal[1], v.normal[2]);
    out.points.push_back(corner * size.extent + normal * size.rounding_radius);
    out.normals.push_back(size.rounding_radius > 0 ? normal : normalized(normal / size.extent));
  }
  return out;
}

TEST(Mesh, PrimitivesAreClosedAndHaveTheirSize) {
  const double pi = std::numbers::pi;
  struct Case {
    model::ShapeModel shape;
    Vec3 half;
    double volume;
  };
  model::ShapeModel egg = box({0.2, 0.4, 1});
  egg.kind = model::ShapeKind::ellipsoid;
  const Case cases[] = {
      {box({0.2, 0.4, 1}), {0.1, 0.2, 0.5}, 0.08},
      {egg, {0.1, 0.2, 0.5}, pi / 6 * 0.08},
      {round(model::ShapeKind::sphere, 0.5), Vec3(0.5), pi / 6},
      {round(model::ShapeKind::capsule, 0.2, 1), {0.2, 0.2, 0.7}, pi * 0.04 + 4 * pi / 3 * 0.008},
      {round(model::ShapeKind::cylinder, 0.2, 1), {0.2, 0.2, 0.5}, pi * 0.04},
      {round(model::ShapeKind::cone, 0.2, 1), {0.2, 0.2, 0.5}, pi * 0.04 / 3},
  };
  for (const Case& c : cases) {
    for (int detail = 0; detail < kDetailLevels; detail++) {
      SCOPED_TRACE(fmt::format("kind {} detail {}", static_cast<int>(c.shape.kind), detail));
      const Solid mesh = solid(primitive_mesh(c.shape.kind, detail), mesh_size(c.shape));
      ASSERT_FALSE(mesh.points.empty());
      EXPECT_LT(glm::length(mesh.area()), 1e-5);
      EXPECT_LT(glm::length(mesh.half_size() - c.half), 1e-6) << "to the outermost point";
      EXPECT_GT(mesh.volume(), c.volume * (detail == 0 ? 0.95 : 0.8));
      EXPECT_LT(mesh.volume(), c.volume * 1.001);
      for (std::size_t i = 0; i < mesh.points.size(); i++) {
        const std::size_t t = i - i % 3;
        const Vec3 flat = glm::cross(mesh.points[t + 1] - mesh.points[t], mesh.points[t + 2] - mesh.points[t]);
        EXPECT_GE(glm::dot(normalized(flat), mesh.normals[i]), flat == Vec3(0) ? 0 : 0.3) << i;
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5);
      }
    }
    EXPECT_GT(primitive_mesh(c.shape.kind, 0).size(), 2 * primitive_mesh(c.shape.kind, 2).size());
  }
  EXPECT_TRUE(primitive_mesh(model::ShapeKind::plane, 0).empty());
}

model::MeshModel cube() {
  model::MeshModel m;
  for (int i = 0; i < 8; i++) m.vertices.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  m.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

TEST(Mesh, SharpEdgesStaySharp) {
  const model::MeshModel model = cube();
  const Solid mesh = solid(model_mesh(model, 0), {});
  EXPECT_NEAR(mesh.volume(), 1, 1e-6);
  for (const Vec3& n : mesh.normals) EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-6);
}

// a sphere of triangles with shared vertices
model::MeshModel ball(unsigned around) {
  model::MeshModel m;
  for (unsigned i = 0; i <= around; i++) {
    for (unsigned k = 0; k < around; k++) {
      const double up = std::numbers::pi * i / around;
      const double azimuth = 2 * std::numbers::pi * k / around;
      m.vertices.emplace_back(std::sin(up) * std::cos(azimuth), std::sin(up) * std::sin(azimuth), std::cos(up));
    }
  }
  for (unsigned i = 0; i < around; i++) {
    for (unsigned k = 0; k < around; k++) {
      const unsigned a = i * around + k;
      const unsigned b = i * around + (k + 1) % around;
      for (const unsigned v : {a, a + around, b, b, a + around, b + around}) m.triangles.push_back(v);
    }
  }
  return m;
}

TEST(Mesh, RoundMeshesAreSmooth) {
  const Solid mesh = solid(model_mesh(ball(24), 0), {});
  for (std::size_t i = 0; i < mesh.points.size(); i++) {
    if (std::abs(mesh.points[i].z) < 0.95) {
      EXPECT_GT(glm::dot(mesh.points[i], mesh.normals[i]), 0.995);
    }
  }
}

TEST(Mesh, CoarserDetailKeepsTheShape) {
  const model::MeshModel model = ball(80);  // 12 800 triangles
  std::size_t before = model_mesh(model, 0).size();
  for (const int detail : {1, 2}) {
    const MeshVertices vertices = model_mesh(model, detail);
    EXPECT_LT(2 * vertices.size(), before);
    EXPECT_NEAR(solid(vertices, {}).volume(), 4 * std::numbers::pi / 3, 0.9);
    before = vertices.size();
  }
}

TEST(Mesh, IgnoresBadIndices) {
  model::MeshModel model = cube();
  model.triangles.insert(model.triangles.end(), {0, 1, 8, 7});
  EXPECT_EQ(model_mesh(model, 0).size(), 36u);
  EXPECT_TRUE(model_mesh(model::MeshModel{}, 2).empty());
}

TEST(Mesh, SharesVertices) {
  for (const model::ShapeKind kind :
       {model::ShapeKind::box, model::ShapeKind::sphere, model::ShapeKind::capsule, model::ShapeKind::cylinder}) {
    for (int detail = 0; detail < kDetailLevels; detail++) {
      const MeshVertices triangles = primitive_mesh(kind, detail);
      const IndexedMesh mesh = with_shared_vertices(triangles);
      EXPECT_LT(mesh.vertices.size(), triangles.size() / 2);
      // the triangles with a non-zero area, in their order
      MeshVertices again;
      for (const std::uint32_t i : mesh.indices) again.push_back(mesh.vertices.at(i));
      const auto same = [](const MeshVertex& a, const MeshVertex& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
      std::size_t at = 0;
      for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        const MeshVertex* const t = &triangles[i];
        if (same(t[0], t[1]) || same(t[1], t[2]) || same(t[0], t[2])) continue;
        for (int k = 0; k < 3; k++) ASSERT_TRUE(same(again.at(at++), t[k])) << i;
      }
      EXPECT_EQ(at, again.size());
    }
  }
  EXPECT_EQ(with_shared_vertices(primitive_mesh(model::ShapeKind::box, kDetailLevels - 1)).vertices.size(), 24U);
  EXPECT_EQ(with_shared_vertices(primitive_mesh(model::ShapeKind::box, kDetailLevels - 1)).indices.size(), 3U * 44);
  EXPECT_TRUE(with_shared_vertices(MeshVertices{}).indices.empty());
}

}  // namespace
}  // namespace limber::render::test
