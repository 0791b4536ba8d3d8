// Behaviours and groups by the rule of reloading: those of C++ and those of files.
#include "engine/edited.h"
#include "sim/behavior_list.h"

namespace limber::engine_test {
namespace {

constexpr const char* kBehaviorShow = R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 3 do
  local body = sim:add_body("b" .. i)
  body:add_part("p", ball, { position = vec3(i, 0, 0) })
end
local b1 = sim:body("b1")
b1:add_behavior("force", "push", { amp = 1, dir = vec3(1, 0, 0) })
b1:add_behavior("count", "counter")
sim:add_group_behavior("cohesion", "together", { amount = 2 })
--MORE
)";
constexpr const char* kCount = R"(return behavior {
  params = { { "by", 1 } },
  start = function(self) self.state.n = 0 end,
  step = function(self) self.state.n = self.state.n + self.by self.body:part("p").friction = self.state.n / 1000 end,
}
)";

Edited a_show() { return Edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}}); }

double value(Edited& edited, const std::string& body, const std::string& behavior, const std::string& row) {
  const Behavior& b = *edited.body(body).find_behavior(behavior);
  double out[4] = {};
  b.store().get(b.id(), b.store().table(b.id()).at(row), out);
  return out[0];
}
void hand(Edited& edited, const std::string& body, const std::string& behavior, const std::string& row, double value) {
  const Behavior& b = *edited.body(body).find_behavior(behavior);
  ASSERT_TRUE(b.store().set(b.id(), row, {&value, 1}).ok());
}
double counted(Edited& edited) {
  return 1000 * edited.world().store().values(edited.part("b1", "p").id(), Part::table().at("friction"))[0];
}

TEST(ReloadBehaviors, WhatIsSaidAsBeforeStaysAsTheHandLeftIt) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  hand(edited, "b1", "push", "amp", 7);
  hand(edited, "b2", "together", "amount", 9);
  EXPECT_EQ(edited.edit("--MORE", "-- nothing"), Reload::End::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 7);
  EXPECT_EQ(value(edited, "b2", "together", "amount"), 9);
  EXPECT_EQ(value(edited, "b3", "together", "amount"), 2);
  EXPECT_EQ(edited.edit("amp = 1", "amp = 3"), Reload::End::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 3);
  EXPECT_EQ(edited.edit("amount = 2", "amount = 4"), Reload::End::applied);
  EXPECT_EQ(value(edited, "b2", "together", "amount"), 4);
  EXPECT_EQ(edited.edit("amp = 3, ", ""), Reload::End::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 0) << "no longer said: the default";
}

TEST(ReloadBehaviors, AnEditThatChangesNothingChangesNoBit) {
  Edited edited = a_show();
  Edited control = a_show();
  for (int i = 0; i < 4; i++) {
    edited.show().ticks(7);
    control.show().ticks(7);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), Reload::End::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadBehaviors, StateOfAFileIsKeptAndItsNewFormulaActs) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  EXPECT_NEAR(counted(edited), 10, 1e-9);
  std::string faster = kCount;
  faster.replace(faster.find("self.state.n + self.by"), 22, "self.state.n + 5 * self.by");
  edited.folder.write("behaviors_lua/count.lua", faster);
  EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::applied);
  edited.show().ticks(2);
  EXPECT_NEAR(counted(edited), 20, 1e-9);
}

TEST(ReloadBehaviors, MigrateBringsTheStateOver) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  edited.folder.write("behaviors_lua/count.lua", R"(return behavior {
  start = function(self) self.state.total = 0 end,
  step = function(self) self.body:part("p").friction = self.state.total / 1000 end,
  migrate = function(self, old) return { total = old.n * 2 } end,
})");
  EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::applied);
  edited.show().ticks(1);
  EXPECT_NEAR(counted(edited), 20, 1e-9);
}

