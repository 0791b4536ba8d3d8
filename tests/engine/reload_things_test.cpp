// Objects are added, removed and rebuilt by a reload; objects that the edit does not change are not touched.
#include <cmath>

#include "engine/edited.h"

namespace limber::engine::test {
namespace {

constexpr const char* kThingsShow = R"(
sim.gravity = vec3(0, 0, -9.81)
local kAxis = vec3(0, 1, 0)
local ball = sim:add_sphere_shape("ball", 0.05)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0, position = vec3(0, 0, 1) })
arm:add_part("upper", ball, { position = vec3(0.4, 0, 1) })
arm:add_part("tip", ball, { position = vec3(0.8, 0, 1) })
arm:add_joint("shoulder", "base", "upper", { position = vec3(0, 0, 1), axis = kAxis })
arm:add_joint("elbow", "upper", "tip", { position = vec3(0.4, 0, 1), axis = kAxis })
arm:add_motor("elbow", { mode = "off" })
local stone = sim:add_body("stone")
stone:add_part("stone", ball, { position = vec3(0, 3, 4), linear_velocity = vec3(1, 0, 0) })
--MORE
)";

TEST(ReloadObjects, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited(kThingsShow);
  EditedShow control(kThingsShow);
  for (int i = 0; i < 5; i++) {
    edited.show().ticks(13);
    control.show().ticks(13);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadObjects, UnchangedObjectsMoveOnUndisturbed) {
  EditedShow edited(kThingsShow);
  EditedShow control(kThingsShow);
  edited.show().ticks(20);
  control.show().ticks(20);
  const NodeId arm = edited.body("arm").id();
  const NodeId elbow = edited.body("arm").find_joint("elbow")->id();
  EXPECT_EQ(edited.edit("--MORE", R"(
local more = sim:add_body("more")
more:add_part("more", sim:add_box_shape("box", vec3(1, 1, 1)), { position = vec3(5, 5, 0.5) }))"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.edit("position = vec3(0, 3, 4)", "position = vec3(0, 6, 4)"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(60);
  control.show().ticks(60);
  EXPECT_EQ(edited.body("arm").id(), arm);
  EXPECT_EQ(edited.body("arm").find_joint("elbow")->id(), elbow);
  for (const char* name : {"base", "upper", "tip"})
    EXPECT_EQ(motion_of(edited.part("arm", name)), motion_of(control.part("arm", name))) << name;
  EXPECT_EQ(sim::body_hash(edited.body("arm"), 1), sim::body_hash(control.body("arm"), 1));
}

TEST(ReloadObjects, AreAddedAndRemoved) {
  EditedShow edited(kThingsShow);
  edited.show().ticks(5);
  EXPECT_EQ(edited.edit(R"(sim:add_body("stone"))", R"(sim:add_body("pebble"))"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.world().find_body("stone"), nullptr);
  ASSERT_NE(edited.world().find_body("pebble"), nullptr);
  EXPECT_EQ(edited.body("pebble").pose().position, Vec3(0, 3, 4)) << "a renamed body is a new one";
  edited.edit(R"(local arm = )", "local box = sim:add_box_shape('box', vec3(1, 1, 1))\nlocal arm = ");
  EXPECT_NE(edited.world().shapes().find("box"), nullptr);
  edited.edit("local box = sim:add_box_shape('box', vec3(1, 1, 1))\n", "");
  EXPECT_EQ(edited.world().shapes().find("box"), nullptr);
  edited.show().ticks(5);
}

TEST(ReloadObjects, BodiesAreInTheOrderOfTheScene) {
  EditedShow edited(
      "local s = sim:add_sphere_shape('s', 0.1)\n"
      "for _, n in ipairs { 'a', 'b', 'c' } do sim:add_body(n):add_part('p', s) end");
  edited.show().send("/make");
  edited.save(
      "local s = sim:add_sphere_shape('s', 0.1)\n"
      "for _, n in ipairs { 'c', 'x', 'a', 'b' } do sim:add_body(n):add_part('p', s) end\n"
      "osc:on('/make', function() sim:add_body('mine'):add_part('p', s) end)");
  edited.show().send("/make");
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().body_names(), (std::vector<std::string_view>{"c", "x", "a", "b", "mine"}));
  edited.save(
      "local s = sim:add_sphere_shape('s', 0.1)\n"
      "for _, n in ipairs { 'b', 'c' } do sim:add_body(n):add_part('p', s) end");
  EXPECT_EQ(edited.world().body_names(), (std::vector<std::string_view>{"b", "c", "mine"}));
  edited.show().sent_texts();
  edited.show().send("/list/bodies");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), (std::vector<std::string>{"/list/bodies b c mine"}));
}

