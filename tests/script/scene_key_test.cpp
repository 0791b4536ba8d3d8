// Checkpoints of Lua's heap: after a restore scripts repeat their actions exactly, compiled or not; guards and counters
// continue.
#include "script/scene/scene_checkpoint.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "script/vm/call_log.h"
#include "sim/state/world_checkpoint.h"
#include "stage.h"

namespace limber::script {
namespace {

// a checkpoint of a world and its scene
struct Saved {
  PageStore pages;
  Archive scratch;
  sim::WorldCheckpoint world;
  SceneCheckpoint scene;

  void capture(ScriptFixture& fixture) {
    world.capture(fixture.world, pages, nullptr, scratch);
    scene.capture(fixture.scene, pages, nullptr, scratch);
  }
  void restore(ScriptFixture& fixture) {
    world.restore(fixture.world, pages, scratch);
    scene.restore(fixture.scene, pages, scratch);
  }
};

// runs the scene and returns its output, followed by the state hash
std::vector<std::string> output_of_ticks(ScriptFixture& fixture, int ticks) {
  fixture.host.printed.clear();
  fixture.tick(ticks);
  fixture.host.printed.push_back(std::to_string(fixture.scene.state_hash(fixture.world.state_hash())));
  return fixture.host.printed;
}

// compiled loops, tables that grow and shrink, strings, coroutines, closures, metatables, timers
constexpr const char* kBusy = R"(
local ball = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("s", 0.1))
local list, words, count = {}, setmetatable({}, { __index = function(t, k) return #k end }), 0
local function maker() local n = 0 return function(by) n = n + by return n end end
local add = maker()
local walk = coroutine.create(function(a) while true do a = coroutine.yield(a * 2 + rng:uniform(0, 1)) end end)
sim:on_step(function(dt)
  count = count + 1
  for i = 1, 200 do list[#list + 1] = (list[#list] or 0) * 0.5 + i * dt end
  if #list > 3000 then list = {} end
  local word = "w" .. count % 50
  words[word] = words[word] .. "x"
  if #words[word] > 20 then words[word] = nil end
  local _, value = coroutine.resume(walk, add(count % 3))
  local sum = 0
  for i = 1, #list, 7 do sum = sum + math.sin(list[i]) end
  ball:apply_force(vec3(sum * 0.01, value * 0.001, #words[word]))
  if count % 10 == 0 then print(count, sum, value, words[word]) end
end)
sim:every(0.2, function() state.beats = (state.beats or 0) + 1; print("beat", state.beats, rng:uniform(0, 1)) end)
)";

TEST(SceneCheckpoint, ScriptsRepeatAfterARestore) {
  ScriptFixture fixture({}, true);
  ASSERT_EQ(fixture.play(kBusy, 40), "");
  ASSERT_EQ(fixture.scene.mode(), VmMode::compiled);
  Saved saved;
  saved.capture(fixture);
  const std::vector<std::string> first = output_of_ticks(fixture, 120);
  for (int round = 0; round < 5; round++) {
    fixture.tick(37 * round);
    saved.restore(fixture);
    EXPECT_EQ(output_of_ticks(fixture, 120), first) << "round " << round;
  }
  EXPECT_TRUE(fixture.host.faults.empty());
}

// random draws of a behavior file for all of its instances
TEST(SceneCheckpoint, RestoresGeneratorsOfBehaviorFiles) {
  ScriptFixture fixture({}, true);
  fixture.write("behaviors_lua/dice.lua", R"(local dice = rng
return behavior { doc = "Throws.", step = function(self, dt) print("thrown", dice:uniform(0, 1)) end }
)");
  ASSERT_EQ(fixture.play(R"(
sim:add_body("one"):add_behavior("dice", "it", {})
)",
                         5),
            "");
  Saved saved;
  saved.capture(fixture);
  const std::vector<std::string> first = output_of_ticks(fixture, 10);
  ASSERT_GE(first.size(), 10u);
  EXPECT_NE(first[0], first[1]);
  fixture.tick(7);
  saved.restore(fixture);
  EXPECT_EQ(output_of_ticks(fixture, 10), first);
}

// checkpoints in the middle of a garbage collection, of a compiled and an interpreted heap
TEST(SceneCheckpoint, CapturesDuringGarbageCollection) {
  ScriptFixture fixture({}, true);
  ASSERT_EQ(fixture.play(kBusy, 5), "");
  for (int at = 0; at < 30; at++) {
    Saved saved;
    saved.capture(fixture);
    const std::vector<std::string> first = output_of_ticks(fixture, 11);
    fixture.tick(at);
    for (int i = 0; i < at; i++) fixture.scene.collect_garbage();
    saved.restore(fixture);
    ASSERT_EQ(output_of_ticks(fixture, 11), first) << at;
  }
}

TEST(SceneCheckpoint, StopsStillWorkAfterARestore) {
  SceneOptions options;
  // uses up the memory in a twentieth of a call's time budget, even where the system provides pages slowly
  options.limits.memory = std::size_t{8} << 20u;
  options.limits.call_ms = 100 * kBudgetScale;
  ScriptFixture fixture(options, true);
  ASSERT_EQ(fixture.play(R"(
local stored, at = {}, {}
local function due(name, when)
  at[name] = (at[name] or 0) + 1
  return at[name] == when
end
sim:on_step(function() if due("long", 5) then while true do end end end)
sim:on_step(function() if due("much", 7) then while true do stored[#stored + 1] = ("x"):rep(1e5 - #stored) end end end)
sim:on_step(function() if due("wrong", 9) then error("nine") end end)
)",
                         2),
            "");
  Saved saved;
  saved.capture(fixture);
  const auto faults = [&] {
    fixture.host.faults.clear();
    fixture.tick(12);
    std::vector<std::string> texts;
    for (const auto& fault : fixture.host.faults) texts.push_back(fault.text.substr(0, 48));
    return texts;
  };
  const std::vector<std::string> first = faults();
  ASSERT_EQ(first.size(), 3u);
  EXPECT_NE(first[0].find("stopped after"), std::string::npos) << first[0];
  EXPECT_NE(first[1].find("scripts can use"), std::string::npos) << first[1];
  EXPECT_NE(first[2].find("nine"), std::string::npos) << first[2];
  for (int round = 0; round < 3; round++) {
    saved.restore(fixture);
    EXPECT_EQ(faults(), first);
  }
}

// the memory count is restored with the heap, otherwise the cap would stop innocent calls
TEST(SceneCheckpoint, RestoresTheMemoryCount) {
  SceneOptions options;
  options.limits.memory = std::size_t{24} << 20u;
  ScriptFixture fixture(options, true);
  ASSERT_EQ(fixture.play(R"(
local stored, round = {}, 0
sim:on_step(function()
  round = round + 1
  for i = 1, 60 do stored[#stored + 1] = ("x"):rep(5000) .. #stored .. round end
end)
)",
                         2),
            "");
  Saved saved;
  saved.capture(fixture);
  for (int round = 0; round < 12; round++) {
    fixture.tick(20);  // 6 MB
    EXPECT_TRUE(fixture.host.faults.empty()) << "round " << round << ": " << fixture.host.faults[0].text;
    saved.restore(fixture);
  }
}

// during a repetition nothing is stopped except calls in the log
TEST(SceneCheckpoint, RepeatsWithoutLimits) {
  SceneOptions options;
  options.limits.call_ms = 5 * kBudgetScale;
  ScriptFixture fixture(options, true);
  ASSERT_EQ(fixture.play("local n = 0\nsim:on_step(function() local s = 0; for i = 1, 3e7 do s = s + i % 7 end; "
                         "n = n + 1; print(n, s) end)"),
            "");
  fixture.scene.set_resimulating(true);
  fixture.tick(2);
  EXPECT_TRUE(fixture.host.faults.empty());
  EXPECT_EQ(fixture.host.printed.size(), 2u);
}

TEST(SceneCheckpoint, CheckpointsShareUnchangedPages) {
  ScriptFixture fixture({}, true);
  ASSERT_EQ(
      fixture.play("local big = {}\nfor i = 1, 200000 do big[i] = i end\nsim:on_step(function() big[7] = sim.tick end)",
                   3),
      "");
  PageStore pages;
  Archive scratch;
  std::vector<SceneCheckpoint> checkpoints(10);
  checkpoints[0].capture(fixture.scene, pages, nullptr, scratch);
  const std::size_t one = pages.bytes();
  EXPECT_GT(one, std::size_t{3} << 19u);
  for (std::size_t i = 1; i < checkpoints.size(); i++) {
    fixture.tick(1);
    checkpoints[i].capture(fixture.scene, pages, &checkpoints[i - 1], scratch);
  }
  EXPECT_LT(pages.bytes(), one + one / 2);
  for (SceneCheckpoint& checkpoint : checkpoints) checkpoint.release(pages);
  EXPECT_EQ(pages.bytes(), 0u);
}

}  // namespace
}  // namespace limber::script
