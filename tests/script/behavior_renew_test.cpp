// A behaviour's type is renewed: its instances go on in another Lua state.
#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber {
namespace {

// the world of one scene, with behaviours of a second one that has loaded the file anew
class Renewed : public ::testing::Test {
 protected:
  void play(const std::string& file, int ticks) { ASSERT_EQ(stage.play_one(file, ticks), ""); }
  // saved with another text, and run
  void save(const std::string& file) {
    stage.write("behaviors_lua/test.lua", file);
    stage.write("scripts/next.lua",
                "sim:add_body('next" + std::to_string(count_++) + "'):add_behavior('test', 'x', { active = false })");
    scenes_.push_back(std::make_unique<Scene>(stage.world, host, SceneOptions{}));
    const Result<void> ran = scenes_.back()->run((stage.folder / "scripts" / "next.lua").string());
    ASSERT_TRUE(ran.ok()) << ran.error();
    stage.world.behaviors().renew("test");
  }
  std::vector<std::string> take_printed() { return std::exchange(host.printed, {}); }

  BehaviorStage stage;
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

TEST_F(Renewed, StateAndValuesStayAndStartIsNotCalled) {
  play(std::string(kCounts) + "}", 3);
  stage.set("amp", 4);
  save(std::string(kCounts) + "doc = 'Another.' }");
  stage.tick(2);
  EXPECT_EQ(take_printed(), (Lines{"4\t4", "5\t4"}));
  EXPECT_EQ(stage.it().type().doc, "Another.");
  EXPECT_EQ(stage.host.printed, (Lines{"start", "1\t1", "2\t1", "3\t1"})) << "the old one does nothing more";
}

TEST_F(Renewed, MigrateBringsTheStateOver) {
  play(std::string(kCounts) + "}", 3);
  save(R"(
return behavior {
  start = function(self) print("start") end,
  step = function(self) self.state.count = self.state.count + 10 print(self.state.count) end,
  migrate = function(self, old) print(self.name, old.n) return { count = old.n * 100 } end,
})");
  stage.tick(2);
  EXPECT_EQ(take_printed(), (Lines{"it\t3", "310", "320"}));
}

TEST_F(Renewed, TheSameFileIsNotMigrated) {
  const std::string file = std::string(kCounts) + "migrate = function(self, old) print('migrate') return old end }";
  play(file, 1);
  save(file);
  stage.tick();
  EXPECT_EQ(take_printed(), (Lines{"2\t1"}));
}

TEST_F(Renewed, AFailingMigrateSuspends) {
  play(std::string(kCounts) + "}", 1);
  save(std::string(kCounts) + "migrate = function(self, old)\n  return old.x.y end }");
  stage.tick(2);
  EXPECT_EQ(first_line(stage.it().error()), "behaviors_lua/test.lua:5: attempt to index field 'x' (a nil value)");
  EXPECT_EQ(take_printed(), Lines{});
  // mended, it goes on with the state that it had
  save(std::string(kCounts) + "migrate = function(self, old) old.n = old.n + 1000 return old end }");
  stage.tick();
  EXPECT_EQ(take_printed(), (Lines{"1002\t1"}));
}

TEST_F(Renewed, MigrateMustReturnATable) {
  play(std::string(kCounts) + "}", 1);
  save(std::string(kCounts) + "migrate = function(self, old) end }");
  stage.tick();
  EXPECT_EQ(first_line(stage.it().error()),
            "behaviors_lua/test.lua:4: behavior 'ball/it': migrate returns the new state, a table, not nothing");
  EXPECT_EQ(stage.it().fault().file, "behaviors_lua/test.lua");
}

TEST_F(Renewed, StateThatCantBeKeptBeginsAnew) {
  play("return behavior { start = function(self) self.state.f = print end, step = function(self) end }", 1);
  save("return behavior { start = function(self) print('start') end, step = function(self) print(self.state.f) end }");
  stage.tick();
  EXPECT_EQ(take_printed(), (Lines{"start", "nil"}));
  EXPECT_EQ(stage.logged().back(),
            "behavior 'ball/it' begins anew: state.f is a function; state holds numbers, text, true and false, vec3, "
            "quat, timers, and tables of them");
}

TEST_F(Renewed, ASuspendedOneTriesAgain) {
  play("return behavior { step = function(self)\n  error('no') end }", 2);
  EXPECT_NE(stage.it().error(), "");
  save("return behavior { step = function(self) print('yes') end }");
  stage.tick();
  EXPECT_EQ(take_printed(), Lines{"yes"});
  EXPECT_EQ(stage.it().error(), "");
}

TEST_F(Renewed, TwiceBetweenTwoTicksKeepsTheState) {
  play(std::string(kCounts) + "}", 2);
  save(std::string(kCounts) + "doc = '1' }");
  save(std::string(kCounts) + "doc = '2' }");
  stage.tick();
  EXPECT_EQ(take_printed(), (Lines{"3\t1"}));
}

TEST_F(Renewed, TheGeneratorGoesOn) {
  const std::string file = "return behavior { step = function(self) print(self.rng:uniform()) end ";
  play(file + "}", 2);
  Random expected(stage.world.seed(), "/physics/body/ball/behavior/it");
  expected.next();
  expected.next();
  save(file + ", doc = 'x' }");
  stage.tick();
  EXPECT_EQ(take_printed(), Lines{fmt::format("{:.14g}", expected.uniform())});
}

TEST(BehaviorOutlives, ItsScene) {
  BehaviorStage stage;
  auto scene = std::make_unique<Scene>(stage.world, stage.host, SceneOptions{});
  stage.write("behaviors_lua/test.lua", "return behavior { step = function() print('step') end }");
  stage.write("scripts/short.lua", std::string(kBall) + "ball:add_behavior('test', 'it')");
  ASSERT_TRUE(scene->run((stage.folder / "scripts" / "short.lua").string()).ok());
  stage.world.step();
  EXPECT_EQ(stage.host.printed, std::vector<std::string>{"step"});
  scene.reset();
  stage.world.step();  // nobody is there to ask
  EXPECT_EQ(stage.host.printed, std::vector<std::string>{"step"});
  EXPECT_EQ(stage.it().error(), "the scene no longer names this type; name it once at the top level");
}

}  // namespace
}  // namespace limber
