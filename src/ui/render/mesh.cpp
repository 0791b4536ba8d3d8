// Meshes of primitives (surfaces of revolution and boxes), and meshes of files with normals and levels of detail.
#include "ui/render/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace limber::render {

namespace {

constexpr double kMinCreaseCosine = 0.82;  // cosine of 35°: normals are averaged across smaller angles
constexpr std::size_t kMaxNeighbors = 64;  // vertices with more triangles are not smoothed, to bound the time

struct Point {
  Vec3 corner;
  Vec3 normal;
};

MeshVertex vertex_of(const Point& p) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {{f(p.corner.x), f(p.corner.y), f(p.corner.z)}, {f(p.normal.x), f(p.normal.y), f(p.normal.z)}};
}

void add_quad(MeshVertices& out, const Point& a, const Point& b, const Point& c, const Point& d) {
  for (const Point* p : {&a, &b, &c, &a, &c, &d}) out.push_back(vertex_of(*p));
}

// one point of a profile: radius and height of the corner and of the normal
struct ProfilePoint {
  double corner_r, corner_z, normal_r, normal_z;
};

// revolves a profile, given from top to bottom, about z
MeshVertices revolve(const std::vector<ProfilePoint>& profile, int around) {
  MeshVertices out;
  const auto at = [&](const ProfilePoint& rim, int step) {
    const double angle = 2 * std::numbers::pi * step / around;
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    return Point{{rim.corner_r * x, rim.corner_r * y, rim.corner_z},
                 {rim.normal_r * x, rim.normal_r * y, rim.normal_z}};
  };
  for (std::size_t i = 0; i + 1 < profile.size(); i++) {
    for (int k = 0; k < around; k++) {
      const ProfilePoint& up = profile[i];
      const ProfilePoint& down = profile[i + 1];
      add_quad(out, at(down, k), at(down, k + 1), at(up, k + 1), at(up, k));
    }
  }
  return out;
}

// appends a quarter circle of normals around one corner: from up to outward, or from outward to down (`lower`)
void add_quarter(std::vector<ProfilePoint>& profile, double corner_r, double corner_z, bool lower, int steps) {
  for (int i = 0; i <= steps; i++) {
    const double angle = std::numbers::pi / 2 * (static_cast<double>(i) / steps + (lower ? 1 : 0));
    profile.push_back({corner_r, corner_z, std::sin(angle), std::cos(angle)});
  }
}

MeshVertices round_mesh(model::ShapeKind kind, int detail) {
  const int around = std::array{40, 20, 12, 8}[static_cast<std::size_t>(detail)];
  const int quarter = std::array{10, 5, 3, 3}[static_cast<std::size_t>(detail)];
  const int bevel = std::array{3, 2, 1, 1}[static_cast<std::size_t>(detail)];
  std::vector<ProfilePoint> profile;
  if (kind == model::ShapeKind::sphere || kind == model::ShapeKind::capsule) {
    const double end = kind == model::ShapeKind::capsule ? 1 : 0;
    add_quarter(profile, 0, end, false, quarter);
    add_quarter(profile, 0, -end, true, quarter);
    return revolve(profile, around);
  }
  if (kind == model::ShapeKind::cylinder) {
    profile.push_back({0, 1, 0, 1});
    add_quarter(profile, 1, 1, false, bevel);
    add_quarter(profile, 1, -1, true, bevel);
    profile.push_back({0, -1, 0, -1});
    return revolve(profile, around);
  }
  // a cone: the apex has the normals of the side; the shader adapts them to its proportions
  profile = {{0, 1, 1, 0.5}, {1, -1, 1, 0.5}};
  MeshVertices out = revolve(profile, around);
  const MeshVertices bottom = revolve({{1, -1, 0, -1}, {0, -1, 0, -1}}, around);
  out.insert(out.end(), bottom.begin(), bottom.end());
  return out;
}

