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

#include "model/look/mesh_look.h"

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
  if (kind == model::ShapeKind::ellipsoid) {
    // without rounding, unlike a sphere, since its radii differ
    for (int i = 0; i <= 2 * quarter; i++) {
      const double angle = std::numbers::pi / 2 * i / quarter;
      profile.push_back({std::sin(angle), std::cos(angle), std::sin(angle), std::cos(angle)});
    }
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
  std::vector<std::size_t> sources;  // indices of the triangles in the model
};

Soup soup_of(const model::MeshModel& model) {
  Soup soup{model.vertices, {}, {}};
  const auto count = static_cast<unsigned>(model.vertices.size());
  for (std::size_t i = 0; i + 2 < model.triangles.size(); i += 3) {
    const std::array<unsigned, 3> t = {model.triangles[i], model.triangles[i + 1], model.triangles[i + 2]};
    if (t[0] >= count || t[1] >= count || t[2] >= count) continue;
    soup.triangles.push_back(t);
    soup.sources.push_back(i / 3);
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
  for (std::size_t i = 0; i < fine.triangles.size(); i++) {
    const auto& t = fine.triangles[i];
    const std::array<unsigned, 3> moved = {cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]};
    if (moved[0] == moved[1] || moved[1] == moved[2] || moved[0] == moved[2]) continue;
    out.triangles.push_back(moved);
    out.sources.push_back(fine.sources[i]);
  }
  return out;
}

// calls `add(point, triangle, k)` for each corner k of each triangle of the model at this level of detail
template <class Add>
void for_each_corner(const model::MeshModel& model, int detail, Add add) {
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
  for (std::size_t i = 0; i < soup.triangles.size(); i++) {
    const Vec3 face_normal = normalized(face_normals[i]);
    for (std::size_t k = 0; k < 3; k++) {
      const unsigned corner = soup.triangles[i][k];
      Vec3 sum = face_normals[i];
      if (triangles_at[corner].size() <= kMaxNeighbors) {
        for (const unsigned neighbor : triangles_at[corner]) {
          if (neighbor != i && glm::dot(face_normal, normalized(face_normals[neighbor])) > kMinCreaseCosine)
            sum += face_normals[neighbor];
        }
      }
      add(Point{soup.points[corner], normalized(sum)}, soup.sources[i], k);
    }
  }
}

ColoredVertex colored(const MeshVertex& v) {
  return {{v.corner[0], v.corner[1], v.corner[2]},
          {v.normal[0], v.normal[1], v.normal[2]},
          {0, 0},
          {255, 255, 255, 255},
          {0, 0, 0, 255}};
}

std::uint8_t byte_of(double channel) { return static_cast<std::uint8_t>(std::clamp(channel, 0.0, 1.0) * 255 + 0.5); }

// texture coordinates of a triangle of a box: its face is the axis along which its normals point
void map_box(std::array<ColoredVertex, 3>& t) {
  Vec3 sum(0);
  for (const ColoredVertex& v : t) sum += Vec3(v.normal[0], v.normal[1], v.normal[2]);
  int axis = 0;
  for (int i = 1; i < 3; i++) axis = std::abs(sum[i]) > std::abs(sum[axis]) ? i : axis;
  const float side = sum[axis] < 0 ? -1.0F : 1.0F;
  // seen from outside, v points up (z, or y on the horizontal faces) and u to the right
  const int up = axis == 2 ? 1 : 2;
  const int right = axis == 0 ? 1 : 0;
  const float turn = axis == 1 ? -side : side;
  for (ColoredVertex& v : t) {
    v.texcoord[0] = 0.5F + 0.5F * turn * v.corner[right];
    v.texcoord[1] = 0.5F - 0.5F * v.corner[up];
  }
}

// texture coordinates of a triangle of a round shape: u around z, v from the top down
void map_round(std::array<ColoredVertex, 3>& t) {
  const auto turn_of = [](const ColoredVertex& v) {
    const bool on_axis = v.corner[0] == 0 && v.corner[1] == 0;
    const float* const from = on_axis ? v.normal : v.corner;
    return 0.5F + std::atan2(from[1], from[0]) / (2 * std::numbers::pi_v<float>);
  };
  float high = 0;
  for (ColoredVertex& v : t) high = std::max(high, v.texcoord[0] = turn_of(v));
  for (ColoredVertex& v : t) {
    if (high - v.texcoord[0] > 0.5F) v.texcoord[0] += 1;  // across the seam
    v.texcoord[1] = 0.5F - 0.25F * (v.corner[2] + v.normal[2]);
  }
}

