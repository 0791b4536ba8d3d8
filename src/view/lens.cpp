// Matrices as the seed has them: T(position)·Rx·Ry·Rz.
#include "view/lens.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace limber {

namespace {

constexpr double kUpmost = 1.55;   // rad: just short of straight above, where there is no right and left
constexpr double kNearest = 0.02;  // m
constexpr double kFurthest = 1e5;

}  // namespace

Lens lens_of(const CameraView& camera, int width, int height, const FreePart& free) {
  Lens lens;
  const glm::dvec3 r = glm::radians(camera.rotation);
  glm::dmat4 view = glm::translate(glm::dmat4(1), camera.position);
  view = glm::rotate(view, r.x, glm::dvec3(1, 0, 0));
  view = glm::rotate(view, r.y, glm::dvec3(0, 1, 0));
  view = glm::rotate(view, r.z, glm::dvec3(0, 0, 1));
  const glm::dmat4 back = glm::inverse(view);
  lens.eye = Vec3(back[3]);
  lens.forward = -Vec3(back[2]);
  lens.up = Vec3(back[1]);
  lens.target = lens.eye + camera.distance * lens.forward;
  lens.view = glm::mat4(view);
  const double aspect = camera.aspect > 0 ? std::max(camera.aspect, 1e-3) : static_cast<double>(width) / height;
  const double fovy = glm::radians(camera.fovy);
  const double far = std::max(camera.far, 1.001 * camera.near);
  const double part = std::clamp(free.height, 0.05, 1.0);
  const glm::dvec3 middle(2 * free.x + free.width - 1, 1 - 2 * free.y - free.height, 0);
  const glm::dmat4 placed = glm::scale(glm::translate(glm::dmat4(1), middle), glm::dvec3(part, part, 1));
  lens.projection = glm::mat4(placed * glm::perspective(fovy, aspect, camera.near, far));
  lens.pixels = part * height / (2 * std::tan(fovy / 2));
  return lens;
}

void Orbit::turn(double right, double up) {
  const Vec3 arm = eye - target;
  const double length = std::max(glm::length(arm), kNearest);
  const double heading = std::atan2(arm.y, arm.x) - right;
  const double height = std::clamp(std::asin(std::clamp(arm.z / length, -1.0, 1.0)) + up, -kUpmost, kUpmost);
  eye = target +
        length * Vec3(std::cos(height) * std::cos(heading), std::cos(height) * std::sin(heading), std::sin(height));
}

void Orbit::shift(double right, double up, double fovy_degrees) {
  const Vec3 arm = target - eye;
  const Vec3 forward = normalized(arm);
  Vec3 side = normalized(glm::cross(forward, Vec3(0, 0, 1)));
  if (side == Vec3(0)) side = {1, 0, 0};
  const double metres = 2 * glm::length(arm) * std::tan(glm::radians(fovy_degrees) / 2);
  const Vec3 by = -metres * (right * side + up * glm::cross(side, forward));
  eye += by;
  target += by;
}

void Orbit::zoom(double factor) {
  const Vec3 arm = eye - target;
  const double length = std::max(glm::length(arm), kNearest);
  eye = target + normalized(arm) * std::clamp(length * factor, kNearest, kFurthest);
}

}  // namespace limber
