// What is drawn of snapshots: who, where, in which order; and where the bodies are.
#include "view/draw_list.h"

#include <limits>

#include "view/stage.h"

namespace limber::view_test {
namespace {

const DrawEye kEye{{0, -10, 0}, {0, 1, 0}, 1000, 0};

Vec3 place(const DrawList& list, std::size_t i) {
  const Instance& instance = list.instances().at(i);
  return {instance.place[0], instance.place[1], instance.place[2]};
}

TEST(DrawList, BetweenTwoSnapshotsThingsAreInBetween) {
  Stage stage;
  Part& part = stage.add("box", box(Vec3(1)), {0, 0, 0});
  const auto before = stage.snapshot();
  part.set_pose({{1, 2, 4}, quat_axis({0, 0, 1}, 1.0)});
  const auto now = stage.snapshot();
  DrawList list;
  list.gather(*before, *now, 0.25, kEye);
  EXPECT_LT(glm::length(place(list, 0) - Vec3(0.25, 0.5, 1)), 1e-6);
  const Instance& turned = list.instances()[0];
  EXPECT_NEAR(2 * std::atan2(turned.turn[2], turned.turn[3]), 0.25, 0.01) << "radians";
  list.gather(*before, *now, 1, kEye);
  EXPECT_LT(glm::length(place(list, 0) - Vec3(1, 2, 4)), 1e-6);
}

TEST(DrawList, WhoComesAndGoesIsSeenAtOnce) {
  Stage stage;
  stage.add("a", box(Vec3(1)));
  const auto one = stage.snapshot();
  stage.add("b", box(Vec3(1)), {3, 0, 0});
  const auto two = stage.snapshot();
  DrawList list;
  list.gather(*one, *two, 0, kEye);
  EXPECT_EQ(list.instances().size(), 2u) << "no mix of two drawings";
  stage.set("/physics/body/b/enabled", {0});
  const auto off = stage.snapshot();
  list.gather(*off, *off, 1, kEye);
  EXPECT_EQ(list.instances().size(), 1u) << "who is switched off";
  stage.world.remove_body(*stage.world.find_body("a"));
  const auto gone = stage.snapshot();
  list.gather(*off, *gone, 0.5, kEye);
  EXPECT_TRUE(list.instances().empty());
  EXPECT_TRUE(list.opaque().empty());
}

TEST(DrawList, OneBatchForAllOfOneShapeAndDetail) {
  Stage stage;
  for (int i = 0; i < 10; i++) {
    stage.add(fmt::format("box{}", i), box(Vec3(0.1 * (i + 1))), {0.2 * i, 0, 0});
    stage.add(fmt::format("ball{}", i), round(ShapeKind::sphere, 0.5), {0.2 * i, 0, 3});
  }
  const auto now = stage.snapshot();
  DrawList list;
  list.gather(*now, *now, 1, {{0, -10, 0}, {0, 1, 0}, 1e6, 0});
  ASSERT_EQ(list.opaque().size(), 2u) << "whatever their sizes and colours";
  EXPECT_EQ(list.opaque()[0].count, 10u);
  EXPECT_EQ(list.opaque()[1].first, 10u);
  list.gather(*now, *now, 1, {{0, -10, 0}, {0, 1, 0}, 1e6, 2});
  EXPECT_EQ(list.opaque()[0].detail, 2);
  list.gather(*now, *now, 1, {{0, -1e5, 0}, {0, 1, 0}, 1000, 0});
  EXPECT_EQ(list.opaque()[0].detail, kDetails - 1) << "what is far is coarse";
}

TEST(DrawList, GlassIsSortedFurthestFirstAndCastsNoShadow) {
  Stage stage;
  for (const int i : {2, 0, 3, 1}) {
    const std::string name = fmt::format("glass{}", i);
    stage.add(name, i % 2 == 0 ? box(Vec3(1)) : round(ShapeKind::sphere, 0.5), {0, 2.0 * i, 0});
    stage.set("/visuals/shape/" + name + "/transparency", {i == 3 ? 0.2 : 0.8});
  }
  const auto now = stage.snapshot();
  DrawList list;
  list.gather(*now, *now, 1, kEye);
  EXPECT_TRUE(list.opaque().empty());
  ASSERT_EQ(list.instances().size(), 4u);
  for (std::size_t i = 0; i < 4; i++) EXPECT_EQ(place(list, i).y, 6 - 2.0 * static_cast<double>(i));
  ASSERT_EQ(list.clear().size(), 4u);
  EXPECT_TRUE(list.clear()[0].casts);
  EXPECT_FALSE(list.clear()[1].casts);
}

TEST(DrawList, AStrayBodyMovesNeitherMiddleNorSize) {
  Stage stage;
  for (int i = 0; i < 20; i++) stage.add(fmt::format("box{}", i), box(Vec3(0.2)), {0.1 * i - 0.95, 0, 1});
  auto now = stage.snapshot();
  DrawList list;
  list.gather(*now, *now, 1, kEye);
  EXPECT_NEAR(list.center().x, 0, 0.06);
  EXPECT_NEAR(list.center().z, 1, 1e-6);
  EXPECT_NEAR(list.radius(), 1.05, 0.15);
  stage.add("stray", box(Vec3(0.2)), {0, 0, -9000});
  now = stage.snapshot();
  list.gather(*now, *now, 1, kEye);
  EXPECT_NEAR(list.center().z, 1, 1e-6);
  EXPECT_LT(list.radius(), 1.3);
}

TEST(DrawList, PlanesAreEndless) {
  Stage stage;
  stage.add("ground", plane(), {0, 0, -0.5});
  stage.paint("ground", {0, 1, 1});
  const auto now = stage.snapshot();
  DrawList list;
  list.gather(*now, *now, 1, kEye);
  EXPECT_TRUE(list.instances().empty());
  ASSERT_EQ(list.planes().size(), 1u);
  EXPECT_EQ(list.planes()[0].origin.z, -0.5F);
  EXPECT_EQ(list.planes()[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(list.planes()[0].tint, glm::vec3(1, 0, 0));
}

TEST(DrawList, WhatIsNoNumberIsNotDrawn) {
  Stage stage;
  stage.add("box", box(Vec3(1)));
  Snapshot now = *stage.snapshot();
  now.live[now.drawing->pieces[0].part_at + live_offsets().part_position] = std::numeric_limits<double>::quiet_NaN();
  DrawList list;
  list.gather(now, now, 1, kEye);
  EXPECT_TRUE(list.instances().empty());
}

}  // namespace
}  // namespace limber::view_test
