// Behaviors and groups in a reload: built-in types and types from files.
#include "engine/edited.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine::test {
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

EditedShow make_show() { return EditedShow(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}}); }

double value(EditedShow& edited, const std::string& body, const std::string& behavior, const std::string& property) {
  const sim::Behavior& b = *edited.body(body).behaviors().find(behavior);
  double out[4] = {};
  b.store().get(b.id(), b.store().table(b.id()).at(property), out);
  return out[0];
}
void override_value(EditedShow& edited, const std::string& body, const std::string& behavior,
                    const std::string& property, double value) {
  const sim::Behavior& b = *edited.body(body).behaviors().find(behavior);
  ASSERT_TRUE(b.store().set(b.id(), property, {&value, 1}).ok());
}
double step_count(EditedShow& edited) {
  return 1000 * edited.world().store().values(edited.part("b1", "p").id(), sim::Part::table().at("friction"))[0];
}

TEST(ReloadBehaviors, UnchangedDeclarationsKeepOverrides) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  override_value(edited, "b1", "push", "amp", 7);
  override_value(edited, "b2", "together", "amount", 9);
  EXPECT_EQ(edited.edit("--MORE", "-- nothing"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 7);
  EXPECT_EQ(value(edited, "b2", "together", "amount"), 9);
  EXPECT_EQ(value(edited, "b3", "together", "amount"), 2);
  EXPECT_EQ(edited.edit("amp = 1", "amp = 3"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 3);
  EXPECT_EQ(edited.edit("amount = 2", "amount = 4"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b2", "together", "amount"), 4);
  EXPECT_EQ(edited.edit("amp = 3, ", ""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 0) << "no longer set: the default";
}

TEST(ReloadBehaviors, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited = make_show();
  EditedShow control = make_show();
  for (int i = 0; i < 4; i++) {
    edited.show().ticks(7);
    control.show().ticks(7);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadBehaviors, StateIsPreservedAndTheNewCodeRuns) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  EXPECT_NEAR(step_count(edited), 10, 1e-9);
  std::string faster = kCount;
  faster.replace(faster.find("self.state.n + self.by"), 22, "self.state.n + 5 * self.by");
  edited.folder.write("behaviors_lua/count.lua", faster);
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  edited.show().ticks(2);
  EXPECT_NEAR(step_count(edited), 20, 1e-9);
}

TEST(ReloadBehaviors, MigrateConvertsTheState) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  edited.folder.write("behaviors_lua/count.lua", R"(return behavior {
  start = function(self) self.state.total = 0 end,
  step = function(self) self.body:part("p").friction = self.state.total / 1000 end,
  migrate = function(self, old) return { total = old.n * 2 } end,
})");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_NEAR(step_count(edited), 20, 1e-9);
}

TEST(ReloadBehaviors, ParametersFollowEditsOfTheFile) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(10);
  override_value(edited, "b1", "counter", "by", 3);
  const auto declare = [&](const std::string& params) {
    std::string text = kCount;
    text.replace(text.find("{ \"by\", 1 }"), 11, params);
    edited.folder.write("behaviors_lua/count.lua", text);
    EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  };
  declare("{ \"by\", 1 }, { \"more\", 4 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 3);
  EXPECT_EQ(value(edited, "b1", "counter", "more"), 4);
  declare("{ \"by\", 1, max = 2 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 2) << "clamped to the new range";
  declare("{ \"by\", 1.5, max = 2 }");
  EXPECT_EQ(value(edited, "b1", "counter", "by"), 1.5) << "an edited default is applied";
}

TEST(ReloadBehaviors, AreAddedRemovedAndRebuilt) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  EXPECT_EQ(edited.edit("--MORE", R"(b1:add_behavior("speed", "pace", { speed = 2 })
sim:add_group_behavior("separation", "apart")
--MORE)"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b1", "pace", "speed"), 2);
  EXPECT_NE(edited.body("b3").behaviors().find("apart"), nullptr);
  EXPECT_EQ(edited.edit("\"speed\", \"pace\", { speed = 2 }", "\"torque\", \"pace\", { scale = 3 }"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.body("b1").behaviors().find("pace")->type().name, "torque");
  EXPECT_EQ(edited.edit("b1:add_behavior(\"torque\", \"pace\", { scale = 3 })", ""),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.body("b1").behaviors().find("pace"), nullptr);
  EXPECT_EQ(edited.edit("sim:add_group_behavior(\"separation\", \"apart\")", ""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.body("b3").behaviors().find("apart"), nullptr);
  EXPECT_EQ(edited.edit("\"together\", { amount = 2 }", "\"together\", { bodies = \"b[12]\", amount = 2 }"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.body("b3").behaviors().find("together"), nullptr);
  EXPECT_NE(edited.body("b2").behaviors().find("together"), nullptr);
}

TEST(ReloadBehaviors, RunInTheOrderOfTheScene) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  EXPECT_EQ(edited.world().behaviors().order().keys(),
            (std::vector<std::string>{"b1/push", "b1/counter", "/together"}));
  EXPECT_EQ(edited.edit("b1:add_behavior(\"force\", \"push\", { amp = 1, dir = vec3(1, 0, 0) })\n", ""),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.edit("--MORE", "b1:add_behavior(\"force\", \"push\")"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.world().behaviors().order().keys(),
            (std::vector<std::string>{"b1/counter", "/together", "b1/push"}));
  EXPECT_EQ(edited.save(std::string("local b\n") + kBehaviorShow), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(edited.world().behaviors().order().keys(),
            (std::vector<std::string>{"b1/push", "b1/counter", "/together"}));
}

TEST(ReloadBehaviors, KeepTheirValuesWhenTheirBodyIsRebuilt) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  override_value(edited, "b1", "push", "amp", 5);
  EXPECT_EQ(edited.edit("sphere_shape(\"ball\", 0.05)", "sphere_shape(\"ball\", 0.1)"),
            SceneReloader::ApplyResult::applied);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 5);
  EXPECT_NE(edited.body("b1").behaviors().find("counter"), nullptr);
  edited.show().ticks(3);
  EXPECT_NE(edited.body("b1").behaviors().find("together"), nullptr);
  EXPECT_EQ(edited.body("b1").behaviors().find("counter")->error(), "");
}

TEST(ReloadBehaviors, HandlesOfTheNewRunReferToLiveObjects) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(3);
  EXPECT_EQ(edited.edit("--MORE", R"(local push, group = b1:behavior("push"), sim:group_behavior("together")
osc:on("/amp", function(x) push.amp = x group.amount = x end))"),
            SceneReloader::ApplyResult::applied);
  edited.show().send("/amp", 6.0);
  edited.show().ticks(1);
  EXPECT_EQ(value(edited, "b1", "push", "amp"), 6);
  EXPECT_EQ(value(edited, "b3", "together", "amount"), 6);
}

TEST(ReloadBehaviors, ABrokenFileChangesNothingAndAFixedOneIsApplied) {
  EditedShow edited(kBehaviorShow, {{"behaviors_lua/count.lua", kCount}});
  edited.show().ticks(5);
  edited.folder.write("behaviors_lua/count.lua", "return behavior {");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::failed);
  edited.show().ticks(5);
  EXPECT_NEAR(step_count(edited), 10, 1e-9);
  std::string erring = kCount;
  erring.replace(erring.find("self.state.n = self.state.n + self.by"), 37, "self.state.n = nothing.x");
  edited.folder.write("behaviors_lua/count.lua", erring);
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  edited.show().ticks(2);
  EXPECT_NE(edited.body("b1").behaviors().find("counter")->error().find("count.lua:4: there is no global 'nothing'"),
            std::string::npos);
  edited.folder.write("behaviors_lua/count.lua", kCount);
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  edited.show().ticks(2);
  EXPECT_EQ(edited.body("b1").behaviors().find("counter")->error(), "");
  EXPECT_NEAR(step_count(edited), 12, 1e-9) << "it continues counting";
}

}  // namespace
}  // namespace limber::engine::test
