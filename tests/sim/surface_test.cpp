// Surfaces: contacts of every convex shape with triangles, rolling over inner edges, slopes, fast parts, rays, threads.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/threads/thread_pool.h"
#include "model/mesh/heightfield.h"
#include "model/mesh/surface.h"
#include "sim/sensors/part_tree.h"
#include "sim/sensors/solid.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;
using model::ShapeKind;

/// A grid of 21 by 21 points on 4 by 4 m.
template <class Height>
model::ShapeModel terrain(Height height) {
  constexpr int kSide = 21;
  std::vector<double> heights;
  for (int row = 0; row < kSide; row++) {
    for (int column = 0; column < kSide; column++) heights.push_back(height(0.2 * column - 2, 0.2 * row - 2));
  }
  return *model::heightfield_shape({kSide, kSide, 4, 4, heights}, "terrain");
}

model::ShapeModel flat() {
  return terrain([](double, double) { return 0.0; });
}

model::ShapeModel mesh_of(std::vector<Vec3> vertices, std::vector<unsigned> triangles) {
  auto mesh = std::make_shared<model::MeshModel>();
  mesh->vertices = std::move(vertices);
  mesh->triangles = std::move(triangles);
  return model::surface_shape(mesh);
}

/// A plate of 2 by 2 m and 1 cm, with its upper side at z = 0, of 12 triangles.
model::ShapeModel plate() {
  std::vector<Vec3> corners;
  for (const double z : {-0.01, 0.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double x : {-1.0, 1.0}) corners.emplace_back(x, y, z);
    }
  }
  return mesh_of(corners, {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                           2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
}

struct Ground : WorldFixture {
  explicit Ground(const model::ShapeModel& shape) {
    set(world.id(), "gravity", {0, 0, -9.81});
    ground = &add("ground", shape, 0, Pose{});
  }
  Part& add(const std::string& name, const model::ShapeModel& shape, double mass, const Pose& pose) {
    Body& body = **world.add_body(name);
    return **body.add_part(name, **world.shapes().add(name, shape), mass, pose);
  }
  Part* ground = nullptr;
};

TEST(Surface, HoldsEveryShapeAtTheHeightOfAPlane) {
  const std::vector<std::pair<model::ShapeModel, double>> shapes = {
      {sphere_model(0.1), 0.1},
      {box_model({0.5, 0.3, 0.2}), 0.1},
      {round_model(ShapeKind::cylinder, 0.15, 0.2), 0.1},
      {round_model(ShapeKind::cone, 0.15, 0.2), 0.1},
  };
  for (std::size_t i = 0; i < shapes.size(); i++) {
    Ground scene(flat());
    Part& part = scene.add("part", shapes[i].first, 1, {{0.07, 0.03, shapes[i].second + 0.02}, quat_identity()});
    scene.ticks(120);
    EXPECT_NEAR(part.pose().position.z, shapes[i].second, 1e-3) << i;
    EXPECT_NEAR(part.pose().position.x, 0.07, 1e-3) << i;
    EXPECT_NEAR(std::abs(part.pose().rotation.w), 1, 1e-5) << i;
  }
}

TEST(Surface, ASphereRollsOverInnerEdges) {
  Ground scene(flat());
  Part& ball = scene.add("ball", sphere_model(0.05), 1, {{-1.5, -0.31, 0.05}, quat_identity()});
  scene.set(ball.id(), "linear_velocity", {1, 0.2, 0});
  scene.set(ball.id(), "angular_velocity", {-4, 20, 0});
  for (int i = 0; i < 120; i++) {
    scene.ticks(1);
    ASSERT_NEAR(ball.pose().position.z, 0.05, 2e-4) << i;
    ASSERT_NEAR(scene.vec(ball.id(), "linear_velocity").x, 1, 2e-3) << i;
  }
  EXPECT_NEAR(ball.pose().position.x, 0.5, 5e-3);
}

TEST(Surface, ABoxSlidesOverInnerEdges) {
  Ground scene(flat());
  Part& box = scene.add("box", box_model({0.1, 0.1, 0.1}), 1, {{-1.5, 0.03, 0.05}, quat_identity()});
  scene.set(box.id(), "friction", {0});
  scene.set(box.id(), "linear_velocity", {1.5, 0.3, 0});
  scene.ticks(120);
  EXPECT_NEAR(scene.vec(box.id(), "linear_velocity").x, 1.5, 1e-3);
  EXPECT_NEAR(scene.vec(box.id(), "linear_velocity").y, 0.3, 1e-3);
  EXPECT_NEAR(box.pose().position.z, 0.05, 5e-4);
  EXPECT_NEAR(std::abs(box.pose().rotation.w), 1, 1e-5);
}

// the normal force of a slope that turns under a box equals that of its plane until the angle of friction
double slide_on_slope(double angle, double friction) {
  Ground scene(terrain([&](double x, double) { return -x * std::tan(angle); }));
  const Quat tilt = quat_axis(Vec3(0, 1, 0), angle);
  const Vec3 start = tilt * Vec3(-0.5, 0, 0.05);
  Part& box = scene.add("box", box_model({0.2, 0.2, 0.1}), 1, {start, tilt});
  scene.set(box.id(), "friction", {friction});
  scene.ticks(120);
  return glm::length(box.pose().position - start);
}

TEST(Surface, ABoxRestsOnASlopeUpToTheAngleOfFriction) {
  for (const double friction : {0.3, 0.6}) {
    const double limit = std::atan(friction);
    EXPECT_LT(slide_on_slope(limit - kPi / 360, friction), 2e-3) << friction;
    EXPECT_GT(slide_on_slope(limit + kPi / 360, friction), 0.05) << friction;
  }
}

TEST(Surface, ABoxRestsInAValleyAndASphereOnARidge) {
  const double slope = 0.5;
  Ground valley(terrain([&](double x, double) { return slope * std::abs(x); }));
  Part& ball = valley.add("ball", sphere_model(0.1), 1, {{0.05, 0.03, 0.2}, quat_identity()});
  valley.set(ball.id(), "linear_damping", {0.9});
  valley.set(ball.id(), "angular_damping", {0.9});
  valley.ticks(600);
  // it touches both sides
  EXPECT_NEAR(ball.pose().position.z, 0.1 * std::sqrt(1 + slope * slope), 1e-3);
  EXPECT_NEAR(ball.pose().position.x, 0, 1e-3);

  Ground ridge(terrain([&](double x, double) { return -slope * std::abs(x); }));
  Part& bar = ridge.add("bar", box_model({0.6, 0.3, 0.1}), 1, {{0, 0.03, 0.06}, quat_identity()});
  ridge.ticks(60);
  EXPECT_NEAR(bar.pose().position.z, 0.05, 1e-3) << "it lies on the edge, which stands out";
}

TEST(Surface, ABoxOverhangsAPlate) {
  Ground scene(plate());
  Part& box = scene.add("box", box_model({0.4, 0.2, 0.2}), 1, {{0.9, 0, 0.101}, quat_identity()});
  scene.ticks(120);
  EXPECT_NEAR(box.pose().position.x, 0.9, 1e-3) << "the plate's side must not push it";
  EXPECT_NEAR(box.pose().position.z, 0.1, 1e-3);
}

TEST(Surface, NothingFastPassesFromEitherSide) {
  for (const double side : {1.0, -1.0}) {
    Ground scene(plate());
    scene.set(scene.world.id(), "gravity", {0, 0, 0});
    Part& ball = scene.add("ball", sphere_model(0.005), 0.01, {{0.1, 0.2, side - 0.005}, quat_identity()});
    Part& stick = scene.add("stick", round_model(ShapeKind::capsule, 0.005, 0.05), 0.01,
                            {{-0.4, 0.1, side - 0.005}, quat_identity()});
    for (const Part* part : {&ball, &stick}) scene.set(part->id(), "linear_velocity", {3, 0, -100 * side});
    for (int i = 0; i < 30; i++) {
      scene.ticks(1);
      for (const Part* part : {&ball, &stick})
        ASSERT_GT(side * (part->pose().position.z + 0.005), 0) << side << " " << i;
    }
  }
}

TEST(Surface, RaysAndDistances) {
  const auto height = [](double x, double y) { return 0.3 * std::sin(x) * std::cos(2 * y); };
  const model::ShapeModel shape = terrain(height);
  const sim::Solid solid({shape, Pose{}, {}, 1});
  for (int row = 1; row < 20; row += 3) {
    for (int column = 1; column < 20; column += 3) {
      const double x = 0.2 * column - 2, y = 0.2 * row - 2;
      const auto hit = solid.intersect({x, y, 2}, {0, 0, -1}, 10);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(2 - hit->distance, height(x, y), 1e-5);
      EXPECT_GT(hit->normal.z, 0.5);
      // on the diagonal of a cell
      const auto between = solid.intersect({x + 0.1, y + 0.1, -2}, {0, 0, 1}, 10);
      ASSERT_TRUE(between);
      EXPECT_NEAR(-2 + between->distance, (height(x, y) + height(x + 0.2, y + 0.2)) / 2, 1e-5);
      EXPECT_LT(between->normal.z, -0.5) << "the side that the ray comes from";
    }
  }
  EXPECT_FALSE(solid.intersect({2.01, 0, 2}, {0, 0, -1}, 10));
  EXPECT_FALSE(solid.intersect({0, 0, 2}, {0, 0, -1}, 1.5));
  EXPECT_NEAR(sim::Solid({flat(), Pose{}, {}, 1}).signed_distance({2.3, 0.1, 0.4}), 0.5, 1e-9);
}

TEST(Surface, TakesNoMassAndNoCompound) {
  Ground scene(flat());
  Shape& shape = *scene.world.shapes().find("ground");
  const auto part = (*scene.world.add_body("other"))->add_part("part", shape, 1, Pose{});
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error(), "part 'other/part' is a surface: its mass must be 0, not 1 kg");
  model::ShapeModel compound;
  compound.kind = ShapeKind::compound;
  EXPECT_FALSE((*scene.world.shapes().add("compound", compound))->add_child(shape, Pose{}));
}

