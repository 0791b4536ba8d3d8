// The view matrix follows ofxDabPhysics: T(position)·Rx·Ry·Rz.
#include "ui/render/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace limber::render {

namespace {

constexpr double kMaxElevation = 1.55;      // rad, just below π/2, where the direction to the right is undefined
constexpr double kMinOrbitDistance = 0.02;  // m
constexpr double kMaxOrbitDistance = 1e5;

}  // namespace

CameraMatrices camera_matrices(const engine::CameraSettings& camera, int width, int height, const FreeArea& free_area) {
  CameraMatrices out;
  const glm::dvec3 r = glm::radians(camera.rotation);
  glm::dmat4 view = glm::translate(glm::dmat4(1), camera.position);
  view = glm::rotate(view, r.x, glm::dvec3(1, 0, 0));
  view = glm::rotate(view, r.y, glm::dvec3(0, 1, 0));
  view = glm::rotate(view, r.z, glm::dvec3(0, 0, 1));
  const glm::dmat4 back = glm::inverse(view);
  out.eye = Vec3(back[3]);
  out.forward = -Vec3(back[2]);
  out.up = Vec3(back[1]);
  out.target = out.eye + camera.distance * out.forward;
  out.view = glm::mat4(view);
  const double aspect = camera.aspect > 0 ? std::max(camera.aspect, 1e-3) : static_cast<double>(width) / height;
  const double fovy = glm::radians(camera.fovy);
  const double far = std::max(camera.far, 1.001 * camera.near);
  const double height_fraction = std::clamp(free_area.height, 0.05, 1.0);
  const glm::dvec3 center(2 * free_area.x + free_area.width - 1, 1 - 2 * free_area.y - free_area.height, 0);
  const glm::dmat4 area_transform =
      glm::scale(glm::translate(glm::dmat4(1), center), glm::dvec3(height_fraction, height_fraction, 1));
  out.projection = glm::mat4(area_transform * glm::perspective(fovy, aspect, camera.near, far));
  out.focal_pixels = height_fraction * height / (2 * std::tan(fovy / 2));
  return out;
}

void Orbit::orbit(double right, double up) {
  const Vec3 offset = eye - target;
  const double length = std::max(glm::length(offset), kMinOrbitDistance);
  const double heading = std::atan2(offset.y, offset.x) - right;
  const double height =
      std::clamp(std::asin(std::clamp(offset.z / length, -1.0, 1.0)) + up, -kMaxElevation, kMaxElevation);
  eye = target +
        length * Vec3(std::cos(height) * std::cos(heading), std::cos(height) * std::sin(heading), std::sin(height));
}

void Orbit::pan(double right, double up, double fovy_degrees) {
  const Vec3 offset = target - eye;
  const Vec3 forward = normalized(offset);
  Vec3 side = normalized(glm::cross(forward, Vec3(0, 0, 1)));
  if (side == Vec3(0)) side = {1, 0, 0};
  const double meters = 2 * glm::length(offset) * std::tan(glm::radians(fovy_degrees) / 2);
  const Vec3 by = -meters * (right * side + up * glm::cross(side, forward));
  eye += by;
  target += by;
}

void Orbit::zoom(double factor) {
  const Vec3 offset = eye - target;
  const double length = std::max(glm::length(offset), kMinOrbitDistance);
  eye = target + normalized(offset) * std::clamp(length * factor, kMinOrbitDistance, kMaxOrbitDistance);
}

}  // namespace limber::render