TEST(ReloadObjects, AnEditedStartMovesTheBodyInItsCurrentState) {
  EditedShow edited(kThingsShow);
  edited.show().ticks(30);
  const Pose root = edited.body("arm").pose();
  const Vec3 tip = edited.part("arm", "tip").pose().position;
  const Vec3 speed = edited.part("arm", "tip").linear_velocity();
  const double angle = edited.body("arm").find_joint("elbow")->value();
  ASSERT_GT(glm::length(speed), 0.5);
  // one constant moves all of it: the poses of parts and joints are computed from it
  std::string moved = edited.text;
  for (std::size_t at = 0; (at = moved.find(", 0, 1)", at)) != std::string::npos;) moved.replace(at, 7, ", 7, 1)");
  EXPECT_EQ(edited.save(moved), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.body("arm").pose().position, root.position + Vec3(0, 7, 0));
  EXPECT_NEAR(glm::length(edited.part("arm", "tip").pose().position - tip - Vec3(0, 7, 0)), 0, 1e-9);
  EXPECT_EQ(edited.part("arm", "tip").linear_velocity(), speed);
  edited.show().ticks(1);
  EXPECT_NEAR(edited.body("arm").find_joint("elbow")->value(), angle, 0.1);
  // body:reset() uses the new start
  edited.show().send("/physics/body/arm/reset");
  edited.show().ticks(1);
  EXPECT_NEAR(edited.part("arm", "tip").pose().position.y, 7, 1e-6);
}

TEST(ReloadObjects, AnUnchangedStartPoseIsNotApplied) {
  EditedShow edited(kThingsShow);
  edited.show().ticks(30);
  const std::vector<double> there = motion_of(edited.part("stone", "stone"));
  edited.edit("linear_velocity = vec3(1, 0, 0)", "linear_velocity = vec3(1, 0, 0), friction = 0.1");
  EXPECT_EQ(motion_of(edited.part("stone", "stone")), there);
  edited.edit("linear_velocity = vec3(1, 0, 0)", "linear_velocity = vec3(2, 0, 0)");
  EXPECT_EQ(edited.part("stone", "stone").linear_velocity(), Vec3(2, 0, 0)) << "a start velocity is explicitly set too";
  EXPECT_NE(edited.part("stone", "stone").pose().position, Vec3(0, 3, 4));
}

TEST(ReloadObjects, ARingWithAnotherCountMovesTheRemainingBodies) {
  const auto ring = [](int n) {
    return fmt::format(R"(
sim.gravity = vec3(0, 0, 0)
local s = sim:add_sphere_shape("s", 0.1)
local n = {}
for i = 1, n do
  local a = 2 * math.pi * (i - 1) / n
  sim:add_body("b" .. i):add_part("p", s, {{ position = vec3(2 * math.cos(a), 2 * math.sin(a), 1) }})
end)",
                       n);
  };
  EditedShow edited(ring(4));
  edited.show().send("/physics/part/linearvelocity", "b2", 0, 0, 1);
  edited.show().ticks(10);
  edited.save(ring(6));
  ASSERT_EQ(edited.world().bodies().size(), 6u);
  for (int i = 1; i <= 6; i++) {
    const double a = 2 * kPi * (i - 1) / 6;
    const Vec3 at = edited.part("b" + std::to_string(i), "p").pose().position;
    EXPECT_NEAR(at.x, 2 * std::cos(a), 1e-12) << i;
    EXPECT_NEAR(at.y, 2 * std::sin(a), 1e-12) << i;
  }
  EXPECT_EQ(edited.part("b2", "p").linear_velocity(), Vec3(0, 0, 1));
  edited.save(ring(3));
  EXPECT_EQ(edited.world().bodies().size(), 3u);
}

TEST(ReloadObjects, AnotherShapeRebuildsTheBodyInPlace) {
  EditedShow edited(kThingsShow);
  edited.show().send("/physics/part/friction", "arm", "tip", 0.9);
  edited.show().ticks(25);
  const Pose tip = edited.part("arm", "tip").pose();
  const Vec3 spin = edited.part("arm", "tip").angular_velocity();
  const std::vector<double> base = motion_of(edited.part("arm", "base"));
  const NodeId shape = edited.world().shapes().find("ball")->id();
  EXPECT_EQ(edited.edit(R"(("ball", 0.05))", R"(("ball", 0.07))"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.world().shapes().find("ball")->id(), shape);
  EXPECT_EQ(edited.world().shapes().find("ball")->model().radius, 0.07);
  // the center of a sphere does not move, so the whole arm stays to the bit
  EXPECT_EQ(motion_of(edited.part("arm", "base")), base);
  EXPECT_EQ(edited.part("arm", "tip").pose().position, tip.position);
  EXPECT_EQ(edited.part("arm", "tip").angular_velocity(), spin);
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.9);
  // inertia of a sphere: 2/5 m r²
  EXPECT_NEAR(edited.part("arm", "tip").geometry()->unit_inertia.x, 0.4 * 0.07 * 0.07, 1e-9);
  edited.show().ticks(5);
}

