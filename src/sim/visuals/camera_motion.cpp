// CameraMoves: interpolation of views, and following.
#include "sim/visuals/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr double kTolerance = 1e-9;  // s; a sum of time steps misses the end by a few bits

// An offset from the target in spherical coordinates: heading and elevation (rad), length (m).
struct Orbit {
  double heading = 0, elevation = 0, length = 0;
};

Orbit orbit_of(const Vec3& offset) {
  const double horizontal = fixed::hypot(offset.x, offset.y);
  return {fixed::atan2(offset.y, offset.x), fixed::atan2(offset.z, horizontal), fixed::hypot(horizontal, offset.z)};
}

Vec3 offset_of(const Orbit& orbit) {
  const double horizontal = orbit.length * fixed::cos(orbit.elevation);
  return {horizontal * fixed::cos(orbit.heading), horizontal * fixed::sin(orbit.heading),
          orbit.length * fixed::sin(orbit.elevation)};
}

// True if the offset is vertical, so that its heading is undefined: the other offset's is used then.
bool is_vertical(const Vec3& offset) { return fixed::hypot(offset.x, offset.y) < 1e-9 * glm::length(offset); }

Vec3 interpolate_offset(const Vec3& from, const Vec3& to, double fraction) {
  Orbit a = orbit_of(from);
  Orbit b = orbit_of(to);
  if (is_vertical(from)) a.heading = b.heading;
  if (is_vertical(to)) b.heading = a.heading;
  const double heading_change = std::remainder(b.heading - a.heading, 2 * std::numbers::pi);
  return offset_of({a.heading + fraction * heading_change, std::lerp(a.elevation, b.elevation, fraction),
                    std::lerp(a.length, b.length, fraction)});
}

}  // namespace

CameraMoves::View CameraMoves::view() const {
  View view{};
  double* out = view.data();
  for (const char* name : {"position", "rotation", "distance"}) {
    const Property& property = Camera::table().at(name);
    out = std::copy_n(world_.store().values(world_.visuals().camera().id(), property), property.width, out);
  }
  return view;
}

std::optional<Vec3> CameraMoves::position_of(NodeId object) const {
  const Store& store = world_.store();
  if (!store.alive(object)) return {};
  const Part* part = nullptr;
  if (&store.table(object) == &Part::table()) part = static_cast<const Part*>(store.object(object));
  if (&store.table(object) == &Body::table()) part = static_cast<const Body*>(store.object(object))->root();
  if (part == nullptr) return {};
  return part->pose().position;
}

void CameraMoves::save_for_rollback() {
  if (world_.transaction().first_in_call(saved_in_call_)) world_.transaction().save_fields(state_);
}

void CameraMoves::glide(const Vec3& eye, const Vec3& target, double seconds) {
  save_for_rollback();
  const Camera& camera = world_.visuals().camera();
  state_ = {};
  state_.glide = Glide{camera.eye(), camera.target(), eye, target, world_.time(), seconds, view()};
}

void CameraMoves::follow(NodeId object) {
  save_for_rollback();
  state_ = {};
  const std::optional<Vec3> at = position_of(object);
  if (!at) return;
  state_.followed = object;
  state_.last_position = *at;
  Camera& camera = world_.visuals().camera();
  camera.look_at(*at + camera.eye() - camera.target(), *at);
}

void CameraMoves::step() {
  if (state_.glide) step_glide();
  if (!state_.followed.null()) step_follow();
}

void CameraMoves::step_glide() {
  Glide& glide = *state_.glide;
  if (view() != glide.last_view) return stop();  // something else has moved the camera
  const double elapsed = world_.time() - glide.start_time;
  if (elapsed + kTolerance >= glide.seconds) {
    world_.visuals().camera().look_at(glide.eye, glide.target);
    return stop();
  }
  const double progress = std::max(elapsed, 0.0) / glide.seconds;
  const double fraction = progress * progress * (3 - 2 * progress);
  const Vec3 target = glm::mix(glide.from_target, glide.target, fraction);
  const Vec3 offset = interpolate_offset(glide.from_eye - glide.from_target, glide.eye - glide.target, fraction);
  world_.visuals().camera().look_at(target + offset, target);
  glide.last_view = view();
}

void CameraMoves::step_follow() {
  const std::optional<Vec3> at = position_of(state_.followed);
  if (!at) return stop();
  const Vec3 moved = *at - state_.last_position;
  state_.last_position = *at;
  if (moved == Vec3(0)) return;
  Camera& camera = world_.visuals().camera();
  camera.look_at(camera.eye() + moved, camera.target() + moved);
}

}  // namespace limber::sim
