// Callbacks, timers and handlers are removed with their run; handles and `state` persist; a failed run has no effect.
#include "engine/edited.h"

namespace limber::engine::test {
namespace {

using Texts = std::vector<std::string>;

TEST(ReloadScript, OnlyCallbacksOfTheLastRunAreCalled) {
  EditedShow edited(
      "sim:on_step(function() osc:send('/step', 1) end) osc:on('/hit', function() osc:send('/hit', 1) end)");
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), (Texts{"/hit 1", "/step 1"}));
  edited.save(
      "sim:on_step(function() osc:send('/step', 2) end) osc:on('/hit', function() osc:send('/hit', 2) end)\n"
      "sim:on_start(function() osc:send('/start') end)");
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), (Texts{"/hit 2", "/step 2"})) << "on_start is for starts and resets";
  edited.save("");
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts().size(), 1u) << "only the error of /hit";
}

TEST(ReloadScript, EveryKeepsItsIntervalAndAtIsCalledOnce) {
  const std::string scene =
      "sim.timestep = 0.1\n"
      "sim:every(1, function() osc:send('/beat', sim.tick) end)\n"
      "sim:at(0.5, function() osc:send('/at', sim.tick) end)\n"
      "sim:at(2.5, function() osc:send('/later', sim.tick) end)\n";
  EditedShow edited(scene);
  Texts received;
  // saved before every single tick: no call is lost or repeated
  for (int i = 0; i < 32; i++) {
    ASSERT_EQ(edited.save(scene + "-- " + std::to_string(i)), SceneReloader::ApplyResult::applied);
    edited.show().ticks(1);
    for (const std::string& text : edited.show().sent_texts()) received.push_back(text);
  }
  EXPECT_EQ(received, (Texts{"/at 5", "/beat 10", "/beat 20", "/later 25", "/beat 30"}));
}

TEST(ReloadScript, AfterKeepsItsTime) {
  const std::string scene = "sim.timestep = 0.1\nsim:after(0.5, function() osc:send('/after', sim.tick) end)";
  EditedShow edited(scene);
  edited.show().ticks(4);
  edited.save(scene);
  edited.show().ticks(10);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/after 5"});
}

