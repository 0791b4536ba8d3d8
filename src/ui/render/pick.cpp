// Tests a ray against every piece, its bounding box first. Clicks are rare, so no acceleration structure is needed.
#include "ui/render/pick.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/matrix_inverse.hpp>

#include "ui/render/mesh.h"

namespace limber {

namespace {

struct Extent {
  Vec3 low{0}, high{0};
};

// bounding box of a shape in its own frame
Extent extent_of(const ShapeModel& shape) {
  if (shape.mesh == nullptr) {
    const MeshSize size = mesh_size(shape);
    const Vec3 half(size.extent.x + size.rounding_radius, size.extent.y + size.rounding_radius,
                    size.extent.z + size.rounding_radius);
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

// the interval of the ray inside the box; empty: it misses the box, or the box is behind
std::optional<Span> hit_box(const Extent& box, const Vec3& from, const Vec3& along) {
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

std::optional<double> hit_sphere(double radius, const Vec3& from, const Vec3& along) {
  const double b = glm::dot(from, along);
  const double discriminant = b * b - glm::dot(from, from) + radius * radius;
  if (discriminant < 0) return std::nullopt;
  const double distance = -b - std::sqrt(discriminant);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

// distance along the ray to the triangle, from either side (Möller–Trumbore)
std::optional<double> hit_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& along) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = glm::cross(along, ac);
  const double determinant = glm::dot(ab, p);
  if (std::abs(determinant) < 1e-18) return std::nullopt;
  const Vec3 offset = from - a;
  const double u = glm::dot(offset, p) / determinant;
  const Vec3 q = glm::cross(offset, ab);
  const double v = glm::dot(along, q) / determinant;
  const double distance = glm::dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? std::optional(distance) : std::nullopt;
}

void keep_nearest(std::optional<double>& nearest, const std::optional<double>& distance) {
  if (distance && (!nearest || *distance < *nearest)) nearest = distance;
}

std::optional<double> hit_mesh(const MeshModel& mesh, const Vec3& from, const Vec3& along) {
  std::optional<double> nearest;
  const auto corner = [&](std::size_t i) { return mesh.vertices[mesh.triangles[i]]; };
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    keep_nearest(nearest, hit_triangle(corner(i), corner(i + 1), corner(i + 2), from, along));
  return nearest;
}

// tests the mesh that is drawn for this kind, scaled like in the vertex shader
std::optional<double> hit_primitive_mesh(const ShapeModel& shape, const Vec3& from, const Vec3& along) {
  constexpr int kDetail = 1;
  static const std::map<ShapeKind, MeshVertices> meshes = [] {
    std::map<ShapeKind, MeshVertices> all;
    for (const ShapeKind kind : {ShapeKind::capsule, ShapeKind::cylinder, ShapeKind::cone})
      all[kind] = primitive_mesh(kind, kDetail);
    return all;
  }();
  const MeshVertices& vertices = meshes.at(shape.kind);
  const MeshSize size = mesh_size(shape);
  const auto corner = [&](std::size_t i) {
    const MeshVertex& v = vertices[i];
    return Vec3(v.corner[0], v.corner[1], v.corner[2]) * size.extent +
           Vec3(v.normal[0], v.normal[1], v.normal[2]) * size.rounding_radius;
  };
  std::optional<double> nearest;
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
    keep_nearest(nearest, hit_triangle(corner(i), corner(i + 1), corner(i + 2), from, along));
  return nearest;
}

std::optional<double> hit_shape(const ShapeModel& shape, const Vec3& from, const Vec3& along) {
  if (shape.kind == ShapeKind::sphere && shape.mesh == nullptr) return hit_sphere(shape.radius, from, along);
  const std::optional<Span> box = hit_box(extent_of(shape), from, along);
  if (!box) return std::nullopt;
  if (shape.mesh != nullptr) return hit_mesh(*shape.mesh, from, along);
  if (shape.kind == ShapeKind::box) return box->begin > 0 ? std::optional(box->begin) : std::nullopt;
  return hit_primitive_mesh(shape, from, along);
}

}  // namespace

Pose part_pose(const Snapshot& now, std::uint32_t part_offset) {
  const TransientOffsets& at = transient_offsets();
  const double* const block = now.transient.data() + part_offset;
  return {vec3_at(block + at.part_position), quat_at(block + at.part_rotation)};
}

Vec3 ray_through(const ViewCamera& camera, double x, double y) {
  const glm::dmat4 back = glm::inverse(glm::dmat4(camera.projection) * glm::dmat4(camera.view));
  const glm::dvec4 far = back * glm::dvec4(x, y, 0.5, 1);
  return glm::normalize(Vec3(far) / far.w - camera.eye);
}

std::optional<Picked> pick(const Snapshot& now, const ViewCamera& camera, double x, double y) {
  const Vec3 along = ray_through(camera, x, y);
  std::optional<Picked> nearest;
  for (const RenderInstance& piece : now.render_scene->instances) {
    const ShapeModel& shape = now.render_scene->shapes[piece.shape].geometry;
    if (shape.kind == ShapeKind::plane || now.transient[piece.enabled_offset] == 0) continue;
    Pose pose = part_pose(now, piece.part_offset) * piece.origin;
    if (shape.mesh != nullptr) pose = pose * shape.mesh_pose;
    const Quat back = glm::conjugate(pose.rotation);
    const auto distance = hit_shape(shape, back * (camera.eye - pose.position), back * along);
    if (!distance || (nearest && *distance >= nearest->distance)) continue;
    nearest = Picked{piece.part_offset, camera.eye + *distance * along, *distance};
  }
  return nearest;
}

}  // namespace limber
