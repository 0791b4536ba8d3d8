// Presets in a running engine: stored values are restored, whatever happened in between.
#include "engine/presets/presets.h"

#include "base/log/log.h"
#include "engine/edited.h"
#include "engine/everything.h"
#include "engine/random_values.h"

namespace limber::engine::test {
namespace {

std::vector<double> persistent_values(Show& show) {
  const auto persistent = show.engine.store().persistent_values();
  return {persistent.begin(), persistent.end()};
}

std::vector<std::string> names_of(Show& show) {
  std::vector<std::string> names;
  for (const auto& preset : show.engine.presets().list()) names.push_back(preset->name);
  return names;
}

// Sends a message; returns the reply, or "".
template <class... A>
std::string send_and_get_reply(Show& show, std::string address, A&&... args) {
  show.sent_texts();
  show.send(std::move(address), std::forward<A>(args)...);
  show.ticks(1);
  std::string all;
  for (const std::string& text : show.sent_texts()) {
    if (!text.starts_with("/physics/contact")) all += (all.empty() ? "" : "\n") + text;
  }
  return all;
}

// a static scene, so that only messages change values
constexpr const char* kTwoBodyScene = R"(
sim.gravity = vec3(0, 0, 0)
params { { "wind", 1, min = 0, max = 10 }, { "on", false }, { "way", "in", choices = { "in", "out" } } }
local ball = sim:add_sphere_shape("ball", 0.05)
for _, name in ipairs { "left", "right" } do
  local body = sim:add_body(name)
  body:add_part("tip", ball, { position = vec3(0, name == "left" and 1 or -1, 1) })
  body:add_behavior("force", "push", { amp = 0 })
end
)";

TEST(Presets, RestoresEveryValueExactly) {
  EditedShow edited(kEverything);
  Show& show = edited.show();
  Random random(5, "presets");
  for (int i = 0; i < 5; i++) {
    set_random_values(show.engine.store(), random);
    show.engine.world().flush();
    const std::vector<double> before = persistent_values(show);
    EXPECT_EQ(send_and_get_reply(show, "/preset/store", "all"), "");
    EXPECT_GT(set_random_values(show.engine.store(), random), 300);
    EXPECT_NE(persistent_values(show), before);
    EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "all"), "");
    EXPECT_EQ(persistent_values(show), before);
  }
}

TEST(Presets, AnotherEngineReadsThemExactly) {
  EditedShow edited(kEverything);
  Random random(6, "presets");
  set_random_values(edited.show().engine.store(), random);
  const std::vector<double> before = persistent_values(edited.show());
  EXPECT_EQ(send_and_get_reply(edited.show(), "/preset/store", "dusk"), "");
  EXPECT_EQ(send_and_get_reply(edited.show(), "/preset/store", "sky", "looks", "except", "/visuals/camera//*"), "");
  edited.show().engine.finish_saving();
  Show other(edited.folder.path("scripts/scene.lua"));
  EXPECT_EQ(names_of(other), (std::vector<std::string>{"dusk", "sky"}));
  EXPECT_EQ(other.engine.presets().list()[1]->selection.except, (std::vector<std::string>{"/visuals/camera//*"}));
  EXPECT_EQ(send_and_get_reply(other, "/preset/recall", "dusk"), "");
  EXPECT_EQ(persistent_values(other), before);
}

