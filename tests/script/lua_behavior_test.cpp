// Behaviors in Lua: start, step, self, errors, state after a reload.
#include "script/behaviors/lua_behavior.h"

#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber::script {
namespace {

TEST(LuaBehavior, StartsOnceThenStepsWhileActive) {
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one(R"(
return behavior {
  start = function(self) self.state.steps = 0 print("start") end,
  step = function(self, dt) self.state.steps = self.state.steps + 1 print(self.state.steps, self.time, dt == sim.timestep) end,
}
)",
                             2),
            "");
  fixture.set("active", 0);
  fixture.tick(3);
  fixture.set("active", 1);
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"start", "1\t0\ttrue", "2\t0.016666666666667\ttrue",
                                                            "3\t0.083333333333333\ttrue"}));
  // a reset of the body calls start again
  fixture.world.find_body("ball")->recovery().reset();
  fixture.tick();
  EXPECT_EQ(fixture.host.printed.back(), "1\t0.1\ttrue");
}

TEST(LuaBehavior, RestartsAfterANewPart) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", R"(
return behavior {
  start = function(self) print("start", #self.parts) end,
  step = function(self) end,
}
)");
  ASSERT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior("test", "it")
sim:after(0.05, function() ball:add_part("more", "ball") end)
)",
                         6),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"start\t1", "start\t2"}));
}

TEST(LuaBehavior, ForcesActInTheSameTick) {
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one(
                behavior_with_step("for _, part in ipairs(self.parts) do part:apply_force(self.way * self.speed) end"),
                1, "{ speed = 3, way = vec3(0, 2, 0) }"),
            "");
  // F = 6 N on 2 kg for 1/60 s
  EXPECT_NEAR(fixture.world.find_body("ball")->root()->linear_velocity().y, 3.0 / 60, 1e-6);
}

TEST(LuaBehavior, SelfHasNameTypeAndBody) {
  EXPECT_EQ(step_output("print(self.name, self.type, self.body, self.active, self)"),
            "it\ttest\tbody 'ball'\ttrue\tbehavior 'ball/it'");
  EXPECT_EQ(step_output("print(#self.parts, self.parts[1], #self.joints, #self.motors, self.parts)"),
            "1\tpart 'ball/ball'\t0\t0\tlist of parts");
  EXPECT_EQ(step_output("for i, part in ipairs(self.parts) do print(i, part) end"), "1\tpart 'ball/ball'");
  EXPECT_EQ(step_output("for i, part in pairs(self.parts) do print(i, part) end"), "1\tpart 'ball/ball'");
  EXPECT_EQ(step_output("print(self.time == sim.time, self.alive, self.body == sim:body('ball'))"), "true\ttrue\ttrue");
  EXPECT_EQ(step_output("print(self == self, ({ [self] = 'key' })[self])"), "true\tkey");
}

TEST(LuaBehavior, ParametersAreReadAndWrittenThroughTheStore) {
  EXPECT_EQ(step_output("print(self.speed, self.way)", "{ speed = 4 }"), "4\tvec3(1, 0, 0)");
  EXPECT_EQ(step_output("self.speed = 2.5 self.way = { 1, 2, 3 } print(self.speed, self.way)"), "2.5\tvec3(1, 2, 3)");
  EXPECT_EQ(step_output("self.speed = 12 print(self.speed)"), "10") << "clamped";
  EXPECT_EQ(step_output("self.speed = 0/0"),
            "behaviors_lua/test.lua:2: behavior 'ball/it': 'speed' takes finite numbers, not nan");
  EXPECT_EQ(step_output("self.speed = 'fast'"),
            "behaviors_lua/test.lua:2: behavior 'ball/it': 'speed' takes a number, not 'fast'");
  // a value set by a controller is visible at once
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one(behavior_with_step("print(self.speed)"), 1), "");
  fixture.set("speed", 7);
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"1", "7"}));
}

TEST(LuaBehavior, WrongMembersAreExplained) {
  const std::string at = "behaviors_lua/test.lua:2: ";
  EXPECT_EQ(step_output("print(self.motor)"),
            at + "behavior 'ball/it' has no property 'motor'; did you mean 'motors'?");
  EXPECT_EQ(step_output("self.sped = 1"), at + "behavior 'ball/it' has no property 'sped'; did you mean 'speed'?");
  EXPECT_EQ(step_output("self.parts = {}"), at + "behavior 'ball/it': 'parts' can be read, not set");
  EXPECT_EQ(step_output("self.parts[1] = 3"), at + "the list of parts is read-only");
  EXPECT_EQ(step_output("self.state = 3"), at + "behavior 'ball/it': state is a table, not 3");
  EXPECT_EQ(step_output("self.due('speed')"),
            at + "due is a method of a behavior: write it with a colon, behavior:due(…), not with a dot");
  EXPECT_EQ(step_output("self:due('sped')"),
            at + "behavior 'ball/it': due takes the name of a parameter in quotes, not 'sped'; did you mean 'speed'?");
  EXPECT_EQ(step_output("self:due(500)"),
            at + "behavior 'ball/it': due takes the name of a parameter in quotes, not 500; there are: speed");
  EXPECT_EQ(step_output("self:due('way')"),
            at + "behavior 'ball/it': 'way' is not a number of milliseconds; due takes the name of a number parameter");
  EXPECT_EQ(step_output("self:remove()").substr(0, 72), at + "behavior 'ball/it' has no property 'remove'; t");
}

