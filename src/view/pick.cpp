// A ray against every piece: a click is seldom.
#include "view/pick.h"

#include <algorithm>
#include <cmath>

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

// how far along the ray the box begins; nothing: it is missed, or lies behind
std::optional<double> enter_box(const Extent& box, const Vec3& from, const Vec3& along) {
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
  return begin <= end && begin > 0 ? std::optional(begin) : std::nullopt;
}

std::optional<double> enter_sphere(double radius, const Vec3& from, const Vec3& along) {
  const double b = glm::dot(from, along);
  const double under = b * b - glm::dot(from, from) + radius * radius;
  if (under < 0) return std::nullopt;
  const double distance = -b - std::sqrt(under);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

std::optional<double> enter(const ShapeModel& shape, const Vec3& from, const Vec3& along) {
  if (shape.kind == ShapeKind::sphere && shape.mesh == nullptr) return enter_sphere(shape.radius, from, along);
  return enter_box(extent_of(shape), from, along);
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