TEST(ReloadObjects, AnotherFrameKeepsAnglesAndSpeeds) {
  EditedShow edited(kThingsShow);
  edited.show().ticks(25);
  const auto joint = [&](const char* name) -> sim::Joint& { return *edited.body("arm").find_joint(name); };
  const double shoulder = joint("shoulder").value();
  const double elbow = joint("elbow").value();
  const double rate = edited.show().read("/physics/body/arm/joint/elbow/speed");
  ASSERT_GT(std::abs(shoulder), 0.3);
  // a longer upper arm: its end and the elbow are 0.2 m farther out
  edited.edit(R"("tip", ball, { position = vec3(0.8)", R"("tip", ball, { position = vec3(1.0)");
  edited.edit(R"({ position = vec3(0.4, 0, 1), axis = kAxis })", R"({ position = vec3(0.6, 0, 1), axis = kAxis })");
  edited.world().flush();
  EXPECT_NEAR(joint("shoulder").value(), shoulder, 1e-5);
  EXPECT_NEAR(joint("elbow").value(), elbow, 1e-5);
  EXPECT_NEAR(edited.show().read("/physics/body/arm/joint/elbow/speed"), rate, 1e-4);
  const double reach = glm::length(edited.part("arm", "tip").pose().position - Vec3(0, 0, 1));
  const double expected = std::sqrt(0.6 * 0.6 + 0.4 * 0.4 + 2 * 0.6 * 0.4 * std::cos(elbow));
  EXPECT_NEAR(reach, expected, 2e-3);
}

TEST(ReloadObjects, AnotherJointTypeStartsAtItsStartPose) {
  EditedShow edited(kThingsShow);
  edited.show().send("/physics/part/friction", "arm", "tip", 0.9);
  edited.show().ticks(20);
  const Pose upper = edited.part("arm", "upper").pose();
  edited.edit(R"("tip", { position = vec3(0.4, 0, 1), axis = kAxis })",
              R"("tip", { position = vec3(0.4, 0, 1), axis = kAxis, type = "prismatic" })");
  EXPECT_EQ(edited.body("arm").find_joint("elbow")->type(), model::JointType::prismatic);
  EXPECT_EQ(edited.part("arm", "upper").pose().position, upper.position);
  // at its start pose: 0.4 m along the upper arm's own x
  const Vec3 tip = edited.part("arm", "tip").pose().position;
  EXPECT_NEAR(glm::length(tip - upper * Vec3(0.4, 0, 0)), 0, 1e-5);
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.9);
  edited.show().ticks(3);
}

TEST(ReloadObjects, ChangingStaticRebuildsTheBody) {
  EditedShow edited(kThingsShow);
  edited.show().ticks(20);
  const Vec3 tip = edited.part("arm", "tip").pose().position;
  edited.edit(R"("base", ball, { mass = 0,)", R"("base", ball, { mass = 3,)");
  EXPECT_FALSE(edited.part("arm", "base").is_static());
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/base/mass"), 3);
  EXPECT_EQ(edited.part("arm", "tip").pose().position, tip);
  edited.show().ticks(10);
  EXPECT_LT(edited.part("arm", "base").pose().position.z, 0.99) << "it falls now";
  edited.edit(R"("base", ball, { mass = 3,)", R"("base", ball, { mass = 0,)");
  EXPECT_TRUE(edited.part("arm", "base").is_static());
}

TEST(ReloadObjects, SeparateTreesAreMovedIndependently) {
  EditedShow edited(R"(
sim.gravity = vec3(0, 0, 0)
local s = sim:add_sphere_shape("s", 0.1)
local heap = sim:add_body("heap")
for i = 1, 3 do heap:add_part("p" .. i, s, { position = vec3(i, 0, 1), linear_velocity = vec3(0, i, 0) }) end
heap:part("p2").position = vec3(2, 0, 1)
)");
  edited.show().ticks(60);
  const Vec3 first = edited.part("heap", "p1").pose().position;
  const Vec3 third = edited.part("heap", "p3").pose().position;
  edited.edit("vec3(2, 0, 1)", "vec3(2, 0, 5)");
  EXPECT_EQ(edited.part("heap", "p1").pose().position, first);
  EXPECT_EQ(edited.part("heap", "p2").pose().position, Vec3(2, 0, 5));
  EXPECT_EQ(edited.part("heap", "p3").pose().position, third);
  EXPECT_EQ(edited.part("heap", "p2").linear_velocity(), Vec3(0, 2, 0));
  // the whole heap is moved: all parts move along
  edited.show().ticks(1);
  const Vec3 before = edited.part("heap", "p3").pose().position - edited.part("heap", "p1").pose().position;
  edited.save(edited.text + "heap.position = vec3(10, 0, 1)");
  EXPECT_EQ(edited.part("heap", "p1").pose().position, Vec3(10, 0, 1));
  const Vec3 after = edited.part("heap", "p3").pose().position - edited.part("heap", "p1").pose().position;
  EXPECT_NEAR(glm::length(after - before), 0, 1e-9);
}

}  // namespace
}  // namespace limber::engine::test
