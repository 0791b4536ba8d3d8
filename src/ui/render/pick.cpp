// Tests a ray against every instance, its bounding box first. Clicks are rare, so no acceleration structure is needed.
#include "ui/render/pick.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/matrix_inverse.hpp>

#include "ui/render/mesh.h"

namespace limber::render {

namespace {

struct Aabb {
  Vec3 min{0}, max{0};
};

// bounding box of a shape in its own frame
Aabb bounds_of(const model::ShapeModel& shape) {
  if (shape.mesh == nullptr) {
    const MeshSize size = mesh_size(shape);
    const Vec3 half(size.extent.x + size.rounding_radius, size.extent.y + size.rounding_radius,
                    size.extent.z + size.rounding_radius);
    return {-half, half};
  }
  if (shape.mesh->vertices.empty()) return {};
  Aabb bounds{shape.mesh->vertices.front(), shape.mesh->vertices.front()};
  for (const Vec3& v : shape.mesh->vertices) bounds = {glm::min(bounds.min, v), glm::max(bounds.max, v)};
  return bounds;
}

struct Interval {
  double begin = 0, end = 0;
};

// the interval of the ray inside the box; empty: it misses the box, or the box is behind
std::optional<Interval> hit_box(const Aabb& box, const Vec3& from, const Vec3& direction) {
  double begin = 0;
  double end = 1e30;
  for (int i = 0; i < 3; i++) {
    if (std::abs(direction[i]) < 1e-12) {
      if (from[i] < box.min[i] || from[i] > box.max[i]) return std::nullopt;
      continue;
    }
    const double a = (box.min[i] - from[i]) / direction[i];
    const double b = (box.max[i] - from[i]) / direction[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end ? std::optional(Interval{begin, end}) : std::nullopt;
}

std::optional<double> hit_sphere(double radius, const Vec3& from, const Vec3& direction) {
  const double b = glm::dot(from, direction);
  const double discriminant = b * b - glm::dot(from, from) + radius * radius;
  if (discriminant < 0) return std::nullopt;
  const double distance = -b - std::sqrt(discriminant);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

std::optional<double> hit_ellipsoid(const Vec3& radii, const Vec3& from, const Vec3& direction) {
  const Vec3 scaled = direction / radii;
  const double length = glm::length(scaled);
  const std::optional<double> distance = hit_sphere(1, from / radii, scaled / length);
  return distance ? std::optional(*distance / length) : std::nullopt;
}

// distance along the ray to the triangle, from either side (Möller–Trumbore)
std::optional<double> hit_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from,
                                   const Vec3& direction) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (std::abs(determinant) < 1e-18) return std::nullopt;
  const Vec3 offset = from - a;
  const double u = glm::dot(offset, p) / determinant;
  const Vec3 q = glm::cross(offset, ab);
  const double v = glm::dot(direction, q) / determinant;
  const double distance = glm::dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? std::optional(distance) : std::nullopt;
}

void keep_nearest(std::optional<double>& nearest, const std::optional<double>& distance) {
  if (distance && (!nearest || *distance < *nearest)) nearest = distance;
}

std::optional<double> hit_mesh(const model::MeshModel& mesh, const Vec3& from, const Vec3& direction) {
  std::optional<double> nearest;
  const auto corner = [&](std::size_t i) { return mesh.vertices[mesh.triangles[i]]; };
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    keep_nearest(nearest, hit_triangle(corner(i), corner(i + 1), corner(i + 2), from, direction));
  return nearest;
}

// tests the mesh that is drawn for this kind, scaled like in the vertex shader
std::optional<double> hit_primitive_mesh(const model::ShapeModel& shape, const Vec3& from, const Vec3& direction) {
  constexpr int kDetail = 1;
  static const std::map<model::ShapeKind, MeshVertices> meshes = [] {
    std::map<model::ShapeKind, MeshVertices> all;
    for (const model::ShapeKind kind : {model::ShapeKind::capsule, model::ShapeKind::cylinder, model::ShapeKind::cone})
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
    keep_nearest(nearest, hit_triangle(corner(i), corner(i + 1), corner(i + 2), from, direction));
  return nearest;
}

std::optional<double> hit_shape(const model::ShapeModel& shape, const Vec3& from, const Vec3& direction) {
  if (shape.kind == model::ShapeKind::sphere && shape.mesh == nullptr) return hit_sphere(shape.radius, from, direction);
  if (shape.kind == model::ShapeKind::ellipsoid && shape.mesh == nullptr)
    return hit_ellipsoid(shape.size / 2.0, from, direction);
  const std::optional<Interval> box = hit_box(bounds_of(shape), from, direction);
  if (!box) return std::nullopt;
  if (shape.mesh != nullptr) return hit_mesh(*shape.mesh, from, direction);
  if (shape.kind == model::ShapeKind::box) return box->begin > 0 ? std::optional(box->begin) : std::nullopt;
  return hit_primitive_mesh(shape, from, direction);
}

}  // namespace

Vec3 ray_through(const CameraMatrices& camera, double x, double y) {
  const glm::dmat4 back = glm::inverse(glm::dmat4(camera.projection) * glm::dmat4(camera.view));
  const glm::dvec4 far = back * glm::dvec4(x, y, 0.5, 1);
  return glm::normalize(Vec3(far) / far.w - camera.eye);
}

std::optional<Picked> pick(const engine::Snapshot& current, const CameraMatrices& camera, double x, double y) {
  const Vec3 direction = ray_through(camera, x, y);
  std::optional<Picked> nearest;
  for (const engine::RenderInstance& instance : current.render_scene->instances) {
    const model::ShapeModel& shape = current.render_scene->shapes[instance.shape].geometry;
    if (shape.kind == model::ShapeKind::plane || current.transient[instance.enabled_offset] == 0) continue;
    Pose pose = engine::part_pose(current, instance.part_offset) * instance.origin;
    if (shape.mesh != nullptr) pose = pose * shape.mesh_pose;
    const Quat back = glm::conjugate(pose.rotation);
    const auto distance = hit_shape(shape, back * (camera.eye - pose.position), back * direction);
    if (!distance || (nearest && *distance >= nearest->distance)) continue;
    nearest = Picked{instance.part_offset, camera.eye + *distance * direction, *distance};
  }
  return nearest;
}

}  // namespace limber::render
