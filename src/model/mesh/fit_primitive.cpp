// Boxes are recognized by their face normals, spheres and capsules by the distance of their vertices from the axis.
#include "model/mesh/fit_primitive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/mesh/mass_properties.h"

namespace limber::model {

namespace {

struct Interval {
  double low, high;
};

Interval interval_along(const std::vector<Vec3>& points, const Vec3& axis) {
  Interval s{glm::dot(points[0], axis), glm::dot(points[0], axis)};
  for (const Vec3& p : points) {
    const double d = glm::dot(p, axis);
    s.low = std::min(s.low, d);
    s.high = std::max(s.high, d);
  }
  return s;
}

/// The pose of a frame with these axes; `along` is its origin in coordinates along them.
Pose pose_of(const Mat3& axes, const Vec3& along) { return {axes * along, glm::normalize(glm::quat_cast(axes))}; }

/// Face normals with the faces' areas as their lengths, largest first.
std::vector<Vec3> face_normals(const Hull& hull) {
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i + 2 < hull.triangles.size(); i += 3) {
    const Vec3& a = hull.vertices[hull.triangles[i]];
    normals.push_back(glm::cross(hull.vertices[hull.triangles[i + 1]] - a, hull.vertices[hull.triangles[i + 2]] - a) /
                      2.0);
  }
  std::stable_sort(normals.begin(), normals.end(),
                   [](const Vec3& a, const Vec3& b) { return glm::dot(a, a) > glm::dot(b, b); });
  return normals;
}

std::optional<PlacedShape> fit_box(const Hull& hull, double volume) {
  if (hull.vertices.size() < 8) return std::nullopt;
  const std::vector<Vec3> normals = face_normals(hull);
  constexpr double kMaxCosine = 1e-3;
  Mat3 axes(0);
  axes[0] = normalized(normals[0]);
  int found = 1;
  for (const Vec3& n : normals) {
    const Vec3 d = normalized(n);
    if (std::abs(glm::dot(d, axes[0])) > kMaxCosine) continue;
    axes[1] = normalized(d - glm::dot(d, axes[0]) * axes[0]);
    found = 2;
    break;
  }
  if (found < 2) return std::nullopt;
  axes[2] = glm::cross(axes[0], axes[1]);
  // order the axes so that they match the mesh's own as closely as possible
  for (int i = 0; i < 3; ++i) {
    for (int k = i + 1; k < 3; ++k) {
      if (std::abs(axes[k][i]) > std::abs(axes[i][i]) + 1e-9) std::swap(axes[i], axes[k]);
    }
    if (axes[i][i] < 0) axes[i] = -axes[i];
  }
  if (glm::determinant(axes) < 0) axes[2] = -axes[2];
  PlacedShape out;
  out.shape.kind = ShapeKind::box;
  Vec3 middle(0);
  for (int i = 0; i < 3; ++i) {
    const Interval s = interval_along(hull.vertices, axes[i]);
    out.shape.size[i] = s.high - s.low;
    middle[i] = (s.low + s.high) / 2;
  }
  const double box_volume = out.shape.size.x * out.shape.size.y * out.shape.size.z;
  if (std::abs(volume - box_volume) > 1e-3 * box_volume) return std::nullopt;
  out.origin = pose_of(axes, middle);
  return out;
}

double distance_from_segment(const Vec3& p, const Vec3& center, const Vec3& axis, double half) {
  const double along = std::clamp(glm::dot(p - center, axis), -half, half);
  return glm::length(p - center - along * axis);
}

std::optional<PlacedShape> fit_capsule(const Hull& hull, const Inertial& solid) {
  // the vertices of cubes and icosahedra lie on a sphere, too
  if (hull.vertices.size() < 24) return std::nullopt;
  const Mat3 principal = principal_axes(solid.tensor).axes;
  const Vec3 axis = principal[0];
  const Interval length = interval_along(hull.vertices, axis);
  const Vec3 center = solid.center + ((length.low + length.high) / 2 - glm::dot(solid.center, axis)) * axis;
  double radius = 0;
  for (const Vec3& p : hull.vertices)
    radius = std::max(radius, glm::length(p - center - glm::dot(p - center, axis) * axis));
  const double half = (length.high - length.low) / 2 - radius;
  const bool sphere = std::abs(half) <= 0.01 * radius;
  if (half < 0 && !sphere) return std::nullopt;
  for (const Vec3& p : hull.vertices) {
    if (std::abs(distance_from_segment(p, center, axis, sphere ? 0 : half) - radius) > 0.01 * radius)
      return std::nullopt;
  }
  PlacedShape out;
  out.shape.kind = sphere ? ShapeKind::sphere : ShapeKind::capsule;
  out.shape.radius = radius;
  out.shape.height = sphere ? 0 : 2 * half;
  if (solid.mass < 0.9 * unit_inertial_of(out.shape).mass) return std::nullopt;
  const Vec3 z = axis.z < 0 ? -axis : axis;
  const Vec3 helper = std::abs(z.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = normalized(glm::cross(z, helper));
  out.origin = {center, sphere ? quat_identity() : glm::normalize(glm::quat_cast(Mat3(glm::cross(y, z), y, z)))};
  return out;
}

}  // namespace

std::optional<PlacedShape> recognize_primitive(const Hull& whole) {
  const Inertial solid = unit_inertial_of(whole.vertices, whole.triangles);
  if (!(solid.mass > 0)) return std::nullopt;
  std::optional<PlacedShape> box = fit_box(whole, solid.mass);
  return box ? box : fit_capsule(whole, solid);
}

}  // namespace limber::model
