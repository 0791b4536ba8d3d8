// Types of behaviors_lua/: file search, declarations, errors.
#include <algorithm>

#include <gtest/gtest.h>

#include "behavior_stage.h"
#include "properties/catalog.h"
#include "script/scene/sources.h"

namespace limber::script {
namespace {

// a type with a step that prints a word
std::string behavior_that_prints(const std::string& word) {
  return "return behavior { step = function() print('" + word + "') end }";
}

TEST(BehaviorTypes, TheNearestFileWins) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/hum.lua", behavior_that_prints("show"));
  fixture.write("scripts/behaviors_lua/hum.lua", behavior_that_prints("scripts"));
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('hum', 'a')", 1), "");
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"scripts"});
}

TEST(BehaviorTypes, InstalledFilesAreSearchedLast) {
  BehaviorFixture data;
  data.write("behaviors_lua/hum.lua", behavior_that_prints("installed"));
  data.write("behaviors_lua/buzz.lua", behavior_that_prints("buzz"));
  BehaviorFixture fixture(with_data(data.folder));
  fixture.write("behaviors_lua/hum.lua", behavior_that_prints("show"));
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('hum', 'a') ball:add_behavior('buzz', 'b')", 1), "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"show", "buzz"}));
}

TEST(BehaviorTypes, NamesAreComparedLoosely) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/soft_hum.lua", behavior_that_prints("hum"));
  ASSERT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior("SoftHumBehavior", "a")
ball:add_behavior("softhum", "b")
)",
                         1),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"hum", "hum"}));
  EXPECT_EQ(fixture.world.find_body("ball")->behaviors().find("a")->type().name, "soft_hum");
}

TEST(BehaviorTypes, AMissingTypeListsTheSearchedFolders) {
  BehaviorFixture data;
  BehaviorFixture fixture(with_data(data.folder));
  fixture.write("behaviors_lua/breathe.lua", behavior_that_prints("x"));
  const std::string fault = fixture.run(std::string(kBall) + "ball:add_behavior('brethe', 'a')");
  EXPECT_EQ(first_line(fault), "scripts/scene.lua:5: there is no behavior type 'brethe'; did you mean 'breathe'?");
  for (const auto& folder : {fixture.folder / "scripts", fixture.folder, data.folder}) {
    EXPECT_NE(fault.find("\n  " + (folder / "behaviors_lua").string() + "\n"), std::string::npos) << fault;
  }
  // built-in types are suggested as well
  BehaviorFixture second;
  const std::string other = second.run(std::string(kBall) + "ball:add_behavior('random_forse', 'a')");
  EXPECT_NE(other.find("did you mean 'random_force'?"), std::string::npos) << other;
}

TEST(BehaviorTypes, AFileNamedLikeABuiltInTypeIsAnError) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/Random_Force.lua", behavior_that_prints("x"));
  EXPECT_EQ(first_line(fixture.run(std::string(kBall) + "ball:add_behavior('random_force', 'a')")),
            "scripts/scene.lua:5: behaviors_lua/Random_Force.lua: 'random_force' is a built-in behavior type; rename "
            "the file");
}

TEST(BehaviorTypes, ParametersBecomeProperties) {
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one(R"(
return behavior {
  doc = "Hums.",
  params = {
    { "rate", 0.25, min = 0, max = 4, unit = "Hz", step = 0.05, doc = "Hums per second." },
    { "loud", true },
    { "where", { 1, 2, 3 }, min = 0, max = { 5, 6, 7 }, unit = "m" },
    { "mood", "calm", choices = { "wild", "calm" } },
  },
  step = function() end,
}
)",
                             0, "{ rate = 9, mood = 'wild' }"),
            "");
  const sim::BehaviorType& type = fixture.it().type();
  EXPECT_EQ(type.name, "test");
  EXPECT_EQ(type.doc, "Hums.");
  EXPECT_FALSE(type.is_built_in);
  EXPECT_EQ(type.table->property_names(), (std::vector<std::string_view>{"active", "time", "remove", "place", "rate",
                                                                         "loud", "where", "mood", "error"}));
  const Property& rate = fixture.property_at("rate");
  EXPECT_EQ(rate.type, PropertyType::number);
  EXPECT_EQ(rate.kind, PropertyKind::setting);
  EXPECT_EQ(rate.unit, "Hz");
  EXPECT_EQ(rate.doc, "Hums per second.");
  EXPECT_EQ(rate.max, 4);
  EXPECT_EQ(rate.step, 0.05);
  EXPECT_EQ(rate.initial[0], 0.25);
  EXPECT_EQ(fixture.property_at("loud").type, PropertyType::boolean);
  EXPECT_EQ(fixture.property_at("where").high(2), 7);
  EXPECT_EQ(fixture.property_at("mood").choices, (std::vector<std::string>{"wild", "calm"}));
  EXPECT_EQ(fixture.value("rate"), 4) << "clamped";
  EXPECT_EQ(fixture.value("mood"), 0);
  const Result<PropertyRef> place = find_property(fixture.store, "/physics/body/ball/behavior/it/rate");
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place->property, &rate);
}