TEST(Presets, SelectsByPatternAndWord) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/preset/store", "left", "/physics/body/left//*");
  show.send("/preset/store", "moves", "behaviors");
  show.send("/preset/store", "looks", "looks");
  show.send("/preset/store", "most", "all", "except", "/scene//*", "/physics/body/right/part/tip/friction");
  show.ticks(1);
  const auto disturb = [&] {
    for (const char* body : {"left", "right"}) {
      show.send(fmt::format("/physics/body/{}/part/tip/friction", body), 3);
      show.send(fmt::format("/physics/body/{}/behavior/push/amp", body), 7);
    }
    show.send("/scene/wind", 9);
    show.send("/visuals/background", 0.5, 0.5, 0.5);
    show.ticks(1);
  };
  struct Case {
    const char* preset;
    double left_friction, right_friction, left_amp, right_amp, wind, hue;
  };
  constexpr Case kCases[] = {{"left", 0.5, 3, 0, 7, 9, 0.5},
                             {"moves", 3, 3, 0, 0, 9, 0.5},
                             {"looks", 3, 3, 7, 7, 9, 0.62},
                             {"most", 0.5, 3, 0, 0, 9, 0.62},
                             {"script", 0.5, 0.5, 0, 0, 1, 0.62}};
  for (const Case& c : kCases) {
    disturb();
    EXPECT_EQ(send_and_get_reply(show, "/preset/recall", c.preset), "") << c.preset;
    EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), c.left_friction) << c.preset;
    EXPECT_EQ(show.read("/physics/body/right/part/tip/friction"), c.right_friction) << c.preset;
    EXPECT_EQ(show.read("/physics/body/left/behavior/push/amp"), c.left_amp) << c.preset;
    EXPECT_EQ(show.read("/physics/body/right/behavior/push/amp"), c.right_amp) << c.preset;
    EXPECT_EQ(show.read("/scene/wind"), c.wind) << c.preset;
    EXPECT_EQ(show.read("/visuals/background"), c.hue) << c.preset;
  }
}

TEST(Presets, IncludesPosesAndVelocitiesOnRequest) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/physics/body/left/part/tip/linear_velocity", 1, 2, 3);
  show.send("/physics/body/left/part/tip/rotation", 0.1, 0.2, 0.3, 0.4);
  show.ticks(3);
  show.send("/transport/pause");
  show.ticks(1);
  show.send("/preset/store", "still", "poses", "/physics/body/left//*");
  show.send("/preset/store", "moving", "all", "poses", "velocities");
  show.ticks(1);
  const std::vector<double> before = motion_of(edited.part("left", "tip"));
  show.send("/transport/play");
  show.ticks(20);
  EXPECT_EQ(send_and_get_reply(show, "/transport/pause").substr(0, 16), "/transport/state");
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "moving"), "");
  EXPECT_EQ(motion_of(edited.part("left", "tip")), before);
  show.send("/physics/body/left/part/tip/linear_velocity", 0, 0, 5);
  show.send("/physics/body/left/part/tip/position", 7, 7, 7);
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "still"), "");
  EXPECT_NEAR(show.read("/physics/body/left/part/tip/position", 2), 1 + 3 * 3 / 60.0, 1e-6);
  EXPECT_EQ(show.read("/physics/body/left/part/tip/linear_velocity", 2), 5) << "velocities were not stored";
}

TEST(Presets, AFractionalNumberIsABlend) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  const std::string path = "/physics/body/left/part/tip/friction";
  for (const double friction : {1.0, 2.0, 5.0}) {
    show.send(path, friction);
    show.send("/scene/on", friction > 4);
    show.send("/preset/store", fmt::format("friction {}", friction));
    show.ticks(1);
  }
  struct Case {
    double number, friction;
    bool on;
  };
  for (const Case& c : {Case{1, 1, false}, {2.5, 3.5, true}, {2.25, 2.75, false}, {3, 5, true}, {1.5, 1.5, false}}) {
    EXPECT_EQ(send_and_get_reply(show, "/preset/recall", c.number), "");
    EXPECT_EQ(show.read(path), c.friction) << c.number;
    EXPECT_EQ(show.read("/scene/on"), c.on ? 1 : 0) << c.number;
  }
  EXPECT_EQ(send_and_get_reply(show, "/preset/morph", "friction 1", "friction 5", 0.75), "");
  EXPECT_EQ(show.read(path), 4);
  EXPECT_EQ(send_and_get_reply(show, "/preset/morph", "friction 5", 1, 2), "") << "the amount is clamped to 1";
  EXPECT_EQ(show.read(path), 1);
}

TEST(Presets, BlendsOnlyPropertiesOfBoth) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/preset/store", "a", "/physics/body/left//*", "/scene//*");
  show.send("/physics/body/left/part/tip/friction", 1.5);
  show.send("/scene/way", "out");
  show.send("/preset/store", "b", "/physics/body/*/part//*", "/scene/way");
  show.send("/scene/wind", 4);
  show.send("/physics/body/right/part/tip/friction", 9);
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", 1.5), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1);
  EXPECT_EQ(show.read("/scene/wind"), 4);
  EXPECT_EQ(show.read("/scene/way"), 1) << "a choice switches at the middle";
  EXPECT_EQ(show.read("/physics/body/right/part/tip/friction"), 9);
}

