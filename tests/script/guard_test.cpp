// Guarded calls: calls that take too long or use too much memory are stopped, failing calls are rolled back, and others
// continue; interpreted and live mode; calls from C++.
#include "script/vm/guard.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <lua.hpp>

#include "script/api/script_context.h"
#include "script/vm/vm.h"
#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

constexpr double kShortCallMs = 5 * kBudgetScale;

SceneOptions short_limits(double call_ms = kShortCallMs) {
  SceneOptions options;
  options.limits.call_ms = call_ms;
  options.limits.run_ms = 40 * kBudgetScale;
  return options;
}

std::string stopped(double ms) {
  return fmt::format(
      "stopped after {:g} ms of computing; check for an infinite loop, or spread the work over several steps", ms);
}

TEST(Guard, ACompiledLoopIsStopped) {
  ScriptFixture fixture(short_limits());
  ASSERT_EQ(fixture.play(R"(
sim:on_step(function()
  print("in")
  while true do end
end)
sim:on_step(function() print("alive") end)
)",
                         3),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"in", "alive", "alive", "alive"}));
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(fixture.host.faults[0].file, "scripts/scene.lua");
  EXPECT_EQ(fixture.host.faults[0].line, 4);
  EXPECT_EQ(fixture.host.faults[0].text, "scripts/scene.lua:4: " + stopped(kShortCallMs) +
                                             "\n  4 |   while true do end\nstack traceback:\n"
                                             "  scripts/scene.lua:4: in the function of line 2");
}

TEST(Guard, ARunIsStopped) {
  ScriptFixture fixture(short_limits());
  EXPECT_EQ(first_line(fixture.run("local i = 0\nrepeat i = i + 1 until i < 0")),
            fmt::format("scripts/scene.lua:2: stopped after {:g} s of computing; check for an infinite loop",
                        0.04 * kBudgetScale));
}

TEST(Guard, AStopCaughtByPcallIsRaisedAgain) {
  ScriptFixture fixture(short_limits());
  ASSERT_EQ(fixture.play(R"(
sim:on_step(function()
  while true do
    pcall(function() while true do end end)
  end
end)
sim:on_step(function() return pcall(function() while true do end end) end)
)",
                         2),
            "");
  ASSERT_EQ(fixture.host.faults.size(), 2u);
  // the line where it was stopped first
  EXPECT_EQ(first_line(fixture.host.faults[0].text), "scripts/scene.lua:4: " + stopped(kShortCallMs));
  EXPECT_EQ(first_line(fixture.host.faults[1].text), "scripts/scene.lua:7: " + stopped(kShortCallMs));
}

// changes to be rolled back, checked from outside
constexpr const char* kTwoBalls = R"(
sim.gravity = vec3(0, 0, -9.81)
local shape = sim:add_sphere_shape("ball", 0.1)
local ball = sim:add_body("ball"):add_part("ball", shape, { position = { 0, 0, 1 } })
local other = sim:add_body("other"):add_part("other", shape, { position = { 3, 0, 1 } })
sim:on_step(function() ball:apply_force(vec3(0, 0, 9)) rng:uniform() end)
)";

std::uint64_t hash_after(const std::string& more, std::size_t faults) {
  ScriptFixture fixture(short_limits());
  EXPECT_EQ(fixture.play(std::string(kTwoBalls) + more, 30), "");
  EXPECT_EQ(fixture.host.faults.size(), faults);
  EXPECT_TRUE(fixture.host.sent.empty());
  return fixture.scene.state_hash(fixture.world.state_hash());
}

TEST(Guard, AFailingCallIsRolledBack) {
  const std::uint64_t alone = hash_after("", 0);
  const std::vector<std::string> actions = {
      "ball:apply_force(vec3(5, 0, 0))",
      "ball:apply_impulse(vec3(1, 1, 1), vec3(0, 0, 0.9)) ball:apply_torque(vec3(0, 1, 0))",
      "ball.position = vec3(0, 0, 2) ball.rotation = quat.euler(0.1, 0.2, 0.3)",
      "ball.linear_velocity = vec3(1, 0, 0) other.angular_velocity = vec3(0, 9, 0)",
      "ball.mass = 5 ball.friction = 0 sim.gravity = vec3() sim.substeps = 1",
      "ball.body.position = vec3(0, 1, 1) ball.body.rotation = quat.euler(0, 0, 1)",
      "ball.body.linear_velocity = vec3(0, 1, 1) ball.body.enabled = false",
      "ball.body:reset()",
      "ball.body:remove()",
      "other.body:remove() sim:add_body('other'):add_part('p', shape)",
      "sim:add_body('new'):add_part('p', shape, { position = { 0, 0, 1.1 } })",
      "local n = ball.body:copy('new') n.position = vec3(0, 0, 1.1) n:copy('newer') n:remove()",
      "ball.position = vec3(1, 1, 1) ball.body:copy('new')",
      "local p = ball.body:add_part('p', shape, { position = { 0, 0, 2 } }) ball.position = vec3(0, 1, 1) "
      "ball.body:add_motor(ball.body:add_joint('j', ball, p))",
      "sim:add_compound_shape('c'):add_child(shape)",
      "rng:uniform() math.random()",
      "osc:send('/a', 1) sim:reset()",
      "sim:on_step(function() ball:apply_force(vec3(9, 0, 0)) end) sim:after(0.1, function() error('late') end)",
  };
  for (const std::string& action : actions) {
    EXPECT_EQ(hash_after("sim:at(0.1, function() " + action + " error('x') end)", 1), alone) << action;
    EXPECT_EQ(hash_after("sim:at(0.1, function() " + action + " while true do end end)", 1), alone) << action;
  }
}

