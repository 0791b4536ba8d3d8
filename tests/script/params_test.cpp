// params: properties of /scene declared by a scene; reading, setting, clamping.
#include <gtest/gtest.h>

#include "properties/catalog.h"
#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kParams = R"(
params {
  { "wind", 1.5, min = 0, max = 10, unit = "N", doc = "How hard the wind blows." },
  { "loud", true },
  { "place", vec3(1, 2, 3), min = vec3(0, 1, 2), max = { 5, 5, 5 }, unit = "m" },
  { "mood", "calm", choices = { "calm", "wild" } },
  { "free", -7 },
}
)";

TEST(Params, BecomePropertiesOfScene) {
  ScriptFixture fixture;
  ASSERT_EQ(
      fixture.run(std::string(kParams) + "print(params.wind, params.loud, params.place, params.mood, params.free)"),
      "");
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"1.5\ttrue\tvec3(1, 2, 3)\tcalm\t-7"});
  const NodeId node = fixture.store.child(fixture.store.root(), "scene");
  ASSERT_TRUE(fixture.store.alive(node));
  const Property& wind = fixture.store.table(node).at("wind");
  EXPECT_EQ(wind.min, 0);
  EXPECT_EQ(wind.max, 10);
  EXPECT_EQ(wind.initial[0], 1.5);
  EXPECT_EQ(wind.unit, "N");
  EXPECT_EQ(wind.doc, "How hard the wind blows.");
  EXPECT_EQ(wind.kind, PropertyKind::setting);
  EXPECT_EQ(fixture.store.table(node).at("mood").choices, (std::vector<std::string>{"calm", "wild"}));
  EXPECT_EQ(fixture.store.table(node).property_names(),
            (std::vector<std::string_view>{"wind", "loud", "place", "mood", "free"}));
  const Result<PropertyRef> place = find_property(fixture.store, "/scene/wind");
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place->property, &wind);
}

TEST(Params, TheLiveValueIsReadAndSet) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kParams) + R"(
sim:on_step(function()
  print(params.wind, params.place)
  params.wind = params.wind + 4
  params.mood = "wild"
  params.loud = false
end)
)"),
            "");
  const NodeId node = fixture.store.child(fixture.store.root(), "scene");
  const double wind = 3;
  ASSERT_TRUE(fixture.store.set(node, "wind", {&wind, 1}).ok());
  const double place[] = {9, 0, 4};  // each axis has its own range
  ASSERT_TRUE(fixture.store.set(node, "place", place).ok());
  fixture.world.flush();
  fixture.tick(3);
  EXPECT_EQ(fixture.host.printed,
            (std::vector<std::string>{"3\tvec3(5, 1, 4)", "7\tvec3(5, 1, 4)", "10\tvec3(5, 1, 4)"}));
  EXPECT_EQ(fixture.store.values(node, fixture.store.table(node).at("mood"))[0], 1);
  EXPECT_EQ(fixture.store.values(node, fixture.store.table(node).at("loud"))[0], 0);
  // 7 + 4 and 10 + 4 are out of range: reported once
  ASSERT_EQ(fixture.logged().size(), 1u);
  EXPECT_NE(fixture.logged()[0].find("params: 'wind' takes 0 .. 10 N; 11 is outside and was clamped"),
            std::string::npos);
}

TEST(Params, AVectorsAxesHaveTheirOwnRanges) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kParams) + R"(
sim:on_step(function() params.place = vec3(-1, 9, 3) end)
)"),
            "");
  const NodeId node = fixture.store.child(fixture.store.root(), "scene");
  const Property& place = fixture.store.table(node).at("place");
  EXPECT_EQ(place.axis_min, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(place.axis_max, (std::vector<double>{5, 5, 5}));
  EXPECT_TRUE(fixture.store.table(node).at("wind").axis_min.empty());
  // the setter clamps, too, and reports it
  const double low[] = {1, 0, 3};
  const Result<SetOutcome> set = fixture.store.set(node, place, low);
  ASSERT_TRUE(set.ok());
  EXPECT_TRUE(set->clamped);
  EXPECT_EQ(fixture.store.values(node, place)[1], 1);
  fixture.tick(1);
  EXPECT_EQ(fixture.store.values(node, place)[0], 0);
  EXPECT_EQ(fixture.store.values(node, place)[1], 5);
  EXPECT_EQ(fixture.store.values(node, place)[2], 3);
  ASSERT_EQ(fixture.logged().size(), 1u);
  EXPECT_NE(fixture.logged()[0].find("'place' takes 0 1 2 .. 5 5 5 m; -1, 9, 3 is outside"), std::string::npos)
      << fixture.logged()[0];
}

