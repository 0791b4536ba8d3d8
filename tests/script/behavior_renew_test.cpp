// Reload of a behavior type: its instances continue in another Lua state.
#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber::script {
namespace {

// plays a scene with a behavior, then reloads the behavior's file with a second scene in the same world
class BehaviorReload : public ::testing::Test {
 protected:
  void play(const std::string& file, int ticks) { ASSERT_EQ(fixture.play_one(file, ticks), ""); }
  // reloads the behavior type from another text
  void save(const std::string& file) {
    fixture.write("behaviors_lua/test.lua", file);
    fixture.write("scripts/next.lua",
                  "sim:add_body('next" + std::to_string(count_++) + "'):add_behavior('test', 'x', { active = false })");
    scenes_.push_back(std::make_unique<Scene>(fixture.world, host, SceneOptions{}));
    const Result<void> result = scenes_.back()->run((fixture.folder / "scripts" / "next.lua").string());
    ASSERT_TRUE(result.ok()) << result.error();
    fixture.world.behaviors().replace_instances("test");
  }
  std::vector<std::string> consume_printed() { return std::exchange(host.printed, {}); }

  BehaviorFixture fixture;
  RecordingHost host;

 private:
  int count_ = 0;
  std::vector<std::unique_ptr<Scene>> scenes_;
};

constexpr const char* kCounts =
    "return behavior { params = { { 'amp', 1, max = 10 } },\n"
    "start = function(self) self.state.n = 0 print('start') end,\n"
    "step = function(self) self.state.n = self.state.n + 1 print(self.state.n, self.amp) end,\n";

using Lines = std::vector<std::string>;

TEST_F(BehaviorReload, StateAndValuesStayAndStartIsNotCalled) {
  play(std::string(kCounts) + "}", 3);
  fixture.set("amp", 4);
  save(std::string(kCounts) + "doc = 'Another.' }");
  fixture.tick(2);
  EXPECT_EQ(consume_printed(), (Lines{"4\t4", "5\t4"}));
  EXPECT_EQ(fixture.it().type().doc, "Another.");
  EXPECT_EQ(fixture.host.printed, (Lines{"start", "1\t1", "2\t1", "3\t1"}))
      << "the old instance is not stepped any more";
}

TEST_F(BehaviorReload, MigrateConvertsTheState) {
  play(std::string(kCounts) + "}", 3);
  save(R"(
return behavior {
  start = function(self) print("start") end,
  step = function(self) self.state.count = self.state.count + 10 print(self.state.count) end,
  migrate = function(self, old) print(self.name, old.n) return { count = old.n * 100 } end,
})");
  fixture.tick(2);
  EXPECT_EQ(consume_printed(), (Lines{"it\t3", "310", "320"}));
}

TEST_F(BehaviorReload, TheSameFileIsNotMigrated) {
  const std::string file = std::string(kCounts) + "migrate = function(self, old) print('migrate') return old end }";
  play(file, 1);
  save(file);
  fixture.tick();
  EXPECT_EQ(consume_printed(), (Lines{"2\t1"}));
}

TEST_F(BehaviorReload, AFailingMigrateSuspends) {
  play(std::string(kCounts) + "}", 1);
  save(std::string(kCounts) + "migrate = function(self, old)\n  return old.x.y end }");
  fixture.tick(2);
  EXPECT_EQ(first_line(fixture.it().error()), "behaviors_lua/test.lua:5: attempt to index field 'x' (a nil value)");
  EXPECT_EQ(consume_printed(), Lines{});
  // after a fix it continues with its previous state
  save(std::string(kCounts) + "migrate = function(self, old) old.n = old.n + 1000 return old end }");
  fixture.tick();
  EXPECT_EQ(consume_printed(), (Lines{"1002\t1"}));
}

TEST_F(BehaviorReload, MigrateMustReturnATable) {
  play(std::string(kCounts) + "}", 1);
  save(std::string(kCounts) + "migrate = function(self, old) end }");
  fixture.tick();
  EXPECT_EQ(first_line(fixture.it().error()),
            "behaviors_lua/test.lua:4: behavior 'ball/it': migrate returns the new state, a table, not nothing");
  EXPECT_EQ(fixture.it().fault().file, "behaviors_lua/test.lua");
}

TEST_F(BehaviorReload, UnserializableStateStartsEmpty) {
  play("return behavior { start = function(self) self.state.f = print end, step = function(self) end }", 1);
  save("return behavior { start = function(self) print('start') end, step = function(self) print(self.state.f) end }");
  fixture.tick();
  EXPECT_EQ(consume_printed(), (Lines{"start", "nil"}));
  EXPECT_EQ(fixture.logged().back(),
            "behavior 'ball/it' restarts with an empty state: state.f is a function; state can have numbers, text, "
            "true and false, vec3, "
            "quat, timers, and tables of them");
}

TEST_F(BehaviorReload, ASuspendedInstanceIsRetried) {
  play("return behavior { step = function(self)\n  error('no') end }", 2);
  EXPECT_NE(fixture.it().error(), "");
  save("return behavior { step = function(self) print('yes') end }");
  fixture.tick();
  EXPECT_EQ(consume_printed(), Lines{"yes"});
  EXPECT_EQ(fixture.it().error(), "");
}

TEST_F(BehaviorReload, TwoReloadsBetweenTicksKeepTheState) {
  play(std::string(kCounts) + "}", 2);
  save(std::string(kCounts) + "doc = '1' }");
  save(std::string(kCounts) + "doc = '2' }");
  fixture.tick();
  EXPECT_EQ(consume_printed(), (Lines{"3\t1"}));
}

TEST_F(BehaviorReload, TheGeneratorContinues) {
  const std::string file = "return behavior { step = function(self) print(self.rng:uniform()) end ";
  play(file + "}", 2);
  Random expected(fixture.world.seed(), "/physics/body/ball/behavior/it");
  expected.next();
  expected.next();
  save(file + ", doc = 'x' }");
  fixture.tick();
  EXPECT_EQ(consume_printed(), Lines{fmt::format("{:.14g}", expected.uniform())});
}

TEST(BehaviorLifetime, OutlivesTheScene) {
  BehaviorFixture fixture;
  auto scene = std::make_unique<Scene>(fixture.world, fixture.host, SceneOptions{});
  fixture.write("behaviors_lua/test.lua", "return behavior { step = function() print('step') end }");
  fixture.write("scripts/short.lua", std::string(kBall) + "ball:add_behavior('test', 'it')");
  ASSERT_TRUE(scene->run((fixture.folder / "scripts" / "short.lua").string()).ok());
  fixture.world.step();
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"step"});
  scene.reset();
  fixture.world.step();  // there is no script to call
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"step"});
  EXPECT_EQ(fixture.it().error(), "the scene no longer uses this type; use it once at the top level");
}

}  // namespace
}  // namespace limber::script
