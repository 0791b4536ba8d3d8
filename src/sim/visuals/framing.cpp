// Framing: each side of the view is a plane through the eye; a sphere is inside if its distance from each plane is at
// least its radius.
#include "sim/visuals/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/math/fixed_math.h"
#include "sim/shapes/geometry.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr double kFilled = 0.8;     // fraction of the view that the objects fill
constexpr double kMinDistance = 4;  // multiple of the near clipping distance
constexpr double kMinAspect = 4.0 / 3;

void add_box(const Vec3& half, const Pose& pose, std::vector<FramedSphere>& out) {
  for (int corner = 0; corner < 8; corner++) {
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    out.push_back({pose * (sign * half), 0});
  }
}

void add_mesh(const model::MeshModel& mesh, const Pose& pose, std::vector<FramedSphere>& out) {
  if (mesh.hull.empty()) return;
  Vec3 low = mesh.hull.front();
  Vec3 high = low;
  for (const Vec3& v : mesh.hull) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  add_box((high - low) / 2.0, pose * Pose{(low + high) / 2.0, Quat(1, 0, 0, 0)}, out);
}

void add_placed(std::span<const model::PlacedShape> shapes, const Pose& pose, std::vector<FramedSphere>& out) {
  if (!is_finite(pose.position) || !is_finite(pose.rotation)) return;
  for (const model::PlacedShape& placed : shapes) add_framed_shape(placed.shape, pose * placed.origin, out);
}

// Adds the visuals of the body's model; the first parts of the body are the links of the model.
void add_visuals(const Body& body, std::vector<FramedSphere>& out) {
  const std::vector<model::LinkModel>& links = body.model()->links;
  for (std::size_t i = 0; i < std::min(links.size(), body.parts().size()); i++)
    add_placed(links[i].visuals, body.parts()[i]->pose(), out);
}

// Returns the distance of the eye from the target at which the sphere is inside the planes of one axis. `side` and
// `ahead`: its center relative to the target. `tangent`: of half the angle between the planes.
double distance_for(double side, double ahead, double radius, double tangent) {
  return (radius * std::sqrt(1 + tangent * tangent) + std::abs(side)) / tangent - ahead;
}

}  // namespace

void add_framed_shape(const model::ShapeModel& shape, const Pose& pose, std::vector<FramedSphere>& out) {
  switch (shape.kind) {
    case model::ShapeKind::plane:
    case model::ShapeKind::compound:
      return;
    case model::ShapeKind::sphere:
      return out.push_back({pose.position, shape.radius});
    case model::ShapeKind::capsule:
      for (const double end : {-0.5, 0.5}) out.push_back({pose * Vec3(0, 0, end * shape.height), shape.radius});
      return;
    case model::ShapeKind::box:
    case model::ShapeKind::ellipsoid:
      return add_box(shape.size / 2.0, pose, out);
    case model::ShapeKind::cylinder:
    case model::ShapeKind::cone:
      return add_box({shape.radius, shape.radius, shape.height / 2}, pose, out);
    case model::ShapeKind::mesh:
      if (shape.mesh != nullptr) add_mesh(*shape.mesh, pose * shape.mesh_pose, out);
      return;
  }
}

std::optional<FramedView> frame(std::span<const FramedSphere> spheres, const Vec3& direction, const FrameShape& shape) {
  const Vec3 back = normalized(direction);
  if (spheres.empty() || back == Vec3(0)) return std::nullopt;
  Vec3 low = spheres.front().center;
  Vec3 high = low;
  for (const FramedSphere& sphere : spheres) {
    low = glm::min(low, sphere.center - sphere.radius);
    high = glm::max(high, sphere.center + sphere.radius);
  }
  const Vec3 target = (low + high) / 2.0;
  Vec3 right = normalized(glm::cross(Vec3(0, 0, 1), back));
  if (right == Vec3(0)) right = {1, 0, 0};
  const Vec3 up = glm::cross(back, right);
  const double vertical = kFilled * fixed::tan(shape.fovy * std::numbers::pi / 360);
  const double horizontal = vertical * shape.aspect;
  double distance = kMinDistance * shape.near;
  for (const FramedSphere& sphere : spheres) {
    const Vec3 at = sphere.center - target;
    const double ahead = -glm::dot(at, back);
    distance = std::max({distance, distance_for(glm::dot(at, right), ahead, sphere.radius, horizontal),
                         distance_for(glm::dot(at, up), ahead, sphere.radius, vertical)});
  }
  return FramedView{target + distance * back, target};
}

std::vector<FramedSphere> framed_bodies(const World& world) {
  std::vector<FramedSphere> spheres;
  const auto can_move = [](const auto& body) {
    return std::ranges::any_of(body->parts(), [](const auto& part) { return !part->is_static(); });
  };
  const bool any_moves = std::ranges::any_of(world.bodies(), can_move);
  for (const auto& body : world.bodies()) {
    if (!body->in_world() || (any_moves && !can_move(body))) continue;
    const std::size_t before = spheres.size();
    for (const auto& part : body->parts()) {
      if (part->geometry() != nullptr) add_placed(part->geometry()->placed, part->pose(), spheres);
    }
    if (spheres.size() == before && body->model() != nullptr) add_visuals(*body, spheres);
  }
  return spheres;
}

void frame_scene(World& world) {
  Camera& camera = world.visuals().camera();
  if (camera.pose_is_set()) return;
  const auto value = [&](const char* name) { return world.store().values(camera.id(), Camera::table().at(name))[0]; };
  const double aspect = value("aspect") > 0 ? value("aspect") : kMinAspect;
  const auto view = frame(framed_bodies(world), camera.eye() - camera.target(), {value("fovy"), aspect, value("near")});
  if (!view) return;
  // beyond half of the far clipping distance, the objects would be hidden by the fog
  const Vec3 offset = view->eye - view->target;
  const double distance = std::min(glm::length(offset), value("far") / 2);
  camera.set_default_pose(view->target + distance * normalized(offset), view->target);
}

}  // namespace limber::sim
