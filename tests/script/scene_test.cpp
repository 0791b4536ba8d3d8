// Scenes: callbacks and their order, timers, contacts, differences between runs and callbacks, reset of the seed.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

TEST(Scene, CallbacksRunInTheOrderOfATick) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:on_step(function(dt) print("step 1", dt == sim.timestep) end)
sim:after(0, function() print("after") end)
sim:on_step(function() print("step 2") end)
sim:on_start(function() print("start 1", sim.time) end)
sim:at(0, function() print("at") end)
sim:on_start(function() print("start 2") end)
osc:on("/a", function() print("osc") end)
print("top")
)"),
            "");
  fixture.scene.handle_message({"/a", {}}, {});
  fixture.tick();
  EXPECT_EQ(fixture.host.printed,
            (Lines{"top", "start 1\t0", "start 2", "osc", "after", "at", "step 1\ttrue", "step 2"}));
  fixture.host.printed.clear();
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (Lines{"step 1\ttrue", "step 2"}));
}

TEST(Scene, EveryFiresAtMultiplesOfThePeriod) {
  // at 60 ticks per second a tenth of a second passes at ticks 6, 12, 18 …, whenever the timer was set
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:every(0.1, function() print("tenth", math.floor(sim.time * 60 + 0.5)) end)
sim:after(0.15, function()
  sim:every(0.1, function() print("late", math.floor(sim.time * 60 + 0.5)) end)
end)
)",
                         31),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"tenth\t6", "tenth\t12", "late\t12", "tenth\t18", "late\t18", "tenth\t24",
                                         "late\t24", "tenth\t30", "late\t30"}));
}

TEST(Scene, EveryDoesNotDrift) {
  // 600 s in ticks of 1/60: the time is a sum, and its error must neither skip nor repeat a period
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("beats = 0 sim:every(1, function() beats = beats + 1 end) "
                         "sim:every(600, function() print(beats) end)",
                         0),
            "");
  fixture.tick(36001);
  EXPECT_EQ(fixture.host.printed, Lines{"600"});
}

TEST(Scene, AfterAndAtFireOnce) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local function say(what) return function() print(what, math.floor(sim.time * 60 + 0.5)) end end
sim:after(0.5, say("after"))
sim:at(0.25, say("at"))
local never = sim:after(0.1, say("never"))
sim:on_start(function() never:cancel() end)
)",
                         60),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"at\t15", "after\t30"}));
}

TEST(Scene, ATimerCanCancelItselfAndOthers) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local a, b
local n = 0
a = sim:every(1 / 60, function() n = n + 1 print("a", n) if n == 3 then a:cancel() b:cancel() end end)
b = sim:every(1 / 60, function() print("b", n) end)
)",
                         10),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"a\t1", "b\t1", "a\t2", "b\t2", "a\t3"}));
  EXPECT_TRUE(fixture.host.faults.empty());
}

TEST(Scene, ContactsAreReportedOnceWhenTheyBegin) {
  // dropped from 0.5 m above the floor: falls sqrt(2·0.5/9.81) = 0.319 s, 19.2 ticks; reported in the next tick
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1),
  { position = { 1, 2, 0.6 }, report_contacts = true, mass = 2 })
sim:on_contact(function(part, other, impulse, position)
  print(part, other, math.floor(sim.time * 60 + 0.5))
  hit, where = impulse, position
end)
sim:at(1, function() print(hit > 0, (where - vec3(1, 2, 0)):length() < 0.02) end)
)",
                         90),
            "");
  ASSERT_EQ(fixture.host.printed.size(), 2u);
  EXPECT_EQ(fixture.host.printed[0].substr(0, 35), "part 'ball/ball'\tpart 'floor/floor'");
  const int tick = std::stoi(fixture.host.printed[0].substr(fixture.host.printed[0].rfind('\t')));
  EXPECT_GE(tick, 19);
  EXPECT_LE(tick, 21);
  EXPECT_EQ(fixture.host.printed[1], "true\ttrue");
}

TEST(Scene, ForcesAndImpulsesMove) {
  // without gravity: 6 N on 2 kg for 30 ticks of 1/60 s gives 1.5 m/s; an impulse of 1 N·s gives 0.5 m/s
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim.gravity = vec3()
local box = sim:add_box_shape("box", { 0.1, 0.1, 0.1 })
local a = sim:add_body("a"):add_part("p", box, { mass = 2 })
local b = sim:add_body("b"):add_part("p", box, { mass = 2, position = { 5, 0, 0 } })
sim:on_step(function() a:apply_force(vec3(0, 6, 0)) end)
sim:on_start(function() b:apply_impulse({ 0, 0, 1 }) end)
sim:at(0.5, function() print(string.format("%.4f %.4f", a.linear_velocity.y, b.linear_velocity.z)) end)
)",
                         31),
            "");
  EXPECT_EQ(fixture.host.printed, Lines{"1.5000 0.5000"});
}

