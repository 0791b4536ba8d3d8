// Behaviors in a scene: attaching, options, handles, groups, errors.
#include <gtest/gtest.h>

#include "script/stage.h"

namespace limber::script {
namespace {

constexpr const char* kBehavingArm = R"(
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
for i, name in ipairs { "base", "mid", "tip" } do arm:add_part(name, shape, { position = vec3(i, 0, 0) }) end
for i, name in ipairs { "mid", "tip" } do arm:add_motor(arm:add_joint("j_" .. name, i, name)) end
sim.gravity = vec3(0, 0, 0)
)";

std::string value(const std::string& expression, const std::string& before = "") {
  return value_of(expression, std::string(kBehavingArm) + before);
}
std::string error(const std::string& text) { return error_of(std::string(kBehavingArm) + text); }

TEST(LuaBehaviors, AHandleHasParametersNameTypeAndBody) {
  const std::string before = R"(local b = arm:add_behavior("RandomForceBehavior", "wind",
    { parts = "tip", max_amp = 3, min_dir = { 1, 2, 3 }, active = false }))";
  EXPECT_EQ(value("b.max_amp, b.min_dir, b.active, b.rand_interval", before), "3\tvec3(1, 2, 3)\tfalse\t1000");
  EXPECT_EQ(value("b.name, b.type, b.body, b.alive", before), "wind\trandom_force\tbody 'arm'\ttrue");
  EXPECT_EQ(value("#b.parts, b.parts[1], #b.joints, #b.motors", before), "1\tpart 'arm/tip'\t2\t2");
  EXPECT_EQ(value("b.error, b", before), "nil\tbehavior 'arm/wind'");
  EXPECT_EQ(value("b.max_amp", before + " b.max_amp = 7"), "7");
  EXPECT_EQ(value("arm:behavior('wind') == b, arm:behavior(1) == b, #arm.behaviors, arm.behaviors[1] == b", before),
            "true\ttrue\t1\ttrue");
  EXPECT_EQ(value("b.time", before), "0");
}

TEST(LuaBehaviors, TargetsAreNamesPatternsObjectsOrLists) {
  const auto of = [](const std::string& key, const std::string& wanted) {
    return value("table.concat(names, ' ')", "local names = {}\nlocal b = arm:add_behavior('rotation_target', 'f', { " +
                                                 key + " = " + wanted + " })\nfor _, x in ipairs(b." +
                                                 (key == "parts" ? "parts" : "motors") +
                                                 ") do names[#names + 1] = x.name end");
  };
  EXPECT_EQ(of("parts", "'tip'"), "tip");
  EXPECT_EQ(of("parts", "{ 'tip', 'm*' }"), "mid tip");
  EXPECT_EQ(of("parts", "'all'"), "base mid tip");
  EXPECT_EQ(of("parts", "{}"), "");
  EXPECT_EQ(of("parts", "arm:part('mid')"), "mid");
  EXPECT_EQ(of("parts", "{ arm:part(1), 'tip' }"), "base tip");
  EXPECT_EQ(of("parts", "arm.parts"), "base mid tip");
  EXPECT_EQ(of("joints", "'j_tip'"), "j_tip");
  EXPECT_EQ(of("joints", "arm.joints"), "j_mid j_tip");
  EXPECT_EQ(of("motors", "{ arm:motor('j_mid') }"), "j_mid");
}

TEST(LuaBehaviors, TargetListsBehaveLikeOtherLists) {
  const std::string before = "local b = arm:add_behavior('force', 'f', { parts = { 'base', 'tip' } })\n";
  EXPECT_EQ(value("#names, names[1], names[2]",
                  before + "local names = {} for part in b:parts('t*') do names[#names + 1] = part.name end"),
            "1\ttip\tnil");
  EXPECT_EQ(value("i, part", before + "local i, part for p, n in b:parts() do i, part = n, p end"),
            "2\tpart 'arm/tip'");
}

