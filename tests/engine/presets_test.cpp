// Presets through a playing engine: what is stored comes back, whatever happened in between.
#include "engine/presets.h"

#include "base/log.h"
#include "engine/edited.h"
#include "engine/everything.h"
#include "engine/random_values.h"

namespace limber::engine_test {
namespace {

std::vector<double> kept_of(Show& show) {
  const auto kept = show.engine.store().kept();
  return {kept.begin(), kept.end()};
}

std::vector<std::string> names_of(Show& show) {
  std::vector<std::string> names;
  for (const auto& preset : show.engine.presets().list()) names.push_back(preset->name);
  return names;
}

// what was answered to the message, or ""
template <class... A>
std::string answer(Show& show, std::string address, A&&... args) {
  show.outbox();
  show.send(std::move(address), std::forward<A>(args)...);
  show.ticks(1);
  std::string all;
  for (const std::string& text : show.outbox()) {
    if (!text.starts_with("/physics/contact")) all += (all.empty() ? "" : "\n") + text;
  }
  return all;
}

// values of a scene that stands still, so that nothing but hands moves anything
constexpr const char* kTwo = R"(
sim.gravity = vec3(0, 0, 0)
params { { "wind", 1, min = 0, max = 10 }, { "on", false }, { "way", "in", choices = { "in", "out" } } }
local ball = sim:add_sphere_shape("ball", 0.05)
for _, name in ipairs { "left", "right" } do
  local body = sim:add_body(name)
  body:add_part("tip", ball, { position = vec3(0, name == "left" and 1 or -1, 1) })
  body:add_behavior("force", "push", { amp = 0 })
end
)";

TEST(Presets, EveryValueComesBackToTheBit) {
  Edited edited(kEverything);
  Show& show = edited.show();
  Random random(5, "presets");
  for (int i = 0; i < 5; i++) {
    set_at_random(show.engine.store(), random);
    show.engine.world().settle();
    const std::vector<double> before = kept_of(show);
    EXPECT_EQ(answer(show, "/preset/store", "all"), "");
    EXPECT_GT(set_at_random(show.engine.store(), random), 300);
    EXPECT_NE(kept_of(show), before);
    EXPECT_EQ(answer(show, "/preset/recall", "all"), "");
    EXPECT_EQ(kept_of(show), before);
  }
}

TEST(Presets, AnotherEngineReadsThemToTheBit) {
  Edited edited(kEverything);
  Random random(6, "presets");
  set_at_random(edited.show().engine.store(), random);
  const std::vector<double> before = kept_of(edited.show());
  EXPECT_EQ(answer(edited.show(), "/preset/store", "dusk"), "");
  EXPECT_EQ(answer(edited.show(), "/preset/store", "sky", "looks", "except", "/visuals/camera//*"), "");
  edited.show().engine.finish_saving();
  Show other(edited.folder.path("scripts/scene.lua"));
  EXPECT_EQ(names_of(other), (std::vector<std::string>{"dusk", "sky"}));
  EXPECT_EQ(other.engine.presets().list()[1]->choice.except, (std::vector<std::string>{"/visuals/camera//*"}));
  EXPECT_EQ(answer(other, "/preset/recall", "dusk"), "");
  EXPECT_EQ(kept_of(other), before);
}

TEST(Presets, ChosenByPatternAndWord) {
  Edited edited(kTwo);
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
    EXPECT_EQ(answer(show, "/preset/recall", c.preset), "") << c.preset;
    EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), c.left_friction) << c.preset;
    EXPECT_EQ(show.read("/physics/body/right/part/tip/friction"), c.right_friction) << c.preset;
    EXPECT_EQ(show.read("/physics/body/left/behavior/push/amp"), c.left_amp) << c.preset;
    EXPECT_EQ(show.read("/physics/body/right/behavior/push/amp"), c.right_amp) << c.preset;
    EXPECT_EQ(show.read("/scene/wind"), c.wind) << c.preset;
    EXPECT_EQ(show.read("/visuals/background"), c.hue) << c.preset;
  }
}

TEST(Presets, PosesAndVelocitiesWhenAskedFor) {
  Edited edited(kTwo);
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
  EXPECT_EQ(answer(show, "/transport/pause").substr(0, 16), "/transport/state");
  EXPECT_EQ(answer(show, "/preset/recall", "moving"), "");
  EXPECT_EQ(motion_of(edited.part("left", "tip")), before);
  show.send("/physics/body/left/part/tip/linear_velocity", 0, 0, 5);
  show.send("/physics/body/left/part/tip/position", 7, 7, 7);
  EXPECT_EQ(answer(show, "/preset/recall", "still"), "");
  EXPECT_NEAR(show.read("/physics/body/left/part/tip/position", 2), 1 + 3 * 3 / 60.0, 1e-6);
  EXPECT_EQ(show.read("/physics/body/left/part/tip/linear_velocity", 2), 5) << "it was not asked for";
}

