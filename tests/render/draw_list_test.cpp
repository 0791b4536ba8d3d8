// Draw lists of snapshots: instances, their poses and order, and the scene's bounds.
#include "ui/render/draw_list.h"

#include <limits>

#include "render/stage.h"
#include "sim/tendons/tendon_list.h"

namespace limber::render::test {
namespace {

const DrawCamera kEye{{0, -10, 0}, {0, 1, 0}, 1000, 0};

Vec3 position_of(const DrawList& list, std::size_t i) {
  const Instance& instance = list.instances().at(i);
  return {instance.position[0], instance.position[1], instance.position[2]};
}

TEST(DrawList, InterpolatesBetweenSnapshots) {
  TestScene scene;
  sim::Part& part = scene.add("box", box(Vec3(1)), {0, 0, 0});
  const auto before = scene.snapshot();
  part.set_pose({{1, 2, 4}, quat_axis({0, 0, 1}, 1.0)});
  const auto now = scene.snapshot();
  DrawList list;
  list.update(*before, *now, 0.25, kEye);
  EXPECT_LT(glm::length(position_of(list, 0) - Vec3(0.25, 0.5, 1)), 1e-6);
  const Instance& turned = list.instances()[0];
  EXPECT_NEAR(2 * std::atan2(turned.rotation[2], turned.rotation[3]), 0.25, 0.01) << "radians";
  list.update(*before, *now, 1, kEye);
  EXPECT_LT(glm::length(position_of(list, 0) - Vec3(1, 2, 4)), 1e-6);
}

TEST(DrawList, ShowsAddedAndRemovedBodiesAtOnce) {
  TestScene scene;
  scene.add("a", box(Vec3(1)));
  const auto one = scene.snapshot();
  scene.add("b", box(Vec3(1)), {3, 0, 0});
  const auto two = scene.snapshot();
  DrawList list;
  list.update(*one, *two, 0, kEye);
  EXPECT_EQ(list.instances().size(), 2u) << "no interpolation between scenes";
  scene.set("/physics/body/b/enabled", {0});
  const auto off = scene.snapshot();
  list.update(*off, *off, 1, kEye);
  EXPECT_EQ(list.instances().size(), 1u) << "a disabled body";
  scene.world.remove_body(*scene.world.find_body("a"));
  const auto gone = scene.snapshot();
  list.update(*off, *gone, 0.5, kEye);
  EXPECT_TRUE(list.instances().empty());
  EXPECT_TRUE(list.opaque().empty());
}

TEST(DrawList, BatchesByShapeAndDetail) {
  TestScene scene;
  for (int i = 0; i < 10; i++) {
    scene.add(fmt::format("box{}", i), box(Vec3(0.1 * (i + 1))), {0.2 * i, 0, 0});
    scene.add(fmt::format("ball{}", i), round(model::ShapeKind::sphere, 0.5), {0.2 * i, 0, 3});
  }
  const auto now = scene.snapshot();
  DrawList list;
  list.update(*now, *now, 1, {{0, -10, 0}, {0, 1, 0}, 1e6, 0});
  ASSERT_EQ(list.opaque().size(), 2u) << "for any size and color";
  EXPECT_EQ(list.opaque()[0].count, 10u);
  EXPECT_EQ(list.opaque()[1].first, 10u);
  list.update(*now, *now, 1, {{0, -10, 0}, {0, 1, 0}, 1e6, 2});
  EXPECT_EQ(list.opaque()[0].detail, 2);
  list.update(*now, *now, 1, {{0, -1e5, 0}, {0, 1, 0}, 1000, 0});
  EXPECT_EQ(list.opaque()[0].detail, kDetailLevels - 1) << "distant shapes are coarse";
}

TEST(DrawList, SortsGlassFarthestFirstWithoutShadow) {
  TestScene scene;
  for (const int i : {2, 0, 3, 1}) {
    const std::string name = fmt::format("glass{}", i);
    scene.add(name, i % 2 == 0 ? box(Vec3(1)) : round(model::ShapeKind::sphere, 0.5), {0, 2.0 * i, 0});
    scene.set("/visuals/shape/" + name + "/transparency", {i == 3 ? 0.2 : 0.8});
  }
  const auto now = scene.snapshot();
  DrawList list;
  list.update(*now, *now, 1, kEye);
  EXPECT_TRUE(list.opaque().empty());
  ASSERT_EQ(list.instances().size(), 4u);
  for (std::size_t i = 0; i < 4; i++) EXPECT_EQ(position_of(list, i).y, 6 - 2.0 * static_cast<double>(i));
  ASSERT_EQ(list.transparent().size(), 4u);
  EXPECT_TRUE(list.transparent()[0].casts_shadow);
  EXPECT_FALSE(list.transparent()[1].casts_shadow);
}

TEST(DrawList, BoundsIgnoreAStrayBody) {
  TestScene scene;
  for (int i = 0; i < 20; i++) scene.add(fmt::format("box{}", i), box(Vec3(0.2)), {0.1 * i - 0.95, 0, 1});
  auto now = scene.snapshot();
  DrawList list;
  list.update(*now, *now, 1, kEye);
  EXPECT_NEAR(list.center().x, 0, 0.06);
  EXPECT_NEAR(list.center().z, 1, 1e-6);
  EXPECT_NEAR(list.radius(), 1.05, 0.15);
  scene.add("stray", box(Vec3(0.2)), {0, 0, -9000});
  now = scene.snapshot();
  list.update(*now, *now, 1, kEye);
  EXPECT_NEAR(list.center().z, 1, 1e-6);
  EXPECT_LT(list.radius(), 1.3);
}

TEST(DrawList, PlanesAreInfinite) {
  TestScene scene;
  scene.add("ground", plane(), {0, 0, -0.5});
  scene.paint("ground", {0, 1, 1});
  const auto now = scene.snapshot();
  DrawList list;
  list.update(*now, *now, 1, kEye);
  EXPECT_TRUE(list.instances().empty());
  ASSERT_EQ(list.planes().size(), 1u);
  EXPECT_EQ(list.planes()[0].origin.z, -0.5F);
  EXPECT_EQ(list.planes()[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(list.planes()[0].tint, glm::vec3(1, 0, 0));
}

// One cylinder per segment, along it, in the color of its tension; radius 0 hides the tendon.
TEST(DrawList, DrawsTendons) {
  TestScene scene;
  sim::Part& a = scene.add("a", box(Vec3(0.1)), {0, 0, 0});
  sim::Shape& shape = **scene.world.shapes().add("b", box(Vec3(0.1)));
  sim::Part& b = **(*scene.world.add_body("b"))->add_part("part", shape, 1, {{3, 0, 0}, quat_identity()});
  (void)scene.world.tendons().add(a.body(), "line", {{&a, {0, 0, 0}}, {&a, {0, 0, 4}}, {&b, {0, 0, 0}}}).value();
  scene.set("/physics/body/a/tendon/line/radius", {0.2});
  const auto slack = scene.snapshot();
  DrawList list;
  list.update(*slack, *slack, 1, kEye);
  ASSERT_EQ(list.instances().size(), 4u);
  const Instance* segments[2] = {};
  for (const Instance& instance : list.instances()) {
    if (instance.position[2] != 2.0F) continue;
    segments[instance.position[0] == 0 ? 0 : 1] = &instance;
  }
  ASSERT_TRUE(segments[0] != nullptr && segments[1] != nullptr) << "their middles";
  const auto half_length = [](const Instance& s) { return s.extent[2] + s.rounding_radius; };
  EXPECT_NEAR(half_length(*segments[0]), 2, 1e-5);
  EXPECT_NEAR(half_length(*segments[1]), 2.5, 1e-5);
  EXPECT_NEAR(segments[0]->extent[0] + segments[0]->rounding_radius, 0.2, 1e-5);
  const float* const q = segments[1]->rotation;
  const Vec3 along = quat_xyzw(q[0], q[1], q[2], q[3]) * Vec3(0, 0, 1);
  EXPECT_LT(glm::length(along - Vec3(0.6, 0, -0.8)), 1e-5);
  const float pale = segments[0]->diffuse[2] / segments[0]->diffuse[0];
  EXPECT_GT(pale, 0.7F);
  scene.set("/physics/body/a/tendon/line/tension", {1000});
  scene.world.step();
  const auto taut = scene.snapshot();
  list.update(*taut, *taut, 1, kEye);
  bool has_red = false;
  for (const Instance& instance : list.instances())
    has_red = has_red || instance.diffuse[2] / instance.diffuse[0] < 0.2F * pale;
  EXPECT_TRUE(has_red);
  scene.set("/physics/body/a/tendon/line/radius", {0});
  const auto hidden = scene.snapshot();
  list.update(*hidden, *hidden, 1, kEye);
  EXPECT_EQ(list.instances().size(), 2u);
}

TEST(DrawList, SkipsNonFinitePoses) {
  TestScene scene;
  scene.add("box", box(Vec3(1)));
  engine::Snapshot now = *scene.snapshot();
  now.transient[now.render_scene->instances[0].part_offset + engine::transient_offsets().part_position] =
      std::numeric_limits<double>::quiet_NaN();
  DrawList list;
  list.update(now, now, 1, kEye);
  EXPECT_TRUE(list.instances().empty());
}

}  // namespace
}  // namespace limber::render::test
