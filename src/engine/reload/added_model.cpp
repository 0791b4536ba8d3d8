// Placement: compares the boxes around the model and around each part of the world.
#include "engine/reload/added_model.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/lua_text.h"
#include "base/text.h"
#include "sim/shapes/bounds.h"
#include "sim/shapes/geometry.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::engine {

namespace {

constexpr int kMaxRing = 20;            // size of the spiral of places, in steps
constexpr double kGap = 0.1;            // distance between bodies, as a fraction of the model's size
constexpr double kMaxReach = 1000;      // bodies farther from the origin don't count, m
constexpr double kMinSteepness = 0.99;  // z of the normal of a plane that counts as a floor

// the height of a part that is a floor
std::optional<double> floor_height(const sim::Part& part) {
  if (part.geometry() == nullptr) return std::nullopt;
  for (const model::PlacedShape& placed : part.geometry()->placed) {
    const Pose pose = part.pose() * placed.origin;
    const Vec3 normal = pose.rotation * placed.shape.normal;
    if (placed.shape.kind == model::ShapeKind::plane && normal.z > kMinSteepness) return pose.position.z;
  }
  return std::nullopt;
}

struct Surroundings {
  std::vector<sim::Bounds> obstacles;
  std::optional<double> floor;
};

Surroundings surroundings_of(const sim::World& world) {
  Surroundings found;
  for (const auto& body : world.bodies()) {
    for (const auto& part : body->parts()) {
      if (const std::optional<double> height = floor_height(*part))
        found.floor = std::max(found.floor.value_or(*height), *height);
      const sim::Bounds bounds = sim::bounds_of(*part);
      if (!bounds.empty() && glm::length(bounds.center()) < kMaxReach) found.obstacles.push_back(bounds);
    }
  }
  return found;
}

bool is_free(const sim::Bounds& box, const std::vector<sim::Bounds>& obstacles) {
  return std::ranges::none_of(obstacles, [&](const sim::Bounds& other) { return box.overlaps(other); });
}

// Returns the offset in x and y to the nearest free place of the spiral; beyond all obstacles if none is free.
Vec3 free_place(const sim::Bounds& box, double step, const std::vector<sim::Bounds>& obstacles) {
  for (int ring = 0; ring <= kMaxRing; ring++) {
    for (int row = 0; row <= 2 * ring; row++) {
      for (int column = 0; column <= 2 * ring; column++) {
        // alternating sides, beginning in the middle
        const int i = column % 2 == 0 ? -column / 2 : (column + 1) / 2;
        const int j = row % 2 == 0 ? -row / 2 : (row + 1) / 2;
        if (std::max(std::abs(i), std::abs(j)) != ring) continue;
        const Vec3 offset(i * step, j * step, 0);
        if (is_free(box.moved(offset), obstacles)) return offset;
      }
    }
  }
  double right = 0;
  for (const sim::Bounds& other : obstacles) right = std::max(right, other.high.x);
  return {right - box.low.x + step, 0, 0};
}

std::string free_name(const std::string& wanted, const std::vector<std::string>& names) {
  std::string name = wanted;
  for (int number = 2; std::ranges::find(names, name) != names.end(); number++)
    name = fmt::format("{}_{}", wanted, number);
  return name;
}

}  // namespace

bool needs_servos(const model::BodyModel& model) {
  const auto is_driven = [](const model::JointModel& joint) { return joint.takes_servo() && joint.driven; };
  return std::ranges::any_of(model.joints, &model::JointModel::takes_servo) &&
         std::ranges::none_of(model.joints, is_driven);
}

AddedModel place_model(const sim::World& world, const std::string& path, const model::BodyModel& model,
                       const std::vector<std::string>& names) {
  AddedModel added{path, free_name(model.name, names), model.links.front().start.position, needs_servos(model)};
  const sim::Bounds bounds = sim::bounds_of(model);
  if (bounds.empty()) return added;
  const Surroundings around = surroundings_of(world);
  const double floor = around.floor.value_or(0);
  const bool fixed = model.links.front().inertial.mass == 0;
  const double up = fixed ? std::max(0.0, floor - bounds.low.z) : floor - bounds.low.z;
  // centered on the origin, and enlarged by half the gap on each side
  const Vec3 to_origin(-bounds.center().x, -bounds.center().y, up);
  const double width = std::max({bounds.size().x, bounds.size().y, 1e-3});
  sim::Bounds box = bounds.moved(to_origin);
  box.low -= Vec3(kGap * width, kGap * width, 0);
  box.high += Vec3(kGap * width, kGap * width, 0);
  added.position += to_origin + free_place(box, (1 + kGap) * width, around.obstacles);
  return added;
}

std::string lua_line(const AddedModel& model, const std::string& path) {
  return fmt::format("sim:load_urdf({}, {{ name = {}, position = vec3({}, {}, {}){} }})\n", lua_string(path),
                     lua_string(model.name), number_text(model.position.x), number_text(model.position.y),
                     number_text(model.position.z), model.servos ? ", motors = \"servo\"" : "");
}

}  // namespace limber::engine