TEST(ReloadScript, HandlesReferToLiveObjects) {
  EditedShow edited("");
  edited.show().ticks(3);
  // ids in the candidate's own world differ: the floor comes first there
  const std::string floor = "sim:add_body('floor'):add_part('floor', sim:add_plane_shape('ground'))\n";
  const std::string arms = R"(
local s = sim:add_sphere_shape("s", 0.1)
local phase, motors = {}, {}
for i = 1, 3 do
  local arm = sim:add_body("arm" .. i)
  arm:add_part("base", s, { mass = 0, position = vec3(i, 0, 2) })
  arm:add_part("tip", s, { position = vec3(i, 0, 1.5) })
  arm:add_joint("j", "base", "tip", { position = vec3(i, 0, 2), axis = vec3(1, 0, 0) })
  motors[i] = arm:add_motor("j")
  phase[arm] = i
end
local joints, first = sim:body("arm2").joints, sim:body("arm1")
local link = first:link("tip")
sim:on_step(function()
  local found = {}
  for arm, i in pairs(phase) do found[#found + 1] = arm.name .. "=" .. i end
  osc:send("/arms", table.concat(found, " "), sim.bodies[1] == first, phase[sim:body("arm3")], #joints, joints[1].name)
  osc:send("/things", motors[2].joint.child.body.name, motors[2] == joints[1].motor, link.alive, link.name, s.name,
    tostring(s), sim.bodies[1].alive, first:part("tip").shape == s)
end)
)";
  Texts received;
  for (const std::string& scene : {arms, floor + arms, arms + floor, arms}) {
    ASSERT_EQ(edited.save(scene), SceneReloader::ApplyResult::applied);
    edited.show().ticks(1);
    received = edited.show().sent_texts();
    ASSERT_EQ(received.size(), 2u) << (received.empty() ? "" : received[0]);
    const bool is_first = scene.find("floor") != 0 && scene.find("sim:add_body('floor')") != 0;
    EXPECT_EQ(received[0], fmt::format("/arms arm1=1 arm2=2 arm3=3 {} 3 1 j", is_first ? 1 : 0));
    EXPECT_EQ(received[1], "/things arm2 1 1 tip s shape 's' 1 1");
  }
}

TEST(ReloadScript, StatePersistsAndAssignmentsOfTheRunWin) {
  const std::string scene = R"(
state.hits = state.hits or 0
state.list = state.list or { first = vec3(1, 2, 3), [1] = true, turn = quat(0, 0, 0, 1) }
local list = state.list
osc:on('/hit', function()
  state.hits = state.hits + 1
  list[#list + 1] = state.hits
  osc:send('/hits', state.hits, #list, list.first.y, list == state.list, state.version or 'none')
end)
)";
  EditedShow edited(scene);
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/hits 1 2 2 1 none"});
  edited.save(scene + "state.version = 'new'");
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/hits 2 3 2 1 new"});
  edited.save(scene + "state.version = nil state.hits = 100");
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/hits 101 4 2 1 none"});
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  edited.show().sent_texts();
  edited.show().send("/hit");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/hits 101 2 2 1 none"}) << "a reset empties it";
}

TEST(ReloadScript, StateThatIsNotPlainDataIsSkippedAndReported) {
  const std::string scene = R"(
state.n = (state.n or 0) + 1
state.list = state.list or { 1, print, { deep = print, flag = true }, turn = quat(0, 0, 0, 1) }
local list = state.list
osc:on('/ask', function() osc:send('/list', state.n, list[1], list[2] == nil, list[3].deep == nil, list[3].flag) end)
)";
  EditedShow edited(scene);
  const std::uint64_t before = log_count(LogLevel::warning);
  edited.save(scene + "-- saved");
  edited.show().send("/ask");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/list 2 1 1 1 1"});
  EXPECT_EQ(log_count(LogLevel::warning), before + 2) << "list[2] and list[3].deep, once each";
  edited.save(scene + "-- again");
  edited.show().send("/ask");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/list 3 1 1 1 1"});
  EXPECT_EQ(log_count(LogLevel::warning), before + 2) << "nothing is left to be skipped";
}

TEST(ReloadScript, AFailedRunChangesNothing) {
  const std::string good =
      "sim.gravity = vec3(0, 0, -3)\nlocal s = sim:add_sphere_shape('s', 0.1)\n"
      "sim:add_body('b'):add_part('p', s)\nsim:on_step(function() osc:send('/good') end)\n";
  const Texts kBrokenScenes = {
      good + "sim.gravity = vec3(0, 0, -7) sim:add_body('c') error('no')",
      good + "sim:body('b').root.friction = 0.1 sim:body('d')",
      "sim.gravity = vec3(",
      good.substr(0, 40),
      good + "if true then",
      "\x1bLJ",
  };
  EditedShow edited(good);
  edited.show().ticks(2);
  const std::uint64_t structure = edited.show().engine.store().structure_version();
  for (const std::string& broken : kBrokenScenes) {
    edited.show().sent_texts();
    ASSERT_EQ(edited.save(broken), SceneReloader::ApplyResult::failed) << broken;
    Texts out = edited.show().sent_texts();
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].substr(0, 31), "/script/error scripts/scene.lua") << out[0];
    edited.show().ticks(1);
    EXPECT_EQ(edited.show().sent_texts(), Texts{"/good"});
    EXPECT_EQ(edited.show().read("/physics/sim/gravity", 2), -3);
    EXPECT_EQ(edited.show().read("/physics/body/b/part/p/friction"), 0.5);
    EXPECT_EQ(edited.show().engine.store().structure_version(), structure);
  }
  // compared with the last successful run it changes nothing
  edited.show().send("/physics/sim/gravity", 0, 0, -1);
  edited.show().ticks(1);
  edited.show().sent_texts();
  EXPECT_EQ(edited.save(good), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/script/ok scripts/scene.lua"});
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 2), -1);
  EXPECT_EQ(edited.save(good), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.show().sent_texts(), Texts{}) << "the fix is reported once";
}

