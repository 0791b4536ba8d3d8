// Behaviours in Lua as they are played: start, step, self, errors, what lives on when a file is renewed.
#include "script/lua_behavior.h"

#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber {
namespace {

TEST(LuaBehavior, StartsOnceThenStepsWhileActive) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(R"(
return behavior {
  start = function(self) self.state.steps = 0 print("start") end,
  step = function(self, dt) self.state.steps = self.state.steps + 1 print(self.state.steps, self.time, dt == sim.timestep) end,
}
)",
                           2),
            "");
  stage.set("active", 0);
  stage.tick(3);
  stage.set("active", 1);
  stage.tick();
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"start", "1\t0\ttrue", "2\t0.016666666666667\ttrue",
                                                          "3\t0.083333333333333\ttrue"}));
  // a reset of the body starts again
  stage.world.find_body("ball")->reset();
  stage.tick();
  EXPECT_EQ(stage.host.printed.back(), "1\t0.1\ttrue");
}

TEST(LuaBehavior, ANewPartStartsAgain) {
  BehaviorStage stage;
  stage.write("behaviors_lua/test.lua", R"(
return behavior {
  start = function(self) print("start", #self.parts) end,
  step = function(self) end,
}
)");
  ASSERT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior("test", "it")
sim:after(0.05, function() ball:add_part("more", "ball") end)
)",
                       6),
            "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"start\t1", "start\t2"}));
}

TEST(LuaBehavior, MovesTheBodyInTheTickInWhichItActs) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(stepping("for _, part in ipairs(self.parts) do part:apply_force(self.way * self.speed) end"),
                           1, "{ speed = 3, way = vec3(0, 2, 0) }"),
            "");
  // F = 6 N on 2 kg for 1/60 s
  EXPECT_NEAR(stage.world.find_body("ball")->root()->linear_velocity().y, 3.0 / 60, 1e-6);
}

TEST(LuaBehavior, SelfTellsWhatItIs) {
  EXPECT_EQ(step_says("print(self.name, self.type, self.body, self.active, self)"),
            "it\ttest\tbody 'ball'\ttrue\tbehavior 'ball/it'");
  EXPECT_EQ(step_says("print(#self.parts, self.parts[1], #self.joints, #self.motors, self.parts)"),
            "1\tpart 'ball/ball'\t0\t0\tlist of parts");
  EXPECT_EQ(step_says("for i, part in ipairs(self.parts) do print(i, part) end"), "1\tpart 'ball/ball'");
  EXPECT_EQ(step_says("for i, part in pairs(self.parts) do print(i, part) end"), "1\tpart 'ball/ball'");
  EXPECT_EQ(step_says("print(self.time == sim.time, self.alive, self.body == sim:body('ball'))"), "true\ttrue\ttrue");
  EXPECT_EQ(step_says("print(self == self, ({ [self] = 'key' })[self])"), "true\tkey");
}

TEST(LuaBehavior, ParametersAreReadAndWrittenThroughTheDoor) {
  EXPECT_EQ(step_says("print(self.speed, self.way)", "{ speed = 4 }"), "4\tvec3(1, 0, 0)");
  EXPECT_EQ(step_says("self.speed = 2.5 self.way = { 1, 2, 3 } print(self.speed, self.way)"), "2.5\tvec3(1, 2, 3)");
  EXPECT_EQ(step_says("self.speed = 12 print(self.speed)"), "10") << "clamped";
  EXPECT_EQ(step_says("self.speed = 0/0"),
            "behaviors_lua/test.lua:2: behavior 'ball/it': 'speed' takes finite numbers, not nan");
  EXPECT_EQ(step_says("self.speed = 'fast'"),
            "behaviors_lua/test.lua:2: behavior 'ball/it': 'speed' takes a number, not 'fast'");
  // what a hand sets is seen at once
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(stepping("print(self.speed)"), 1), "");
  stage.set("speed", 7);
  stage.tick();
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"1", "7"}));
}

TEST(LuaBehavior, WrongMembersAreExplained) {
  const std::string at = "behaviors_lua/test.lua:2: ";
  EXPECT_EQ(step_says("print(self.motor)"), at + "behavior 'ball/it' has no property 'motor'; did you mean 'motors'?");
  EXPECT_EQ(step_says("self.sped = 1"), at + "behavior 'ball/it' has no property 'sped'; did you mean 'speed'?");
  EXPECT_EQ(step_says("self.parts = {}"), at + "behavior 'ball/it': 'parts' can be read, not set");
  EXPECT_EQ(step_says("self.parts[1] = 3"), at + "the list of parts can't be changed by hand");
  EXPECT_EQ(step_says("self.state = 3"), at + "behavior 'ball/it': state is a table, not 3");
  EXPECT_EQ(step_says("self.due('speed')"),
            at + "due is a method of a behavior: write it with a colon, behavior:due(…), not with a dot");
  EXPECT_EQ(step_says("self:due('sped')"),
            at + "behavior 'ball/it': due takes the name of a parameter in quotes, not 'sped'; did you mean 'speed'?");
  EXPECT_EQ(step_says("self:due(500)"),
            at + "behavior 'ball/it': due takes the name of a parameter in quotes, not 500; there are: speed");
  EXPECT_EQ(step_says("self:due('way')"),
            at + "behavior 'ball/it': 'way' is no number of milliseconds; due takes the name of a number");
  EXPECT_EQ(step_says("self:remove()").substr(0, 72), at + "behavior 'ball/it' has no property 'remove'; t");
}

