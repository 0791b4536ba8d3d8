// Panic: one request brings every show to rest, and the next one restores it.
#include <algorithm>
#include <cmath>

#include "engine/edited.h"
#include "engine/rewound.h"
#include "engine/taken.h"
#include "support/skip.h"

namespace limber::engine::test {
namespace {

// kinetic energy in J
double energy(sim::World& world) {
  double sum = 0;
  for (const auto& body : world.bodies()) {
    for (const auto& part : body->parts()) {
      if (part->is_static() || !body->in_world()) continue;
      const Vec3 v = part->linear_velocity();
      const Vec3 w = glm::conjugate(part->principal_axes()) * part->angular_velocity();
      sum += 0.5 * part->mass() * (glm::dot(v, v) + glm::dot(part->geometry()->unit_inertia, w * w));
    }
  }
  return sum;
}

constexpr const char* kPanicScene = R"(
sim.gravity = vec3(0, 0, 0)
params { { "push", 0 } }
state.steps, state.beats = 0, 0
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 5) })
sim:body("ball"):add_behavior("force", "wind", { amp = 2 })
sim:on_step(function() state.steps = state.steps + 1; ball:apply_force(vec3(0, 3, 0)) end)
sim:every(0.1, function() state.beats = state.beats + 1 end)
osc:on("/steps", function() osc:reply("/steps", state.steps, state.beats) end)
osc:on("/push", function() ball:apply_impulse(vec3(0, 0, 100)) end)
osc:on("/panic", function() sim:panic() end)
)";

constexpr const char* kBallSpeed = "/physics/body/ball/part/ball/linear_velocity";
constexpr const char* kPanicked = "/physics/sim/panicked";
constexpr int kGuardTicks = 61;  // ticks: the first second of a panic, in which another request is ignored

std::string reply_to(Show& show, const char* address) {
  show.sent_texts();
  show.send(address);
  show.ticks(1);
  for (const std::string& text : show.sent_texts()) {
    if (text.starts_with(address)) return text;
  }
  return {};
}

class PanicButton : public testing::Test {
 protected:
  void SetUp() override { LIMBER_SKIP_IF(kThreadSanitizer, "its tests use one thread"); }
};

TEST_F(PanicButton, EveryShowComesToRest) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  for (const char* scene : {"arms", "hello", "live", "quadruped", "swarm"}) {
    for (const double motors : {0.0, 1.0}) {
      Show show(std::string(LIMBER_SOURCE_DIR) + "/scripts/" + scene + ".lua");
      sim::World& world = show.engine.world();
      show.ticks(60);
      Random random(1, "blows");
      for (const auto& body : world.bodies()) {
        for (const auto& part : body->parts()) part->apply_impulse(random.direction() * 8.0 * part->mass());
      }
      show.send("/physics/sim/panic_motors", motors);
      show.ticks(1);
      const double before = energy(world);
      ASSERT_GT(before, 0.5) << scene;
      show.send("/transport/panic");
      show.ticks(120);
      EXPECT_LT(energy(world), 0.01 * before) << scene << " " << motors;
      EXPECT_EQ(show.read(kPanicked), 1);
    }
  }
}

TEST_F(PanicButton, StopsScriptsButNotMessages) {
  const SceneFile file(kPanicScene);
  Show show(file.path());
  show.ticks(60);
  EXPECT_NEAR(show.read(kBallSpeed, 0), 2, 0.05) << "1 kg, pushed with 2 N for a second";
  show.send("/transport/panic");
  show.ticks(60);
  EXPECT_LT(std::abs(show.read(kBallSpeed, 1)), 0.02);
  const std::string before = reply_to(show, "/steps");
  ASSERT_FALSE(before.empty());
  show.send("/push");
  show.send("/physics/part/hold", "ball", "ball", 0, 0, 0, 9, 9, 9);
  show.send("/physics/part/force", "ball", "ball", 50, 0, 0);
  show.send("/physics/sim/gravity", 1, 2, 3);
  show.ticks(1);
  EXPECT_LT(std::abs(show.read(kBallSpeed, 2)), 0.02) << "no force gets through";
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 3) << "a value does";
  EXPECT_EQ(reply_to(show, "/steps"), before);
  EXPECT_EQ(show.read("/physics/body/ball/behavior/wind/active"), 1);
}

TEST_F(PanicButton, AScriptCanRequestAPanic) {
  const SceneFile file(kPanicScene);
  Show show(file.path());
  show.send("/panic");
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1);
  show.send("/panic");
  show.ticks(2);
  EXPECT_EQ(show.read(kPanicked), 1) << "in the first second";
  show.ticks(60);
  show.send("/panic");
  show.send("/panic");
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1) << "a script's second press is executed before the next tick";
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 0) << "twice in a tick is once";
}

TEST_F(PanicButton, ReleasingTheButtonDoesNothing) {
  const SceneFile file(kPanicScene);
  Show show(file.path());
  show.send("/transport/panic", 1);
  show.ticks(1);
  show.send("/transport/panic", 0);
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1);
}

