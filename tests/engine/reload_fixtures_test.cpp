// Fixtures in a reload, a take and a rewind.
#include "engine/edited.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/visuals/visuals.h"

namespace limber::engine::test {
namespace {

constexpr const char* kFixtureShow = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
local mover = sim:add_body("mover")
mover:add_part("tip", ball, { position = vec3(2, 0, 1), mass = 0 })
local spot = sim:add_fixture("spot", { profile = "moving_spot", targets = mover:part("tip"), dimmer = 0.5 })
sim:add_fixture("par", { profile = "rgb_par" })
--MORE
)";

sim::FixtureList& fixtures_of(EditedShow& edited) { return edited.world().visuals().fixtures(); }

TEST(ReloadFixtures, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited(kFixtureShow);
  EditedShow control(kFixtureShow);
  for (int i = 0; i < 3; i++) {
    edited.show().ticks(5);
    control.show().ticks(5);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadFixtures, AreChangedRebuiltAddedAndRemoved) {
  EditedShow edited(kFixtureShow);
  edited.show().ticks(30);
  const NodeId spot = fixtures_of(edited).find("spot")->id();
  EXPECT_EQ(edited.edit("dimmer = 0.5", "dimmer = 0.25"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(fixtures_of(edited).find("spot")->id(), spot) << "changed in place";
  EXPECT_EQ(edited.show().read("/lighting/fixture/spot/dimmer"), 0.25);
  EXPECT_EQ(edited.edit("\"moving_spot\"", "\"moving_wash\""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(fixtures_of(edited).find("spot")->profile().name, "moving_wash");
  EXPECT_EQ(fixtures_of(edited).find("spot")->targets().size(), 1u);
  EXPECT_EQ(fixtures_of(edited).find("par")->address(), 11) << "the next free address, as in a run from the start";
  EXPECT_EQ(edited.edit("--MORE", "sim:add_fixture(\"more\", { profile = \"dimmer\", universe = 3, address = 7 })"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(fixtures_of(edited).find("more")->universe(), 3);
  EXPECT_EQ(fixtures_of(edited).find("more")->address(), 7);
  EXPECT_EQ(edited.edit("sim:add_fixture(\"par\"", "--"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(fixtures_of(edited).find("par"), nullptr);
  EXPECT_EQ(fixtures_of(edited).list().size(), 2u);
}

TEST(ReloadFixtures, RewindsToTheSameState) {
  EditedShow edited(kFixtureShow);
  edited.show().ticks(20);
  const std::uint64_t hash = edited.show().engine.state_hash();
  const double pan = edited.show().read("/lighting/fixture/spot/pan");
  EXPECT_NE(pan, edited.show().read("/lighting/fixture/spot/tilt"));
  edited.show().ticks(40);
  edited.show().send("/transport/rewind", 40.0 / 60);
  edited.show().engine.idle();
  EXPECT_EQ(edited.show().read("/physics/sim/tick"), 20);
  EXPECT_EQ(edited.show().read("/lighting/fixture/spot/pan"), pan);
  EXPECT_EQ(edited.show().engine.state_hash(), hash);
}

}  // namespace
}  // namespace limber::engine::test