TEST(LuaBehavior, IntervalsAreThoseOfTheBuiltInOnes) {
  // a tick of 1/60 s is 16.7 ms; 25 ms fire at 0, 33.3 (25 has passed), 50, 83.3 (75), 100 …
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one("return behavior { params = { { 'pause', 25, unit = 'ms' } },\n"
                           "step = function(self) if self:due('pause') then print(sim.tick) end end }",
                           13),
            "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"0", "2", "3", "5", "6", "8", "9", "11", "12"}));
}

TEST(LuaBehavior, DrawsAsItsSeedAndPathSay) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(stepping("print(self.rng:uniform(), self.rng:uniform(vec3(), vec3(1, 2, 3)))"), 1), "");
  Random expected(stage.world.seed(), "/physics/body/ball/behavior/it");
  const double u = expected.uniform();
  const double x = expected.uniform();
  const double y = expected.uniform();
  const double z = expected.uniform();
  EXPECT_EQ(stage.host.printed.back(), fmt::format("{:.14g}\tvec3({:.14g}, {:.14g}, {:.14g})", u, x, 2 * y, 3 * z));
}

TEST(LuaBehavior, AFilesOwnDrawsDisturbNobody) {
  const auto draws = [](const std::string& step) {
    BehaviorStage stage;
    stage.write("behaviors_lua/test.lua", stepping(step));
    EXPECT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior("test", "it")
sim:on_step(function() print(math.random(), rng:uniform()) end)
)",
                         3),
              "");
    return stage.host.printed;
  };
  EXPECT_EQ(draws("local _ = math.random() + rng:uniform() + self.rng:uniform()"), draws(""));
  // but they repeat, and count in the hash
  const auto hash = [](const std::string& step) {
    BehaviorStage stage({}, true);
    EXPECT_EQ(stage.play_one(stepping(step), 1), "");
    return stage.scene.state_hash(stage.world.state_hash());
  };
  EXPECT_EQ(hash("math.random()"), hash("math.random()"));
  EXPECT_NE(hash("math.random()"), hash("math.random() math.random()"));
}

TEST(LuaBehavior, MakesNothingAndRegistersNothing) {
  const auto refused = [](const std::string& call) {
    return "behaviors_lua/test.lua:2: " + call +
           " makes or registers something: that is the scene's; a behavior moves what is there";
  };
  EXPECT_EQ(step_says("sim:on_step(print)"), refused("sim:on_step"));
  EXPECT_EQ(step_says("sim:every(1, print)"), refused("sim:every"));
  EXPECT_EQ(step_says("sim:add_body('x')"), refused("sim:add_body"));
  EXPECT_EQ(step_says("sim:load_urdf('x.urdf')"), refused("sim:load_urdf"));
  EXPECT_EQ(step_says("self.body:copy('x')"), refused("body:copy"));
  EXPECT_EQ(step_says("self.body:add_behavior('force', 'x')"), refused("body:add_behavior"));
  EXPECT_EQ(step_says("osc:on('/x', print)"), refused("osc:on"));
  EXPECT_EQ(step_says("sim:after(1, print)"), refused("sim:after"));
  EXPECT_EQ(
      load_error("sim:add_body('x')\nreturn behavior { step = function() end }"),
      "behaviors_lua/test.lua:1: sim:add_body makes or registers something: that is the scene's; a behavior moves "
      "what is there");
  EXPECT_EQ(load_error("sim:body('ball').root:apply_force(vec3())"),
            "behaviors_lua/test.lua:1: part 'ball/ball':apply_force acts on the running scene; a behavior acts in its "
            "start and step");
  // what else a scene can do, it can
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(stepping("osc:send('/hello', self.speed)"), 1), "");
  EXPECT_EQ(stage.host.sent.size(), 1u);
}

