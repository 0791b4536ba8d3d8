// Points to angles and back.
#include "sim/visuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace limber {

namespace {

using namespace rows;

constexpr double kDegrees = 180 / std::numbers::pi;
const Vec3 kEye{4.5, -6, 3.5};
const Vec3 kTarget{0, 0, 1};

struct View {
  Vec3 position;
  Vec3 rotation;  // degrees
  double distance = 0;
};

// Rx(x)·Ry(y)·Rz(z), degrees
Mat3 turn_of(const Vec3& rotation) {
  const Vec3 r = rotation / kDegrees;
  const auto about = [](const Vec3& axis, double angle) { return glm::mat3_cast(quat_axis(axis, angle)); };
  return about({1, 0, 0}, r.x) * about({0, 1, 0}, r.y) * about({0, 0, 1}, r.z);
}

// Rz brings the direction into the plane of y and z, Rx from there to −z, which the eye looks along
View view_between(const Vec3& eye, const Vec3& target) {
  const Vec3 along = target - eye;
  const double flat = fixed::hypot(along.x, along.y);
  View view;
  view.distance = glm::length(along);
  // straight up or down any angle about z will do
  const double heading = flat > 1e-9 * view.distance ? fixed::atan2(along.y, along.x) : std::numbers::pi / 2;
  view.rotation = Vec3(fixed::atan2(-flat, -along.z), 0, std::numbers::pi / 2 - heading) * kDegrees;
  view.position = -(turn_of(view.rotation) * eye);
  return view;
}

std::array<double, 3> numbers_of(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

const Table& Camera::table() {
  static const View start = view_between(kEye, kTarget);
  static const Table table(
      "camera", "/visuals/camera", "/visuals/camera",
      {
          vec3("position", "m", numbers_of(start.position), -1e6, 1e6,
               "The world's origin, as the eye has it before it is turned; z below 0 is in front."),
          turns(vec3("rotation", "deg", numbers_of(start.rotation), -36000, 36000,
                     "Turns the world: about z, then y, then x.")),
          number("fovy", "deg", 40, 1, 170, "Field of view from bottom to top."),
          number("aspect", "", 0, 0, 100, "Width by height of the picture; 0: the window's."),
          number("near", "m", 0.05, 1e-4, 1e4, "What is nearer is not drawn."),
          number("far", "m", 200, 1e-2, 1e7, "What is further away is not drawn."),
          number("distance", "m", start.distance, 1e-3, 1e6, "From the eye to the target."),
          state(view<&Camera::read_eye, &Camera::write_eye>(
              vec3("eye", "m", numbers_of(kEye), -1e6, 1e6, "Where it looks from, world; the target stays."))),
          state(view<&Camera::read_target, &Camera::write_target>(
              vec3("target", "m", numbers_of(kTarget), -1e6, 1e6, "What it looks at, world; the eye stays."))),
      });
  return table;
}

Camera::Camera(Store& store, NodeId parent) : store_(store), id_(store.add(table(), parent, "camera", this)) {}

Mat3 Camera::turn() const {
  const double* const r = store_.values(id_, table().at("rotation"));
  return turn_of({r[0], r[1], r[2]});
}

Vec3 Camera::eye() const {
  const double* const p = store_.values(id_, table().at("position"));
  return -(glm::transpose(turn()) * Vec3(p[0], p[1], p[2]));
}

Vec3 Camera::target() const {
  const double distance = store_.values(id_, table().at("distance"))[0];
  return eye() + glm::transpose(turn()) * Vec3(0, 0, -distance);
}

void Camera::look_at(const Vec3& eye, const Vec3& target) {
  if (eye == target) return;
  const View view = view_between(eye, target);
  (void)store_.set(id_, table().at("position"), numbers_of(view.position));
  (void)store_.set(id_, table().at("rotation"), numbers_of(view.rotation));
  (void)store_.set(id_, table().at("distance"), {&view.distance, 1});
}

void Camera::read_eye(double* out) const { std::ranges::copy(numbers_of(eye()), out); }
void Camera::write_eye(const double* in) { look_at({in[0], in[1], in[2]}, target()); }
void Camera::read_target(double* out) const { std::ranges::copy(numbers_of(target()), out); }
void Camera::write_target(const double* in) { look_at(eye(), {in[0], in[1], in[2]}); }

const Table& Visuals::table() {
  static const Table table(
      "visuals", "/visuals", "",
      {vec3("background", "hsb", {0.62, 0.45, 0.06}, 0, 1,
            "Behind everything, as hue, saturation, brightness; the default: as the look has it.")});
  return table;
}

Visuals::Visuals(Store& store)
    : store_(store), id_(store.add(table(), store.root(), "visuals", this)), camera_(store, id_), look_(store, id_) {}

void Visuals::clear() {
  for (const auto& [id, rows] :
       {std::pair{id_, table().rows()}, {camera_.id(), Camera::table().rows()}, {look_.id(), Look::table().rows()}}) {
    for (const Row& row : rows) {
      if (row.stored()) (void)store_.set(id, row, {row.initial.data(), row.width});
    }
  }
}

}  // namespace limber
