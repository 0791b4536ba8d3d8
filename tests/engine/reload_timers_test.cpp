// Timers set by callbacks survive a save with their functions and variables, and end by cancel or a reset.
#include "engine/edited.h"
#include "engine/taken.h"
#include "script/scene/earlier_runs.h"

namespace limber::engine::test {
namespace {

using Texts = std::vector<std::string>;

constexpr const char* kCue = R"(
sim.timestep = 0.1
local stone = sim:add_sphere_shape("stone", 0.1)
local ball = sim:add_body("ball")
ball:add_part("p", stone, { position = vec3(0, 0, 5) })
local name = "first"
osc:on("/cue", function(seconds)
  local cue = (state.cues or 0) + 1
  state.cues = cue
  sim:after(seconds, function()
    ball.parts[1].mass = 2
    osc:send("/blackout", name, cue, sim.tick, state.cues)
  end)
end)
)";

Texts received(Show& show, int ticks) {
  show.sent_texts();
  show.ticks(ticks);
  return show.sent_texts();
}

std::string newest_log(std::uint64_t seen, std::string_view about) {
  for (const LogLine& line : log_since(seen)) {
    if (line.text.find(about) != std::string::npos) return line.text;
  }
  return "";
}

TEST(ReloadTimers, ABlackoutRunsAfterSavesWithItsOwnFunctionAndVariables) {
  EditedShow edited(kCue);
  edited.show().send("/cue", 3);
  edited.show().ticks(1);
  const std::uint64_t seen = log_newest();
  for (int i = 0; i < 5; i++) {
    ASSERT_EQ(edited.save(std::string(kCue) + fmt::format("name = 'save {}'", i)), SceneReloader::ApplyResult::applied);
    edited.show().ticks(2);
  }
  EXPECT_NE(newest_log(seen, "1 timer set by callbacks before the save continues"), "");
  ASSERT_EQ(edited.save("sim.timestep = 0.1"), SceneReloader::ApplyResult::applied)
      << "its ball and its line are removed";
  ASSERT_EQ(edited.save(kCue), SceneReloader::ApplyResult::applied);
  // the cue was given at tick 0, and 30 ticks are 3 s
  EXPECT_EQ(received(edited.show(), 19), Texts{});
  edited.show().send("/cue", 100);  // a timer of the current run
  const Texts out = received(edited.show(), 2);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_TRUE(out[0].starts_with("/script/error scripts/scene.lua")) << out[0];
  EXPECT_NE(out[0].find("body 'ball' no longer exists"), std::string::npos) << out[0];
}

TEST(ReloadTimers, HandlesFollowRebuiltObjects) {
  EditedShow edited(kCue);
  edited.show().send("/cue", 3);
  edited.show().ticks(1);
  const std::string box = "sim:add_box_shape(\"stone\", vec3(1, 1, 1))";
  ASSERT_EQ(edited.edit("sim:add_sphere_shape(\"stone\", 0.1)", box), SceneReloader::ApplyResult::applied);
  edited.show().ticks(5);
  // another joint: the body is rebuilt
  ASSERT_EQ(edited.edit("local name", R"(ball:add_part("q", stone, { position = vec3(0, 0, 7) })
ball:add_joint("j", "p", "q", { type = "prismatic" })
local name)"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(24);
  EXPECT_EQ(edited.part("ball", "p").mass(), 1);
  EXPECT_EQ(received(edited.show(), 1), Texts{"/blackout first 1 30 1"});
  EXPECT_EQ(edited.part("ball", "p").mass(), 2);
}

TEST(ReloadTimers, RunsShareState) {
  EditedShow edited(kCue);
  edited.show().send("/cue", 1);
  edited.show().ticks(1);
  ASSERT_EQ(edited.save(std::string(kCue) + R"(
state.list = { 1, { deep = 2 } }
local list = state.list
state.f = print
osc:on("/more", function() state.cues = state.cues + 10; osc:send("/list", list == state.list, state.f == print) end)
)"),
            SceneReloader::ApplyResult::applied);
  edited.show().send("/more");
  edited.show().ticks(1);
  edited.show().send("/cue", 2);
  edited.show().ticks(1);
  EXPECT_EQ(received(edited.show(), 8), Texts{"/blackout first 1 10 12"}) << "it sees the writes of the later run";
  edited.show().send("/more");
  EXPECT_EQ(received(edited.show(), 1), Texts{"/list 1 1"});
  EXPECT_EQ(received(edited.show(), 11), Texts{"/blackout first 12 22 22"});
}

TEST(ReloadTimers, SequencesContinue) {
  const std::string scene = R"(
sim.timestep = 0.1
osc:on("/go", function()
  local step = 0
  local function more()
    step = step + 1
    osc:send("/step", step, sim.tick)
    if step < 4 then sim:after(0.5, more) end
  end
  sim:after(0.5, more)
end)
)";
  EditedShow edited(scene);
  edited.show().send("/go");
  Texts all;
  for (int i = 0; i < 30; i++) {
    edited.show().ticks(1);
    for (const std::string& text : edited.show().sent_texts()) all.push_back(text);
    ASSERT_EQ(edited.save(fmt::format("{}\n-- {}", scene, i)), SceneReloader::ApplyResult::applied);
  }
  EXPECT_EQ(all, (Texts{"/step 1 5", "/step 2 10", "/step 3 15", "/step 4 20"}));
}

TEST(ReloadTimers, ResetAndCancelEndThem) {
  const std::string scene = R"(
sim.timestep = 0.1
osc:on("/go", function()
  local beats, timer = 0, nil
  timer = sim:every(0.2, function()
    beats = beats + 1
    osc:send("/beat", sim.tick)
    if beats == 3 then timer:cancel() end
  end)
end)
)";
  EditedShow edited(scene);
  edited.show().send("/go");
  edited.show().ticks(1);
  edited.save(scene + "-- saved");
  EXPECT_EQ(received(edited.show(), 20), (Texts{"/beat 2", "/beat 4", "/beat 6"}));
  edited.show().send("/go");
  edited.show().ticks(1);
  edited.save(scene + "-- again");
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  EXPECT_EQ(received(edited.show(), 20), Texts{});
}

