// The console's side of a scene: texts evaluated in its environment, and the words that may end a half-written one.
#include <gtest/gtest.h>

#include <sstream>

#include "stage.h"

namespace limber {
namespace {

using Kind = Evaluation::Kind;

/// A scene with a body "arm": a base that stands, a tip, a joint and motor "hinge".
constexpr const char* kConsoleArm = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0 })
arm:add_part("tip", ball, { position = { 0, 0, 1 } })
arm:add_motor(arm:add_joint("hinge", "base", "tip", { axis = { 0, 1, 0 } }))
params { { "wind", 3 }, { "warmth", 1 } }
state.hits = 4
local hidden = 1
)";

constexpr const char* kSway = R"(
return behavior {
  params = { { "depth", 1, min = 0, max = 9 }, { "delay", vec3() } },
  step = function(self) end,
}
)";
constexpr const char* kHerd =
    "return behavior { group = true, params = { { 'closeness', 1 } }, step = function() end }";

struct Console : testing::Test {
  explicit Console(const std::string& more = "") {
    stage.write("behaviors_lua/sway.lua", kSway);
    stage.write("behaviors_lua/herd.lua", kHerd);
    EXPECT_EQ(stage.play(kConsoleArm + more), "");
  }

  /// "kind: text" of what comes of it.
  std::string say(const std::string& text) {
    const Evaluation said = stage.scene.evaluate(text);
    constexpr const char* kWords[] = {"done", "value", "error", "incomplete", "names"};
    const std::string word = kWords[static_cast<std::size_t>(said.kind)];
    return said.text.empty() ? word : word + ": " + said.text;
  }
  /// The words, with blanks between.
  std::string words(const std::string& text) {
    const Evaluation said = stage.scene.complete(text);
    EXPECT_EQ(said.kind, Kind::names);
    std::string list = said.text;
    for (char& c : list) c = c == '\n' ? ' ' : c;
    return list;
  }

  Stage stage;
};

struct ConsoleOfBehaviors : Console {
  ConsoleOfBehaviors()
      : Console(R"(
arm:add_behavior("sway", "to (and) fro")
arm:add_behavior("random_force", "wind")
sim:add_group_behavior("herd", "all of \"us\"")
sim:add_group_behavior("cohesion", "together")
)") {}
};

TEST_F(Console, ExpressionsHaveValues) {
  EXPECT_EQ(say("1 + 2"), "value: 3");
  EXPECT_EQ(say("= 1 + 2"), "value: 3") << "as other consoles write it";
  EXPECT_EQ(say("'text'"), "value: text");
  EXPECT_EQ(say("nil"), "value: nil");
  EXPECT_EQ(say("1, nil, 'x'"), "value: 1\tnil\tx");
  EXPECT_EQ(say("''"), "value");
  EXPECT_EQ(say("vec3(1, 2, 3)"), "value: vec3(1, 2, 3)");
  EXPECT_EQ(say("print"), "value: function");
}

TEST_F(Console, StatementsRunInTheScenesEnvironment) {
  EXPECT_EQ(say("x = state.hits + params.wind"), "done");
  EXPECT_EQ(say("x"), "value: 7");
  EXPECT_EQ(say(""), "done");
  EXPECT_EQ(say("-- only said"), "done");
  EXPECT_EQ(say("local y = 1"), "done");
  EXPECT_EQ(first_line(say("y")), "error: console:1: there is no global 'y'; did you mean 'x'?")
      << "a local ends with its text";
  EXPECT_EQ(first_line(say("hidden")), "error: console:1: there is no global 'hidden'");
  EXPECT_EQ(say("for i = 1, 2 do print(i) end"), "done");
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"1", "2"}));
}