TEST(Surface, CompoundsAndTurnedGround) {
  Ground scene(plate());
  scene.set(scene.ground->id(), "position", {0, 0, 1});
  model::ShapeModel empty;
  empty.kind = ShapeKind::compound;
  Shape& compound = **scene.world.shapes().add("feet", empty);
  Shape& foot = **scene.world.shapes().add("foot", sphere_model(0.05));
  for (const double x : {-0.3, 0.3}) {
    for (const double y : {-0.2, 0.2}) ASSERT_TRUE(compound.add_child(foot, {{x, y, -0.2}, quat_identity()}));
  }
  Part& table = **(*scene.world.add_body("table"))->add_part("table", compound, 2, {{0.1, 0, 1.27}, quat_identity()});
  scene.ticks(120);
  EXPECT_NEAR(table.pose().position.z, 1.25, 1e-3);
  EXPECT_NEAR(std::abs(table.pose().rotation.w), 1, 1e-5);
}

/// Shapes that tumble down hills.
std::vector<std::uint64_t> avalanche(World& world, int ticks) {
  if (world.bodies().empty()) {
    Store& store = world.store();
    const double gravity[] = {0, 0, -9.81};
    EXPECT_TRUE(store.set(world.id(), "gravity", gravity).ok());
    Shape& hills = **world.shapes().add(
        "hills", terrain([](double x, double y) { return 0.3 * fixed::sin(3 * x) * fixed::cos(2 * y) + 0.2 * x; }));
    EXPECT_TRUE((*world.add_body("ground"))->add_part("ground", hills, 0, Pose{}).ok());
    const std::vector<model::ShapeModel> kinds = {sphere_model(0.08), box_model({0.2, 0.15, 0.1}),
                                                  round_model(ShapeKind::capsule, 0.05, 0.15),
                                                  round_model(ShapeKind::cylinder, 0.06, 0.2)};
    for (int i = 0; i < 24; i++) {
      const std::string name = "stone" + std::to_string(i);
      Shape& shape = **world.shapes().add(name, kinds[static_cast<std::size_t>(i) % kinds.size()]);
      const Pose pose{{0.5 * (i % 6) - 1.25, 0.6 * (i / 6) - 0.9, 1}, quat_axis({0, 1, 0}, i)};
      EXPECT_TRUE((*world.add_body(name))->add_part("stone", shape, 1, pose).ok());
    }
  }
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < ticks; i++) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

TEST(Surface, IsEqualForAnyNumberOfThreads) {
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 4}) {
    Store store;
    WorldSetup setup;
    if (threads > 1) setup.thread_pool = std::make_shared<ThreadPool>(threads);
    World world(store, setup);
    const std::vector<std::uint64_t> hashes = avalanche(world, 100);
    if (expected.empty()) expected = hashes;
    EXPECT_EQ(hashes, expected) << threads;
  }
}

TEST(Surface, IsRestoredFromACheckpoint) {
  WorldFixture s;
  avalanche(s.world, 40);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, scratch);
  const std::vector<std::uint64_t> first = avalanche(s.world, 80);
  checkpoint.restore(s.world, pages, scratch);
  EXPECT_EQ(avalanche(s.world, 80), first);
  checkpoint.release(pages);
}

}  // namespace
}  // namespace limber::sim
