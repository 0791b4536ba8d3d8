// Kinematic parts in takes, which are replayed by the rules of their time.
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

constexpr const char* kPlatformScene = R"(
sim.gravity = vec3(0, 0, -9.81)
local deck = sim:add_box_shape("deck", vec3(4, 4, 0.2))
sim:add_body("platform"):add_part("deck", deck, { mass = 0, position = vec3(0, 0, -0.1) })
local crate = sim:add_box_shape("crate", vec3(0.2, 0.2, 0.2))
sim:add_body("crate"):add_part("crate", crate, { position = vec3(0, 0, 0.1) })
sim:on_step(function() sim:body("platform").position = vec3(0.1 * sim.time ^ 2, 0, -0.1) end)
)";

double crate_position(Engine& engine) { return engine.world().find_body("crate")->pose().position.x; }

// In a take of an earlier version the platform jumps from tick to tick, below a crate that stays.
TEST(KinematicTake, OlderTakesDoNotCarry) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kPlatformScene);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("now.take");
  {
    Show show(options);
    show.ticks(120);
    EXPECT_NEAR(crate_position(show.engine), 0.4, 0.02);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  std::string bytes = file_bytes(options.record);
  const std::string rules = ",\"rules\":2";
  const std::size_t at = bytes.find(rules);
  ASSERT_NE(at, std::string::npos);
  bytes[at + rules.size() - 1] = '1';
  folder.write("before.take", bytes);
  EXPECT_FALSE(replay_take(options.record).result.diverged_at.has_value());
  // by the older rules, this recording can't be reproduced: the platform has no velocity
  const ReplayOutcome older = replay_take(folder.path("before.take"));
  ASSERT_TRUE(older.result.diverged_at.has_value());
  EXPECT_EQ(older.result.diverged_body, "platform");
}

}  // namespace
}  // namespace limber::engine::test
