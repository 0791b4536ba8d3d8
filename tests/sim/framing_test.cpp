// Framed views contain their objects, and no more than needed.
#include "sim/visuals/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/visuals/visuals.h"
#include "support/world_objects.h"

namespace limber::sim {
namespace {

// Returns the largest extent of the spheres in a view as a fraction of half its width or height.
double filled_part(const std::vector<FramedSphere>& spheres, const FramedView& view, const FrameShape& shape) {
  const Vec3 ahead = normalized(view.target - view.eye);
  const Vec3 right = normalized(glm::cross(ahead, Vec3(0, 0, 1)));
  const Vec3 up = glm::cross(right, ahead);
  const double vertical = std::tan(shape.fovy * std::numbers::pi / 360);
  double most = 0;
  for (const FramedSphere& sphere : spheres) {
    const Vec3 at = sphere.center - view.eye;
    const double depth = glm::dot(at, ahead);
    for (const auto& [axis, tangent] : {std::pair(right, vertical * shape.aspect), {up, vertical}}) {
      // of the sphere's silhouette in this direction: the angle to its center, plus its angular radius
      const double side = std::abs(glm::dot(at, axis));
      const double angle = std::atan2(side, depth) + std::asin(sphere.radius / std::hypot(side, depth));
      most = std::max(most, std::tan(angle) / tangent);
    }
  }
  return most;
}

TEST(Framing, FillsFourFifthsOfTheView) {
  std::mt19937 random(1);
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  for (int i = 0; i < 200; i++) {
    std::vector<FramedSphere> spheres;
    for (int k = 0; k <= i % 7; k++) spheres.push_back({{number(-9, 9), number(-9, 9), number(-9, 9)}, number(0.1, 3)});
    const FrameShape shape{number(10, 100), number(0.3, 3)};
    const auto view = frame(spheres, {number(-1, 1), number(-1, 1), number(-0.5, 1)}, shape);
    ASSERT_TRUE(view);
    EXPECT_NEAR(filled_part(spheres, *view, shape), 0.8, 1e-9) << i;
  }
}

TEST(Framing, TargetIsTheCenterAndTheDirectionStays) {
  const std::vector<FramedSphere> spheres{{{0, 0, 0}, 1}, {{10, 0, 0}, 1}};
  const auto view = frame(spheres, {0, -2, 2}, {40, 1});
  ASSERT_TRUE(view);
  EXPECT_EQ(view->target, Vec3(5, 0, 0));
  const Vec3 along = normalized(view->eye - view->target);
  EXPECT_NEAR(along.y, -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(along.z, std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(frame(spheres, {0, 0, 1}, {40, 1})) << "from straight above";
  EXPECT_FALSE(frame({}, {0, 0, 1}, {40, 1}));
  EXPECT_FALSE(frame(spheres, {0, 0, 0}, {40, 1}));
}

TEST(Framing, ShapesAreEnclosed) {
  const auto extent = [](const model::ShapeModel& shape) {
    std::vector<FramedSphere> spheres;
    add_framed_shape(shape, {{1, 2, 3}, quat_identity()}, spheres);
    Vec3 high(-1e9);
    for (const FramedSphere& sphere : spheres) high = glm::max(high, sphere.center + sphere.radius);
    return spheres.empty() ? Vec3(0) : high - Vec3(1, 2, 3);
  };
  model::ShapeModel shape;
  shape.size = {2, 4, 6};
  shape.radius = 0.5;
  shape.height = 3;
  EXPECT_EQ(extent(shape), Vec3(1, 2, 3));
  shape.kind = model::ShapeKind::sphere;
  EXPECT_EQ(extent(shape), Vec3(0.5));
  shape.kind = model::ShapeKind::capsule;
  EXPECT_EQ(extent(shape), Vec3(0.5, 0.5, 2));
  shape.kind = model::ShapeKind::cylinder;
  EXPECT_EQ(extent(shape), Vec3(0.5, 0.5, 1.5));
  shape.kind = model::ShapeKind::plane;
  EXPECT_EQ(extent(shape), Vec3(0));
}

struct FramedWorld : testing::Test {
  Store store;
  World world{store};
  Camera& camera = world.visuals().camera();

  void add(const std::string& name, double size, const Vec3& at, double mass) {
    model::ShapeModel box;
    box.size = Vec3(size);
    Body& body = **world.add_body(name);
    ASSERT_TRUE(body.add_part("part", **world.shapes().add(name, box), mass, {at, quat_identity()}).ok());
  }
};

TEST_F(FramedWorld, DefaultViewShowsBodiesThatMove) {
  add("ball", 0.2, {10, 20, 0.5}, 1);
  add("stand", 30, {0, 0, -15}, 0);
  frame_scene(world);
  EXPECT_NEAR(glm::length(camera.target() - Vec3(10, 20, 0.5)), 0, 1e-9) << "without the static body";
  EXPECT_LT(glm::length(camera.eye() - camera.target()), 1.5);
  EXPECT_TRUE(camera.has_framed_pose());
}

TEST_F(FramedWorld, DefaultViewShowsStaticBodiesIfThereAreNoOthers) {
  add("stand", 3, {0, 0, -15}, 0);
  frame_scene(world);
  EXPECT_NEAR(glm::length(camera.target() - Vec3(0, 0, -15)), 0, 1e-9);
}

TEST_F(FramedWorld, HashIgnoresTheDefaultView) {
  add("ball", 0.2, {10, 20, 0.5}, 1);
  const std::uint64_t before = world.state_hash();
  frame_scene(world);
  EXPECT_EQ(world.state_hash(), before);
  ASSERT_TRUE(store.set(camera.id(), "fovy", std::vector{50.0}).ok());
  const std::uint64_t zoomed = world.state_hash();
  EXPECT_NE(zoomed, before) << "but no other property of the camera";
  ASSERT_TRUE(store.set(camera.id(), "distance", std::vector{7.0}).ok());
  EXPECT_FALSE(camera.has_framed_pose());
  EXPECT_NE(world.state_hash(), zoomed) << "a view that was set";
}

TEST_F(FramedWorld, ViewThatWasSetStays) {
  add("ball", 0.2, {10, 20, 0.5}, 1);
  camera.look_at({1, 2, 3}, {0, 0, 0});
  frame_scene(world);
  EXPECT_NEAR(glm::length(camera.eye() - Vec3(1, 2, 3)), 0, 1e-9);
  EXPECT_FALSE(camera.has_framed_pose());
}

TEST_F(FramedWorld, EmptySceneKeepsTheTablesView) {
  frame_scene(world);
  EXPECT_FALSE(camera.has_framed_pose());
  EXPECT_FALSE(camera.pose_is_set());
}

}  // namespace
}  // namespace limber::sim
