// Types of behaviors_lua/: where their files are found, what they declare, what is wrong with them.
#include <algorithm>

#include <gtest/gtest.h>

#include "behavior_stage.h"
#include "params/catalog.h"
#include "script/sources.h"

namespace limber {
namespace {

// a type whose step prints a word
std::string says(const std::string& word) { return "return behavior { step = function() print('" + word + "') end }"; }

TEST(BehaviorTypes, TheNearestFileWins) {
  BehaviorStage stage;
  stage.write("behaviors_lua/hum.lua", says("show"));
  stage.write("scripts/behaviors_lua/hum.lua", says("scripts"));
  ASSERT_EQ(stage.play(std::string(kBall) + "ball:add_behavior('hum', 'a')", 1), "");
  EXPECT_EQ(stage.host.printed, std::vector<std::string>{"scripts"});
}

TEST(BehaviorTypes, TheInstalledOnesComeLast) {
  BehaviorStage data;
  data.write("behaviors_lua/hum.lua", says("installed"));
  data.write("behaviors_lua/buzz.lua", says("buzz"));
  BehaviorStage stage(with_data(data.folder));
  stage.write("behaviors_lua/hum.lua", says("show"));
  ASSERT_EQ(stage.play(std::string(kBall) + "ball:add_behavior('hum', 'a') ball:add_behavior('buzz', 'b')", 1), "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"show", "buzz"}));
}

TEST(BehaviorTypes, NamesAreComparedLoosely) {
  BehaviorStage stage;
  stage.write("behaviors_lua/soft_hum.lua", says("hum"));
  ASSERT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior("SoftHumBehavior", "a")
ball:add_behavior("softhum", "b")
)",
                       1),
            "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"hum", "hum"}));
  EXPECT_EQ(stage.world.find_body("ball")->find_behavior("a")->type().name, "soft_hum");
}

TEST(BehaviorTypes, AMissingOneSaysWhereItWasLookedFor) {
  BehaviorStage data;
  BehaviorStage stage(with_data(data.folder));
  stage.write("behaviors_lua/breathe.lua", says("x"));
  const std::string fault = stage.run(std::string(kBall) + "ball:add_behavior('brethe', 'a')");
  EXPECT_EQ(first_line(fault), "scripts/scene.lua:5: there is no behavior type 'brethe'; did you mean 'breathe'?");
  for (const auto& folder : {stage.folder / "scripts", stage.folder, data.folder}) {
    EXPECT_NE(fault.find("\n  " + (folder / "behaviors_lua").string() + "\n"), std::string::npos) << fault;
  }
  // the built-in ones are near names too
  BehaviorStage second;
  const std::string other = second.run(std::string(kBall) + "ball:add_behavior('random_forse', 'a')");
  EXPECT_NE(other.find("did you mean 'random_force'?"), std::string::npos) << other;
}

TEST(BehaviorTypes, AFileCalledLikeABuiltInTypeIsAnError) {
  BehaviorStage stage;
  stage.write("behaviors_lua/Random_Force.lua", says("x"));
  EXPECT_EQ(first_line(stage.run(std::string(kBall) + "ball:add_behavior('random_force', 'a')")),
            "scripts/scene.lua:5: behaviors_lua/Random_Force.lua: 'random_force' is a built-in behavior type; call the "
            "file something else");
}

TEST(BehaviorTypes, ParametersBecomeRows) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one(R"(
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
  const BehaviorType& type = stage.it().type();
  EXPECT_EQ(type.name, "test");
  EXPECT_EQ(type.doc, "Hums.");
  EXPECT_FALSE(type.is_built_in);
  EXPECT_EQ(type.table->row_names(), (std::vector<std::string_view>{"active", "time", "remove", "place", "rate", "loud",
                                                                    "where", "mood", "error"}));
  const Row& rate = stage.row("rate");
  EXPECT_EQ(rate.type, RowType::number);
  EXPECT_EQ(rate.kind, RowKind::property);
  EXPECT_EQ(rate.unit, "Hz");
  EXPECT_EQ(rate.doc, "Hums per second.");
  EXPECT_EQ(rate.max, 4);
  EXPECT_EQ(rate.step, 0.05);
  EXPECT_EQ(rate.initial[0], 0.25);
  EXPECT_EQ(stage.row("loud").type, RowType::boolean);
  EXPECT_EQ(stage.row("where").high(2), 7);
  EXPECT_EQ(stage.row("mood").choices, (std::vector<std::string>{"wild", "calm"}));
  EXPECT_EQ(stage.value("rate"), 4) << "clamped";
  EXPECT_EQ(stage.value("mood"), 0);
  const Result<Place> place = find_place(stage.store, "/physics/body/ball/behavior/it/rate");
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place->row, &rate);
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
  EXPECT_EQ(with("{ 'rate', 1, unit = 'furlong' },").substr(0, 90),
            "behaviors_lua/test.lua:4: params: 'rate' has the unit 'furlong', which limber doesn't know");
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
  // a declaration that failed leaves nothing behind
  BehaviorStage stage;
  stage.write("behaviors_lua/bad.lua",
              "return behavior { params = { { 'rate', 1 }, { 'x' } }, step = function() end }");
  stage.write("behaviors_lua/good.lua", "return behavior { params = { { 'rate', 1 } }, step = function() end }");
  EXPECT_EQ(stage.play(std::string(kBall) + R"(
print(pcall(function() ball:add_behavior("bad", "a") end))
ball:add_behavior("good", "b")
)"),
            "");
  EXPECT_EQ(stage.host.printed.front().substr(0, 5), "false");
}

