// Lua's heap as an image: what scripts do after it was brought back is what they did before, compiled or not; guards
// and counts go on.
#include "script/scene_key.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "script/call_ledger.h"
#include "sim/world_key.h"
#include "stage.h"

namespace limber {
namespace {

// what a scene has printed after each tick, and the world's hash
struct Kept {
  PageStore pages;
  KeyBytes scratch;
  WorldKey world;
  SceneKey scene;

  void take(Stage& stage) {
    world.take(stage.world, pages, nullptr, scratch);
    scene.take(stage.scene, pages, nullptr, scratch);
  }
  void bring_back(Stage& stage) {
    world.bring_back(stage.world, pages, scratch);
    scene.bring_back(stage.scene, pages, scratch);
  }
};

std::vector<std::string> prints(Stage& stage, int ticks) {
  stage.host.printed.clear();
  stage.tick(ticks);
  stage.host.printed.push_back(std::to_string(stage.scene.state_hash(stage.world.state_hash())));
  return stage.host.printed;
}

// loops that are compiled, tables that grow and shrink, strings, coroutines, closures, metatables, timers
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

TEST(SceneKey, ScriptsGoOnAsTheyDid) {
  Stage stage({}, true);
  ASSERT_EQ(stage.play(kBusy, 40), "");
  ASSERT_EQ(stage.scene.mode(), VmMode::live);
  Kept kept;
  kept.take(stage);
  const std::vector<std::string> first = prints(stage, 120);
  for (int round = 0; round < 5; round++) {
    stage.tick(37 * round);
    kept.bring_back(stage);
    EXPECT_EQ(prints(stage, 120), first) << "round " << round;
  }
  EXPECT_TRUE(stage.host.faults.empty());
}

// what a behaviour's file draws for all of its instances
TEST(SceneKey, FilesGeneratorsGoBackToo) {
  Stage stage({}, true);
  stage.write("behaviors_lua/dice.lua", R"(local dice = rng
return behavior { doc = "Throws.", step = function(self, dt) print("thrown", dice:uniform(0, 1)) end }
)");
  ASSERT_EQ(stage.play(R"(
sim:add_body("one"):add_behavior("dice", "it", {})
)",
                       5),
            "");
  Kept kept;
  kept.take(stage);
  const std::vector<std::string> first = prints(stage, 10);
  ASSERT_GE(first.size(), 10u);
  EXPECT_NE(first[0], first[1]);
  stage.tick(7);
  kept.bring_back(stage);
  EXPECT_EQ(prints(stage, 10), first);
}

// a copy in the middle of a garbage collection, of a heap that is compiled and that is not
TEST(SceneKey, AnyMomentWillDo) {
  Stage stage({}, true);
  ASSERT_EQ(stage.play(kBusy, 5), "");
  for (int at = 0; at < 30; at++) {
    Kept kept;
    kept.take(stage);
    const std::vector<std::string> first = prints(stage, 11);
    stage.tick(at);
    for (int i = 0; i < at; i++) stage.scene.collect_garbage();
    kept.bring_back(stage);
    ASSERT_EQ(prints(stage, 11), first) << at;
  }
}

TEST(SceneKey, WhatIsStoppedIsStoppedAfterwardsToo) {
  SceneOptions options;
  // memory is out in a twentieth of the time that a call has, where the system gives pages slowly, too
  options.limits.memory = std::size_t{8} << 20u;
  options.limits.call_ms = 100 * kBudgetScale;
  Stage stage(options, true);
  ASSERT_EQ(stage.play(R"(
local kept, at = {}, {}
local function due(name, when)
  at[name] = (at[name] or 0) + 1
  return at[name] == when
end
sim:on_step(function() if due("long", 5) then while true do end end end)
sim:on_step(function() if due("much", 7) then while true do kept[#kept + 1] = ("x"):rep(1e5 - #kept) end end end)
sim:on_step(function() if due("wrong", 9) then error("nine") end end)
)",
                       2),
            "");
  Kept kept;
  kept.take(stage);
  const auto faults = [&] {
    stage.host.faults.clear();
    stage.tick(12);
    std::vector<std::string> texts;
    for (const auto& fault : stage.host.faults) texts.push_back(fault.text.substr(0, 48));
    return texts;
  };
  const std::vector<std::string> first = faults();
  ASSERT_EQ(first.size(), 3u);
  EXPECT_NE(first[0].find("stopped after"), std::string::npos) << first[0];
  EXPECT_NE(first[1].find("may hold"), std::string::npos) << first[1];
  EXPECT_NE(first[2].find("nine"), std::string::npos) << first[2];
  for (int round = 0; round < 3; round++) {
    kept.bring_back(stage);
    EXPECT_EQ(faults(), first);
  }
}

// the count of what Lua holds goes back with it, or the cap would stop the innocent
TEST(SceneKey, MemoryIsCountedAsItWas) {
  SceneOptions options;
  options.limits.memory = std::size_t{24} << 20u;
  Stage stage(options, true);
  ASSERT_EQ(stage.play(R"(
local kept, round = {}, 0
sim:on_step(function()
  round = round + 1
  for i = 1, 60 do kept[#kept + 1] = ("x"):rep(5000) .. #kept .. round end
end)
)",
                       2),
            "");
  Kept kept;
  kept.take(stage);
  for (int round = 0; round < 12; round++) {
    stage.tick(20);  // 6 MB
    EXPECT_TRUE(stage.host.faults.empty()) << "round " << round << ": " << stage.host.faults[0].text;
    kept.bring_back(stage);
  }
}

// while it is done again nothing is stopped but what the ledger says
TEST(SceneKey, DoneAgainWithoutLimits) {
  SceneOptions options;
  options.limits.call_ms = 5 * kBudgetScale;
  Stage stage(options, true);
  ASSERT_EQ(stage.play("local n = 0\nsim:on_step(function() local s = 0; for i = 1, 3e7 do s = s + i % 7 end; "
                       "n = n + 1; print(n, s) end)"),
            "");
  stage.scene.do_again(true);
  stage.tick(2);
  EXPECT_TRUE(stage.host.faults.empty());
  EXPECT_EQ(stage.host.printed.size(), 2u);
}

TEST(SceneKey, CopiesShareWhatRests) {
  Stage stage({}, true);
  ASSERT_EQ(
      stage.play("local big = {}\nfor i = 1, 200000 do big[i] = i end\nsim:on_step(function() big[7] = sim.tick end)",
                 3),
      "");
  PageStore pages;
  KeyBytes scratch;
  std::vector<SceneKey> keys(10);
  keys[0].take(stage.scene, pages, nullptr, scratch);
  const std::size_t one = pages.bytes();
  EXPECT_GT(one, std::size_t{3} << 19u);
  for (std::size_t i = 1; i < keys.size(); i++) {
    stage.tick(1);
    keys[i].take(stage.scene, pages, &keys[i - 1], scratch);
  }
  EXPECT_LT(pages.bytes(), one + one / 2);
  for (SceneKey& key : keys) key.release(pages);
  EXPECT_EQ(pages.bytes(), 0u);
}

}  // namespace
}  // namespace limber