TEST(ReloadTimers, ATimerInStateIsCancelledByALaterRun) {
  const std::string scene = R"(
sim.timestep = 0.1
osc:on("/go", function(n)
  state.timers = state.timers or {}
  state.timers[n] = sim:after(1, function() osc:send("/go", n, sim.tick) end)
end)
osc:on("/cancel", function(n) state.timers[n]:cancel() end)
osc:on("/cancel_and_fail", function(n)
  state.timers[n]:cancel()
  error("no")
end)
)";
  EditedShow edited(scene);
  for (int n = 1; n <= 4; n++) {
    edited.show().send("/go", n);
    edited.show().ticks(1);
    // the third and fourth are of one run, as is the one that cancels
    if (n < 3) edited.save(fmt::format("{} -- {}", scene, n));
  }
  edited.show().send("/cancel", 1);
  edited.show().send("/cancel_and_fail", 2);
  edited.show().send("/cancel", 4);
  edited.show().ticks(1);
  EXPECT_EQ(received(edited.show(), 20), (Texts{"/go 2 11", "/go 3 12"}));
  // a run may end with the last timer that another one cancels
  edited.show().send("/go", 5);
  edited.show().ticks(1);
  edited.save(scene + "-- once more");
  edited.show().send("/cancel", 5);
  EXPECT_EQ(received(edited.show(), 20), Texts{});
  edited.show().send("/cancel", 5);
  EXPECT_EQ(received(edited.show(), 1), Texts{}) << "it has ended already";
}

TEST(ReloadTimers, TopLevelAfterActsOnceAtItsTime) {
  const std::string scene = "sim.timestep = 0.1\nsim:after(0.5, function() osc:send('/after', 1, sim.tick) end)\n";
  EditedShow edited(scene);
  edited.show().ticks(3);
  // edited before it is due: called at its time, with the new function
  edited.edit("'/after', 1", "'/after', 2");
  EXPECT_EQ(received(edited.show(), 3), Texts{"/after 2 5"});
  edited.edit("'/after', 2", "'/after', 3");
  EXPECT_EQ(received(edited.show(), 20), Texts{}) << "it was called";
  // a new one, and one with another delay, count from the run, here from tick 26
  edited.save(scene + "sim:after(0.5, function() osc:send('/more', sim.tick) end)");
  EXPECT_EQ(received(edited.show(), 20), Texts{"/more 31"});
  edited.edit("sim:after(0.5, function() osc:send('/after'", "sim:after(0.4, function() osc:send('/after'");
  EXPECT_EQ(received(edited.show(), 20), Texts{"/after 1 50"});
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  EXPECT_EQ(received(edited.show(), 20), (Texts{"/after 1 4", "/more 5"})) << "a reset begins again";
}

TEST(ReloadTimers, AFailedTopLevelAfterIsCorrectedByASave) {
  const std::string scene = "sim.timestep = 0.1\nsim:after(0.5, function() osc:nothing() end)\n";
  EditedShow edited(scene);
  edited.show().ticks(10);
  edited.edit("osc:nothing()", "osc:send('/mended', sim.tick)");
  EXPECT_EQ(received(edited.show(), 20), Texts{"/mended 15"});
}

