// Bounds: the extent of a shape along an axis is that of its support points, the farthest points in both directions.
#include "sim/shapes/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "model/mesh/surface.h"
#include "sim/shapes/geometry.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

// Returns the largest value of dot(direction, point) over a shape at the origin. `direction`: a unit vector.
double support(const model::ShapeModel& shape, const Vec3& direction) {
  const double along = direction.z;
  const double radial = shape.radius * std::sqrt(std::max(0.0, 1 - along * along));
  switch (shape.kind) {
    case model::ShapeKind::sphere:
      return shape.radius;
    case model::ShapeKind::box:
      return glm::dot(glm::abs(direction), shape.size) / 2;
    case model::ShapeKind::ellipsoid:
      return glm::length(direction * shape.size) / 2;
    case model::ShapeKind::capsule:
      return shape.radius + std::abs(along) * shape.height / 2;
    case model::ShapeKind::cylinder:
      return radial + std::abs(along) * shape.height / 2;
    case model::ShapeKind::cone:  // the tip is at +z
      return std::max(along * shape.height / 2, radial - along * shape.height / 2);
    default:
      return 0;
  }
}

Bounds bounds_of_points(std::span<const Vec3> points, const Pose& pose) {
  Bounds bounds;
  for (const Vec3& point : points) {
    const Vec3 at = pose * point;
    bounds.low = glm::min(bounds.low, at);
    bounds.high = glm::max(bounds.high, at);
  }
  return bounds;
}

Bounds bounds_of_surface(const model::Surface& surface, const Pose& pose) {
  std::array<Vec3, 8> corners;
  for (unsigned i = 0; i < 8; i++) {
    for (int axis = 0; axis < 3; axis++)
      corners[i][axis] = (i >> axis & 1U) == 0 ? surface.low()[axis] : surface.high()[axis];
  }
  return bounds_of_points(corners, pose);
}

Bounds bounds_of_shapes(std::span<const model::PlacedShape> shapes, const Pose& pose) {
  Bounds bounds;
  for (const model::PlacedShape& placed : shapes) bounds.add(bounds_of(placed.shape, pose * placed.origin));
  return bounds;
}

bool is_finite_pose(const Pose& pose) { return is_finite(pose.position) && is_finite(pose.rotation); }

// the visuals of a body's model at the present poses of its parts, which come first and in the order of the links
Bounds bounds_of_visuals(const Body& body) {
  Bounds bounds;
  if (body.model() == nullptr) return bounds;
  const auto parts = body.parts();
  for (std::size_t i = 0; i < std::min(parts.size(), body.model()->links.size()); i++) {
    if (is_finite_pose(parts[i]->pose()))
      bounds.add(bounds_of_shapes(body.model()->links[i].visuals, parts[i]->pose()));
  }
  return bounds;
}

}  // namespace

void Bounds::add(const Bounds& other) {
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
}

bool Bounds::overlaps(const Bounds& other) const {
  return glm::all(glm::lessThan(low, other.high)) && glm::all(glm::lessThan(other.low, high));
}

Bounds bounds_of(const model::ShapeModel& shape, const Pose& pose) {
  if (shape.kind == model::ShapeKind::plane || shape.kind == model::ShapeKind::compound) return {};
  if (shape.surface != nullptr) return bounds_of_surface(*shape.surface, pose);
  if (shape.kind == model::ShapeKind::mesh)
    return shape.mesh == nullptr ? Bounds() : bounds_of_points(shape.mesh->hull, pose * shape.mesh_pose);
  Bounds bounds{pose.position, pose.position};
  const Quat to_shape = glm::conjugate(pose.rotation);
  for (int axis = 0; axis < 3; axis++) {
    Vec3 direction(0);
    direction[axis] = 1;
    const Vec3 local = to_shape * direction;
    bounds.low[axis] -= support(shape, -local);
    bounds.high[axis] += support(shape, local);
  }
  return bounds;
}

Bounds bounds_of(const Part& part) {
  if (part.geometry() == nullptr || !is_finite_pose(part.pose())) return {};
  return bounds_of_shapes(part.geometry()->placed, part.pose());
}

Bounds bounds_of(const Body& body) {
  Bounds bounds;
  for (const auto& part : body.parts()) bounds.add(bounds_of(*part));
  return bounds.empty() ? bounds_of_visuals(body) : bounds;
}

Bounds bounds_of(const model::BodyModel& model) {
  Bounds collisions;
  Bounds visuals;
  for (const model::LinkModel& link : model.links) {
    collisions.add(bounds_of_shapes(link.collisions, link.start));
    visuals.add(bounds_of_shapes(link.visuals, link.start));
  }
  return collisions.empty() ? visuals : collisions;
}

}  // namespace limber::sim
