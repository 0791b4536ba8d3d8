// Gears in a reload: changed, added, removed, preserved when a body is rebuilt.
#include <cmath>

#include "engine/edited.h"

namespace limber::engine::test {
namespace {

constexpr const char* kGearShow = R"(
sim.gravity = vec3()
local arm = sim:add_box_shape("arm", vec3(0.05, 0.4, 0.05))
local body = sim:add_body("train")
body:add_part("frame", sim:add_box_shape("frame", vec3(1, 0.05, 0.05)), { mass = 0 })
for i, x in ipairs { -0.4, 0, 0.4 } do
  body:add_part("arm" .. i, arm, { position = vec3(x, 0, 0.1) })
  body:add_joint("j" .. i, "frame", "arm" .. i, { axis = vec3(0, 0, 1) })
end
body:add_motor("j1").target = 0.3
local gear = sim:add_gear(body:joint("j1"), body:joint("j2"), 2, { name = "gear" })
--MORE
)";

sim::Gear* gear_of(EditedShow& edited, const char* name = "gear") { return edited.world().gears().find(name); }
double angle(EditedShow& edited, const char* joint) { return edited.body("train").find_joint(joint)->value(); }

TEST(ReloadGears, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited(kGearShow);
  EditedShow control(kGearShow);
  for (int i = 0; i < 3; i++) {
    edited.show().ticks(5);
    control.show().ticks(5);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadGears, ARatioIsChangedInPlace) {
  EditedShow edited(kGearShow);
  edited.show().ticks(60);
  const NodeId id = gear_of(edited)->id();
  EXPECT_NEAR(angle(edited, "j2"), 0.6, 1e-3);
  EXPECT_EQ(edited.edit("body:joint(\"j2\"), 2", "body:joint(\"j2\"), -1"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(60);
  EXPECT_EQ(gear_of(edited)->id(), id);
  EXPECT_NEAR(angle(edited, "j2"), -0.3, 1e-3);
}

TEST(ReloadGears, AreAddedRemovedAndChangeTheirJoints) {
  EditedShow edited(kGearShow);
  edited.show().ticks(5);
  EXPECT_EQ(edited.edit("--MORE", "sim:add_gear(body:joint(\"j2\"), body:joint(\"j3\"), -1, { name = \"more\" })"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(60);
  EXPECT_NEAR(angle(edited, "j3") + angle(edited, "j2"), 0, 0.05);
  EXPECT_EQ(edited.edit("local gear = sim:add_gear(body:joint(\"j1\"), body:joint(\"j2\")",
                        "local gear = sim:add_gear(body:joint(\"j1\"), body:joint(\"j3\")"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(gear_of(edited)->joint_b().name(), "j3");
  EXPECT_EQ(edited.edit("local gear = ", "--"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(gear_of(edited), nullptr);
  EXPECT_NE(gear_of(edited, "more"), nullptr);
}

TEST(ReloadGears, StayWhenTheirBodyIsRebuilt) {
  EditedShow edited(kGearShow);
  edited.show().ticks(60);
  const NodeId id = gear_of(edited)->id();
  EXPECT_EQ(edited.edit("--MORE", R"(
body:add_part("hat", arm, { position = vec3(0, 0, 1) })
body:add_joint("weld", "arm3", "hat", { type = "fixed" }))"),
            SceneReloader::ApplyResult::applied);
  ASSERT_NE(gear_of(edited), nullptr);
  EXPECT_EQ(gear_of(edited)->id(), id);
  EXPECT_EQ(&gear_of(edited)->joint_b(), edited.body("train").find_joint("j2"));
  edited.body("train").find_motor("j1")->set_target(-0.2);
  edited.show().ticks(60);
  EXPECT_NEAR(angle(edited, "j2"), -0.4, 1e-3);
}

TEST(ReloadGears, ARemovedOneIsAddedAgain) {
  EditedShow edited(kGearShow);
  edited.show().ticks(5);
  edited.world().gears().remove(*gear_of(edited));
  edited.show().ticks(5);
  EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
  EXPECT_NE(gear_of(edited), nullptr);
}

}  // namespace
}  // namespace limber::engine::test