TEST(ReloadTimers, AFailedOneIsReportedAndItsWritesAreRolledBack) {
  const std::string scene = R"(
sim.timestep = 0.1
osc:on("/go", function()
  sim:after(0.3, function() sim.gravity = vec3(0, 0, -1); error("no") end)
  sim:every(0.3, function() osc:send("/beat", sim.tick) end)
end)
)";
  EditedShow edited(scene);
  edited.show().send("/go");
  edited.show().ticks(1);
  edited.save(scene + "-- saved");
  const Texts out = received(edited.show(), 7);
  ASSERT_EQ(out.size(), 3u);
  EXPECT_TRUE(out[0].starts_with("/script/error scripts/scene.lua 4")) << out[0];
  EXPECT_EQ((Texts{out[1], out[2]}), (Texts{"/beat 3", "/beat 6"}));
  EXPECT_NE(edited.show().read("/physics/sim/gravity", 2), -1);
}

TEST(ReloadTimers, UseTheParametersOfTheCurrentRun) {
  const std::string scene = R"(
sim.timestep = 0.1
params { { "wind", 1, max = 9 }, { "rain", 2, max = 9 }, { "mode", "a", choices = { "a", "b" } } }
osc:on("/go", function()
  sim:every(0.2, function() osc:send("/is", params.wind, params.mode); params.wind = params.wind + 1 end)
end)
)";
  EditedShow edited(scene);
  edited.show().send("/go");
  edited.show().ticks(1);
  edited.save(scene + "-- the same parameters");
  EXPECT_EQ(received(edited.show(), 2), Texts{"/is 1 a"});
  edited.edit("{ \"wind\", 1, max = 9 }, { \"rain\", 2, max = 9 }", "{ \"snow\", 3 }, { \"wind\", 1, max = 4 }");
  EXPECT_EQ(received(edited.show(), 4), (Texts{"/is 2 a", "/is 3 a"}));
  edited.edit("{ \"wind\", 1, max = 4 }, ", "");
  const Texts out = received(edited.show(), 2);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NE(out[0].find("params has no 'wind'"), std::string::npos) << out[0];
}

TEST(ReloadTimers, BehaviorsKeepTheirNamesWhenTheirTypeChanges) {
  const std::string sway = R"(return behavior {
  params = { { "depth", 0.4, max = 1 } },
  step = function(self, dt) self.motors[1].target = self.depth end,
})";
  const std::string scene = R"(
sim.timestep = 0.1
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("sway", "sway")
osc:on("/go", function()
  local sway = arm:behavior("sway")
  sim:every(0.2, function() osc:send("/depth", sway.depth, sway.alive); sway.depth = sway.depth / 2 end)
end)
)";
  EditedShow edited("", {{"behaviors_lua/sway.lua", sway}});
  namespace fs = std::filesystem;
  fs::create_directories(edited.folder.path("urdf"));
  fs::copy(fs::path(LIMBER_SOURCE_DIR) / "urdf/arm6.urdf", edited.folder.path("urdf/arm6.urdf"));
  fs::copy(fs::path(LIMBER_SOURCE_DIR) / "urdf/meshes", edited.folder.path("urdf/meshes"), fs::copy_options::recursive);
  ASSERT_EQ(edited.save(scene), SceneReloader::ApplyResult::applied);
  edited.show().send("/go");
  edited.show().ticks(1);
  edited.folder.write("behaviors_lua/sway.lua", R"(return behavior {
  params = { { "speed", 7, max = 9 }, { "far", 5, max = 9 }, { "depth", 0.4, max = 1 } },
  step = function(self, dt) self.motors[1].target = self.depth end,
})");
  ASSERT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(received(edited.show(), 4), (Texts{"/depth 0.4 1", "/depth 0.2 1"}));
  EXPECT_EQ(edited.show().read("/physics/body/arm/behavior/sway/speed"), 7);
  EXPECT_EQ(edited.show().read("/physics/body/arm/behavior/sway/depth"), 0.1);
}

TEST(ReloadTimers, HandlersOfCallbacksEndAndAreReported) {
  const std::string scene = R"(
osc:on("/go", function()
  osc:on("/more", function() osc:send("/more") end)
  sim:on_step(function() end)
  sim:every(0.01, function() osc:on("/late", function() osc:send("/late") end) osc:send("/beat") end)
end)
)";
  EditedShow edited(scene);
  edited.show().send("/go");
  edited.show().ticks(1);
  const std::uint64_t seen = log_newest();
  edited.save(scene + "-- saved");
  EXPECT_NE(newest_log(seen, "handlers registered in callbacks ended with the save"), "");
  edited.show().ticks(2);
  EXPECT_NE(newest_log(seen, "osc:on is ignored"), "");
  edited.show().sent_texts();
  edited.show().send("/late");
  edited.show().send("/more");
  const Texts out = received(edited.show(), 1);
  EXPECT_EQ(std::count(out.begin(), out.end(), "/beat"), 1);
  EXPECT_EQ(std::count(out.begin(), out.end(), "/late") + std::count(out.begin(), out.end(), "/more"), 0);
}

