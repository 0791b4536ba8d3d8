// Excluded pairs and collision properties across edits of a scene: changed declarations are applied, the rest stays.
#include <string>

#include "engine/edited.h"
#include "sim/bullet/collision_filter.h"

namespace limber::engine::test {
namespace {

constexpr const char* kPairsShow = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
local three = sim:add_body("three")
three:add_part("a", ball)
three:add_part("b", ball, { position = vec3(0.19, 0, 0) })
three:add_part("c", ball, { position = vec3(0, 3, 0) })
--EDIT
osc:on("/include", function() three:include_pair("a", "b") end)
osc:on("/exclude", function() three:exclude_pair("a", "c") end)
)";

std::string pairs_of(const sim::Body& body) {
  std::string text;
  for (const sim::PartPair& pair : body.pairs().list()) {
    if (pair.excluded()) text += body.parts()[pair.a]->name() + body.parts()[pair.b]->name() + " ";
  }
  return text;
}

TEST(ReloadPairs, ChangedDeclarationsAreApplied) {
  EditedShow edited(kPairsShow);
  edited.show().ticks(3);
  EXPECT_EQ(pairs_of(edited.body("three")), "ab ");
  EXPECT_EQ(edited.edit("--EDIT", "three:exclude_pair('b', 'c')\n--EDIT"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(pairs_of(edited.body("three")), "ab bc ");
  EXPECT_EQ(edited.edit("three:exclude_pair('b', 'c')", "three:include_pair('a', 'b')"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(pairs_of(edited.body("three")), "");
  EXPECT_EQ(edited.edit("three:include_pair('a', 'b')", ""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(pairs_of(edited.body("three")), "ab ") << "back to the default";
}

TEST(ReloadPairs, ChangesOfTheShowStay) {
  EditedShow edited(kPairsShow);
  edited.show().ticks(3);
  edited.show().send("/include");
  edited.show().send("/exclude");
  edited.show().ticks(1);
  EXPECT_EQ(pairs_of(edited.body("three")), "ac ");
  EXPECT_EQ(edited.edit("vec3(0, 3, 0)", "vec3(0, 4, 0)"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(pairs_of(edited.body("three")), "ac ");
  // the body is rebuilt, and its parts have other indices
  EXPECT_EQ(edited.edit("three:add_part(\"a\", ball)",
                        "three:add_part(\"new\", ball, { position = vec3(0, 9, 0) })\n"
                        "three:add_part(\"a\", ball)"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(pairs_of(edited.body("three")), "ac ");
  edited.show().ticks(3);
  EXPECT_EQ(pairs_of(edited.body("three")), "ac ");
}

// a rebuilt body is compared by its start poses, not by the current poses of its parts
TEST(ReloadPairs, ARebuiltBodyIsComparedByItsSpec) {
  EditedShow edited(kPairsShow);
  edited.show().ticks(3);
  edited.part("three", "b").set_pose({{0, 3.1, 0}, quat_identity()});
  edited.show().ticks(2);
  EXPECT_EQ(edited.edit("three:add_part(\"c\", ball, {", "three:add_part(\"c\", ball, { mass = 0,"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(2);
  EXPECT_EQ(pairs_of(edited.body("three")), "ab ");
}

TEST(ReloadPairs, GroupsAreProperties) {
  EditedShow edited(kPairsShow);
  edited.show().ticks(1);
  EXPECT_EQ(
      edited.edit("--EDIT", "sim.collision_groups = { 'one', 'two' }\nthree:part('a').collision_group = 'two'\n--EDIT"),
      SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_EQ(sim::bullet::CollisionFilter::of(edited.part("three", "a").rigid()).group, 2);
  EXPECT_EQ(edited.edit("{ 'one', 'two' }", "{ 'one', 'more', 'two' }"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_EQ(sim::bullet::CollisionFilter::of(edited.part("three", "a").rigid()).group, 4);
}

}  // namespace
}  // namespace limber::engine::test
