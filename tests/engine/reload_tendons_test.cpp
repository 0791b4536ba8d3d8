// Tendons in a reload: changed, added, removed, preserved when a body is rebuilt; presets and undo.
#include "engine/edited.h"

namespace limber::engine::test {
namespace {

constexpr const char* kTendonShow = R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("mobile")
body:add_part("top", ball, { mass = 0, position = vec3(0, 0, 2) })
body:add_part("low", ball, { position = vec3(0, 0, 1) })
local other = sim:add_body("other")
other:add_part("ball", ball, { position = vec3(1, 0, 1) })
body:add_tendon("cable", { points = { { "top" }, { "low", 0, 0, 0.1 } }, stiffness = 50 })
body:add_tendon("link", { points = { { "low" }, { other:part("ball"), vec3(0, 0.1, 0) } }, tension = 2 })
--MORE
)";

sim::Tendon* tendon_of(EditedShow& edited, const char* name = "cable") {
  return edited.world().tendons().find(edited.body("mobile"), name);
}
double value_of(EditedShow& edited, const char* property) {
  const Store& store = edited.world().store();
  return store.values(tendon_of(edited)->id(), sim::Tendon::table().at(property))[0];
}

TEST(ReloadTendons, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited(kTendonShow);
  EditedShow control(kTendonShow);
  for (int i = 0; i < 3; i++) {
    edited.show().ticks(5);
    control.show().ticks(5);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadTendons, AValueIsChangedInPlace) {
  EditedShow edited(kTendonShow);
  edited.show().ticks(5);
  const NodeId id = tendon_of(edited)->id();
  EXPECT_EQ(edited.edit("stiffness = 50", "stiffness = 70"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(tendon_of(edited)->id(), id);
  EXPECT_EQ(value_of(edited, "stiffness"), 70);
  EXPECT_NEAR(value_of(edited, "rest_length"), 0.9, 1e-9) << "the length at its creation";
}

TEST(ReloadTendons, AreAddedRemovedAndChangeTheirPoints) {
  EditedShow edited(kTendonShow);
  edited.show().ticks(5);
  EXPECT_EQ(edited.edit("--MORE", "other:add_tendon(\"more\", { points = { { \"ball\" }, { body:part(\"top\") } } })"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().tendons().list().size(), 3u);
  EXPECT_EQ(edited.edit("{ \"low\", 0, 0, 0.1 } }", "{ \"low\", 0, 0, 0.2 } }"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(tendon_of(edited)->points()[1].position, Vec3(0, 0, 0.2));
  EXPECT_EQ(edited.edit("body:add_tendon(\"cable\"", "--"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(tendon_of(edited), nullptr);
  EXPECT_NE(tendon_of(edited, "link"), nullptr);
  edited.show().ticks(2);
}

TEST(ReloadTendons, StayWhenTheirBodiesAreRebuilt) {
  EditedShow edited(kTendonShow);
  edited.show().ticks(5);
  EXPECT_EQ(edited.edit("--MORE", "body:add_part(\"hat\", ball, { position = vec3(0, 0, 4) })"),
            SceneReloader::ApplyResult::applied);
  ASSERT_NE(tendon_of(edited), nullptr);
  EXPECT_EQ(tendon_of(edited)->points()[1].part, edited.body("mobile").find_part("low"));
  EXPECT_EQ(value_of(edited, "stiffness"), 50);
  EXPECT_EQ(edited.edit("position = vec3(1, 0, 1) })", "position = vec3(1, 0, 1) })\nother:add_part(\"x\", ball)"),
            SceneReloader::ApplyResult::applied);
  ASSERT_NE(tendon_of(edited, "link"), nullptr);
  EXPECT_EQ(tendon_of(edited, "link")->points()[1].part, edited.body("other").find_part("ball"));
  edited.show().ticks(5);
  EXPECT_GT(glm::length(edited.part("other", "ball").linear_velocity()), 0.01);
}

TEST(ReloadTendons, ABodyThatLeavesRemovesThem) {
  EditedShow edited(kTendonShow);
  edited.show().ticks(5);
  edited.world().remove_body(edited.body("other"));
  EXPECT_EQ(tendon_of(edited, "link"), nullptr);
  edited.show().ticks(2);
  EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
  EXPECT_NE(tendon_of(edited, "link"), nullptr) << "the scene adds it again, with its body";
}

}  // namespace
}  // namespace limber::engine::test