TEST_F(Console, ActionsActAndValuesAreSet) {
  // 2 N·s on 1 kg at rest
  EXPECT_EQ(say("sim.gravity = vec3()"), "done");
  EXPECT_EQ(say("free = sim:add_body('free'):add_part('f', 'ball', { position = { 5, 0, 0 } })"), "done");
  stage.tick();
  EXPECT_EQ(say("free:apply_impulse(vec3(0, 0, 2))"), "done");
  stage.tick();
  EXPECT_EQ(say("free.linear_velocity.z"), "value: 2");
  EXPECT_EQ(say("params.wind = 8"), "done");
  EXPECT_EQ(say("params.wind"), "value: 8");
  EXPECT_EQ(say("sim:on_step(function() state.stepped = true end)"), "done");
  stage.tick();
  EXPECT_EQ(say("state.stepped"), "value: true");
  EXPECT_EQ(say("sim:reset()"), "done");
  EXPECT_EQ(stage.host.resets, 1);
  EXPECT_EQ(first_line(say("osc:listen(9)")),
            "error: console:1: osc:listen declares something about the scene; write it at the top level");
}

TEST_F(Console, TablesAreOpened) {
  EXPECT_EQ(say("{ 1, 'two', { x = true }, a = vec3(), ['b c'] = 1, [5] = 2 }"),
            "value: { 1, \"two\", { x = true }, [5] = 2, a = vec3(0, 0, 0), [\"b c\"] = 1 }");
  EXPECT_EQ(say("{}"), "value: {}");
  EXPECT_EQ(say("{ { { { 1 } } } }"), "value: { { { { … } } } }");
  EXPECT_EQ(say("arm.parts"), "value: { part 'arm/base', part 'arm/tip' }");
  EXPECT_EQ(say("setmetatable({}, { __tostring = function() return 'mine' end })"), "value: mine");
  // one that holds itself ends, and so does one that is very wide
  EXPECT_EQ(say("(function() local t = {} t.t = t return t end)()"), "value: { t = { t = { t = { … } } } }");
  const std::string wide = say("(function() local t = {} for i = 1, 1e5 do t[i] = i end return t end)()");
  EXPECT_LT(wide.size(), 3000U);
  EXPECT_TRUE(wide.starts_with("value: { 1, 2, 3, ")) << wide.substr(0, 40);
  EXPECT_LT(say("('x'):rep(1e6)").size(), kMostEvaluated + 20);
}

TEST_F(Console, ErrorsStandAtTheirLine) {
  EXPECT_EQ(say("sim:body('amr')"),
            "error: console:1: there is no body 'amr'; did you mean 'arm'?\n  1 | sim:body('amr')\n"
            "stack traceback:\n  console:1: in the main chunk");
  EXPECT_EQ(say("local a = 1\n\nfoo.bar = a"),
            "error: console:3: there is no global 'foo'\n  3 | foo.bar = a\n"
            "stack traceback:\n  console:3: in the main chunk");
  EXPECT_EQ(say("x = = 2"), "error: console:1: unexpected symbol near '='\n  1 | x = = 2");
  EXPECT_EQ(say("error({})"),
            "error: console:1: an error that is no text but a table\n  1 | error({})\n"
            "stack traceback:\n  console:1: in the main chunk");
  EXPECT_EQ(say("function f() nothing() end"), "done");
  EXPECT_TRUE(say("f()").ends_with("  console:1: in function 'f'\n  console:1: in the main chunk")) << say("f()");
  EXPECT_TRUE(stage.host.faults.empty()) << "what a person mistypes is no fault of the show";
  // what ran before the error stays done
  EXPECT_EQ(first_line(say("z = 5 nothing()")), "error: console:1: there is no global 'nothing'");
  EXPECT_EQ(say("z"), "value: 5");
}

TEST_F(Console, ACallbackFromHereErrsWithoutAForeignLine) {
  EXPECT_EQ(say("sim:on_step(function() error('late') end)"), "done");
  stage.tick();
  ASSERT_EQ(stage.host.faults.size(), 1U);
  EXPECT_EQ(first_line(stage.host.faults[0].text), "console:1: late");
  EXPECT_EQ(stage.host.faults[0].text.find(" | "), std::string::npos);
}