TEST(Params, StoresTheStep) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run("params { { 'wind', 1, step = 0.25 }, { 'free', 2 } }"), "");
  const PropertyTable& table = fixture.store.table(fixture.store.child(fixture.store.root(), "scene"));
  EXPECT_EQ(table.at("wind").step, 0.25);
  EXPECT_EQ(table.at("free").step, 0);
}

TEST(Params, TheNodeIsRemovedWithTheScene) {
  Store store;
  sim::World world(store);
  RecordingHost host;
  ScriptFixture files;
  files.write("scripts/scene.lua", kParams);
  for (int i = 0; i < 3; i++) {
    Scene scene(world, host, {});
    ASSERT_TRUE(scene.run((files.folder / "scripts/scene.lua").string()).ok());
    EXPECT_FALSE(store.child(store.root(), "scene").null());
  }
  EXPECT_TRUE(store.child(store.root(), "scene").null());
}

TEST(Params, ReportsMistakes) {
  const std::string at = "scripts/scene.lua:1: ";
  const std::pair<const char*, const char*> cases[] = {
      {"params { 5 }", "params: entry 1 is a table { \"name\", default, … }, not 5"},
      {"params { { 'my wind', 0 } }", "params: entry 1 begins with a name of letters, digits and _, not 'my wind'"},
      {"params { { 'a' } }",
       "params: 'a' needs a default that is a number, true or false, a vec3, or text with choices, not nothing"},
      {"params { { 'a', 1, mi = 0 } }", "params: 'a' has no 'mi'; did you mean 'min'?"},
      {"params { { 'a', 1, min = 2, max = 1 } }", "params: 'a' has a min above its max"},
      {"params { { 'a', 1, unit = 'furlong' } }", nullptr},
      {"params { { 'a', 'x' } }", "params: 'a' is text, so it needs choices = { … }"},
      {"params { { 'a', 'x', choices = { 'y' } } }",
       "params: 'a': the default 'x' is none of its choices; did you mean 'y'?"},
      {"params { { 'wind', 1 }, { 'Wi_nd', 2 } }",
       "params: 'wind' and 'Wi_nd' are the same name (case and underscores don't count)"},
      {"params { { 'a', 1, rerun = 1 } }", "params: 'a': rerun is true or false, not 1"},
      {"params { { 'a', 0 / 0 } }", nullptr},
      {"params { { 'a', 1 } } params { { 'b', 1 } }", "params is called once, with all parameters of the scene"},
      {"params { { 'wind', 1 } } print(params.win)", "params has no 'win'; did you mean 'wind'?"},
      {"print(params.wind)", "params has no 'wind'; none exist"},
      {"params { { 'wind', 1 } } params.wind = 2",
       "setting params.wind acts on the running scene; at the top level use sim:on_start(function() … end)"},
      {"params { rate = 1 }", "params: 'rate' is not an entry of the list; write { \"rate\", … }"},
      {"params { { 'a', 1 }, [3] = { 'b', 1 } }", "params: '3' is not an entry of the list; write { \"3\", … }"},
      {"params(5)", "params takes a list of { \"name\", default, … }, not 5"},
  };
  for (const auto& [text, expected] : cases) {
    if (expected != nullptr) {
      EXPECT_EQ(error_of(text), at + expected) << text;
    } else {
      EXPECT_NE(error_of(text), "no error") << text;
    }
  }
  EXPECT_EQ(callback_error_of("params { { 'wind', 1 } }", "params.wind = true"),
            "scripts/scene.lua:1: params: 'wind' takes a number, not true");
}

}  // namespace
}  // namespace limber::script