TEST(LuaBehavior, IntervalsMatchBuiltInBehaviors) {
  // a tick of 1/60 s is 16.7 ms; 25 ms elapse at 0, 33.3 (25 has passed), 50, 83.3 (75), 100 …
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one("return behavior { params = { { 'pause', 25, unit = 'ms' } },\n"
                             "step = function(self) if self:due('pause') then print(sim.tick) end end }",
                             13),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"0", "2", "3", "5", "6", "8", "9", "11", "12"}));
}

TEST(LuaBehavior, RandomDrawsDependOnSeedAndPath) {
  BehaviorFixture fixture;
  ASSERT_EQ(
      fixture.play_one(behavior_with_step("print(self.rng:uniform(), self.rng:uniform(vec3(), vec3(1, 2, 3)))"), 1),
      "");
  Random expected(fixture.world.seed(), "/physics/body/ball/behavior/it");
  const double u = expected.uniform();
  const double x = expected.uniform();
  const double y = expected.uniform();
  const double z = expected.uniform();
  EXPECT_EQ(fixture.host.printed.back(), fmt::format("{:.14g}\tvec3({:.14g}, {:.14g}, {:.14g})", u, x, 2 * y, 3 * z));
}

TEST(LuaBehavior, AFilesDrawsDoNotAffectOthers) {
  const auto draws = [](const std::string& step) {
    BehaviorFixture fixture;
    fixture.write("behaviors_lua/test.lua", behavior_with_step(step));
    EXPECT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior("test", "it")
sim:on_step(function() print(math.random(), rng:uniform()) end)
)",
                           3),
              "");
    return fixture.host.printed;
  };
  EXPECT_EQ(draws("local _ = math.random() + rng:uniform() + self.rng:uniform()"), draws(""));
  // but they are reproducible, and included in the hash
  const auto hash = [](const std::string& step) {
    BehaviorFixture fixture({}, true);
    EXPECT_EQ(fixture.play_one(behavior_with_step(step), 1), "");
    return fixture.scene.state_hash(fixture.world.state_hash());
  };
  EXPECT_EQ(hash("math.random()"), hash("math.random()"));
  EXPECT_NE(hash("math.random()"), hash("math.random() math.random()"));
}

TEST(LuaBehavior, CanNotCreateOrRegister) {
  const auto rejection = [](const std::string& call) {
    return "behaviors_lua/test.lua:2: " + call +
           " creates or registers something, which only a scene can do; a behavior controls existing objects";
  };
  EXPECT_EQ(step_output("sim:on_step(print)"), rejection("sim:on_step"));
  EXPECT_EQ(step_output("sim:every(1, print)"), rejection("sim:every"));
  EXPECT_EQ(step_output("sim:add_body('x')"), rejection("sim:add_body"));
  EXPECT_EQ(step_output("sim:load_urdf('x.urdf')"), rejection("sim:load_urdf"));
  EXPECT_EQ(step_output("self.body:copy('x')"), rejection("body:copy"));
  EXPECT_EQ(step_output("self.body:add_behavior('force', 'x')"), rejection("body:add_behavior"));
  EXPECT_EQ(step_output("osc:on('/x', print)"), rejection("osc:on"));
  EXPECT_EQ(step_output("sim:after(1, print)"), rejection("sim:after"));
  EXPECT_EQ(
      load_error("sim:add_body('x')\nreturn behavior { step = function() end }"),
      "behaviors_lua/test.lua:1: sim:add_body creates or registers something, which only a scene can do; a behavior "
      "controls existing objects");
  EXPECT_EQ(load_error("sim:body('ball').root:apply_force(vec3())"),
            "behaviors_lua/test.lua:1: part 'ball/ball':apply_force acts on the running scene; a behavior acts in its "
            "start and step");
  // all other functions of a scene are available
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one(behavior_with_step("osc:send('/hello', self.speed)"), 1), "");
  EXPECT_EQ(fixture.host.sent.size(), 1u);
}

