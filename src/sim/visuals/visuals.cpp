// Visuals: conversion of points to angles and back, and properties.
#include "sim/visuals/visuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "properties/values_hash.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
const Vec3 kDefaultEye{4.5, -6, 3.5};
const Vec3 kDefaultTarget{0, 0, 1};

// Returns Rx(x)·Ry(y)·Rz(z), degrees.
Mat3 rotation_matrix(const Vec3& rotation) {
  const Vec3 r = rotation / kDegreesPerRadian;
  const auto about = [](const Vec3& axis, double angle) { return glm::mat3_cast(quat_axis(axis, angle)); };
  return about({1, 0, 0}, r.x) * about({0, 1, 0}, r.y) * about({0, 0, 1}, r.z);
}

constexpr std::array kPose = {"position", "rotation", "distance"};

std::array<double, 3> to_array(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

// Rz rotates the direction into the plane of y and z, Rx from there to −z, the viewing direction.
CameraView view_from_to(const Vec3& eye, const Vec3& target) {
  const Vec3 direction = target - eye;
  const double horizontal = fixed::hypot(direction.x, direction.y);
  CameraView view;
  view.distance = glm::length(direction);
  // looking straight up or down, the angle about z is arbitrary
  const double heading =
      horizontal > 1e-9 * view.distance ? fixed::atan2(direction.y, direction.x) : std::numbers::pi / 2;
  view.rotation = Vec3(fixed::atan2(-horizontal, -direction.z), 0, std::numbers::pi / 2 - heading) * kDegreesPerRadian;
  view.position = -(rotation_matrix(view.rotation) * eye);
  return view;
}

const PropertyTable& Camera::table() {
  static const CameraView start = view_from_to(kDefaultEye, kDefaultTarget);
  static const PropertyTable table(
      "camera", "/visuals/camera", "/visuals/camera",
      {
          vec3("position", "m", to_array(start.position), -1e6, 1e6,
               "The world's origin in the eye's frame before the rotation; negative z is in front."),
          euler_angles(vec3("rotation", "deg", to_array(start.rotation), -36000, 36000,
                            "Rotation of the world: about z, then y, then x.")),
          number("fovy", "deg", 40, 1, 170, "Vertical field of view."),
          number("aspect", "", 0, 0, 100, "Aspect ratio of the view; 0: the window's."),
          number("near", "m", 0.05, 1e-4, 1e4, "Near clipping distance."),
          number("far", "m", 200, 1e-2, 1e7, "Far clipping distance."),
          number("distance", "m", start.distance, 1e-3, 1e6, "Distance from the eye to the target."),
          state(computed<&Camera::read_eye, &Camera::write_eye>(
              vec3("eye", "m", to_array(kDefaultEye), -1e6, 1e6, "Position of the eye, world; the target stays."))),
          state(computed<&Camera::read_target, &Camera::write_target>(vec3(
              "target", "m", to_array(kDefaultTarget), -1e6, 1e6, "Point that it looks at, world; the eye stays."))),
      });
  return table;
}

Camera::Camera(Store& store, NodeId parent) : store_(store), id_(store.add(table(), parent, "camera", this)) {}

Mat3 Camera::rotation() const {
  const double* const r = store_.values(id_, table().at("rotation"));
  return rotation_matrix({r[0], r[1], r[2]});
}

Vec3 Camera::eye() const {
  const double* const p = store_.values(id_, table().at("position"));
  return -(glm::transpose(rotation()) * Vec3(p[0], p[1], p[2]));
}

Vec3 Camera::target() const {
  const double distance = store_.values(id_, table().at("distance"))[0];
  return eye() + glm::transpose(rotation()) * Vec3(0, 0, -distance);
}

void Camera::look_at(const Vec3& eye, const Vec3& target) {
  if (eye == target) return;
  const CameraView view = view_from_to(eye, target);
  (void)store_.set(id_, table().at("position"), to_array(view.position));
  (void)store_.set(id_, table().at("rotation"), to_array(view.rotation));
  (void)store_.set(id_, table().at("distance"), {&view.distance, 1});
}

Camera::CameraPose Camera::pose() const {
  CameraPose pose{};
  double* out = pose.data();
  for (const char* const name : kPose) {
    const Property& property = table().at(name);
    out = std::copy_n(store_.values(id_, property), property.width, out);
  }
  return pose;
}

std::uint64_t Camera::pose_mask() {
  std::uint64_t mask = 0;
  for (const char* const name : kPose) mask |= std::uint64_t{1} << table().at(name).index;
  return mask;
}

bool Camera::pose_is_set() const {
  if ((store_.explicitly_set(id_) & pose_mask()) != 0) return true;
  return !std::ranges::all_of(kPose, [&](const char* name) {
    const Property& property = table().at(name);
    return std::equal(property.initial.begin(), property.initial.begin() + property.width,
                      store_.values(id_, property));
  });
}

void Camera::set_default_pose(const Vec3& eye, const Vec3& target) {
  look_at(eye, target);
  default_pose_ = pose();
}

std::uint64_t Camera::settings_hash() const {
  if (!has_framed_pose()) return fixed_node_hash(table(), store_.persistent_block(id_));
  std::vector<double> values(store_.persistent_block(id_), store_.persistent_block(id_) + table().persistent_width());
  for (const char* const name : kPose) {
    const Property& property = table().at(name);
    std::copy_n(property.initial.begin(), property.width, values.begin() + property.offset);
  }
  return fixed_node_hash(table(), values.data());
}

void Camera::read_eye(double* out) const { std::ranges::copy(to_array(eye()), out); }
void Camera::write_eye(const double* in) { look_at({in[0], in[1], in[2]}, target()); }
void Camera::read_target(double* out) const { std::ranges::copy(to_array(target()), out); }
void Camera::write_target(const double* in) { look_at(eye(), {in[0], in[1], in[2]}); }

const PropertyTable& Visuals::table() {
  static const PropertyTable table(
      "visuals", "/visuals", "",
      {vec3("background", "hsb", {0.62, 0.45, 0.06}, 0, 1,
            "Background color: hue, saturation, brightness; the default is that of the look.")});
  return table;
}

Visuals::Visuals(World& world)
    : store_(world.store()),
      id_(store_.add(table(), store_.root(), "visuals", this)),
      camera_(store_, id_),
      appearance_(store_, id_),
      camera_moves_(world),
      overlay_(world),
      fixtures_(std::make_unique<FixtureList>(world)) {}

Visuals::~Visuals() = default;

void Visuals::clear() {
  for (const auto& [id, properties] : {std::pair{id_, table().properties()},
                                       {camera_.id(), Camera::table().properties()},
                                       {appearance_.id(), Appearance::table().properties()}}) {
    for (const Property& property : properties) {
      if (property.stored()) (void)store_.set(id, property, {property.initial.data(), property.width});
    }
  }
  camera_moves_.stop();
  fixtures_->clear();
}

}  // namespace limber::sim
