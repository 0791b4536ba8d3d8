// A scene's own parameters in a reload, and those that run the scene again.
#include "engine/edited.h"

namespace limber::engine::test {
namespace {

using Texts = std::vector<std::string>;

struct ParamCase {
  const char* name;
  const char* before;
  Arg override_value;
  const char* after;
  double value;
};

TEST(ReloadParams, ApplyDefaultsRangesAndTypes) {
  const ParamCase kCases[] = {
      {"untouched by the editor", "5, min = 0, max = 10", arg(7), "5, min = 0, max = 10, doc = 'x'", 7},
      {"an edited default", "5, min = 0, max = 10", arg(7), "6, min = 0, max = 10", 6},
      {"outside of the new range", "5, min = 0, max = 10", arg(7), "5, min = 0, max = 6", 6},
      {"inside of the new range", "5, min = 0, max = 10", arg(7), "5, min = 1, max = 8", 7},
      {"another type", "5, min = 0, max = 10", arg(7), "true", 1},
      {"a boolean", "false", arg(true), "false, doc = 'x'", 1},
      {"a choice keeps its label", "'a', choices = { 'a', 'b', 'c' }", arg("c"), "'a', choices = { 'c', 'a' }", 0},
      {"a label that is gone", "'a', choices = { 'a', 'b', 'c' }", arg("c"), "'a', choices = { 'b', 'a' }", 1},
      {"another default label", "'a', choices = { 'a', 'b', 'c' }", arg("c"), "'b', choices = { 'a', 'b', 'c' }", 1},
  };
  for (const ParamCase& c : kCases) {
    const auto scene = [](const char* spec) { return fmt::format("params {{ {{ 'p', {} }} }}", spec); };
    EditedShow edited(scene(c.before));
    edited.show().send("/scene/p", c.override_value);
    edited.show().ticks(1);
    ASSERT_EQ(edited.save(scene(c.after)), SceneReloader::ApplyResult::applied) << c.name;
    EXPECT_EQ(edited.show().read("/scene/p"), c.value) << c.name;
    // a reset has the same result
    edited.show().send("/transport/reset");
    edited.show().ticks(2);
    EXPECT_EQ(edited.show().read("/scene/p"), c.value) << c.name;
  }
}

TEST(ReloadParams, TheTopLevelReadsTheLiveValue) {
  const std::string scene =
      "params { { 'n', 2, min = 0, max = 9 } }\n"
      "for i = 1, params.n do sim:add_body('b' .. i) end\n";
  EditedShow edited(scene);
  edited.show().send("/scene/n", 4);
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().bodies().size(), 2u);
  edited.save(scene + "-- saved");
  EXPECT_EQ(edited.world().bodies().size(), 4u);
  edited.edit("'n', 2", "'n', 3");
  EXPECT_EQ(edited.world().bodies().size(), 3u);
  EXPECT_EQ(edited.show().read("/scene/n"), 3);
}

TEST(ReloadParams, TheNodeStaysWhileItsPropertiesDo) {
  EditedShow edited("params { { 'a', 1 } } sim:on_step(function() osc:send('/a', params.a) end)");
  const NodeId id = edited.show().engine.store().child(edited.show().engine.store().root(), "scene");
  edited.edit("osc:send('/a', params.a)", "osc:send('/b', params.a)");
  EXPECT_EQ(edited.show().engine.store().child(edited.show().engine.store().root(), "scene"), id);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/b 1"});
  edited.edit("{ 'a', 1 }", "{ 'z', 5 }, { 'a', 1 }");
  edited.show().send("/scene/a", 3);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts(), Texts{"/b 3"});
  edited.save("sim:on_step(function() end)");
  EXPECT_TRUE(edited.show().engine.store().child(edited.show().engine.store().root(), "scene").null());
}

constexpr const char* kRerun = R"(
params { { "count", 2, min = 0, max = 50, rerun = true }, { "wind", 0 } }
local s = sim:add_sphere_shape("s", 0.1)
for i = 1, params.count do sim:add_body("b" .. i):add_part("p", s, { position = vec3(i, 0, 9) }) end
sim:on_start(function() osc:send("/start", #sim.bodies) end)
)";

TEST(Rerun, TheSceneFollowsItsSliderAtTheNextTick) {
  EditedShow edited(kRerun);
  edited.show().ticks(10);
  const std::vector<double> first = motion_of(edited.part("b1", "p"));
  edited.show().send("/scene/wind", 3);
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().bodies().size(), 2u);
  edited.show().send("/scene/count", 5);
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().bodies().size(), 2u);
  const std::vector<double> before = motion_of(edited.part("b1", "p"));
  ASSERT_NE(before, first);
  edited.show().send("/transport/pause");
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().bodies().size(), 5u);
  EXPECT_EQ(motion_of(edited.part("b1", "p")), before) << "the remaining ones are not disturbed";
  EXPECT_EQ(edited.show().read("/scene/wind"), 3);
  edited.show().send("/scene/count", 1);
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().bodies().size(), 1u);
}

TEST(Rerun, UsesTheSourcesOfTheLastSuccessfulRun) {
  EditedShow edited(kRerun);
  edited.folder.write("scripts/scene.lua", "half a file (");
  edited.show().send("/scene/count", 3);
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().bodies().size(), 3u);
  EXPECT_EQ(edited.show().sent_texts(), Texts{}) << "no file was saved: nothing is read or reported";
  edited.show().engine.reload_now();
  edited.show().sent_texts();
  edited.show().send("/scene/count", 4);
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().bodies().size(), 4u);
  EXPECT_EQ(edited.show().sent_texts(), Texts{}) << "that does not count as a fix of the file";
}

TEST(Rerun, UsesOverridesBeforeTheFirstTick) {
  EditedShow file(kRerun);
  EngineOptions options = fast_options(file.folder.path("scripts/scene.lua"));
  options.sets = {message("/scene/count", 7)};
  EngineLink link;
  Engine engine(link, options);
  ASSERT_TRUE(engine.start().ok());
  EXPECT_EQ(engine.world().bodies().size(), 7u);
  std::vector<Outgoing> out;
  link.output_queue.drain(out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(text_of(out[0].message), "/start 7");
}

TEST(Rerun, AResetKeepsTheSlider) {
  EditedShow edited(kRerun);
  edited.show().send("/scene/count", 5);
  edited.show().ticks(2);
  edited.show().sent_texts();
  edited.show().send("/transport/reset");
  edited.show().ticks(1);
  EXPECT_EQ(edited.world().bodies().size(), 5u);
  EXPECT_EQ(edited.show().sent_texts()[0], "/start 5");
}

TEST(Rerun, AFailedOneIsReportedOnceAndTheShowContinues) {
  EditedShow edited(std::string(kRerun) + "if params.count > 10 then error('too many') end");
  edited.show().send("/scene/count", 12);
  edited.show().ticks(5);
  EXPECT_EQ(edited.world().bodies().size(), 2u);
  EXPECT_EQ(edited.show().sent_texts().size(), 1u);
  edited.show().send("/scene/count", 4);
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().bodies().size(), 4u);
}

TEST(Rerun, IsDeterministic) {
  const auto hash = [] {
    EditedShow edited(kRerun);
    for (const int count : {5, 9, 3, 8}) {
      edited.show().send("/scene/count", count);
      edited.show().ticks(7);
    }
    return edited.show().engine.state_hash();
  };
  EXPECT_EQ(hash(), hash());
}

}  // namespace
}  // namespace limber::engine::test