TEST(Scene, AFailingCallbackIsDisabledAndReported) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:on_step(function() print("one") error("broken") end)
sim:on_step(function() print("two") end)
osc:on("/a", function() print("heard") nothing() end)
)",
                         3),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"one", "two", "two", "two"}));
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(fixture.host.faults[0].file, "scripts/scene.lua");
  EXPECT_EQ(fixture.host.faults[0].line, 2);
  EXPECT_EQ(first_line(fixture.host.faults[0].text), "scripts/scene.lua:2: broken");
}

TEST(Scene, AHandlerThatFailsIsDisabledAndReportedOnce) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
osc:on("/a", function() print("one") nothing() end)
osc:on("/*", function() print("two") end)
)"),
            "");
  for (int i = 0; i < 3; i++)
    EXPECT_TRUE(fixture.scene.handle_message({"/a", {}}, {})) << "a disabled handler still counts";
  EXPECT_EQ(fixture.host.printed, (Lines{"one", "two", "two", "two"}));
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(fixture.host.faults[0].line, 2);
  EXPECT_EQ(fixture.scene.disabled_handlers(), 1u);
}

TEST(Scene, CallbacksRegisteredMeanwhileRunNextTime) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local n = 0
sim:on_step(function()
  n = n + 1
  if n == 1 then sim:on_step(function() print("new", n) end) end
end)
)",
                         3),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"new\t2", "new\t3"}));
}

TEST(Scene, ReportsMistakesInRegistering) {
  const std::string at = "scripts/scene.lua:1: ";
  EXPECT_EQ(error_of("sim:on_step(5)"), at + "sim:on_step takes a function, not 5");
  EXPECT_EQ(error_of("sim:on_start()"), at + "sim:on_start takes a function, not nothing");
  EXPECT_EQ(error_of("sim:every(0, print)"), at + "sim:every takes seconds above 0, not 0");
  EXPECT_EQ(error_of("sim:every('1', print)"), at + "sim:every takes a number, not '1'");
  EXPECT_EQ(error_of("sim:after(-1, print)"), at + "sim:after takes seconds of 0 or more, not -1");
  EXPECT_EQ(error_of("sim:at(0 / 0, print)").substr(0, 45), at + "sim:at takes a finite nu");
  EXPECT_EQ(error_of("sim.on_step(print)"),
            at + "on_step is a method of a sim: write it with a colon, sim:on_step(…), not with a dot");
  EXPECT_EQ(error_of("sim:after(1, print):stop()"), at + "a timer has no member 'stop'; there are: cancel");
}

TEST(Scene, CallbacksCanCreateBodies) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local box = sim:add_box_shape("box", { 1, 1, 1 })
local first = sim:add_body("first")
first:add_part("p", box, { mass = 3, friction = 0.25 })
sim:on_start(function()
  local twin = first:copy("twin", { position = vec3(0, 0, 4) })
  print(twin:part("p").mass, twin:part("p").friction, twin.position)
  local third = sim:add_body("third")
  third:add_part("p", box, { mass = 0, position = { 0, 9, 0 } })
  print(#sim.bodies, third.root.mass)
  twin:remove()
  print(#sim.bodies, sim:find_body("twin"))
  sim:reset()
end)
)"),
            "");
  EXPECT_TRUE(fixture.host.faults.empty());
  EXPECT_EQ(fixture.host.printed, (Lines{"3\t0.25\tvec3(0, 0, 4)", "3\t0", "2\tnil"}));
  EXPECT_EQ(fixture.host.resets, 1);
}

TEST(Scene, CreatesAllShapes) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run(R"(
sim:add_plane_shape("plane")
sim:add_plane_shape("wall", { 1, 0, 0 })
sim:add_sphere_shape("sphere", 0.5)
local box = sim:add_box_shape("box", { 1, 2, 3 })
sim:add_cylinder_shape("cylinder", 0.5, 2)
sim:add_capsule_shape("capsule", 0.25, 1.5)
sim:add_cone_shape("cone", 0.5, 1)
local points = {}
for i = 0, 7 do points[#points + 1] = vec3(i % 2, math.floor(i / 2) % 2, math.floor(i / 4)) end
local hull = sim:add_convex_mesh_shape("hull", points, { scale = 2 })
local both = sim:add_compound_shape("both")
both:add_child(box):add_child("sphere", { 0, 0, 3 }, quat())
local body = sim:add_body("all")
for i, name in ipairs { "sphere", "box", "cylinder", "capsule", "cone", "hull", "both" } do
  body:add_part(name, name, { position = { 4 * i, 0, 0 } })
end
print(body:part("hull").center, body:part("both").shape)
)"),
            "");
  EXPECT_EQ(fixture.world.shapes().list().size(), 9u);
  EXPECT_EQ(fixture.world.shapes().find("wall")->model().normal, Vec3(1, 0, 0));
  EXPECT_EQ(fixture.world.shapes().find("box")->model().size, Vec3(1, 2, 3));
  EXPECT_EQ(fixture.world.shapes().find("capsule")->model().height, 1.5);
  EXPECT_EQ(fixture.world.shapes().find("hull")->model().mesh->hull.size(), 8u);
  EXPECT_NEAR(fixture.world.shapes().find("hull")->model().mesh->unit_inertial.mass, 8, 1e-9);  // a cube of 2 m
  EXPECT_EQ(fixture.world.shapes().find("both")->placed().size(), 2u);
  // the cube's corner is its origin, at x = 24: its center is one meter away on each axis
  EXPECT_EQ(fixture.host.printed, Lines{"vec3(25, 1, 1)\tshape 'both'"});
}

