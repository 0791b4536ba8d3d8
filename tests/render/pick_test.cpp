// Picking: the first part hit by a ray through a point of the view.
#include "ui/render/pick.h"

#include "render/stage.h"

namespace limber::render::test {
namespace {

model::ShapeModel ball_of(double radius) {
  model::ShapeModel model;
  model.kind = model::ShapeKind::sphere;
  model.radius = radius;
  return model;
}

TEST(Pick, ReturnsTheNearestPart) {
  TestScene scene;
  sim::Part& near = scene.add("near", ball_of(0.5), {0, 0, 0});
  scene.add("far", ball_of(0.5), {0, 5, 0});
  model::ShapeModel box;
  box.size = {0.4, 0.4, 2};
  sim::Part& side = scene.add("side", box, {3, 0, 0});
  scene.look_from({0, -10, 0}, {0, 0, 0});
  const auto now = scene.snapshot();
  const CameraMatrices view_camera = camera_matrices(engine::camera_of(*now), 200, 100);
  const auto at = [&](sim::Part& part) { return scene.store.view()->slots[part.id().slot].transient; };
  const auto middle = pick(*now, view_camera, 0, 0);
  ASSERT_TRUE(middle.has_value());
  EXPECT_EQ(middle->part_offset, at(near));
  EXPECT_NEAR(middle->distance, 9.5, 1e-3) << "its surface";
  EXPECT_LT(glm::length(middle->point - Vec3(0, -0.5, 0)), 1e-3);
  const glm::vec4 clip = view_camera.projection * view_camera.view * glm::vec4(3, 0, 0.8, 1);
  const auto post = pick(*now, view_camera, static_cast<double>(clip.x / clip.w), static_cast<double>(clip.y / clip.w));
  ASSERT_TRUE(post.has_value());
  EXPECT_EQ(post->part_offset, at(side));
  EXPECT_FALSE(pick(*now, view_camera, 0.5, 0.9).has_value()) << "the sky is not a part";
}

TEST(Pick, UsesTheFreeArea) {
  TestScene scene;
  scene.add("ball", ball_of(0.5), {0, 0, 0});
  scene.look_from({0, -10, 0}, {0, 0, 0});
  const auto now = scene.snapshot();
  const CameraMatrices view_camera = camera_matrices(engine::camera_of(*now), 200, 100, {0, 0, 0.5, 0.5});
  EXPECT_FALSE(pick(*now, view_camera, 0, 0).has_value());
  EXPECT_TRUE(pick(*now, view_camera, -0.5, 0.5).has_value()) << "the middle of the upper left quarter";
}

// points inside the bounding box but outside the shape: beside a capsule's end or a cone's tip, at a mesh's corner
TEST(Pick, TestsTheExactShape) {
  auto mesh = std::make_shared<model::MeshModel>();
  mesh->vertices = {{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}};
  mesh->triangles = {0, 1, 2};
  model::ShapeModel triangle;
  triangle.kind = model::ShapeKind::mesh;
  triangle.mesh = mesh;
  mesh->hull = {{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {-1, 0.1, -1}};
  struct Case {
    const char* name;
    model::ShapeModel model;
    Vec3 on, beside;
  };
  model::ShapeModel egg;
  egg.kind = model::ShapeKind::ellipsoid;
  egg.size = {1, 0.4, 2};
  const Case cases[] = {{"egg", egg, {0.3, 0, 0.75}, {0.3, 0, 0.85}},
                        {"cylinder", round(model::ShapeKind::cylinder, 0.5, 2), {0.45, 0, 0.95}, {0.55, 0, 0.95}},
                        {"capsule", round(model::ShapeKind::capsule, 0.5, 1), {0.3, 0, 0.85}, {0.45, 0, 0.95}},
                        {"cone", round(model::ShapeKind::cone, 0.5, 2), {0.2, 0, 0}, {0.4, 0, 0.6}},
                        {"mesh", triangle, {-0.5, 0, -0.5}, {0.5, 0, 0.5}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    TestScene alone;
    alone.add(c.name, c.model);
    alone.look_from({0, -1000, 0}, {0, 0, 0});  // so far away that rays are almost parallel
    alone.set("/visuals/camera/fovy", {1});
    const auto now = alone.snapshot();
    const CameraMatrices view_camera = camera_matrices(engine::camera_of(*now), 200, 100);
    const auto at = [&](const Vec3& point) {
      const glm::vec4 clip = view_camera.projection * view_camera.view * glm::vec4(glm::vec3(point), 1);
      return pick(*now, view_camera, static_cast<double>(clip.x / clip.w), static_cast<double>(clip.y / clip.w));
    };
    EXPECT_TRUE(at(c.on).has_value());
    EXPECT_FALSE(at(c.beside).has_value());
  }
}

TEST(Pick, IgnoresDisabledParts) {
  TestScene scene;
  scene.add("ball", ball_of(0.5), {0, 0, 0});
  scene.look_from({0, -10, 0}, {0, 0, 0});
  scene.set("/physics/body/ball/enabled", {0});
  const auto now = scene.snapshot();
  EXPECT_FALSE(pick(*now, camera_matrices(engine::camera_of(*now), 200, 100), 0, 0).has_value());
}

}  // namespace
}  // namespace limber::render::test
