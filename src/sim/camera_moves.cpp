// Views in between, and displacements.
#include "sim/camera_moves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world.h"

namespace limber {

namespace {

constexpr double kSlack = 1e-9;  // s; a sum of time steps misses its end by a few bits

// an offset from the target as heading and elevation (rad) and length (m)
struct Orbit {
  double heading = 0, elevation = 0, length = 0;
};

Orbit orbit_of(const Vec3& offset) {
  const double flat = fixed::hypot(offset.x, offset.y);
  return {fixed::atan2(offset.y, offset.x), fixed::atan2(offset.z, flat), fixed::hypot(flat, offset.z)};
}

Vec3 offset_of(const Orbit& orbit) {
  const double flat = orbit.length * fixed::cos(orbit.elevation);
  return {flat * fixed::cos(orbit.heading), flat * fixed::sin(orbit.heading),
          orbit.length * fixed::sin(orbit.elevation)};
}

// straight above or below there is no heading: it has the other's
bool upright(const Vec3& offset) { return fixed::hypot(offset.x, offset.y) < 1e-9 * glm::length(offset); }

Vec3 offset_between(const Vec3& from, const Vec3& to, double share) {
  Orbit a = orbit_of(from);
  Orbit b = orbit_of(to);
  if (upright(from)) a.heading = b.heading;
  if (upright(to)) b.heading = a.heading;
  const double turn = std::remainder(b.heading - a.heading, 2 * std::numbers::pi);
  return offset_of(
      {a.heading + share * turn, std::lerp(a.elevation, b.elevation, share), std::lerp(a.length, b.length, share)});
}

}  // namespace

CameraMoves::View CameraMoves::view() const {
  View view{};
  double* out = view.data();
  for (const char* name : {"position", "rotation", "distance"}) {
    const Row& row = Camera::table().at(name);
    out = std::copy_n(world_.store().values(world_.visuals().camera().id(), row), row.width, out);
  }
  return view;
}

std::optional<Vec3> CameraMoves::place_of(NodeId thing) const {
  const Store& store = world_.store();
  if (!store.alive(thing)) return {};
  const Part* part = nullptr;
  if (&store.table(thing) == &Part::table()) part = static_cast<const Part*>(store.thing(thing));
  if (&store.table(thing) == &Body::table()) part = static_cast<const Body*>(store.thing(thing))->root();
  if (part == nullptr) return {};
  return part->pose().position;
}

void CameraMoves::glide(const Vec3& eye, const Vec3& target, double seconds) {
  world_.undo().keep(*this);
  const Camera& camera = world_.visuals().camera();
  state_ = {};
  state_.glide = Glide{camera.eye(), camera.target(), eye, target, world_.time(), seconds, view()};
}

void CameraMoves::follow(NodeId thing) {
  world_.undo().keep(*this);
  state_ = {};
  const std::optional<Vec3> at = place_of(thing);
  if (!at) return;
  state_.followed = thing;
  state_.at = *at;
  Camera& camera = world_.visuals().camera();
  camera.look_at(*at + camera.eye() - camera.target(), *at);
}

void CameraMoves::step() {
  if (state_.glide) step_glide();
  if (!state_.followed.null()) step_follow();
}

void CameraMoves::step_glide() {
  Glide& glide = *state_.glide;
  if (view() != glide.left) return stop();  // another hand has it
  const double since = world_.time() - glide.begin;
  if (since + kSlack >= glide.seconds) {
    world_.visuals().camera().look_at(glide.eye, glide.target);
    return stop();
  }
  const double passed = std::max(since, 0.0) / glide.seconds;
  const double share = passed * passed * (3 - 2 * passed);
  const Vec3 target = glm::mix(glide.from_target, glide.target, share);
  const Vec3 offset = offset_between(glide.from_eye - glide.from_target, glide.eye - glide.target, share);
  world_.visuals().camera().look_at(target + offset, target);
  glide.left = view();
}

void CameraMoves::step_follow() {
  const std::optional<Vec3> at = place_of(state_.followed);
  if (!at) return stop();
  const Vec3 moved = *at - state_.at;
  state_.at = *at;
  if (moved == Vec3(0)) return;
  Camera& camera = world_.visuals().camera();
  camera.look_at(camera.eye() + moved, camera.target() + moved);
}

}  // namespace limber