TEST(Presets, ANumberBetweenTwoIsABlend) {
  Edited edited(kTwo);
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
    EXPECT_EQ(answer(show, "/preset/recall", c.number), "");
    EXPECT_EQ(show.read(path), c.friction) << c.number;
    EXPECT_EQ(show.read("/scene/on"), c.on ? 1 : 0) << c.number;
  }
  EXPECT_EQ(answer(show, "/preset/morph", "friction 1", "friction 5", 0.75), "");
  EXPECT_EQ(show.read(path), 4);
  EXPECT_EQ(answer(show, "/preset/morph", "friction 5", 1, 2), "") << "beyond the end is the end";
  EXPECT_EQ(show.read(path), 1);
}

TEST(Presets, WhatOnlyOneOfTwoHasIsLeftAloneInBetween) {
  Edited edited(kTwo);
  Show& show = edited.show();
  show.send("/preset/store", "a", "/physics/body/left//*", "/scene//*");
  show.send("/physics/body/left/part/tip/friction", 1.5);
  show.send("/scene/way", "out");
  show.send("/preset/store", "b", "/physics/body/*/part//*", "/scene/way");
  show.send("/scene/wind", 4);
  show.send("/physics/body/right/part/tip/friction", 9);
  EXPECT_EQ(answer(show, "/preset/recall", 1.5), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1);
  EXPECT_EQ(show.read("/scene/wind"), 4);
  EXPECT_EQ(show.read("/scene/way"), 1) << "a choice switches at the middle";
  EXPECT_EQ(show.read("/physics/body/right/part/tip/friction"), 9);
}

TEST(Presets, InOrderUnderTheirNames) {
  Edited edited(kTwo);
  Show& show = edited.show();
  EXPECT_EQ(answer(show, "/list/presets"), "/list/presets ");
  for (const char* name : {"one", "two", "three"}) EXPECT_EQ(answer(show, "/preset/store", name, "looks"), "");
  EXPECT_EQ(answer(show, "/list/presets"), "/list/presets one two three");
  EXPECT_EQ(answer(show, "/preset/delete", "two"), "");
  EXPECT_EQ(answer(show, "/preset/store", 1), "") << "again, in its place";
  EXPECT_EQ(answer(show, "/list/presets"), "/list/presets one three");
  EXPECT_EQ(show.engine.presets().list()[0]->choice.rows, (std::vector<std::string>{"/visuals//*"}))
      << "made of what it was made of before";
  EXPECT_EQ(show.read("/preset/count"), 2);
  EXPECT_EQ(answer(show, "/get", "/preset/names"), "/preset/names one\nthree");
}

TEST(Presets, ARecallIsTheHandThatAResetKeeps) {
  Edited edited(kTwo);
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
  EXPECT_EQ(show.read("/scene/wind"), 6) << "set after it";
}

TEST(Presets, AReloadDecidesByTheOneRule) {
  Edited edited(std::string(kTwo) + "sim:body('left'):part('tip').friction = 0.2\n");
  Show& show = edited.show();
  const std::string friction = "/physics/body/left/part/tip/friction";
  show.send(friction, 2);
  show.send("/preset/store", "two");
  show.send("/preset/recall", "script");
  show.ticks(1);
  EXPECT_EQ(show.read(friction), 0.2);
  EXPECT_EQ(answer(show, "/preset/recall", "two"), "");
  EXPECT_EQ(edited.save(edited.text + "-- nothing new\n"), Reload::End::applied);
  EXPECT_EQ(show.read(friction), 2) << "said as before";
  EXPECT_EQ(edited.edit("0.2", "0.3"), Reload::End::applied);
  EXPECT_EQ(show.read(friction), 0.3) << "said otherwise";
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read(friction), 0.3) << "and so it stays";
  EXPECT_EQ(answer(show, "/preset/recall", "script"), "");
  EXPECT_EQ(show.read(friction), 0.3);
}

struct Change {
  const char* what;
  const char* from;
  const char* to;
  const char* said;  // how the answer begins, behind the address and the preset's name; null: anyhow
  const char* path;  // a value
  double value;      // what it is after the recall
};