// a cube with rounded edges and corners: each face is a grid, and its outer cells form the bevel
MeshVertices box_mesh(int detail) {
  const int steps = std::array{3, 2, 1}[static_cast<std::size_t>(detail)];
  // along one axis of a face: corners at -1 and 1, the normal's tangent between -45° and 45°
  std::vector<std::pair<double, double>> line;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i <= steps; i++) {
      const double t = side < 0 ? 1 - static_cast<double>(i) / steps : static_cast<double>(i) / steps;
      line.emplace_back(side, side * std::tan(std::numbers::pi / 4 * t));
    }
  }
  MeshVertices out;
  for (int axis = 0; axis < 3; axis++) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](std::size_t i, std::size_t k) {
        Point p;
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        p.corner[axis] = side;
        p.corner[u] = line[i].first;
        p.corner[v] = line[k].first;
        p.normal[axis] = side;
        p.normal[u] = line[i].second;
        p.normal[v] = line[k].second;
        p.normal = normalized(p.normal);
        return p;
      };
      for (std::size_t i = 0; i + 1 < line.size(); i++) {
        for (std::size_t k = 0; k + 1 < line.size(); k++) {
          if (side > 0) {
            add_quad(out, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
          } else {
            add_quad(out, at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
          }
        }
      }
    }
  }
  return out;
}

// a cube with flat chamfers: a strip along each edge and a triangle at each corner
MeshVertices chamfered_box() {
  MeshVertices out;
  // a corner of the face perpendicular to `axis`; `signs` selects the corner of the cube
  const auto at = [](int axis, const std::array<int, 3>& signs) {
    Point p{{signs[0], signs[1], signs[2]}, Vec3(0)};
    p.normal[axis] = signs[static_cast<std::size_t>(axis)];
    return vertex_of(p);
  };
  const auto add = [&out](const std::array<MeshVertex, 3>& t, bool turned) {
    out.insert(out.end(), {t[0], turned ? t[2] : t[1], turned ? t[1] : t[2]});
  };
  for (const int side : {-1, 1}) {
    for (int axis = 0; axis < 3; axis++) {
      const auto u = static_cast<std::size_t>((axis + 1) % 3);
      const auto v = static_cast<std::size_t>((axis + 2) % 3);
      const auto corner = [&](int a, int b) {
        std::array<int, 3> signs{};
        signs[static_cast<std::size_t>(axis)] = side;
        signs[u] = a;
        signs[v] = b;
        return signs;
      };
      add({at(axis, corner(-1, -1)), at(axis, corner(1, -1)), at(axis, corner(1, 1))}, side < 0);
      add({at(axis, corner(-1, -1)), at(axis, corner(1, 1)), at(axis, corner(-1, 1))}, side < 0);
      // the strips along v to the neighboring faces in direction u
      for (const int a : {-1, 1}) {
        const MeshVertex low = at(axis, corner(a, -1)), high = at(axis, corner(a, 1));
        const MeshVertex beyond_low = at(static_cast<int>(u), corner(a, -1));
        const MeshVertex beyond_high = at(static_cast<int>(u), corner(a, 1));
        add({low, beyond_low, beyond_high}, side * a < 0);
        add({low, beyond_high, high}, side * a < 0);
      }
    }
    for (const int a : {-1, 1}) {
      for (const int b : {-1, 1}) {
        const std::array<int, 3> signs = {side, a, b};
        add({at(0, signs), at(1, signs), at(2, signs)}, side * a * b < 0);
      }
    }
  }
  return out;
}

struct Soup {
  std::vector<Vec3> points;
  std::vector<std::array<unsigned, 3>> triangles;
};

Soup soup_of(const model::MeshModel& model) {
  Soup soup{model.vertices, {}};
  const auto count = static_cast<unsigned>(model.vertices.size());
  for (std::size_t i = 0; i + 2 < model.triangles.size(); i += 3) {
    const std::array<unsigned, 3> t = {model.triangles[i], model.triangles[i + 1], model.triangles[i + 2]};
    if (t[0] < count && t[1] < count && t[2] < count) soup.triangles.push_back(t);
  }
  return soup;
}

// vertex clustering: merges the points of each grid cell into their mean and removes collapsed triangles
Soup cluster_vertices(const Soup& fine, int cells) {
  Vec3 low(1e300);
  Vec3 high(-1e300);
  for (const Vec3& p : fine.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const Vec3 size = high - low;
  const double cell = std::max({size.x, size.y, size.z, 1e-12}) / cells;
  Soup out;
  std::map<std::tuple<int, int, int>, unsigned> cell_of;
  std::vector<unsigned> cluster_of(fine.points.size());
  std::vector<double> count;
  for (std::size_t i = 0; i < fine.points.size(); i++) {
    const Vec3 q = (fine.points[i] - low) / cell + 0.5;
    const auto key = std::tuple(static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(q.z));
    const auto [found, fresh] = cell_of.try_emplace(key, static_cast<unsigned>(out.points.size()));
    if (fresh) {
      out.points.emplace_back(0);
      count.push_back(0);
    }
    cluster_of[i] = found->second;
    out.points[cluster_of[i]] += fine.points[i];
    count[cluster_of[i]] += 1;
  }
  for (std::size_t i = 0; i < out.points.size(); i++) out.points[i] /= count[i];
  for (const auto& t : fine.triangles) {
    const std::array<unsigned, 3> moved = {cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[0] != moved[2]) out.triangles.push_back(moved);
  }
  return out;
}

}  // namespace