TEST(Scene, ConcaveMeshesComeFromFiles) {
  for (const auto& [options, error] : std::vector<std::pair<std::string, std::string>>{
           {"concave = true", "concave needs the surface of a mesh file, not points"},
           {"concave = 1", "concave is true or false, not 1"},
           {"concave = false", ""}}) {
    ScriptFixture fixture;
    const std::string points = "{ vec3(), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1) }";
    const std::string result = fixture.run("sim:add_convex_mesh_shape('m', " + points + ", { " + options + " })");
    EXPECT_NE(result.find(error), std::string::npos) << result;
    EXPECT_EQ(result.empty(), error.empty()) << result;
  }
}

TEST(Scene, TheCommandLineOverridesTheSeed) {
  const std::string draw = "sim.seed = 7 print(rng:uniform(), math.random(1000), sim.seed)";
  ScriptFixture plain;
  ASSERT_EQ(plain.run(draw), "");
  ScriptFixture again;
  ASSERT_EQ(again.run(draw), "");
  EXPECT_EQ(plain.host.printed, again.host.printed);
  limber::Random expected(7, "scene.lua");
  const double first = expected.uniform();
  const double second = expected.uniform();
  EXPECT_EQ(plain.host.printed.back(),
            value_of("string.format('%.14g', " + std::to_string(0) + " + " + fmt::format("{:.17g}", first) + ")") +
                "\t" + std::to_string(1 + static_cast<int>(second * 1000)) + "\t7");
  ScriptFixture other{SceneOptions{"", {}, 8, {}}};
  ASSERT_EQ(other.run(draw), "");
  EXPECT_NE(other.host.printed, plain.host.printed);
  EXPECT_EQ(other.host.printed.back().substr(other.host.printed.back().rfind('\t')), "\t8");
}

TEST(Scene, ALaterSeedTakesEffectAtTheNextStart) {
  const std::string draw = "sim.seed = 7 sim:on_start(function() {} print(rng:uniform()) end)";
  const auto first_draw = [&](const std::string& before) {
    ScriptFixture fixture;
    std::string text = draw;
    text.replace(text.find("{}"), 2, before);
    EXPECT_EQ(fixture.play(text), "");
    return fixture.host.printed;
  };
  EXPECT_EQ(first_draw("sim.seed = 8"), first_draw(""));
}

TEST(Scene, RandomNumbersHaveTheirDistribution) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run(R"(
local n, low, high, sum, squares = 20000, 9, -9, 0, 0
for i = 1, n do
  local u = rng:uniform(-2, 6)
  low, high = math.min(low, u), math.max(high, u)
  local x = rng:normal()
  sum, squares = sum + x, squares + x * x
end
print(low >= -2 and low < -1.99 and high < 6 and high > 5.99)
print(math.abs(sum / n) < 0.03, math.abs(squares / n - 1) < 0.05)
local v = vec3()
for i = 1, n do
  local d = rng:direction()
  if math.abs(d:length() - 1) > 1e-12 then error("length") end
  v = v + d
end
print(v:length() / n < 0.03)
local w = rng:uniform(vec3(1, 2, 3), vec3(2, 2, 5))
print(w.x >= 1 and w.x < 2 and w.y == 2 and w.z >= 3 and w.z < 5)
local seen = {}
for i = 1, 1000 do seen[math.random(6)] = true seen[math.random(-1, 0)] = true end
print(#seen, seen[0], seen[-1], seen[7], seen[-2])
)"),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"true", "true\ttrue", "true", "true", "6\ttrue\ttrue\tnil\tnil"}));
}

TEST(Scene, StateIsATable) { EXPECT_EQ(value_of("state.hits", "state.hits = (state.hits or 0) + 1"), "1"); }

TEST(Scene, SimHasTimeAndTick) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("sim.timestep = 0.01 sim:at(0.05, function() print(sim.tick, sim.time) end)", 8), "");
  EXPECT_EQ(fixture.host.printed, Lines{"5\t0.05"});
}

}  // namespace
}  // namespace limber::script
