// Positions of the camera, and the messages that set them.
#include "app/view/camera_control.h"

#include <cmath>

#include "ui/render/pick.h"

namespace limber::app {

namespace {

// time in s after the last movement in which the local camera overrides the snapshot's
constexpr double kLocalCameraTime = 0.3;
constexpr double kOrbitSpeed = 2.5;  // rad per height of the view
constexpr double kZoomStep = 0.88;   // factor of the distance per step

render::Orbit orbit_of(const engine::CameraSettings& camera) {
  const render::CameraMatrices view_camera = render::camera_matrices(camera, 1, 1);
  return {view_camera.eye, view_camera.target};
}

std::vector<Arg> numbers(const Vec3& v) { return {Arg::of(v.x), Arg::of(v.y), Arg::of(v.z)}; }

// sets the eye twice, because a new eye is ignored if it equals the old target
std::vector<Message> set_camera(const render::Orbit& orbit) {
  return {{"/visuals/camera/eye", numbers(orbit.eye)},
          {"/visuals/camera/target", numbers(orbit.target)},
          {"/visuals/camera/eye", numbers(orbit.eye)}};
}

}  // namespace

void CameraControl::set_default_view(const engine::Snapshot& first) {
  default_view_ = orbit_of(engine::camera_of(first));
}

std::vector<Message> CameraControl::default_view() const { return set_camera(default_view_); }

std::vector<Message> CameraControl::follow(const engine::Snapshot& snapshot, std::uint32_t part) {
  const Vec3 at = engine::part_pose(snapshot, part).position;
  if (followed_ != part) {
    followed_ = part;
    const render::Orbit orbit = orbit_of(engine::camera_of(snapshot));
    follow_offset_ = orbit.eye - orbit.target;
  }
  return set_camera({at + follow_offset_, at});
}

std::vector<Message> CameraControl::frame(const engine::CameraSettings& camera,
                                          std::span<const sim::FramedSphere> spheres, double aspect) {
  const render::Orbit orbit = orbit_of(camera);
  const auto view = sim::frame(spheres, orbit.eye - orbit.target, {camera.fovy, aspect, camera.near});
  if (!view) return {};
  return set_camera({view->eye, view->target});
}

std::vector<Message> CameraControl::move(const MouseMovement& mouse, const engine::CameraSettings& camera,
                                         double height, double now) {
  if (now - moved_at_ > kLocalCameraTime) orbit_ = orbit_of(camera);
  moved_at_ = now;
  orbit_.orbit(kOrbitSpeed * mouse.orbit_x / height, kOrbitSpeed * mouse.orbit_y / height);
  orbit_.pan(mouse.pan_x / height, -mouse.pan_y / height, camera.fovy);
  orbit_.zoom(std::pow(kZoomStep, mouse.wheel));
  follow_offset_ = orbit_.eye - orbit_.target;
  return set_camera(orbit_);
}

}  // namespace limber::app
