// Policies in a show: takes, reloads when the file changes, no allocation per tick.
#include "engine/taken.h"
#include "support/policy_files.h"

namespace limber::engine::test {
namespace {

// the speed of the ball is the policy's action
constexpr const char* kPolicyScene = R"(
sim.gravity = vec3()
local policy = sim:load_policy("walk.safetensors")
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { linear_damping = 0 })
local observations, actions = { 0 }, {}
sim:on_step(function()
  observations[1] = sim.time
  policy:evaluate(observations, actions)
  ball.root.linear_velocity = vec3(actions[1], 0, 0)
end)
)";

std::string gain_policy(float gain) { return limber::test::linear_policy({1, 1}, {gain}); }

TEST(PolicyShow, ATakeReplaysWithoutTheFile) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kPolicyScene);
  folder.write("scripts/walk.safetensors", gain_policy(2));
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("now.take");
  {
    Show show(options);
    show.ticks(50);
    folder.write("scripts/walk.safetensors", gain_policy(-3));
    EXPECT_EQ(show.engine.reload_now(), SceneReloader::ApplyResult::applied);
    show.ticks(50);
    EXPECT_LT(show.engine.world().find_body("ball")->find_part("ball")->linear_velocity().x, 0);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  EXPECT_FALSE(replay_take(options.record).result.diverged_at.has_value());
  folder.write("scripts/walk.safetensors", gain_policy(7));
  EXPECT_FALSE(replay_take(options.record).result.diverged_at.has_value());
  folder.remove("scripts/walk.safetensors");
  EXPECT_FALSE(replay_take(options.record).result.diverged_at.has_value());
}

TEST(PolicyShow, AChangedFileReloadsWithoutMovingTheBody) {
  EditedShow edited(kPolicyScene, {{"scripts/walk.safetensors", gain_policy(1)}});
  edited.show().ticks(30);
  const double x = edited.part("ball", "ball").pose().position.x;
  EXPECT_GT(x, 0.05);
  edited.folder.write("scripts/walk.safetensors", "broken");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::failed);
  edited.show().ticks(1);
  EXPECT_GT(edited.part("ball", "ball").linear_velocity().x, 0) << "the old policy acts on";
  edited.folder.write("scripts/walk.safetensors", gain_policy(0));
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  const double before = edited.part("ball", "ball").pose().position.x;
  EXPECT_GT(before, x);
  edited.show().ticks(5);
  EXPECT_EQ(edited.part("ball", "ball").pose().position.x, before);
}

TEST(PolicyShow, TheFileIsWatched) {
  EditedShow edited(kPolicyScene, {{"scripts/walk.safetensors", gain_policy(1)}});
  bool watched = false;
  for (const script::SourceFile& file : edited.show().engine.scene()->sources()->files())
    watched = watched || (file.path.ends_with("walk.safetensors") && file.content.has_value());
  EXPECT_TRUE(watched);
}

}  // namespace
}  // namespace limber::engine::test