TEST(LuaBehavior, HasAnEnvironmentOfItsOwn) {
  EXPECT_EQ(step_says("print(state)"),
            "behaviors_lua/test.lua:2: there is no global 'state'; a behavior keeps what it remembers in self.state");
  EXPECT_EQ(step_says("behavior {}"), "behaviors_lua/test.lua:2: there is no global 'behavior'");
  EXPECT_EQ(error_of("behavior {}"),
            "scripts/scene.lua:1: there is no global 'behavior'; a behavior is a file of its own in behaviors_lua/");
  BehaviorStage stage;
  stage.write("behaviors_lua/a.lua", "math.sin = nil x = 1 return behavior { step = function() print(x) end }");
  stage.write("behaviors_lua/b.lua",
              "return behavior { step = function() print(math.sin(0), pcall(function() return x end)) end }");
  ASSERT_EQ(stage.play(std::string(kBall) + "ball:add_behavior('a', 'a') ball:add_behavior('b', 'b')", 1), "");
  EXPECT_EQ(stage.host.printed,
            (std::vector<std::string>{"1", "0\tfalse\tbehaviors_lua/b.lua:1: there is no global 'x'"}));
}

TEST(LuaBehavior, InstancesShareNoState) {
  BehaviorStage stage;
  stage.write("behaviors_lua/test.lua",
              "return behavior { step = function(self) self.state[self.body.name] = true\n"
              "local n = 0 for _ in pairs(self.state) do n = n + 1 end print(n) end }");
  ASSERT_EQ(
      stage.play(std::string(kBall) + "ball:add_behavior('test', 'it') ball:copy('twin', { position = vec3(5, 0, 0) })",
                 2),
      "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"1", "1", "1", "1"}));
}

TEST(LuaBehavior, AFaultSuspendsItAloneUntilItIsTriedAgain) {
  BehaviorStage stage;
  std::vector<BehaviorFault> said;
  stage.world.behaviors().on_fault([&](const Behavior& b) { said.push_back(b.fault()); });
  stage.write("behaviors_lua/test.lua",
              "return behavior { params = { { 'bad', true } },\n"
              "start = function(self) print('start') end,\n"
              "step = function(self) if self.bad then\n"
              "  local x = nil + 1 end\n"
              "  print('ok') end }");
  stage.write("behaviors_lua/other.lua", "return behavior { step = function() print('tick') end }");
  ASSERT_EQ(stage.play(std::string(kBall) + "ball:add_behavior('test', 'it') ball:add_behavior('other', 'o')", 3), "");
  ASSERT_EQ(said.size(), 1u) << "said once";
  EXPECT_EQ(said[0].file, "behaviors_lua/test.lua");
  EXPECT_EQ(said[0].line, 4);
  EXPECT_EQ(first_line(said[0].text), "behaviors_lua/test.lua:4: attempt to perform arithmetic on a nil value");
  EXPECT_NE(said[0].text.find("\n  4 |   local x = nil + 1 end"), std::string::npos) << said[0].text;
  EXPECT_NE(said[0].text.find("stack traceback:"), std::string::npos);
  EXPECT_EQ(stage.it().error(), said[0].text);
  EXPECT_TRUE(stage.it().active()) << "active stays as it was";
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"start", "tick", "tick", "tick"}));
  stage.host.printed.clear();
  stage.set("bad", 0);
  stage.tick();
  stage.set("active", 1);
  stage.tick();
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"tick", "ok", "tick"})) << "no start again";
  EXPECT_EQ(stage.it().error(), "");
  stage.world.behaviors().on_fault({});
}

// members of a group step in one call; what one of them does to those behind it counts at once
TEST(LuaBehavior, AMemberThatAnotherSwitchesOffRests) {
  BehaviorStage stage;
  stage.write("behaviors_lua/test.lua", R"(
return behavior { group = true, step = function(self)
  print(self.body.name)
  if self.body.name == "a" then sim:body("b"):behavior("all").active = false end
  if self.body.name == "c" then sim:body("d").enabled = false end
  if self.body.name == "e" then sim:body("f"):behavior("all"):remove() end
end })");
  ASSERT_EQ(stage.play(R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i, name in ipairs { "a", "b", "c", "d", "e", "f", "g" } do
  sim:add_body(name):add_part("ball", ball, { position = vec3(i, 0, 0) })
end
sim:add_group_behavior("test", "all")
)",
                       1),
            "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"a", "c", "e", "g"}));
  stage.host.printed.clear();
  const double on = 1;
  const Behavior& b = *stage.world.find_body("b")->find_behavior("all");
  ASSERT_TRUE(stage.store.set(b.id(), "active", {&on, 1}).ok());
  stage.world.find_body("d")->set_enabled(true);
  stage.tick();
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"a", "c", "e", "g"}));
}

TEST(LuaBehavior, OneThatFailsInItsStartTriesThatAgain) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one("return behavior { params = { { 'bad', true } },\n"
                           "start = function(self) if self.bad then error('no') end print('start') end,\n"
                           "step = function(self) print('step') end }",
                           2),
            "");
  EXPECT_EQ(first_line(stage.it().error()), "behaviors_lua/test.lua:2: no");
  stage.set("bad", 0);
  stage.set("active", 1);
  stage.tick();
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"start", "step"}));
}

}  // namespace
}  // namespace limber
