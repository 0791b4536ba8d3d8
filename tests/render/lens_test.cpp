// Camera matrices, and the orbit camera's rotation, pan and zoom.
#include "ui/render/camera.h"

#include "render/stage.h"

namespace limber::render::test {
namespace {

Vec3 seen(const CameraMatrices& view_camera, const Vec3& point) {
  const glm::vec4 clip = view_camera.projection * view_camera.view * glm::vec4(glm::vec3(point), 1);
  return Vec3(clip) / static_cast<double>(clip.w);
}

TEST(CameraMatrices, FollowsTheCameraProperties) {
  TestScene scene;
  for (const auto& [eye, target] : {std::pair{Vec3(4.5, -6, 3.5), Vec3(0, 0, 1)},
                                    {Vec3(-2, 3, 0.5), Vec3(1, 1, 1)},
                                    {Vec3(0, 0, 9), Vec3(0, 0, 0)}}) {
    scene.look_from(eye, target);
    const CameraMatrices view_camera = camera_matrices(engine::camera_of(*scene.snapshot()), 160, 90);
    EXPECT_LT(glm::length(view_camera.eye - eye), 1e-9);
    EXPECT_LT(glm::length(view_camera.target - target), 1e-9);
    EXPECT_LT(glm::length(view_camera.forward - normalized(target - eye)), 1e-9);
    const Vec3 middle = seen(view_camera, target);
    EXPECT_NEAR(middle.x, 0, 1e-5);
    EXPECT_NEAR(middle.y, 0, 1e-5);
    const Vec3 side = glm::cross(view_camera.forward, view_camera.up);
    EXPECT_GT(seen(view_camera, target + 0.1 * side).x, 0.001) << "right is right";
    EXPECT_GT(seen(view_camera, target + 0.1 * view_camera.up).y, 0.001) << "up is up";
  }
}

TEST(CameraMatrices, FocalLengthIsInPixels) {
  engine::CameraSettings camera;
  camera.fovy = 90;  // the view is 2 m high at a distance of 1 m
  EXPECT_NEAR(camera_matrices(camera, 400, 100).focal_pixels, 50, 1e-9);
  camera.aspect = 1;
  const CameraMatrices square = camera_matrices(camera, 400, 100);
  EXPECT_NEAR(square.projection[0][0], square.projection[1][1], 1e-6)
      << "the property overrides the aspect ratio of the view";
}

TEST(CameraMatrices, FitsTheViewIntoTheFreeArea) {
  engine::CameraSettings camera;
  camera.fovy = 90;
  camera.position = {0, 0, -2};  // looks down from 2 m: the view is 4 m high there
  camera.distance = 2;
  const FreeArea free{0.1, 0.2, 0.5, 0.6};
  const CameraMatrices view_camera = camera_matrices(camera, 400, 200, free);
  const Vec3 middle = seen(view_camera, view_camera.target);
  EXPECT_NEAR(middle.x, 2 * 0.35 - 1, 1e-5) << "0.1 and half of 0.5";
  EXPECT_NEAR(middle.y, 1 - 2 * 0.5, 1e-5) << "0.2 and half of 0.6";
  EXPECT_NEAR(seen(view_camera, view_camera.target + 2.0 * view_camera.up).y, 1 - 2 * 0.2, 1e-5) << "the upper edge";
  EXPECT_NEAR(seen(view_camera, view_camera.target - 2.0 * view_camera.up).y, 1 - 2 * 0.8, 1e-5) << "the lower one";
  EXPECT_NEAR(view_camera.focal_pixels, 0.6 * 100, 1e-9);
}

TEST(Orbit, RotatesAroundItsTarget) {
  Orbit orbit{{0, -2, 0}, {0, 0, 0}};
  orbit.orbit(kPi / 2, 0);
  EXPECT_LT(glm::length(orbit.eye - Vec3(-2, 0, 0)), 1e-9) << "the world rotates to the right";
  orbit.orbit(0, kPi / 4);
  EXPECT_LT(glm::length(orbit.eye - Vec3(-std::sqrt(2), 0, std::sqrt(2))), 1e-9);
  orbit.orbit(0, 10);
  EXPECT_NEAR(glm::length(orbit.eye), 2, 1e-9);
  EXPECT_LT(std::hypot(orbit.eye.x, orbit.eye.y), 0.05) << "at most straight above";
  EXPECT_LT(orbit.eye.x, 0) << "and not past it";
  EXPECT_EQ(orbit.target, Vec3(0));
}

TEST(Orbit, PansWithTheMouse) {
  Orbit orbit{{0, -2, 1}, {0, 0, 1}};
  orbit.pan(0.5, 0.25, 90);  // the view is 4 m high at a distance of 2 m
  EXPECT_LT(glm::length(orbit.target - Vec3(-2, 0, 0)), 1e-9);
  EXPECT_LT(glm::length(orbit.eye - Vec3(-2, -2, 0)), 1e-9);
}

TEST(Orbit, ZoomNeverReachesTheTarget) {
  Orbit orbit{{0, -2, 1}, {0, 0, 1}};
  orbit.zoom(0.5);
  EXPECT_LT(glm::length(orbit.eye - Vec3(0, -1, 1)), 1e-9);
  for (int i = 0; i < 100; i++) orbit.zoom(0.5);
  EXPECT_GT(glm::length(orbit.eye - orbit.target), 0.01);
  for (int i = 0; i < 200; i++) orbit.zoom(2);
  EXPECT_LE(glm::length(orbit.eye - orbit.target), 1.001e5);
}

}  // namespace
}  // namespace limber::render::test