TEST(LuaBehaviors, ErrorsSuggestExistingNames) {
  EXPECT_EQ(error("arm:add_behavior('forse', 'f')"),
            "scripts/scene.lua:7: there is no behavior type 'forse'; did you mean 'force'?");
  EXPECT_EQ(error("arm:add_behavior('force', 'f', { parts = 'tipp' })"),
            "scripts/scene.lua:7: body 'arm' has no part 'tipp'; did you mean 'tip'?");
  EXPECT_EQ(error("arm:add_behavior('force', 'f', { ampp = 2 })"),
            "scripts/scene.lua:7: add_behavior: opts has no 'ampp'; did you mean 'amp'?");
  EXPECT_EQ(error("arm:add_behavior('force', 'f', { parts = 7 })"),
            "scripts/scene.lua:7: add_behavior: parts takes names, patterns, parts or \"all\", not 7");
  EXPECT_EQ(error("arm:add_behavior('force', 'f', { dir = 7 })"),
            "scripts/scene.lua:7: behavior 'arm/f': 'dir' takes a vec3, not 7");
  EXPECT_EQ(error("local b = arm:add_behavior('force', 'f') print(b.ampp)"),
            "scripts/scene.lua:7: behavior 'arm/f' has no property 'ampp'; did you mean 'amp'?");
  EXPECT_EQ(error("local b = arm:add_behavior('force', 'f') b.time = 2"),
            "scripts/scene.lua:7: behavior 'arm/f': 'time' is a readout: it can be read, not set");
  EXPECT_EQ(error("arm:behavior('wind')"), "scripts/scene.lua:7: body 'arm' has no behavior 'wind'; none exist");
  EXPECT_EQ(error("arm:add_behavior('cohesion', 'f')"),
            "scripts/scene.lua:7: 'cohesion' acts on several bodies: attach it with sim:add_group_behavior");
  EXPECT_EQ(error("sim:add_group_behavior('force', 'f')"),
            "scripts/scene.lua:7: 'force' acts on one body: attach it with body:add_behavior");
  EXPECT_EQ(error("sim:group_behavior('flock')"), "scripts/scene.lua:7: sim has no group behavior 'flock'; none exist");
  EXPECT_EQ(error("local twin = arm:copy('twin') arm:add_behavior('force', 'f', { parts = twin:part(1) })"),
            "scripts/scene.lua:7: add_behavior: parts: part 'twin/base' does not belong to body 'arm'");
  EXPECT_EQ(error("arm.add_behavior('force', 'f')"),
            "scripts/scene.lua:7: add_behavior is a method of a body: write it with a colon, body:add_behavior(…), not "
            "with a dot");
  EXPECT_EQ(error("arm:add_behavior('force', 'f'):remove()"),
            "scripts/scene.lua:7: behavior 'arm/f':remove acts on the running scene; at the top level use "
            "sim:on_start(function() … end)");
}

TEST(LuaBehaviors, AGroupSetsAllMembers) {
  const std::string before = R"(
    local twin = arm:copy("twin", { position = vec3(0, 3, 0) })
    local g = sim:add_group_behavior("cohesion", "swarm", { bodies = { arm, "twin" }, parts = "tip", amount = 2 })
  )";
  EXPECT_EQ(value("g.name, g.type, g.amount, g.active, g", before), "swarm\tcohesion\t2\ttrue\tgroup 'swarm'");
  EXPECT_EQ(value("arm:behavior('swarm').amount, twin:behavior('swarm').amount", before), "2\t2");
  EXPECT_EQ(value("arm:behavior('swarm').amount, twin:behavior('swarm').amount",
                  before + "arm:behavior('swarm').amount = 5 g.max_dist = 4"),
            "5\t2");
  EXPECT_EQ(value("arm:behavior('swarm').max_dist, sim:group_behavior('swarm') == g", before + "g.max_dist = 4"),
            "4\ttrue");
  EXPECT_EQ(error("sim:add_group_behavior('cohesion', 'swarm', { bodies = 'amr' })"),
            "scripts/scene.lua:7: there is no body 'amr'; did you mean 'arm'?");
  EXPECT_EQ(error("sim:add_group_behavior('cohesion', 'swarm', { joints = 'all' })"),
            "scripts/scene.lua:7: add_group_behavior: opts has no 'joints'; there are: bodies, neighbor_parts, parts, "
            "active, amount, max_dist, min_dist, place");
}

TEST(LuaBehaviors, ARemovedBehaviorNoLongerExists) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.play(std::string(kBehavingArm) + R"(
    local b = arm:add_behavior("force", "push", { amp = 6, parts = "tip" })
    local g = sim:add_group_behavior("cohesion", "swarm")
    sim:on_start(function()
      b:remove()
      g:remove()
      print(b.alive, g.alive, #arm.behaviors, (pcall(function() return b.amp end)))
    end)
  )",
                         2),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"false\tfalse\t0\tfalse"}));
  EXPECT_TRUE(fixture.host.faults.empty());
}

TEST(LuaBehaviors, RunAfterTheScenesCallbacksAndBeforePhysics) {
  ScriptFixture fixture;
  // the callback's value is used by the behavior in the same tick: F·dt/m = 6/60
  EXPECT_EQ(fixture.play(R"(
    sim.gravity = vec3(0, 0, 0)
    local ball = sim:add_body("ball")
    ball:add_part("ball", sim:add_sphere_shape("s", 0.1))
    local push = ball:add_behavior("force", "push")
    sim:on_step(function() push.amp = 6 print(ball.linear_velocity.x) end)
  )",
                         2),
            "");
  ASSERT_EQ(fixture.host.printed.size(), 2U);
  EXPECT_EQ(fixture.host.printed[0], "0");
  EXPECT_NEAR(std::stod(fixture.host.printed[1]), 0.1, 1e-6);
}

TEST(LuaBehaviors, ACopyHasTheBehaviorsAndPairsVisitsThemInOrder) {
  EXPECT_EQ(value("#twin.behaviors, twin:behavior('a').amp, twin:behavior('a').body",
                  "arm:add_behavior('force', 'a', { amp = 4 }) local twin = arm:copy('twin')"),
            "1\t4\tbody 'twin'");
  EXPECT_EQ(value("list", R"(
    local a, b = arm:add_behavior('force', 'a'), arm:add_behavior('force', 'b')
    local t, list = { [b] = 'b', [arm:part('tip')] = 'tip', [a] = 'a' }, ''
    for _, v in pairs(t) do list = list .. v .. ' ' end)"),
            "tip a b ");
}

}  // namespace
}  // namespace limber::script
