// A ray against every piece, first against a box around it: a click is seldom.
#include "view/pick.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/matrix_inverse.hpp>

#include "view/mesh.h"

namespace limber {

namespace {

struct Extent {
  Vec3 low{0}, high{0};
};

// of a shape, in its own frame
Extent extent_of(const ShapeModel& shape) {
  if (shape.mesh == nullptr) {
    const MeshSize size = mesh_size(shape);
    const Vec3 half(size.extent.x + size.round, size.extent.y + size.round, size.extent.z + size.round);
    return {-half, half};
  }
  if (shape.mesh->vertices.empty()) return {};
  Extent extent{shape.mesh->vertices.front(), shape.mesh->vertices.front()};
  for (const Vec3& v : shape.mesh->vertices) extent = {glm::min(extent.low, v), glm::max(extent.high, v)};
  return extent;
}

struct Span {
  double begin = 0, end = 0;
};

// how far along the ray the box lies; nothing: it is missed, or lies behind
std::optional<Span> enter_box(const Extent& box, const Vec3& from, const Vec3& along) {
  double begin = 0;
  double end = 1e30;
  for (int i = 0; i < 3; i++) {
    if (std::abs(along[i]) < 1e-12) {
      if (from[i] < box.low[i] || from[i] > box.high[i]) return std::nullopt;
      continue;
    }
    const double a = (box.low[i] - from[i]) / along[i];
    const double b = (box.high[i] - from[i]) / along[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end ? std::optional(Span{begin, end}) : std::nullopt;
}

std::optional<double> enter_sphere(double radius, const Vec3& from, const Vec3& along) {
  const double b = glm::dot(from, along);
  const double under = b * b - glm::dot(from, from) + radius * radius;
  if (under < 0) return std::nullopt;
  const double distance = -b - std::sqrt(under);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

// how far along the ray the triangle is met, from either side
std::optional<double> meet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& along) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = glm::cross(along, ac);
  const double under = glm::dot(ab, p);
  if (std::abs(under) < 1e-18) return std::nullopt;
  const Vec3 way = from - a;
  const double u = glm::dot(way, p) / under;
  const Vec3 q = glm::cross(way, ab);
  const double v = glm::dot(along, q) / under;
  const double distance = glm::dot(ac, q) / under;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? std::optional(distance) : std::nullopt;
}

void keep_nearer(std::optional<double>& nearest, const std::optional<double>& distance) {
  if (distance && (!nearest || *distance < *nearest)) nearest = distance;
}

std::optional<double> enter_mesh(const MeshModel& mesh, const Vec3& from, const Vec3& along) {
  std::optional<double> nearest;
  const auto corner = [&](std::size_t i) { return mesh.vertices[mesh.triangles[i]]; };
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    keep_nearer(nearest, meet(corner(i), corner(i + 1), corner(i + 2), from, along));
  return nearest;
}

// as it is drawn: a mesh of the kind, each corner where the size puts it
std::optional<double> enter_round(const ShapeModel& shape, const Vec3& from, const Vec3& along) {
  constexpr int kDetail = 1;
  static const std::map<ShapeKind, MeshVertices> meshes = [] {
    std::map<ShapeKind, MeshVertices> made;
    for (const ShapeKind kind : {ShapeKind::capsule, ShapeKind::cylinder, ShapeKind::cone})
      made[kind] = primitive_mesh(kind, kDetail);
    return made;
  }();
  const MeshVertices& vertices = meshes.at(shape.kind);
  const MeshSize size = mesh_size(shape);
  const auto corner = [&](std::size_t i) {
    const MeshVertex& v = vertices[i];
    return Vec3(v.corner[0], v.corner[1], v.corner[2]) * size.extent +
           Vec3(v.normal[0], v.normal[1], v.normal[2]) * size.round;
  };
  std::optional<double> nearest;
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
    keep_nearer(nearest, meet(corner(i), corner(i + 1), corner(i + 2), from, along));
  return nearest;
}

std::optional<double> enter(const ShapeModel& shape, const Vec3& from, const Vec3& along) {
  if (shape.kind == ShapeKind::sphere && shape.mesh == nullptr) return enter_sphere(shape.radius, from, along);
  const std::optional<Span> box = enter_box(extent_of(shape), from, along);
  if (!box) return std::nullopt;
  if (shape.mesh != nullptr) return enter_mesh(*shape.mesh, from, along);
  if (shape.kind == ShapeKind::box) return box->begin > 0 ? std::optional(box->begin) : std::nullopt;
  return enter_round(shape, from, along);
}

}  // namespace

Pose part_pose(const Snapshot& now, std::uint32_t part_at) {
  const LiveOffsets& at = live_offsets();
  const double* const live = now.live.data() + part_at;
  return {vec3_at(live + at.part_position), quat_at(live + at.part_rotation)};
}

Vec3 ray_through(const Lens& lens, double x, double y) {
  const glm::dmat4 back = glm::inverse(glm::dmat4(lens.projection) * glm::dmat4(lens.view));
  const glm::dvec4 far = back * glm::dvec4(x, y, 0.5, 1);
  return glm::normalize(Vec3(far) / far.w - lens.eye);
}

std::optional<Picked> pick(const Snapshot& now, const Lens& lens, double x, double y) {
  const Vec3 along = ray_through(lens, x, y);
  std::optional<Picked> nearest;
  for (const DrawnPiece& piece : now.drawing->pieces) {
    const ShapeModel& shape = now.drawing->forms[piece.form].shape;
    if (shape.kind == ShapeKind::plane || now.live[piece.enabled_at] == 0) continue;
    Pose pose = part_pose(now, piece.part_at) * piece.origin;
    if (shape.mesh != nullptr) pose = pose * shape.mesh_pose;
    const Quat back = glm::conjugate(pose.rotation);
    const auto distance = enter(shape, back * (lens.eye - pose.position), back * along);
    if (!distance || (nearest && *distance >= nearest->distance)) continue;
    nearest = Picked{piece.part_at, lens.eye + *distance * along, *distance};
  }
  return nearest;
}

}  // namespace limber