TEST(Presets, KeepsOrderAndNames) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  EXPECT_EQ(send_and_get_reply(show, "/list/presets"), "/list/presets ");
  for (const char* name : {"one", "two", "three"})
    EXPECT_EQ(send_and_get_reply(show, "/preset/store", name, "looks"), "");
  EXPECT_EQ(send_and_get_reply(show, "/list/presets"), "/list/presets one two three");
  EXPECT_EQ(send_and_get_reply(show, "/preset/delete", "two"), "");
  EXPECT_EQ(send_and_get_reply(show, "/preset/store", 1), "") << "replaces the preset in its place";
  EXPECT_EQ(send_and_get_reply(show, "/list/presets"), "/list/presets one three");
  EXPECT_EQ(show.engine.presets().list()[0]->selection.include, (std::vector<std::string>{"/visuals//*"}))
      << "with the same selection as before";
  EXPECT_EQ(show.read("/preset/count"), 2);
  EXPECT_EQ(send_and_get_reply(show, "/get", "/preset/names"), "/preset/names one\nthree");
}

TEST(Presets, ARecallSurvivesAReset) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/physics/body/left/part/tip/friction", 2);
  show.send("/preset/store", "two");
  show.send("/physics/body/left/part/tip/friction", 3);
  show.send("/scene/wind", 5);
  show.send("/preset/recall", "two");
  show.send("/scene/wind", 6);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 2);
  EXPECT_EQ(show.read("/scene/wind"), 6) << "set after the recall";
}

TEST(Presets, AReloadOverridesOnlyChangedLines) {
  EditedShow edited(std::string(kTwoBodyScene) + "sim:body('left'):part('tip').friction = 0.2\n");
  Show& show = edited.show();
  const std::string friction = "/physics/body/left/part/tip/friction";
  show.send(friction, 2);
  show.send("/preset/store", "two");
  show.send("/preset/recall", "script");
  show.ticks(1);
  EXPECT_EQ(show.read(friction), 0.2);
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "two"), "");
  EXPECT_EQ(edited.save(edited.text + "-- nothing new\n"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(show.read(friction), 2) << "the line is unchanged";
  EXPECT_EQ(edited.edit("0.2", "0.3"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(show.read(friction), 0.3) << "the line has changed";
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read(friction), 0.3) << "also after a reset";
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "script"), "");
  EXPECT_EQ(show.read(friction), 0.3);
}

struct Change {
  const char* name;
  const char* from;
  const char* to;
  const char* reply_prefix;  // prefix of the reply, after the address and the preset's name; null: any
  const char* path;          // of a property
  double value;              // expected value after the recall
};