TEST(Guard, ASuccessfulCallIsNotRolledBack) {
  // check that each of these changes would be visible without a failure
  const std::uint64_t alone = hash_after("", 0);
  for (const char* action : {"ball:apply_force(vec3(5, 0, 0))", "ball.position = vec3(0, 0, 2)", "ball.mass = 5",
                             "other.body:remove()", "rng:uniform()"}) {
    EXPECT_NE(hash_after("sim:at(0.1, function() " + std::string(action) + " end)", 0), alone) << action;
  }
}

TEST(Guard, AFailingRunReportsItsPlaceAndHasNoEffect) {
  const struct {
    const char* text;
    const char* fault;  // after the file's name; for loops the last possible line
  } runs[] = {
      {"local t = {}\nfor i = 1, math.huge do t[i] = i end", "2: stopped: scripts can use"},
      {"local s = 'x'\nwhile true do s = s .. s end", "2: stopped: scripts can use"},
      {"for i = 1, 3 do sim:add_body('b' .. i) end\nerror('on purpose')", "2: on purpose"},
      {"pcall(function()\nwhile true do end end)", "2: stopped after"},
      {"local co = coroutine.wrap(function()\nwhile true do end end) co()", "2: stopped after"},
      {"setmetatable({}, { __index = function()\nwhile true do end end }).x()", "2: stopped after"},
      {"local x = = 1", "1: unexpected symbol near '='"},
      {"goto nowhere", "1: undefined label 'nowhere'"},
      {"\27LJ\2\2", "1: unexpected symbol near"},
      {"return sim.nothing", "1: sim has no property 'nothing'"},
      {"sim:reset()", "1: sim:reset acts on the running scene"},
  };
  SceneOptions options = short_limits();
  options.limits.memory = std::size_t{16} << 20u;
  for (const auto& run : runs) {
    // enough time on any machine for code that ends by itself or by another limit
    options.limits.run_ms = (std::string_view(run.fault).ends_with("stopped after") ? 200 : 20000) * kBudgetScale;
    ScriptFixture fixture(options);
    const std::string fault = first_line(fixture.run(run.text));
    EXPECT_EQ(fault.find(std::string("scripts/scene.lua:") + run.fault), 0u) << run.text << "\n" << fault;
    EXPECT_NE(fault, "") << run.text;
    fixture.tick(2);
  }
  EXPECT_EQ(value_of("1 + 1"), "2");
}

TEST(Guard, ASceneHasABoundedNumberOfObjects) {
  SceneOptions options = short_limits();
  options.limits.run_ms = 5000 * kBudgetScale;
  options.limits.max_objects = 400;
  ScriptFixture fixture(options, true);
  EXPECT_EQ(first_line(fixture.run("local n = 0 while true do n = n + 1 sim:add_body('body ' .. n) end")),
            "scripts/scene.lua:1: a scene can have at most 400 objects (bodies, parts, joints, motors, shapes)");
  EXPECT_GT(fixture.world.bodies().size(), 70u);  // five nodes per body
  EXPECT_LT(fixture.world.bodies().size(), 81u);
}

TEST(Guard, CallsFromCppAreGuarded) {
  ScriptFixture ground;
  ScriptContext context(ground.world, ground.host, short_limits());
  Vm vm(context, VmMode::interpreted);
  lua_State* const L = vm.state();
  ASSERT_EQ(vm.mode(), VmMode::interpreted);
  const auto push = [&](const char* text) { ASSERT_EQ(luaL_loadbuffer(L, text, std::strlen(text), "@mine.lua"), 0); };
  push("local a, b = ... return a + b, a * b");
  lua_pushnumber(L, 3);
  lua_pushnumber(L, 4);
  ASSERT_TRUE(vm.guard().call(2, 2));
  ASSERT_EQ(lua_gettop(L), 2);
  EXPECT_EQ(lua_tonumber(L, -2), 7);
  EXPECT_EQ(lua_tonumber(L, -1), 12);
  lua_settop(L, 0);

  push("\n\nlocal a = nil\nreturn a.b");
  EXPECT_FALSE(vm.guard().call(0, 1));
  EXPECT_EQ(lua_gettop(L), 0);
  EXPECT_EQ(vm.guard().fault().file, "mine.lua");
  EXPECT_EQ(vm.guard().fault().line, 4);
  EXPECT_FALSE(vm.guard().fault().stopped);

  // an interpreted state has no compiled code, and its loops are stopped as well
  push("\nwhile true do end");
  EXPECT_FALSE(vm.guard().call(0, 0));
  EXPECT_EQ(vm.guard().fault().line, 2);
  EXPECT_TRUE(vm.guard().fault().stopped);
  EXPECT_EQ(first_line(vm.guard().fault().text), "mine.lua:2: " + stopped(kShortCallMs));
}

TEST(Guard, OnlyOneStateIsLive) {
  ScriptFixture first(short_limits());
  EXPECT_EQ(first.scene.mode(), VmMode::compiled);
  auto second = std::make_unique<ScriptFixture>(short_limits(), true);
  EXPECT_EQ(second->scene.mode(), VmMode::interpreted);
  EXPECT_FALSE(second->scene.enable_jit());
  first.scene.disable_jit();
  EXPECT_TRUE(second->scene.enable_jit());
  EXPECT_EQ(second->scene.mode(), VmMode::compiled);
  EXPECT_FALSE(first.scene.enable_jit());
  const char* const kEndless = "sim:on_start(function() while true do end end)";
  ASSERT_EQ(first.play(kEndless), "");
  ASSERT_EQ(second->play(kEndless), "");
  EXPECT_EQ(first.host.faults.size(), 1u);
  EXPECT_EQ(second->host.faults.size(), 1u);
  second.reset();
  EXPECT_TRUE(first.scene.enable_jit());
}

}  // namespace
}  // namespace limber::script
