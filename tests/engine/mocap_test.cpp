// Motion capture in a show: messages, takes, rewinds, reloads.
#include "engine/taken.h"
#include "sim/mocap/mocap_list.h"

namespace limber::engine::test {
namespace {

constexpr const char* kMocapScene = R"(
sim.gravity = vec3()
local dancer = sim:add_mocap("dancer", { source = "osc", dancer = 2, up = "y", unit = "cm", joints = { "hand" } })
local film = sim:add_mocap("film", { source = "film.bvh", scale = 2 })
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("ball"):add_part("ball", ball, { position = vec3(1, 0, 1) })
sim:body("ball"):add_behavior("mocap_attraction", "pull", { source = dancer.number, joint = 1 })
film:add_body("figure")
--MORE
)";
constexpr const char* kFilm =
    "HIERARCHY ROOT hips\n{ OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition JOINT head\n{ OFFSET 0 0.5 0 "
    "CHANNELS "
    "3 Zrotation Xrotation Yrotation } } MOTION Frames: 3 Frame Time: 0.5  0 1 0 0 0 0  1 1 0 20 0 0  0 1 0 0 0 0";

sim::MocapSource& source_of(Engine& engine, const char* name = "dancer") {
  return *engine.world().sensing().mocap().find(name);
}

TEST(MocapShow, MessagesMoveJointsAndBodies) {
  EditedShow edited(kMocapScene, {{"scripts/film.bvh", kFilm}});
  Show& show = edited.show();
  show.send("/mocap/2/joint/pos_world", 100.0, 200.0, 0.0);
  show.ticks(1);
  const Vec3 hand = source_of(show.engine).joints()[0]->pose().position;
  EXPECT_LT(glm::length(hand - Vec3(1, 0, 2)), 1e-9);
  const double before = edited.part("ball", "ball").pose().position.z;
  for (int i = 0; i < 20; i++) {
    show.send("/mocap/2/joint/pos_world", 100.0, 200.0, 0.0);
    show.ticks(1);
  }
  EXPECT_GT(edited.part("ball", "ball").pose().position.z, before + 0.05);
  EXPECT_GT(edited.part("figure", "head").pose().position.z, 2.2) << "twice as large";
}

TEST(MocapShow, ATakeReplaysToTheSameHash) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kMocapScene);
  folder.write("scripts/film.bvh", kFilm);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("now.take");
  {
    Show show(options);
    for (int i = 0; i < 200; i++) {
      if (i % 7 != 3) show.send("/mocap/2/joint/pos_world", 100.0 + i % 50, 200.0 - i % 13, 5.0 * (i % 9));
      if (i == 100) show.send("/mocap/2/joint/rot_world", 1.0, 0.0, 0.0, 1.0);
      show.ticks(1);
    }
    show.engine.end_take();
    show.engine.finish_saving();
  }
  folder.remove("scripts/film.bvh");  // the take has it
  EXPECT_FALSE(replay_take(options.record).result.diverged_at.has_value());
}

TEST(MocapShow, AWrongFrameIsRejectedWithTheSource) {
  EditedShow edited(kMocapScene, {{"scripts/film.bvh", kFilm}});
  edited.show().send("/mocap/2/joint/pos_world", 1.0);
  edited.show().ticks(1);
  const std::vector<std::string> texts = edited.show().sent_texts();
  ASSERT_FALSE(texts.empty());
  EXPECT_EQ(texts.front(), "/error /mocap/2/joint/pos_world mocap 'dancer': takes a multiple of 3 arguments, got 1");
  EXPECT_FALSE(source_of(edited.show().engine).joints()[0]->seen());
}

TEST(MocapShow, AnEditThatChangesNothingKeepsTheMotion) {
  EditedShow edited(kMocapScene, {{"scripts/film.bvh", kFilm}});
  edited.show().send("/mocap/2/joint/pos_world", 100.0, 200.0, 0.0);
  edited.show().ticks(20);
  const sim::MocapSource* const before = &source_of(edited.show().engine, "film");
  EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(&source_of(edited.show().engine, "film"), before);
  EXPECT_TRUE(source_of(edited.show().engine).joints()[0]->seen());
}

TEST(MocapShow, AnEditChangesAddsAndRemovesSources) {
  EditedShow edited(kMocapScene, {{"scripts/film.bvh", kFilm}});
  edited.show().send("/mocap/2/joint/pos_world", 100.0, 200.0, 0.0);
  edited.show().ticks(2);
  Engine& engine = edited.show().engine;
  EXPECT_EQ(edited.edit("scale = 2", "scale = 3"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(engine.world().store().values(source_of(engine, "film").id(), sim::MocapSource::table().at("scale"))[0], 3);
  EXPECT_EQ(edited.edit("--MORE", "dancer:joint(\"foot\")\nsim:add_mocap(\"more\", { source = \"vmc\" })"),
            SceneReloader::ApplyResult::applied);
  EXPECT_NE(source_of(engine).find("foot"), nullptr);
  EXPECT_TRUE(source_of(engine).joints()[0]->seen()) << "it is the same source";
  EXPECT_EQ(engine.world().sensing().mocap().list().size(), 3u);
  EXPECT_EQ(edited.edit("unit = \"cm\"", "unit = \"mm\""), SceneReloader::ApplyResult::applied);
  EXPECT_FALSE(source_of(engine).joints()[0]->seen()) << "it was made again";
  EXPECT_EQ(source_of(engine).name(), engine.world().sensing().mocap().list()[0]->name()) << "in the same order";
  EXPECT_EQ(edited.edit("sim:add_mocap(\"more\", { source = \"vmc\" })", ""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(engine.world().sensing().mocap().find("more"), nullptr);
}

}  // namespace
}  // namespace limber::engine::test