TEST(Presets, RecallAfterAnEditOfTheScene) {
  constexpr const char* kScene = R"(
params { { "wind", 1, min = 0, max = 10 }, { "way", "out", choices = { "in", "out" } }, { "where", vec3(1, 2, 3) } }
local ball = sim:add_sphere_shape("ball", 0.05)
local one = sim:add_body("one")
one:add_part("tip", ball)
one:add_part("base", ball, { mass = 0, position = vec3(0, 0, -1) })
local wind = one:add_behavior("random_force", "wind", { max_amp = 3 })
sim:add_body("two"):add_part("tip", ball)
)";
  constexpr Change kChanges[] = {
      {"renamed body", "\"two\"", "\"too\"",
       "2 objects were not found (/physics/body/two, /physics/body/two/part/tip); ", "/scene/wind", 8},
      {"removed body", "sim:add_body(\"two\"):add_part(\"tip\", ball)", "",
       "2 objects were not found (/physics/body/two, /physics/body/two/part/tip)", "/scene/wind", 8},
      {"added body", "sim:add_body(\"two\")", "sim:add_body(\"three\"):add_part(\"tip\", ball) sim:add_body(\"two\")",
       "21 values are new and stay unchanged", "/scene/wind", 8},
      {"a part that moves now", "{ mass = 0,", "{ mass = 2,", "1 value is new and stays unchanged",
       "/physics/body/one/part/base/mass", 2},
      {"removed behavior", "local wind = one:add_behavior(\"random_force\", \"wind\", { max_amp = 3 })", "",
       "1 object was not found (/physics/body/one/behavior/wind)", "/scene/wind", 8},
      {"another behavior", "\"random_force\", \"wind\", { max_amp = 3 }", "\"force\", \"wind\"", nullptr, "/scene/wind",
       8},
      {"removed parameter", "{ \"wind\", 1, min = 0, max = 10 }, ", "",
       "1 property is missing or of another type (/scene/wind)", "/scene/way", 0},
      {"retyped parameter", "{ \"wind\", 1, min = 0, max = 10 }", "{ \"wind\", true }",
       "1 property is missing or of another type (/scene/wind); 1 value is new", "/scene/wind", 1},
      {"a vector that becomes a number", "vec3(1, 2, 3)", "4",
       "1 property is missing or of another type (/scene/where); 1 value is new", "/scene/where", 4},
      {"narrowed range", "max = 10", "max = 5", "1 value was clamped or rejected (/scene/wind accepts 0 .. 5)",
       "/scene/wind", 5},
      {"choices in another order", "{ \"in\", \"out\" }", "{ \"out\", \"beyond\", \"in\" }", "", "/scene/way", 2},
      {"a choice that is gone", "{ \"in\", \"out\" }", "{ \"out\", \"beyond\" }",
       "1 choice stays unchanged (/scene/way has no 'in' any more)", "/scene/way", 0},
      {"another spelling", "\"wind\", 1, min", "\"Wind\", 1, min", "", "/scene/Wind", 8},
  };
  for (const Change& c : kChanges) {
    EditedShow edited(kScene);
    Show& show = edited.show();
    show.send("/scene/wind", 8);
    show.send("/scene/way", "in");
    show.send("/preset/store", "kept");
    show.send("/preset/recall", "script");
    show.ticks(1);
    EXPECT_EQ(edited.edit(c.from, c.to), SceneReloader::ApplyResult::applied) << c.name;
    const std::string reply = send_and_get_reply(show, "/preset/recall", "kept");
    const std::string_view expected = c.reply_prefix == nullptr ? "" : c.reply_prefix;
    const std::string begin = fmt::format("/error /preset/recall preset 'kept': {}", expected);
    EXPECT_TRUE(c.reply_prefix != nullptr && expected.empty() ? reply.empty() : reply.starts_with(begin))
        << c.name << ": " << reply;
    EXPECT_EQ(show.read(c.path), c.value) << c.name;
  }
}

// a slider that blends presets sends many messages per second
TEST(Presets, SkippedValuesAreRepliedEachTimeAndLoggedOnce) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/preset/store", "dusk");
  show.ticks(1);
  ASSERT_EQ(edited.edit("{ \"on\", false }, ", ""), SceneReloader::ApplyResult::applied);
  const std::uint64_t before = log_count(LogLevel::warning);
  for (int i = 0; i < 20; i++) {
    EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "dusk"),
              "/error /preset/recall preset 'dusk': 1 property is missing or of another type (/scene/on)");
  }
  EXPECT_EQ(log_count(LogLevel::warning) - before, 1u);
}