TEST_F(Console, ChunksThatAreNotWholeAskForMore) {
  for (const char* open : {"for i = 1, 2 do", "function g(", "x = {", "1 +", "arm:part(", "sim.", "if x then", "[[long",
                           "local function f()\n  return 1"}) {
    EXPECT_EQ(say(open), "incomplete") << open;
  }
  for (const char* wrong : {"x = )", "'open", "for for", "end", "1 2", "x = 1 y"}) {
    EXPECT_EQ(stage.scene.evaluate(wrong).kind, Kind::error) << wrong;
  }
  EXPECT_EQ(say("for i = 1, 2 do\nn = i\nend"), "done");
  EXPECT_EQ(say("n"), "value: 2");
}

TEST_F(Console, BeforeARunThereIsNothingToAsk) {
  const Stage fresh;
  Stage& none = const_cast<Stage&>(fresh);
  EXPECT_EQ(none.scene.evaluate("1").kind, Kind::error);
  EXPECT_EQ(none.scene.complete("s").text, "");
}

TEST_F(Console, CompletesGlobalsMembersAndMethods) {
  EXPECT_EQ(words("ar"), "arm");
  EXPECT_EQ(words("x = 3 + st"), "state string");
  EXPECT_EQ(stage.scene.complete("x = 3 + st").word, 2U);
  EXPECT_EQ(words("sim.ti"), "tick time timestep");
  EXPECT_EQ(words("sim:add_c"),
            "add_capsule_shape add_compound_shape add_cone_shape add_convex_mesh_shape "
            "add_cylinder_shape");
  EXPECT_EQ(words("arm."),
            "alive angular_velocity asleep behaviors can_sleep enabled excluded_pairs joints linear_velocity motors "
            "name parts position "
            "root rotation self_collision");
  EXPECT_EQ(words("arm:mo"), "motor motors");
  EXPECT_EQ(words("params.w"), "warmth wind");
  EXPECT_EQ(words("state."), "hits");
  EXPECT_EQ(words("osc:s"), "send sender stream_to");
  EXPECT_EQ(words("math.no"), "noise");
  EXPECT_EQ(words("rng:"), "direction normal uniform");
  EXPECT_EQ(words("sim.gravity."), "cross dot length lerp normalized x y z");
  EXPECT_EQ(words("nothing_like_it"), "");
}

TEST_F(Console, FollowsChains) {
  EXPECT_EQ(words("sim:body('arm').sel"), "self_collision");
  EXPECT_EQ(words("sim:body('arm'):part(2):apply_f"), "apply_force");
  EXPECT_EQ(words("print(arm.motors[1].angular_servo_"), "angular_servo_active angular_servo_position");
  EXPECT_EQ(words("arm:joint(\"hinge\").motor.joint.par"), "parent");
  // where nobody can know, what any thing has
  EXPECT_EQ(words("unknown_call().angular_servo_"), "angular_servo_active angular_servo_position");
  // following runs nothing of the scene's
  EXPECT_EQ(say("trap = setmetatable({}, { __index = function() hit = true end })"), "done");
  EXPECT_EQ(words("trap.x.y"), words("unknown_call().y"));
  EXPECT_EQ(first_line(say("hit")), "error: console:1: there is no global 'hit'; did you mean 'bit'?");
}