TEST(BehaviorTypes, WrongDeclarationsAreExplained) {
  EXPECT_EQ(load_error("return behavior { stp = 1, step = function() end }"),
            "behaviors_lua/test.lua:1: a behavior has no 'stp'; did you mean 'step'?");
  EXPECT_EQ(load_error("return behavior {\n  doc = 3,\n  step = function() end }"),
            "behaviors_lua/test.lua:2: doc is text, not 3");
  EXPECT_EQ(load_error("return behavior {\n  step = 3 }"), "behaviors_lua/test.lua:2: step is a function, not 3");
  EXPECT_EQ(load_error("return behavior {\n  step = function() end,\n  migrate = {} }"),
            "behaviors_lua/test.lua:3: migrate is a function, not a table");
  EXPECT_EQ(load_error("return behavior { group = 1, step = function() end }"),
            "behaviors_lua/test.lua:1: group is true or false, not 1");
  EXPECT_EQ(load_error("\nreturn behavior {}"),
            "behaviors_lua/test.lua:2: a behavior has a step: step = function(self, dt) … end");
  EXPECT_EQ(load_error("return behavior(7)"), "behaviors_lua/test.lua:1: behavior takes a table { … }, not 7");
  EXPECT_EQ(load_error("return behavior { function() end }"),
            "behaviors_lua/test.lua:1: behavior takes named entries, such as step = function(self, dt) … end, not a "
            "function");
  const std::string ends =
      ": a file of behaviors_lua/ ends with: return behavior { doc = …, params = { … }, step = "
      "function(self, dt) … end }";
  EXPECT_EQ(load_error("local x = 1\nlocal y = 2\n"), "behaviors_lua/test.lua:2" + ends);
  EXPECT_EQ(load_error("behavior { step = function() end }"), "behaviors_lua/test.lua:1" + ends);
  EXPECT_EQ(load_error("return { step = function() end }"), "behaviors_lua/test.lua:1" + ends);
}

TEST(BehaviorTypes, WrongParametersAreExplained) {
  const auto with = [](const std::string& params) {
    return load_error("return behavior {\n  -- rate\n  params = {\n    " + params +
                      "\n  },\n  step = function() end }");
  };
  EXPECT_EQ(with("{ 'rate', 1, mim = 0 },"),
            "behaviors_lua/test.lua:4: params: 'rate' has no 'mim'; did you mean 'min'?");
  EXPECT_EQ(with("{ 'rate' },"),
            "behaviors_lua/test.lua:4: params: 'rate' needs a default that is a number, true or false, a vec3, or text "
            "with choices, not nothing");
  EXPECT_EQ(with("{ 'rate', 1, unit = 'furlong' },").substr(0, 65),
            "behaviors_lua/test.lua:4: params: 'rate': unknown unit 'furlong';");
  EXPECT_EQ(with("{ 'rate', 1 },\n{ 'Rate', 2 },"),
            "behaviors_lua/test.lua:4: params: 'rate' and 'Rate' are the same name (case and underscores don't count)");
  EXPECT_EQ(with("{ 'Motors', 1 },"),
            "behaviors_lua/test.lua:4: a parameter can't be called 'Motors': 'motors' is a member of every behavior");
  EXPECT_EQ(with("{ 'is_active', 1 }, { 'act_ive', 1 }"),
            "behaviors_lua/test.lua:4: a parameter can't be called 'act_ive': 'active' is a member of every behavior");
  EXPECT_EQ(with("'rate'"),
            "behaviors_lua/test.lua:3: params: entry 1 is a table { \"name\", default, … }, not 'rate'");
  EXPECT_EQ(load_error("return behavior { params = 3, step = function() end }"),
            "behaviors_lua/test.lua:1: params takes a list of { \"name\", default, … }, not 3");
  // a failed declaration leaves nothing behind
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/bad.lua",
                "return behavior { params = { { 'rate', 1 }, { 'x' } }, step = function() end }");
  fixture.write("behaviors_lua/good.lua", "return behavior { params = { { 'rate', 1 } }, step = function() end }");
  EXPECT_EQ(fixture.play(std::string(kBall) + R"(
print(pcall(function() ball:add_behavior("bad", "a") end))
ball:add_behavior("good", "b")
)"),
            "");
  EXPECT_EQ(fixture.host.printed.front().substr(0, 5), "false");
}