TEST(Presets, SurviveAnEditedScene) {
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
      {"renamed body", "\"two\"", "\"too\"", "2 things are gone (/physics/body/two, /physics/body/two/part/tip); ",
       "/scene/wind", 8},
      {"removed body", "sim:add_body(\"two\"):add_part(\"tip\", ball)", "",
       "2 things are gone (/physics/body/two, /physics/body/two/part/tip)", "/scene/wind", 8},
      {"added body", "sim:add_body(\"two\")", "sim:add_body(\"three\"):add_part(\"tip\", ball) sim:add_body(\"two\")",
       "15 values came since and stay as they are", "/scene/wind", 8},
      {"a part that moves now", "{ mass = 0,", "{ mass = 2,", "1 value came since and stays as it is",
       "/physics/body/one/part/base/mass", 2},
      {"removed behaviour", "local wind = one:add_behavior(\"random_force\", \"wind\", { max_amp = 3 })", "",
       "1 thing is gone (/physics/body/one/behavior/wind)", "/scene/wind", 8},
      {"another behaviour", "\"random_force\", \"wind\", { max_amp = 3 }", "\"force\", \"wind\"", nullptr,
       "/scene/wind", 8},
      {"removed parameter", "{ \"wind\", 1, min = 0, max = 10 }, ", "",
       "1 row is no longer there or of another type (/scene/wind)", "/scene/way", 0},
      {"retyped parameter", "{ \"wind\", 1, min = 0, max = 10 }", "{ \"wind\", true }",
       "1 row is no longer there or of another type (/scene/wind); 1 value came", "/scene/wind", 1},
      {"a vector that becomes a number", "vec3(1, 2, 3)", "4",
       "1 row is no longer there or of another type (/scene/where); 1 value came", "/scene/where", 4},
      {"narrowed range", "max = 10", "max = 5", "1 value was not taken as it is (/scene/wind takes 0 .. 5)",
       "/scene/wind", 5},
      {"choices in another order", "{ \"in\", \"out\" }", "{ \"out\", \"beyond\", \"in\" }", "", "/scene/way", 2},
      {"a choice that is gone", "{ \"in\", \"out\" }", "{ \"out\", \"beyond\" }",
       "1 choice stays as it is (/scene/way has no 'in' any more)", "/scene/way", 0},
      {"another spelling", "\"wind\", 1, min", "\"Wind\", 1, min", "", "/scene/Wind", 8},
  };
  for (const Change& c : kChanges) {
    Edited edited(kScene);
    Show& show = edited.show();
    show.send("/scene/wind", 8);
    show.send("/scene/way", "in");
    show.send("/preset/store", "kept");
    show.send("/preset/recall", "script");
    show.ticks(1);
    EXPECT_EQ(edited.edit(c.from, c.to), Reload::End::applied) << c.what;
    const std::string said = answer(show, "/preset/recall", "kept");
    const std::string_view wanted = c.said == nullptr ? "" : c.said;
    const std::string begin = fmt::format("/error /preset/recall preset 'kept': {}", wanted);
    EXPECT_TRUE(c.said != nullptr && wanted.empty() ? said.empty() : said.starts_with(begin)) << c.what << ": " << said;
    EXPECT_EQ(show.read(c.path), c.value) << c.what;
  }
}

// a slider between presets sends many a second
TEST(Presets, WhatIsLeftOutIsAnsweredEachTimeAndLoggedOnce) {
  Edited edited(kTwo);
  Show& show = edited.show();
  show.send("/preset/store", "dusk");
  show.ticks(1);
  ASSERT_EQ(edited.edit("{ \"on\", false }, ", ""), Reload::End::applied);
  const std::uint64_t before = log_count(LogLevel::warning);
  for (int i = 0; i < 20; i++) {
    EXPECT_EQ(answer(show, "/preset/recall", "dusk"),
              "/error /preset/recall preset 'dusk': 1 row is no longer there or of another type (/scene/on)");
  }
  EXPECT_EQ(log_count(LogLevel::warning) - before, 1u);
}