TEST_F(PanicButton, StopsMorphsAndRemovesMouseSprings) {
  const SceneFile file(kPanicScene);
  Show show(file.path());
  show.send("/preset/store", "calm");
  show.send("/physics/sim/gravity", 0, 0, -8);
  show.ticks(1);
  show.send("/preset/recall", "calm", 1, "linear");
  show.send("/physics/part/hold", "ball", "ball", 0, 0, 0, 9, 9, 9);
  show.ticks(30);
  show.send("/transport/panic");
  show.ticks(1);
  const double value_at_panic = show.read("/physics/sim/gravity", 2);
  EXPECT_LT(value_at_panic, -1);
  show.ticks(60);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), value_at_panic);
  EXPECT_EQ(show.read("/preset/progress"), 1);
}

TEST_F(PanicButton, EndsWithAResetOrASavedScene) {
  EditedShow edited(kPanicScene);
  edited.show().send("/transport/panic");
  edited.show().ticks(5);
  EXPECT_EQ(edited.show().read(kPanicked), 1);
  edited.save(edited.text + "\n-- mended\n");
  EXPECT_EQ(edited.show().read(kPanicked), 0);
  edited.show().send("/transport/panic");
  edited.show().ticks(5);
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().read(kPanicked), 0);
  const double before = edited.show().read(kBallSpeed, 1);
  edited.show().ticks(1);
  EXPECT_GT(edited.show().read(kBallSpeed, 1), before);
}

TEST_F(PanicButton, IsNeitherAnEditNorAnOverride) {
  const SceneFile file(kPanicScene);
  Show show(file.path());
  show.send("/physics/sim/gravity", 0, 0, -1);
  show.ticks(1);
  show.send("/transport/panic");
  show.ticks(1);
  show.send("/edit/undo");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 0) << "the edit before it";
  EXPECT_EQ(show.read(kPanicked), 1);
}

// Requests a panic twice, a second and `ticks_pressed` ticks apart, and expects the checkpoint before the first.
void expect_restored(Show& show, std::uint64_t ticks_pressed, std::vector<std::uint64_t>& hashes,
                     TickInputs send_messages) {
  sim::World& world = show.engine.world();
  const std::uint64_t panic_tick = world.tick();
  show.send("/transport/panic");
  show.ticks(static_cast<int>(ticks_pressed) + kGuardTicks);
  ASSERT_TRUE(world.panic().on());
  show.send("/transport/panic");
  show.engine.idle();
  const std::uint64_t restored_tick = world.tick();
  EXPECT_FALSE(world.panic().on());
  ASSERT_LT(restored_tick, panic_tick);
  EXPECT_GE(restored_tick + 61, panic_tick) << "checkpoints are a second apart";
  ASSERT_EQ(show.engine.state_hash(), hashes.at(restored_tick)) << "back at tick " << restored_tick;
  ASSERT_TRUE(replays_identically(show, panic_tick, send_messages, hashes));
}

TEST_F(PanicButton, TheSecondPressRestoresTheLastCheckpoint) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  Show show(rewind_options(folder));
  std::vector<std::uint64_t> hashes;
  for (const std::uint64_t at : {170, 200, 333}) {
    play_to(show, at, random_inputs, hashes);
    expect_restored(show, at % 90, hashes, random_inputs);
    // earlier states can be restored again, and the second press is not in the history
    show.send("/transport/rewind", 0.4);
    show.engine.idle();
    ASSERT_EQ(show.engine.state_hash(), hashes.at(show.engine.world().tick()));
    ASSERT_TRUE(replays_identically(show, at, random_inputs, hashes));
  }
}

TEST_F(PanicButton, TheCheckpointOutlivesTheHistory) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  EngineOptions options = rewind_options(folder);
  options.sets = {{"/physics/sim/history", {Arg::of(2.0)}}};
  Show show(options);
  std::vector<std::uint64_t> hashes;
  play_to(show, 200, no_inputs, hashes);
  expect_restored(show, 400, hashes, no_inputs);
  expect_restored(show, 3, hashes, no_inputs);
}

TEST_F(PanicButton, TheSecondPressWithoutHistoryContinuesFromRest) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kPanicScene);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.sets = {{"/physics/sim/history", {Arg::of(0.0)}}};
  Show show(options);
  show.ticks(100);
  show.send("/transport/panic");
  show.ticks(100);
  show.send("/transport/panic");
  show.ticks(1);
  EXPECT_FALSE(show.engine.world().panic().on());
  EXPECT_EQ(show.engine.world().tick(), 201U);
}

TEST_F(PanicButton, ATakeWithPanicsReplaysToItsHash) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kPanicScene);
  const std::string take = folder.path("panic.take");
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = take;
  std::uint64_t hash = 0;
  {
    Show show(options);
    for (int i = 0; i < 6; i++) {
      show.ticks(40 + 13 * i);
      if (i == 5) show.send("/transport/panic_end");
      show.send(i % 2 == 0 ? "/transport/panic" : "/panic");
      show.send("/push");
    }
    show.ticks(10);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  expect_replay(take, hash);
}

}  // namespace
}  // namespace limber::engine::test