MeshVertices primitive_mesh(model::ShapeKind kind, int detail) {
  switch (kind) {
    case model::ShapeKind::box:
      return detail == kDetailLevels - 1 ? chamfered_box() : box_mesh(detail);
    case model::ShapeKind::sphere:
    case model::ShapeKind::capsule:
    case model::ShapeKind::cylinder:
    case model::ShapeKind::cone:
      return round_mesh(kind, detail);
    default:
      return {};
  }
}

MeshVertices model_mesh(const model::MeshModel& model, int detail) {
  Soup soup = soup_of(model);
  if (detail > 0 && soup.triangles.size() > 200) soup = cluster_vertices(soup, detail == 1 ? 16 : 8);
  std::vector<Vec3> face_normals;
  std::vector<std::vector<unsigned>> triangles_at(soup.points.size());
  face_normals.reserve(soup.triangles.size());
  for (const auto& t : soup.triangles) {
    const Vec3 along = soup.points[t[1]] - soup.points[t[0]];
    for (const unsigned corner : t) triangles_at[corner].push_back(static_cast<unsigned>(face_normals.size()));
    face_normals.push_back(
        glm::cross(along, soup.points[t[2]] - soup.points[t[0]]));  // not normalized: weighted by area
  }
  MeshVertices out;
  out.reserve(3 * soup.triangles.size());
  for (std::size_t i = 0; i < soup.triangles.size(); i++) {
    const Vec3 face_normal = normalized(face_normals[i]);
    for (const unsigned corner : soup.triangles[i]) {
      Vec3 sum = face_normals[i];
      if (triangles_at[corner].size() <= kMaxNeighbors) {
        for (const unsigned neighbor : triangles_at[corner]) {
          if (neighbor != i && glm::dot(face_normal, normalized(face_normals[neighbor])) > kMinCreaseCosine)
            sum += face_normals[neighbor];
        }
      }
      out.push_back(vertex_of({soup.points[corner], normalized(sum)}));
    }
  }
  return out;
}

IndexedMesh with_shared_vertices(const MeshVertices& triangles) {
  IndexedMesh out;
  std::unordered_map<std::string_view, std::uint32_t> known;  // by the bytes of a vertex
  out.indices.reserve(triangles.size());
  known.reserve(triangles.size() / 3);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    std::array<std::uint32_t, 3> t{};
    for (std::size_t k = 0; k < 3; k++) {
      const MeshVertex& vertex = triangles[i + k];
      const std::string_view bytes(reinterpret_cast<const char*>(&vertex), sizeof vertex);
      const auto [found, fresh] = known.try_emplace(bytes, static_cast<std::uint32_t>(out.vertices.size()));
      if (fresh) out.vertices.push_back(vertex);
      t[k] = found->second;
    }
    // at a pole, two of the three vertices are equal
    if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) out.indices.insert(out.indices.end(), t.begin(), t.end());
  }
  return out;
}

MeshSize mesh_size(const model::ShapeModel& shape) {
  const double r = shape.radius;
  const double half = shape.height / 2;
  switch (shape.kind) {
    case model::ShapeKind::box: {
      const double min_edge = std::min({shape.size.x, shape.size.y, shape.size.z});
      const double round = std::min(0.08 * min_edge, 0.02);
      return {shape.size / 2.0 - Vec3(round), round};
    }
    case model::ShapeKind::sphere:
      return {Vec3(0), r};
    case model::ShapeKind::capsule:
      return {Vec3(0, 0, half), r};
    case model::ShapeKind::cylinder: {
      const double round = std::min({0.1 * r, 0.1 * half, 0.015});
      return {Vec3(r - round, r - round, half - round), round};
    }
    case model::ShapeKind::cone:
      return {Vec3(r, r, half), 0};
    default:
      return {};
  }
}

}  // namespace limber::render