ColoredVertices colored_primitive(model::ShapeKind kind, int detail) {
  ColoredVertices out;
  const MeshVertices plain = primitive_mesh(kind, detail);
  out.reserve(plain.size());
  for (std::size_t i = 0; i + 2 < plain.size(); i += 3) {
    std::array<ColoredVertex, 3> t = {colored(plain[i]), colored(plain[i + 1]), colored(plain[i + 2])};
    if (kind == model::ShapeKind::box) {
      map_box(t);
    } else {
      map_round(t);
    }
    out.insert(out.end(), t.begin(), t.end());
  }
  return out;
}

// the part of each material
std::vector<std::size_t> parts_of_materials(const model::MeshLook& look, std::vector<MeshPart>& parts) {
  std::vector<std::size_t> part_of;
  for (const model::MeshMaterial& material : look.materials) {
    const MeshPart part{material.texture, material.alpha};
    const auto found = std::find(parts.begin(), parts.end(), part);
    part_of.push_back(static_cast<std::size_t>(found - parts.begin()));
    if (found == parts.end()) parts.push_back(part);
  }
  return part_of;
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
    case model::ShapeKind::ellipsoid:
      return round_mesh(kind, detail);
    default:
      return {};
  }
}

MeshVertices model_mesh(const model::MeshModel& model, int detail) {
  MeshVertices out;
  out.reserve(model.triangles.size());
  for_each_corner(model, detail,
                  [&](const Point& point, std::size_t, std::size_t) { out.push_back(vertex_of(point)); });
  return out;
}

MeshColoring coloring_of(const model::ShapeModel& shape) {
  if (shape.texture != nullptr) return MeshColoring::textured;
  const bool own = shape.mesh != nullptr && shape.mesh_colors && model::has_colors(*shape.mesh);
  return own ? MeshColoring::own : MeshColoring::plain;
}

std::vector<MeshPart> mesh_parts(const model::ShapeModel& shape) {
  std::vector<MeshPart> parts;
  if (coloring_of(shape) == MeshColoring::own) {
    (void)parts_of_materials(*shape.mesh->look, parts);
  } else {
    parts.push_back({shape.texture, 1});
  }
  return parts;
}

std::vector<ColoredVertices> colored_meshes(const model::ShapeModel& shape, int detail) {
  if (shape.mesh == nullptr) return {colored_primitive(shape.kind, detail)};
  static const model::MeshLook no_look;
  const model::MeshLook& look = shape.mesh->look != nullptr ? *shape.mesh->look : no_look;
  const bool own = coloring_of(shape) == MeshColoring::own;
  std::vector<MeshPart> parts;
  std::vector<std::size_t> part_of;
  if (own) part_of = parts_of_materials(look, parts);
  std::vector<ColoredVertices> out(own ? parts.size() : 1);
  for_each_corner(*shape.mesh, detail, [&](const Point& point, std::size_t triangle, std::size_t k) {
    ColoredVertex v = colored(vertex_of(point));
    const std::size_t corner = 3 * triangle + k;
    if (corner < look.texcoords.size()) std::copy_n(look.texcoords[corner].begin(), 2, v.texcoord);
    std::size_t part = 0;
    if (own) {
      const std::uint32_t number = look.triangle_materials[triangle];
      const model::MeshMaterial& material = look.materials[number];
      part = part_of[number];
      for (int i = 0; i < 3; i++) {
        const double factor =
            corner < look.colors.size() ? look.colors[corner][static_cast<std::size_t>(i)] / 255.0 : 1;
        v.color[i] = byte_of(material.color[i] * factor);
        v.emission[i] = byte_of(material.emission[i]);
      }
    }
    out[part].push_back(v);
  });
  return out;
}

namespace {

template <class Vertex>
IndexedVertices<Vertex> merged(const std::vector<Vertex>& triangles) {
  IndexedVertices<Vertex> out;
  std::unordered_map<std::string_view, std::uint32_t> known;  // by the bytes of a vertex
  out.indices.reserve(triangles.size());
  known.reserve(triangles.size() / 3);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    std::array<std::uint32_t, 3> t{};
    for (std::size_t k = 0; k < 3; k++) {
      const Vertex& vertex = triangles[i + k];
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

}  // namespace

IndexedMesh with_shared_vertices(const MeshVertices& triangles) { return merged(triangles); }
IndexedVertices<ColoredVertex> with_shared_vertices(const ColoredVertices& triangles) { return merged(triangles); }

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
    case model::ShapeKind::ellipsoid:
      return {shape.size / 2.0, 0};
    default:
      return {};
  }
}

}  // namespace limber::render