TEST(Presets, ErrorsNameTheFix) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", 1),
            "/error /preset/recall there is no preset yet; /preset/store makes one");
  show.send("/preset/store", "dusk");
  show.ticks(1);
  const auto rejection = [&](const std::string& address, auto... args) {
    const std::string reply = send_and_get_reply(show, address, args...);
    return reply.substr(std::min(reply.size(), 8 + address.size()));
  };
  EXPECT_EQ(rejection("/preset/recall", "dusky"), "there is no preset 'dusky'; did you mean 'dusk'?");
  EXPECT_EQ(rejection("/preset/recall", 2), "the number of a preset must be 1 to 1, got 2");
  EXPECT_EQ(rejection("/preset/recall", 0.5), "the number of a preset must be 1 to 1, got 0.5");
  EXPECT_EQ(rejection("/preset/recall", "dusk", -1), "the duration must be 0 to 86400 s");
  EXPECT_EQ(rejection("/preset/recall", "dusk", 1, "bouncy"),
            "unknown easing 'bouncy'; expected one of: linear, smooth, in, out");
  EXPECT_EQ(rejection("/preset/recall"),
            "expected a name or a number, optionally seconds and an easing: linear, smooth, in, out");
  EXPECT_EQ(rejection("/preset/store"), "expected a name, and optionally the properties to store");
  EXPECT_EQ(rejection("/preset/store", "script"), "'script' is reserved for the values of the scene; use another name");
  EXPECT_EQ(rejection("/preset/store", "x", "/nowhere/*"), "'/nowhere/*' matches no property");
  EXPECT_EQ(rejection("/preset/store", "x", "/nowhere").substr(0, 29), "there is no 'nowhere' in /; t");
  EXPECT_EQ(rejection("/preset/store", "x", "lookz"),
            "unknown word 'lookz'; expected path patterns, behaviors, looks, all, poses, "
            "velocities, except");
  EXPECT_EQ(rejection("/preset/delete", "script"), "'script' has the values of the scene; it can't be deleted");
  EXPECT_EQ(rejection("/preset/delete"), "expected the name of a preset");
  EXPECT_EQ(rejection("/preset/morph", "dusk", 0.5), "expected two presets and an amount from 0 to 1");
  EXPECT_EQ(rejection("/list/presets", "x"), "takes no arguments");
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"dusk"}));
}

TEST(Presets, ScriptsStoreAndRecall) {
  EditedShow edited(std::string(kTwoBodyScene) + R"(
local tip = sim:body("left"):part("tip")
osc:on("/go", function()
  tip.friction = 4
  presets:store("four", { rows = "/physics/body/left//*", poses = true })
  tip.friction = 1
  presets:recall("four")
end)
osc:on("/names", function() print(#presets.names, presets.names[1]) end)
osc:on("/wrong", function() tip.friction = 8 presets:recall("fuor") end)
osc:on("/mix", function() presets:morph("script", "four", 0.5) presets:delete("four") end)
)");
  Show& show = edited.show();
  EXPECT_EQ(send_and_get_reply(show, "/go"), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1)
      << "both act after the callback: the final values are stored";
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"four"}));
  const std::string wrong = send_and_get_reply(show, "/wrong");
  EXPECT_NE(wrong.find("presets:recall: there is no preset 'fuor'; did you mean 'four'?"), std::string::npos) << wrong;
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1) << "writes of the failed call are rolled back";
  EXPECT_EQ(send_and_get_reply(show, "/mix"), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 0.75) << "half-way from 0.5 to 1";
  EXPECT_TRUE(names_of(show).empty());
}

// Steps of one behavior type run in one call of the script engine; a failure rolls back only its own step.
TEST(Presets, RequestOfABehaviorSurvivesTheFailureOfTheNextOne) {
  constexpr const char* kKeeper = R"(
return behavior { step = function(self)
  if sim.tick == 2 then
    presets:store(self.body.name, { poses = true })
    if self.body.name == "right" then error("stop") end
  end
end })";
  EditedShow edited(std::string(kTwoBodyScene) + R"(
for _, name in ipairs { "left", "right" } do sim:body(name):add_behavior("keeper", "keeper") end
)",
                    {{"behaviors_lua/keeper.lua", kKeeper}});
  edited.show().ticks(5);
  EXPECT_EQ(names_of(edited.show()), (std::vector<std::string>{"left"}));
}

TEST(Presets, RenameKeepsValuesAndPosition) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  for (const double wind : {2.0, 3.0}) {
    show.send("/scene/wind", wind);
    show.send("/preset/store", wind == 2 ? "breeze" : "storm");
  }
  show.ticks(1);
  EXPECT_EQ(send_and_get_reply(show, "/preset/rename", "breeze", "light wind"), "");
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"light wind", "storm"}));
  EXPECT_EQ(send_and_get_reply(show, "/preset/rename", 2, "gale"), "");
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"light wind", "gale"}));
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "light wind"), "");
  EXPECT_EQ(show.read("/scene/wind"), 2);
  show.engine.finish_saving();
  Show later(fast_options(edited.folder.path("scripts/scene.lua")));
  EXPECT_EQ(names_of(later), (std::vector<std::string>{"light wind", "gale"})) << "from the file";
}