TEST(LuaBehavior, HasAnEnvironmentOfItsOwn) {
  EXPECT_EQ(step_output("print(state)"),
            "behaviors_lua/test.lua:2: there is no global 'state'; a behavior stores its state in self.state");
  EXPECT_EQ(step_output("behavior {}"), "behaviors_lua/test.lua:2: there is no global 'behavior'");
  EXPECT_EQ(error_of("behavior {}"),
            "scripts/scene.lua:1: there is no global 'behavior'; a behavior is a file of its own in behaviors_lua/");
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/a.lua", "math.sin = nil x = 1 return behavior { step = function() print(x) end }");
  fixture.write("behaviors_lua/b.lua",
                "return behavior { step = function() print(math.sin(0), pcall(function() return x end)) end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('a', 'a') ball:add_behavior('b', 'b')", 1), "");
  EXPECT_EQ(fixture.host.printed,
            (std::vector<std::string>{"1", "0\tfalse\tbehaviors_lua/b.lua:1: there is no global 'x'"}));
}

TEST(LuaBehavior, InstancesShareNoState) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua",
                "return behavior { step = function(self) self.state[self.body.name] = true\n"
                "local n = 0 for _ in pairs(self.state) do n = n + 1 end print(n) end }");
  ASSERT_EQ(
      fixture.play(
          std::string(kBall) + "ball:add_behavior('test', 'it') ball:copy('twin', { position = vec3(5, 0, 0) })", 2),
      "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"1", "1", "1", "1"}));
}

TEST(LuaBehavior, AFaultSuspendsOnlyTheInstance) {
  BehaviorFixture fixture;
  std::vector<sim::BehaviorFault> faults;
  fixture.world.behaviors().on_fault([&](const sim::Behavior& b) { faults.push_back(b.fault()); });
  fixture.write("behaviors_lua/test.lua",
                "return behavior { params = { { 'bad', true } },\n"
                "start = function(self) print('start') end,\n"
                "step = function(self) if self.bad then\n"
                "  local x = nil + 1 end\n"
                "  print('ok') end }");
  fixture.write("behaviors_lua/other.lua", "return behavior { step = function() print('tick') end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('test', 'it') ball:add_behavior('other', 'o')", 3),
            "");
  ASSERT_EQ(faults.size(), 1u) << "reported once";
  EXPECT_EQ(faults[0].file, "behaviors_lua/test.lua");
  EXPECT_EQ(faults[0].line, 4);
  EXPECT_EQ(first_line(faults[0].text), "behaviors_lua/test.lua:4: attempt to perform arithmetic on a nil value");
  EXPECT_NE(faults[0].text.find("\n  4 |   local x = nil + 1 end"), std::string::npos) << faults[0].text;
  EXPECT_NE(faults[0].text.find("stack traceback:"), std::string::npos);
  EXPECT_EQ(fixture.it().error(), faults[0].text);
  EXPECT_TRUE(fixture.it().active()) << "active is unchanged";
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"start", "tick", "tick", "tick"}));
  fixture.host.printed.clear();
  fixture.set("bad", 0);
  fixture.tick();
  fixture.set("active", 1);
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"tick", "ok", "tick"})) << "start is not called again";
  EXPECT_EQ(fixture.it().error(), "");
  fixture.world.behaviors().on_fault({});
}

// members of a group step in one call; effects of one on later ones apply at once
TEST(LuaBehavior, AMemberSwitchedOffByAnotherIsNotStepped) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", R"(
return behavior { group = true, step = function(self)
  print(self.body.name)
  if self.body.name == "a" then sim:body("b"):behavior("all").active = false end
  if self.body.name == "c" then sim:body("d").enabled = false end
  if self.body.name == "e" then sim:body("f"):behavior("all"):remove() end
end })");
  ASSERT_EQ(fixture.play(R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i, name in ipairs { "a", "b", "c", "d", "e", "f", "g" } do
  sim:add_body(name):add_part("ball", ball, { position = vec3(i, 0, 0) })
end
sim:add_group_behavior("test", "all")
)",
                         1),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"a", "c", "e", "g"}));
  fixture.host.printed.clear();
  const double on = 1;
  const sim::Behavior& b = *fixture.world.find_body("b")->behaviors().find("all");
  ASSERT_TRUE(fixture.store.set(b.id(), "active", {&on, 1}).ok());
  fixture.world.find_body("d")->set_enabled(true);
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"a", "c", "e", "g"}));
}

TEST(LuaBehavior, AFailedStartIsRetried) {
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one("return behavior { params = { { 'bad', true } },\n"
                             "start = function(self) if self.bad then error('no') end print('start') end,\n"
                             "step = function(self) print('step') end }",
                             2),
            "");
  EXPECT_EQ(first_line(fixture.it().error()), "behaviors_lua/test.lua:2: no");
  fixture.set("bad", 0);
  fixture.set("active", 1);
  fixture.tick();
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"start", "step"}));
}

}  // namespace
}  // namespace limber::script