TEST_F(ConsoleOfBehaviors, LooksThroughThemAndTheirGroups) {
  EXPECT_EQ(words("arm:behavior('to (and) fro').de"), "delay depth") << "parameters of its file";
  EXPECT_EQ(words("sim:body(\"arm\"):behavior('wind').rand_"), "rand_interval");
  EXPECT_EQ(words("sim:find_body('arm'):behavior(1).delay."), "cross dot length lerp normalized x y z");
  EXPECT_EQ(words("x = arm.behaviors[2].max_"), "max_amp max_dir");
  EXPECT_EQ(words("arm:behavior('wind'):"), "joints motors parts remove");
  EXPECT_EQ(words("arm:behavior('wind').body:part(-1):apply_f"), "apply_force");
  EXPECT_EQ(words("arm:behavior('wind'):part"), "parts");
  EXPECT_EQ(words("sim:group_behavior('together').max_d"), "max_dist");
  EXPECT_EQ(words("sim:group_behavior(\"all of \\\"us\\\"\").clo"), "closeness");
  EXPECT_EQ(words("sim:group_behavior(1).clo"), "closeness");
  EXPECT_EQ(words("sim:body'arm':behavior"), "behavior behaviors") << "as Lua reads it, too";
  EXPECT_EQ(words("sim:body( \"arm\" ) :beh"), words("unknown_call():beh")) << "a blank ends what is looked at";
  EXPECT_EQ(words("sim:body('arm'):part('tip').lin"), "linear_damping linear_velocity");
  EXPECT_EQ(words("arm:behavior('"), "all of \"us\" arm ball base hinge tip to (and) fro together wind");
  // one that is not there: what any thing has
  EXPECT_EQ(words("arm:behavior('none').pos"), words("unknown_call().pos"));
  EXPECT_EQ(words("sim:group_behavior('none').pos"), words("unknown_call().pos"));
  EXPECT_EQ(say("pets = { ['big one'] = arm, { arm } }"), "done");
  EXPECT_EQ(words("pets['big one']:behavior('wind').rand_"), "rand_interval");
  EXPECT_EQ(words("pets[1][1].self_"), "self_collision");
}

TEST_F(Console, LooksThroughLookUpsOnly) {
  const std::string any = words("unknown_call().pos");
  // none of these is called: what they make or do would be seen
  for (const char* call : {"sim:add_body('new')", "arm:copy('twin')", "arm:remove()", "arm:reset()", "f('x')",
                           "sim:f(1)", "t:f('x')", "sim:every('1')", "sim:body(f('arm'))", "sim:body('arm' .. f())"}) {
    EXPECT_EQ(say("function f() hit = true return arm end t = { f = f, body = f }"), "done");
    EXPECT_EQ(words(std::string(call) + ".pos"), any) << call;
  }
  EXPECT_EQ(words("t:body('arm').pos"), any) << "a method of the scene's own";
  EXPECT_EQ(say("#sim.bodies"), "value: 1");
  EXPECT_EQ(first_line(say("hit")).find("error: console:1: there is no global 'hit'"), 0u);
}

TEST_F(Console, CompletesNamesOfThingsInQuotes) {
  EXPECT_EQ(words("sim:body(\""), "arm ball base hinge tip");
  EXPECT_EQ(words("arm:part('t"), "tip");
  EXPECT_EQ(stage.scene.complete("arm:part('t").word, 1U);
  EXPECT_EQ(words("arm:part('tip'):apply_t"), "apply_torque") << "outside of quotes again";
  EXPECT_EQ(say("arm:remove()"), "done");
  EXPECT_EQ(words("sim:body(\""), "ball");
}

TEST_F(Console, CompletionTakesAnything) {
  for (const char* odd : {"", ".", ":", "..", "a..b", ")", "](", "))))", "x[", "\"\\", "'\n", "1.", "(((.",
                          "\xff\xfe.x", "sim:body(sim:body('arm')).", "arm.parts[9].", "[1].x"}) {
    EXPECT_EQ(stage.scene.complete(odd).kind, Kind::names) << odd;
  }
  for (const char* piece : {".", "()", "[]", "''", "(' ')", "\\'", "a:b(", ") ", "[1]"}) {
    std::string much;
    while (much.size() < kMostEvaluated - 8) much += piece;
    EXPECT_EQ(stage.scene.complete(much).kind, Kind::names) << piece;
    EXPECT_EQ(stage.scene.complete(much + ".x").kind, Kind::names) << piece;
  }
  EXPECT_TRUE(stage.logged().empty());
}

}  // namespace
}  // namespace limber