TEST(BehaviorTypes, HasAtMostSixtyParameters) {
  const auto many = [](int count) {
    std::string params;
    for (int i = 1; i <= count; i++) params += "{ 'p" + std::to_string(i) + "', 1 }, ";
    return load_error("return behavior { params = { " + params + "}, step = function() end }");
  };
  EXPECT_EQ(many(60), "no error");
  EXPECT_EQ(many(61), "behaviors_lua/test.lua:1: params: a behavior can have at most 60 parameters");
}

TEST(BehaviorTypes, AFileThatFailsRejectsTheScene) {
  EXPECT_EQ(load_error("return behavior {\n  step = function( end }"),
            "behaviors_lua/test.lua:2: <name> or '...' expected near 'end'");
  BehaviorFixture fixture;
  const std::string fault = fixture.play_one("\nlocal x = nil + 1\n");
  EXPECT_EQ(first_line(fault), "behaviors_lua/test.lua:2: attempt to perform arithmetic on a nil value");
  EXPECT_NE(fault.find("2 | local x = nil + 1"), std::string::npos) << fault;
  EXPECT_NE(fault.find("scripts/scene.lua:5: in the main chunk"), std::string::npos) << fault;
  EXPECT_EQ(load_error("error({})"), "scripts/scene.lua:5: an error that is not text but a table");
}

TEST(BehaviorTypes, CallbacksUseTypesLoadedByTheRun) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/hum.lua", behavior_that_prints("hum"));
  fixture.write("behaviors_lua/buzz.lua", behavior_that_prints("buzz"));
  ASSERT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior("hum", "a", { active = false })
sim:on_start(function() ball:add_behavior("hum", "b") end)
sim:on_start(function() ball:add_behavior("buzz", "c") end)
)",
                         1),
            "");
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"hum"});
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(first_line(fixture.host.faults[0].text),
            "scripts/scene.lua:8: the behavior type 'buzz' was not loaded when the scene ran; callbacks can't read "
            "files, so use it once at the top level");
}

TEST(BehaviorTypes, TheRunListsItsFiles) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/lib/steps.lua", "return { word = require('more.words') }");
  fixture.write("behaviors_lua/lib/more/words.lua", "return 'left'");
  fixture.write("behaviors_lua/test.lua",
                "local steps = require 'steps'\nreturn behavior { step = function() print(steps.word) end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('test', 'it')", 1), "");
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"left"});
  const auto& file = static_cast<LuaBehavior&>(fixture.it()).file();
  EXPECT_EQ(file.type, "test");
  EXPECT_EQ(file.display_path, "behaviors_lua/test.lua");
  EXPECT_EQ(file.path, (fixture.folder / "behaviors_lua" / "test.lua").string());
  const auto reads = [&](const std::string& name) {
    const auto files = fixture.scene.sources()->files();
    return std::ranges::any_of(files, [&](const SourceFile& f) { return f.path == (fixture.folder / name).string(); });
  };
  EXPECT_TRUE(reads("behaviors_lua/test.lua"));
  EXPECT_TRUE(reads("behaviors_lua/lib/steps.lua"));
  EXPECT_TRUE(reads("behaviors_lua/lib/more/words.lua"));
}

TEST(BehaviorTypes, ModulesBesideTheFileComeFirst) {
  BehaviorFixture data;
  data.write("behaviors_lua/lib/words.lua", "return 'installed'");
  data.write("behaviors_lua/far.lua", "local w = require 'words' return behavior { step = function() print(w) end }");
  BehaviorFixture fixture(with_data(data.folder));
  fixture.write("behaviors_lua/lib/words.lua", "return 'show'");
  fixture.write("scripts/lib/words.lua", "return 'scene'");
  fixture.write("behaviors_lua/near.lua",
                "local w = require 'words' return behavior { step = function() print(w) end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior("near", "a")
ball:add_behavior("far", "b")
print(require "words")
)",
                         1),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"scene", "show", "installed"}));
}

}  // namespace
}  // namespace limber::script