TEST(Presets, RefusalsNameTheCure) {
  Edited edited(kTwo);
  Show& show = edited.show();
  EXPECT_EQ(answer(show, "/preset/recall", 1), "/error /preset/recall there is no preset yet; /preset/store makes one");
  show.send("/preset/store", "dusk");
  show.ticks(1);
  const auto refused = [&](const std::string& address, auto... args) {
    const std::string said = answer(show, address, args...);
    return said.substr(std::min(said.size(), 8 + address.size()));
  };
  EXPECT_EQ(refused("/preset/recall", "dusky"), "there is no preset 'dusky'; did you mean 'dusk'?");
  EXPECT_EQ(refused("/preset/recall", 2), "presets have the numbers 1 .. 1; 2 is none");
  EXPECT_EQ(refused("/preset/recall", 0.5), "presets have the numbers 1 .. 1; 0.5 is none");
  EXPECT_EQ(refused("/preset/recall", "dusk", -1), "takes 0 to 86400 seconds behind the name");
  EXPECT_EQ(refused("/preset/recall", "dusk", 1, "bouncy"),
            "'bouncy' is no easing; there are: linear, smooth, in, out");
  EXPECT_EQ(refused("/preset/recall"),
            "takes a name or a number, seconds if it is to take some, and how: linear, smooth, in, out");
  EXPECT_EQ(refused("/preset/store"), "takes a name, and what is kept if that is not all");
  EXPECT_EQ(refused("/preset/store", "script"), "'script' is what the scene describes; take another name");
  EXPECT_EQ(refused("/preset/store", "x", "/nowhere/*"), "'/nowhere/*' reaches no property");
  EXPECT_EQ(refused("/preset/store", "x", "/nowhere").substr(0, 29), "there is no 'nowhere' in /; t");
  EXPECT_EQ(refused("/preset/store", "x", "lookz"),
            "'lookz' is none of the words behind the name: patterns of paths, behaviors, looks, all, poses, "
            "velocities, except");
  EXPECT_EQ(refused("/preset/delete", "script"), "'script' is what the scene describes; it can't be deleted");
  EXPECT_EQ(refused("/preset/delete"), "takes the name of a preset");
  EXPECT_EQ(refused("/preset/morph", "dusk", 0.5),
            "takes two presets and how far from the first to the second, 0 to 1");
  EXPECT_EQ(refused("/list/presets", "x"), "takes no arguments");
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"dusk"}));
}

TEST(Presets, ScriptsStoreAndRecall) {
  Edited edited(std::string(kTwo) + R"(
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
  EXPECT_EQ(answer(show, "/go"), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1)
      << "both act once the callback has ended: stored is what it left";
  EXPECT_EQ(names_of(show), (std::vector<std::string>{"four"}));
  const std::string wrong = answer(show, "/wrong");
  EXPECT_NE(wrong.find("presets:recall: there is no preset 'fuor'; did you mean 'four'?"), std::string::npos) << wrong;
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 1) << "what the failing call wrote is taken back";
  EXPECT_EQ(answer(show, "/mix"), "");
  EXPECT_EQ(show.read("/physics/body/left/part/tip/friction"), 0.75) << "half-way from 0.5 to 1";
  EXPECT_TRUE(names_of(show).empty());
}

TEST(Presets, TheCommandLineBeginsWithOne) {
  Edited edited(kTwo);
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
  EXPECT_EQ(other.read("/physics/sim/gravity", 2), -1) << "what is set comes after it";
  EngineLink link;
  options.preset = "wind";
  Engine wrong(link, options);
  const Result<void> started = wrong.start();
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error(), "--preset: there is no preset 'wind'; did you mean 'windy'?");
}

TEST(Presets, AGroupAndItsMembersEachHaveTheirOwn) {
  Edited edited(std::string(kTwo) + R"(sim:add_group_behavior("cohesion", "swarm", { bodies = "all" }))");
  Show& show = edited.show();
  const std::string member = "/physics/body/left/behavior/swarm/amount";
  show.send("/physics/group/swarm/amount", 2);
  show.send(member, 3);
  show.send("/preset/store", "kept");
  show.send("/physics/group/swarm/amount", 5);
  EXPECT_EQ(answer(show, "/preset/recall", "kept"), "");
  EXPECT_EQ(show.read("/physics/group/swarm/amount"), 2);
  EXPECT_EQ(show.read("/physics/body/right/behavior/swarm/amount"), 2);
  EXPECT_EQ(show.read(member), 3);
  show.send("/physics/group/swarm/amount", 5);
  EXPECT_EQ(answer(show, "/preset/recall", "kept", 0.05), "");
  show.ticks(10);
  EXPECT_EQ(show.read("/physics/group/swarm/amount"), 2);
  EXPECT_EQ(show.read(member), 3) << "and at the end of a morph";
}

}  // namespace
}  // namespace limber::engine_test