TEST(ReloadTimers, TheNumberOfEarlierRunsIsLimited) {
  const std::string scene = "osc:on('/go', function(n) sim:every(0.01, function() osc:send('/beat', n) end) end)";
  EditedShow edited(scene);
  constexpr int kExtraRuns = 3;
  constexpr auto kMaxEarlierRuns = static_cast<int>(script::EarlierRuns::kMaxRuns);
  const std::uint64_t seen = log_newest();
  for (int i = 0; i < kMaxEarlierRuns + kExtraRuns; i++) {
    edited.show().send("/go", i);
    edited.show().ticks(1);
    ASSERT_EQ(edited.save(fmt::format("{} -- {}", scene, i)), SceneReloader::ApplyResult::applied);
  }
  EXPECT_NE(newest_log(seen, "1 timer scheduled by the oldest run ended"), "");
  Texts expected;
  for (int i = kExtraRuns; i < kMaxEarlierRuns + kExtraRuns; i++) expected.push_back(fmt::format("/beat {}", i));
  EXPECT_EQ(received(edited.show(), 1), expected) << "oldest first";
}

TEST(ReloadTimers, ARewindRestoresEndedOnes) {
  EditedShow edited(kCue);
  edited.show().send("/cue", 2);
  edited.show().ticks(1);
  edited.save(std::string(kCue) + "-- saved");
  edited.show().ticks(15);
  const std::uint64_t hash = edited.show().engine.state_hash();
  EXPECT_EQ(received(edited.show(), 10), Texts{"/blackout first 1 20 1"});
  const std::uint64_t end = edited.show().engine.state_hash();
  edited.show().send("/transport/rewind_ticks", 10);
  edited.show().engine.idle();
  EXPECT_EQ(edited.show().engine.state_hash(), hash);
  EXPECT_EQ(received(edited.show(), 10), Texts{"/blackout first 1 20 1"});
  EXPECT_EQ(edited.show().engine.state_hash(), end);
}

TEST(ReloadTimers, ATakeReplaysThem) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kCue);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("cue.take");
  std::uint64_t hash = 0;
  {
    Show show(options);
    show.send("/cue", 1);
    show.send("/cue", 100);
    show.ticks(2);
    folder.write("scripts/scene.lua", std::string(kCue) + "-- saved");
    show.engine.reload_now();
    show.ticks(20);
    EXPECT_EQ(show.read("/physics/body/ball/part/p/mass"), 2);
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  const ReplayOutcome again = replay_take(options.record);
  EXPECT_EQ(again.error, "");
  EXPECT_EQ(again.hash, hash);
  EXPECT_FALSE(again.result.diverged_at.has_value());
  // a take of a version that ended timers when a file was saved
  std::string bytes = file_bytes(options.record);
  ASSERT_EQ(bytes.substr(0, 13), fmt::format("limber take {}", kTakeVersion));
  bytes[12] = '3';
  folder.write("old.take", bytes);
  EXPECT_EQ(replay_take(folder.path("old.take")).result.diverged_at, 3u)
      << "there is no timer in the state from the save on";
}

TEST(ReloadTimers, ParametersSetByAConsoleSurviveAReset) {
  const std::string scene =
      "params { { 'wind', 1, max = 9 }, { 'on', false }, { 'where', vec3(1, 2, 3) },\n"
      "  { 'mode', 'a', choices = { 'a', 'b' } }, { 'rain', 5, max = 9 } }\n"
      "osc:on('/rain', function(x) params.rain = x end)";
  EditedShow edited(scene);
  evaluate(edited.show(), "params.wind = 3 params.on = true params.where = vec3(4, 5, 6) params.mode = 'b'");
  evaluate(edited.show(), "params.rain = 7 error('no')");
  edited.show().ticks(1);
  edited.show().send("/rain", 8);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().read("/scene/rain"), 8);
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().read("/scene/wind"), 3);
  EXPECT_EQ(edited.show().read("/scene/on"), 1);
  EXPECT_EQ(edited.show().read("/scene/where", 2), 6);
  EXPECT_EQ(edited.show().read("/scene/mode"), 1);
  EXPECT_EQ(edited.show().read("/scene/rain"), 5) << "a callback's value is not an override";
}

}  // namespace
}  // namespace limber::engine::test