TEST(BehaviorTypes, SixtyParametersAndNoMore) {
  const auto many = [](int count) {
    std::string params;
    for (int i = 1; i <= count; i++) params += "{ 'p" + std::to_string(i) + "', 1 }, ";
    return load_error("return behavior { params = { " + params + "}, step = function() end }");
  };
  EXPECT_EQ(many(60), "no error");
  EXPECT_EQ(many(61), "behaviors_lua/test.lua:1: params: a behavior may have 60 parameters");
}

TEST(BehaviorTypes, WhatDoesNotCompileOrRunRefusesTheScene) {
  EXPECT_EQ(load_error("return behavior {\n  step = function( end }"),
            "behaviors_lua/test.lua:2: <name> or '...' expected near 'end'");
  BehaviorStage stage;
  const std::string fault = stage.play_one("\nlocal x = nil + 1\n");
  EXPECT_EQ(first_line(fault), "behaviors_lua/test.lua:2: attempt to perform arithmetic on a nil value");
  EXPECT_NE(fault.find("2 | local x = nil + 1"), std::string::npos) << fault;
  EXPECT_NE(fault.find("scripts/scene.lua:5: in the main chunk"), std::string::npos) << fault;
  EXPECT_EQ(load_error("error({})"), "scripts/scene.lua:5: an error that is no text but a table");
}

TEST(BehaviorTypes, ACallbackTakesWhatTheRunHasLoaded) {
  BehaviorStage stage;
  stage.write("behaviors_lua/hum.lua", says("hum"));
  stage.write("behaviors_lua/buzz.lua", says("buzz"));
  ASSERT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior("hum", "a", { active = false })
sim:on_start(function() ball:add_behavior("hum", "b") end)
sim:on_start(function() ball:add_behavior("buzz", "c") end)
)",
                       1),
            "");
  EXPECT_EQ(stage.host.printed, std::vector<std::string>{"hum"});
  ASSERT_EQ(stage.host.faults.size(), 1u);
  EXPECT_EQ(first_line(stage.host.faults[0].text),
            "scripts/scene.lua:8: the behavior type 'buzz' was not loaded when the scene ran; a callback must not wait "
            "for a disk, so name it once at the top level");
}

TEST(BehaviorTypes, TheRunKnowsItsFiles) {
  BehaviorStage stage;
  stage.write("behaviors_lua/lib/steps.lua", "return { word = require('more.words') }");
  stage.write("behaviors_lua/lib/more/words.lua", "return 'left'");
  stage.write("behaviors_lua/test.lua",
              "local steps = require 'steps'\nreturn behavior { step = function() print(steps.word) end }");
  ASSERT_EQ(stage.play(std::string(kBall) + "ball:add_behavior('test', 'it')", 1), "");
  EXPECT_EQ(stage.host.printed, std::vector<std::string>{"left"});
  const auto& file = static_cast<LuaBehavior&>(stage.it()).file();
  EXPECT_EQ(file.type, "test");
  EXPECT_EQ(file.shown, "behaviors_lua/test.lua");
  EXPECT_EQ(file.path, (stage.folder / "behaviors_lua" / "test.lua").string());
  const auto reads = [&](const std::string& name) {
    const auto files = stage.scene.sources()->files();
    return std::ranges::any_of(files, [&](const SourceFile& f) { return f.path == (stage.folder / name).string(); });
  };
  EXPECT_TRUE(reads("behaviors_lua/test.lua"));
  EXPECT_TRUE(reads("behaviors_lua/lib/steps.lua"));
  EXPECT_TRUE(reads("behaviors_lua/lib/more/words.lua"));
}

TEST(BehaviorTypes, ModulesLieBesideTheFileFirst) {
  BehaviorStage data;
  data.write("behaviors_lua/lib/words.lua", "return 'installed'");
  data.write("behaviors_lua/far.lua", "local w = require 'words' return behavior { step = function() print(w) end }");
  BehaviorStage stage(with_data(data.folder));
  stage.write("behaviors_lua/lib/words.lua", "return 'show'");
  stage.write("scripts/lib/words.lua", "return 'scene'");
  stage.write("behaviors_lua/near.lua", "local w = require 'words' return behavior { step = function() print(w) end }");
  ASSERT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior("near", "a")
ball:add_behavior("far", "b")
print(require "words")
)",
                       1),
            "");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"scene", "show", "installed"}));
}

}  // namespace
}  // namespace limber