TEST(ReloadScript, AnErrorNamesFileLineAndTraceback) {
  EditedShow edited("");
  edited.folder.write("scripts/lib/dance.lua", "local M = {}\nfunction M.go() return nothing.at.all end\nreturn M");
  edited.save("local dance = require 'dance'\ndance.go()\n");
  EXPECT_EQ(edited.show().sent_texts(),
            Texts{"/script/error scripts/lib/dance.lua 2 scripts/lib/dance.lua:2: there is no global 'nothing'\n"
                  "  2 | function M.go() return nothing.at.all end\nstack traceback:\n"
                  "  scripts/lib/dance.lua:2: in function 'go'\n  scripts/scene.lua:2: in the main chunk"});
  edited.folder.write("scripts/lib/dance.lua", "return { go = function() sim.gravity = vec3(0, 0, -2) end }");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/script/ok scripts/lib/dance.lua"});
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 2), -2);
}

TEST(ReloadScript, AFailedCallbackIsFixedByASave) {
  EditedShow edited("sim:on_step(function() osc:nothing() end)");
  edited.show().ticks(3);
  EXPECT_EQ(edited.show().sent_texts().size(), 1u) << "switched off after its first error";
  edited.save("sim:on_step(function() osc:send('/mended') end)");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), (Texts{"/script/ok scripts/scene.lua", "/mended"}));
}

TEST(ReloadScript, AMissingSceneFileIsAnErrorUntilItIsRestored) {
  EditedShow edited("sim.gravity = vec3(0, 0, -3)");
  edited.folder.remove("scripts/scene.lua");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::failed);
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 2), -3);
  EXPECT_EQ(edited.save("sim.gravity = vec3(0, 0, -4)"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 2), -4);
}

TEST(ReloadScript, AFailedStartIsRepeatedByTheFirstSuccessfulRun) {
  ShowFolder folder;
  folder.write("scripts/scene.lua", "sim:add_body('b') error('not yet')");
  EngineLink link;
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.sets = {message("/physics/sim/gravity", 0, 0, -2)};
  Engine engine(link, options);
  ASSERT_FALSE(engine.start().ok());
  engine.tick();
  EXPECT_TRUE(engine.world().bodies().empty()) << "an empty world waits";
  folder.write("scripts/scene.lua", "sim:add_body('b') sim:on_start(function() osc:send('/start', sim.gravity) end)");
  EXPECT_EQ(engine.reload_now(), SceneReloader::ApplyResult::applied);
  EXPECT_NE(engine.world().find_body("b"), nullptr);
  std::vector<Outgoing> out;
  link.output_queue.drain(out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(text_of(out[0].message), "/start 0 0 -2");
}

TEST(ReloadScript, TheGeneratorStartsFromTheSeedInEachRun) {
  const std::string scene =
      "sim:on_start(function() end) local a = math.random()\n"
      "osc:on('/draw', function() osc:send('/drawn', a, math.random()) end)";
  EditedShow edited(scene);
  edited.show().send("/draw");
  edited.show().ticks(1);
  const Texts first = edited.show().sent_texts();
  edited.save(scene);
  edited.show().send("/draw");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), first);
  edited.save("sim.seed = 7 " + scene);
  edited.show().send("/draw");
  edited.show().ticks(1);
  EXPECT_NE(edited.show().sent_texts(), first);
}

TEST(ReloadScript, TimeIsLiveAtTheTopLevel) {
  EditedShow edited("");
  edited.show().ticks(30);
  edited.save(
      "local tick, time = sim.tick, sim.time\n"
      "osc:on('/ask', function() osc:send('/told', tick, math.abs(time - 0.5) < 1e-9) end)");
  edited.show().send("/ask");
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/told 30 1"});
}

}  // namespace
}  // namespace limber::engine::test