TEST(ReloadBehaviors, ParametersOfAFileFollowItsEdits) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  hand(edited, "b1", "counter", "by", 3);
  const auto declare = [&](const std::string& params) {
    std::string text = kCount;
    text.replace(text.find("{ \"by\", 1 }"), 11, params);
    edited.folder.write("behaviors_lua/count.lua", text);
    EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::applied);
  };
  declare("{ \"by\", 1 }, { \"more\", 4 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 3);
  EXPECT_EQ(value(edited, "b1", "counter", "more"), 4);
  declare("{ \"by\", 1, max = 2 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 2) << "clamped to the new range";
  declare("{ \"by\", 1.5, max = 2 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 1.5) << "an edited default is applied";
}

TEST(ReloadBehaviors, TheyComeGoAndAreMadeAnew) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  EXPECT_EQ(edited.edit("--MORE", R"(b1:add_behavior("speed", "pace", { speed = 2 })
sim:add_group_behavior("separation", "apart")
--MORE)"),
            Reload::End::applied);
  EXPECT_EQ(value(edited, "b1", "pace", "speed"), 2);
  EXPECT_NE(edited.body("b3").find_behavior("apart"), nullptr);
  EXPECT_EQ(edited.edit("\"speed\", \"pace\", { speed = 2 }", "\"torque\", \"pace\", { scale = 3 }"),
            Reload::End::applied);
  EXPECT_EQ(edited.body("b1").find_behavior("pace")->type().name, "torque");
  EXPECT_EQ(edited.edit("b1:add_behavior(\"torque\", \"pace\", { scale = 3 })", ""), Reload::End::applied);
  EXPECT_EQ(edited.body("b1").find_behavior("pace"), nullptr);
  EXPECT_EQ(edited.edit("sim:add_group_behavior(\"separation\", \"apart\")", ""), Reload::End::applied);
  EXPECT_EQ(edited.body("b3").find_behavior("apart"), nullptr);
  EXPECT_EQ(edited.edit("\"together\", { amount = 2 }", "\"together\", { bodies = \"b[12]\", amount = 2 }"),
            Reload::End::applied);
  EXPECT_EQ(edited.body("b3").find_behavior("together"), nullptr);
  EXPECT_NE(edited.body("b2").find_behavior("together"), nullptr);
}

TEST(ReloadBehaviors, TheyActInTheOrderOfTheScene) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  EXPECT_EQ(edited.world().behaviors().order(), (std::vector<std::string>{"b1/push", "b1/counter", "/together"}));
  EXPECT_EQ(edited.edit("b1:add_behavior(\"force\", \"push\", { amp = 1, dir = vec3(1, 0, 0) })\n", ""),
            Reload::End::applied);
  EXPECT_EQ(edited.edit("--MORE", "b1:add_behavior(\"force\", \"push\")"), Reload::End::applied);
  EXPECT_EQ(edited.world().behaviors().order(), (std::vector<std::string>{"b1/counter", "/together", "b1/push"}));
  EXPECT_EQ(edited.save(std::string("local b\n") + kBehaviorShow), Reload::End::applied);
  EXPECT_EQ(edited.world().behaviors().order(), (std::vector<std::string>{"b1/push", "b1/counter", "/together"}));
}

TEST(ReloadBehaviors, OfABodyThatIsMadeAnewTheyKeepTheirValues) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  hand(edited, "b1", "push", "amp", 5);
  EXPECT_EQ(edited.edit("sphere_shape(\"ball\", 0.05)", "sphere_shape(\"ball\", 0.1)"), Reload::End::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 5);
  EXPECT_NE(edited.body("b1").find_behavior("counter"), nullptr);
  edited.show().ticks(3);
  EXPECT_NE(edited.body("b1").find_behavior("together"), nullptr);
  EXPECT_EQ(edited.body("b1").find_behavior("counter")->error(), "");
}

TEST(ReloadBehaviors, HandlesOfTheNewRunMeanTheLiveOnes) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  EXPECT_EQ(edited.edit("--MORE", R"(local push, group = b1:behavior("push"), sim:group_behavior("together")
osc:on("/amp", function(x) push.amp = x group.amount = x end))"),
            Reload::End::applied);
  edited.show().send("/amp", 6.0);
  edited.show().ticks(1);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 6);
  EXPECT_EQ(value(edited, "b3", "together", "amount"), 6);
}

TEST(ReloadBehaviors, ABrokenFileChangesNothingAMendedOneTriesAgain) {
  Edited edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(5);
  edited.folder.write("behaviors_lua/count.lua", "return behavior {");
  EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::failed);
  edited.show().ticks(5);
  EXPECT_NEAR(counted(edited), 10, 1e-9);
  std::string erring = kCount;
  erring.replace(erring.find("self.state.n = self.state.n + self.by"), 37, "self.state.n = nothing.x");
  edited.folder.write("behaviors_lua/count.lua", erring);
  EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::applied);
  edited.show().ticks(2);
  EXPECT_NE(edited.body("b1").find_behavior("counter")->error().find("count.lua:4: there is no global 'nothing'"),
            std::string::npos);
  edited.folder.write("behaviors_lua/count.lua", kCount);
  EXPECT_EQ(edited.show().engine.reload_now(), Reload::End::applied);
  edited.show().ticks(2);
  EXPECT_EQ(edited.body("b1").find_behavior("counter")->error(), "");
  EXPECT_NEAR(counted(edited), 12, 1e-9) << "it goes on counting";
}

}  // namespace
}  // namespace limber::engine_test