TEST(Presets, RenameRejectsTakenAndInvalidNames) {
  EditedShow edited(kTwoBodyScene);
  Show& show = edited.show();
  show.send("/preset/store", "dusk");
  show.send("/preset/store", "dawn");
  show.ticks(1);
  const auto rejection = [&](auto... args) {
    const std::string reply = send_and_get_reply(show, "/preset/rename", args...);
    return reply.substr(std::min(reply.size(), std::string("/error /preset/rename ").size()));
  };
  EXPECT_EQ(rejection("dusk", "dawn"), "there is a preset 'dawn' already; delete it first");
  EXPECT_EQ(rejection("dusk", "script"), "'script' is reserved for the values of the scene; use another name");
  EXPECT_EQ(rejection("script", "scene"), "'script' has the values of the scene; it can't be renamed");
  EXPECT_EQ(rejection("dsk", "night"), "there is no preset 'dsk'; did you mean 'dusk'?");
  EXPECT_EQ(rejection("dusk"), "expected the name or the number of a preset, and its new name");
  EXPECT_EQ(rejection("dusk", 3), "expected the name or the number of a preset, and its new name");
  EXPECT_EQ(rejection("dusk", "dusk"), "") << "the name that it has";
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"dusk", "dawn"}));
}

TEST(Presets, ScriptsRename) {
  EditedShow edited(std::string(kTwoBodyScene) + R"(
osc:on("/go", function()
  presets:store("a")
  presets:rename("a", "b")
  presets:recall("b")
end)
osc:on("/wrong", function() presets:rename("b", "c") presets:recall("b") end)
)");
  Show& show = edited.show();
  EXPECT_EQ(send_and_get_reply(show, "/go"), "");
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"b"}));
  const std::string wrong = send_and_get_reply(show, "/wrong");
  EXPECT_NE(wrong.find("presets:recall: there is no preset 'b'"), std::string::npos) << wrong;
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"b"})) << "the failed call is rolled back";
}

TEST(Presets, TheCommandLineRecallsOne) {
  EditedShow edited(kTwoBodyScene);
  edited.show().send("/scene/wind", 7);
  edited.show().send("/physics/sim/gravity", 0, 0, -3);
  edited.show().send("/preset/store", "windy");
  edited.show().ticks(1);
  edited.show().engine.finish_saving();
  EngineOptions options = fast_options(edited.folder.path("scripts/scene.lua"));
  options.preset = "windy";
  options.sets = {message("/physics/sim/gravity", 0, 0, -1)};
  Show other(options);
  EXPECT_EQ(other.read("/scene/wind"), 7);
  EXPECT_EQ(other.read("/physics/sim/gravity", 2), -1) << "--set is applied after --preset";
  EngineLink link;
  options.preset = "wind";
  Engine wrong(link, options);
  const Result<void> started = wrong.start();
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error(), "--preset: there is no preset 'wind'; did you mean 'windy'?");
}

TEST(Presets, StoresGroupsAndMembersSeparately) {
  EditedShow edited(std::string(kTwoBodyScene) + R"(sim:add_group_behavior("cohesion", "swarm", { bodies = "all" }))");
  Show& show = edited.show();
  const std::string member = "/physics/body/left/behavior/swarm/amount";
  show.send("/physics/group/swarm/amount", 2);
  show.send(member, 3);
  show.send("/preset/store", "kept");
  show.send("/physics/group/swarm/amount", 5);
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "kept"), "");
  EXPECT_EQ(show.read("/physics/group/swarm/amount"), 2);
  EXPECT_EQ(show.read("/physics/body/right/behavior/swarm/amount"), 2);
  EXPECT_EQ(show.read(member), 3);
  show.send("/physics/group/swarm/amount", 5);
  EXPECT_EQ(send_and_get_reply(show, "/preset/recall", "kept", 0.05), "");
  show.ticks(10);
  EXPECT_EQ(show.read("/physics/group/swarm/amount"), 2);
  EXPECT_EQ(show.read(member), 3) << "also at the end of a morph";
}

}  // namespace
}  // namespace limber::engine::test
