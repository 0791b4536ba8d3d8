// Console access to a scene: evaluation of texts in its environment, and completion.
#include <gtest/gtest.h>

#include <sstream>

#include "stage.h"

namespace limber::script {
namespace {

using Kind = Evaluation::Kind;

/// A scene with a body "arm": a static base, a tip, a joint and motor "hinge".
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
    fixture.write("behaviors_lua/sway.lua", kSway);
    fixture.write("behaviors_lua/herd.lua", kHerd);
    EXPECT_EQ(fixture.play(kConsoleArm + more), "");
  }

  /// Returns "kind: text" of the result.
  std::string evaluate_text(const std::string& text) {
    const Evaluation result = fixture.scene.evaluate(text);
    constexpr const char* kWords[] = {"done", "value", "error", "incomplete", "names"};
    const std::string word = kWords[static_cast<std::size_t>(result.kind)];
    return result.text.empty() ? word : word + ": " + result.text;
  }
  /// Returns the words, separated by blanks.
  std::string completions(const std::string& text) {
    const Evaluation result = fixture.scene.complete(text);
    EXPECT_EQ(result.kind, Kind::names);
    std::string list = result.text;
    for (char& c : list) c = c == '\n' ? ' ' : c;
    return list;
  }

  ScriptFixture fixture;
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
  EXPECT_EQ(evaluate_text("1 + 2"), "value: 3");
  EXPECT_EQ(evaluate_text("= 1 + 2"), "value: 3") << "syntax of other consoles";
  EXPECT_EQ(evaluate_text("'text'"), "value: text");
  EXPECT_EQ(evaluate_text("nil"), "value: nil");
  EXPECT_EQ(evaluate_text("1, nil, 'x'"), "value: 1\tnil\tx");
  EXPECT_EQ(evaluate_text("''"), "value");
  EXPECT_EQ(evaluate_text("vec3(1, 2, 3)"), "value: vec3(1, 2, 3)");
  EXPECT_EQ(evaluate_text("print"), "value: function");
}

TEST_F(Console, StatementsRunInTheScenesEnvironment) {
  EXPECT_EQ(evaluate_text("x = state.hits + params.wind"), "done");
  EXPECT_EQ(evaluate_text("x"), "value: 7");
  EXPECT_EQ(evaluate_text(""), "done");
  EXPECT_EQ(evaluate_text("-- only said"), "done");
  EXPECT_EQ(evaluate_text("local y = 1"), "done");
  EXPECT_EQ(first_line(evaluate_text("y")), "error: console:1: there is no global 'y'; did you mean 'x'?")
      << "a local variable ends with its text";
  EXPECT_EQ(first_line(evaluate_text("hidden")), "error: console:1: there is no global 'hidden'");
  EXPECT_EQ(evaluate_text("for i = 1, 2 do print(i) end"), "done");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"1", "2"}));
}

TEST_F(Console, ActionsActAndValuesAreSet) {
  // 2 N·s on 1 kg at rest
  EXPECT_EQ(evaluate_text("sim.gravity = vec3()"), "done");
  EXPECT_EQ(evaluate_text("free = sim:add_body('free'):add_part('f', 'ball', { position = { 5, 0, 0 } })"), "done");
  fixture.tick();
  EXPECT_EQ(evaluate_text("free:apply_impulse(vec3(0, 0, 2))"), "done");
  fixture.tick();
  EXPECT_EQ(evaluate_text("free.linear_velocity.z"), "value: 2");
  EXPECT_EQ(evaluate_text("params.wind = 8"), "done");
  EXPECT_EQ(evaluate_text("params.wind"), "value: 8");
  EXPECT_EQ(evaluate_text("sim:on_step(function() state.stepped = true end)"), "done");
  fixture.tick();
  EXPECT_EQ(evaluate_text("state.stepped"), "value: true");
  EXPECT_EQ(evaluate_text("sim:reset()"), "done");
  EXPECT_EQ(fixture.host.resets, 1);
  EXPECT_EQ(first_line(evaluate_text("osc:listen(9)")),
            "error: console:1: osc:listen declares something about the scene; write it at the top level");
}

TEST_F(Console, TablesAreExpanded) {
  EXPECT_EQ(evaluate_text("{ 1, 'two', { x = true }, a = vec3(), ['b c'] = 1, [5] = 2 }"),
            "value: { 1, \"two\", { x = true }, [5] = 2, a = vec3(0, 0, 0), [\"b c\"] = 1 }");
  EXPECT_EQ(evaluate_text("{}"), "value: {}");
  EXPECT_EQ(evaluate_text("{ { { { 1 } } } }"), "value: { { { { … } } } }");
  EXPECT_EQ(evaluate_text("arm.parts"), "value: { part 'arm/base', part 'arm/tip' }");
  EXPECT_EQ(evaluate_text("setmetatable({}, { __tostring = function() return 'mine' end })"), "value: mine");
  // recursive and very large tables are truncated
  EXPECT_EQ(evaluate_text("(function() local t = {} t.t = t return t end)()"), "value: { t = { t = { t = { … } } } }");
  const std::string wide = evaluate_text("(function() local t = {} for i = 1, 1e5 do t[i] = i end return t end)()");
  EXPECT_LT(wide.size(), 3000U);
  EXPECT_TRUE(wide.starts_with("value: { 1, 2, 3, ")) << wide.substr(0, 40);
  EXPECT_LT(evaluate_text("('x'):rep(1e6)").size(), kMaxEvaluatedBytes + 20);
}

TEST_F(Console, ErrorsHaveTheirLine) {
  EXPECT_EQ(evaluate_text("sim:body('amr')"),
            "error: console:1: there is no body 'amr'; did you mean 'arm'?\n  1 | sim:body('amr')\n"
            "stack traceback:\n  console:1: in the main chunk");
  EXPECT_EQ(evaluate_text("local a = 1\n\nfoo.bar = a"),
            "error: console:3: there is no global 'foo'\n  3 | foo.bar = a\n"
            "stack traceback:\n  console:3: in the main chunk");
  EXPECT_EQ(evaluate_text("x = = 2"), "error: console:1: unexpected symbol near '='\n  1 | x = = 2");
  EXPECT_EQ(evaluate_text("error({})"),
            "error: console:1: an error that is not text but a table\n  1 | error({})\n"
            "stack traceback:\n  console:1: in the main chunk");
  EXPECT_EQ(evaluate_text("function f() nothing() end"), "done");
  EXPECT_TRUE(evaluate_text("f()").ends_with("  console:1: in function 'f'\n  console:1: in the main chunk"))
      << evaluate_text("f()");
  EXPECT_TRUE(fixture.host.faults.empty()) << "errors in entered text are not faults of the scene";
  // effects before the error remain
  EXPECT_EQ(first_line(evaluate_text("z = 5 nothing()")), "error: console:1: there is no global 'nothing'");
  EXPECT_EQ(evaluate_text("z"), "value: 5");
}

TEST_F(Console, AFailingCallbackDoesNotShowOtherSource) {
  EXPECT_EQ(evaluate_text("sim:on_step(function() error('late') end)"), "done");
  fixture.tick();
  ASSERT_EQ(fixture.host.faults.size(), 1U);
  EXPECT_EQ(first_line(fixture.host.faults[0].text), "console:1: late");
  EXPECT_EQ(fixture.host.faults[0].text.find(" | "), std::string::npos);
}

TEST_F(Console, IncompleteChunksAreReported) {
  for (const char* open : {"for i = 1, 2 do", "function g(", "x = {", "1 +", "arm:part(", "sim.", "if x then", "[[long",
                           "local function f()\n  return 1"}) {
    EXPECT_EQ(evaluate_text(open), "incomplete") << open;
  }
  for (const char* wrong : {"x = )", "'open", "for for", "end", "1 2", "x = 1 y"}) {
    EXPECT_EQ(fixture.scene.evaluate(wrong).kind, Kind::error) << wrong;
  }
  EXPECT_EQ(evaluate_text("for i = 1, 2 do\nn = i\nend"), "done");
  EXPECT_EQ(evaluate_text("n"), "value: 2");
}

TEST_F(Console, EvaluatingBeforeARunIsAnError) {
  const ScriptFixture fresh;
  ScriptFixture& none = const_cast<ScriptFixture&>(fresh);
  EXPECT_EQ(none.scene.evaluate("1").kind, Kind::error);
  EXPECT_EQ(none.scene.complete("s").text, "");
}

TEST_F(Console, CompletesGlobalsMembersAndMethods) {
  EXPECT_EQ(completions("ar"), "arm");
  EXPECT_EQ(completions("x = 3 + st"), "state string");
  EXPECT_EQ(fixture.scene.complete("x = 3 + st").word, 2U);
  EXPECT_EQ(completions("sim.ti"), "tick time timestep");
  EXPECT_EQ(completions("sim:add_c"),
            "add_capsule_shape add_compound_shape add_cone_shape add_convex_mesh_shape "
            "add_cylinder_shape");
  EXPECT_EQ(completions("arm."),
            "alive angular_momentum angular_velocity asleep behaviors can_sleep center_of_mass enabled excluded_pairs "
            "gravity_factor joints kinetic_energy linear_velocity mass momentum motion motors name parts position "
            "potential_energy root rotation self_collision sensors tendons");
  EXPECT_EQ(completions("arm:mo"), "motor motors");
  EXPECT_EQ(completions("params.w"), "warmth wind");
  EXPECT_EQ(completions("state."), "hits");
  EXPECT_EQ(completions("osc:s"), "send sender stream_to");
  EXPECT_EQ(completions("math.no"), "noise");
  EXPECT_EQ(completions("rng:"), "direction normal uniform");
  EXPECT_EQ(completions("sim.gravity."), "cross dot length lerp normalized x y z");
  EXPECT_EQ(completions("nothing_like_it"), "");
}

TEST_F(Console, CompletesChains) {
  EXPECT_EQ(completions("sim:body('arm').sel"), "self_collision");
  EXPECT_EQ(completions("sim:body('arm'):part(2):apply_f"), "apply_force");
  EXPECT_EQ(completions("print(arm.motors[1].angular_servo_"), "angular_servo_active angular_servo_position");
  EXPECT_EQ(completions("arm:joint(\"hinge\").motor.joint.par"), "parent");
  // for unknown objects, the members of all classes
  EXPECT_EQ(completions("unknown_call().angular_servo_"), "angular_servo_active angular_servo_position");
  // completion runs no code of the scene
  EXPECT_EQ(evaluate_text("trap = setmetatable({}, { __index = function() hit = true end })"), "done");
  EXPECT_EQ(completions("trap.x.y"), completions("unknown_call().y"));
  EXPECT_EQ(first_line(evaluate_text("hit")), "error: console:1: there is no global 'hit'; did you mean 'bit'?");
}

TEST_F(ConsoleOfBehaviors, CompletesBehaviorsAndGroups) {
  EXPECT_EQ(completions("arm:behavior('to (and) fro').de"), "delay depth") << "parameters of its file";
  EXPECT_EQ(completions("sim:body(\"arm\"):behavior('wind').rand_"), "rand_interval");
  EXPECT_EQ(completions("sim:find_body('arm'):behavior(1).delay."), "cross dot length lerp normalized x y z");
  EXPECT_EQ(completions("x = arm.behaviors[2].max_"), "max_amp max_dir");
  EXPECT_EQ(completions("arm:behavior('wind'):"), "joints motors parts remove");
  EXPECT_EQ(completions("arm:behavior('wind').body:part(-1):apply_f"), "apply_force");
  EXPECT_EQ(completions("arm:behavior('wind'):part"), "parts");
  EXPECT_EQ(completions("sim:group_behavior('together').max_d"), "max_dist");
  EXPECT_EQ(completions("sim:group_behavior(\"all of \\\"us\\\"\").clo"), "closeness");
  EXPECT_EQ(completions("sim:group_behavior(1).clo"), "closeness");
  EXPECT_EQ(completions("sim:body'arm':behavior"), "behavior behaviors") << "call without parentheses";
  EXPECT_EQ(completions("sim:body( \"arm\" ) :beh"), completions("unknown_call():beh")) << "a blank ends the chain";
  EXPECT_EQ(completions("sim:body('arm'):part('tip').lin"), "linear_damping linear_velocity");
  EXPECT_EQ(completions("arm:behavior('"), "all of \"us\" arm ball base hinge tip to (and) fro together wind");
  // unknown object: the members of all classes
  EXPECT_EQ(completions("arm:behavior('none').pos"), completions("unknown_call().pos"));
  EXPECT_EQ(completions("sim:group_behavior('none').pos"), completions("unknown_call().pos"));
  EXPECT_EQ(evaluate_text("pets = { ['big one'] = arm, { arm } }"), "done");
  EXPECT_EQ(completions("pets['big one']:behavior('wind').rand_"), "rand_interval");
  EXPECT_EQ(completions("pets[1][1].self_"), "self_collision");
}

TEST_F(Console, CompletionCallsOnlyLookUps) {
  const std::string any = completions("unknown_call().pos");
  // none of these is called: side effects would be visible
  for (const char* call : {"sim:add_body('new')", "arm:copy('twin')", "arm:remove()", "arm:reset()", "f('x')",
                           "sim:f(1)", "t:f('x')", "sim:every('1')", "sim:body(f('arm'))", "sim:body('arm' .. f())"}) {
    EXPECT_EQ(evaluate_text("function f() hit = true return arm end t = { f = f, body = f }"), "done");
    EXPECT_EQ(completions(std::string(call) + ".pos"), any) << call;
  }
  EXPECT_EQ(completions("t:body('arm').pos"), any) << "a method defined by the scene";
  EXPECT_EQ(evaluate_text("#sim.bodies"), "value: 1");
  EXPECT_EQ(first_line(evaluate_text("hit")).find("error: console:1: there is no global 'hit'"), 0u);
}

TEST_F(Console, CompletesNamesOfObjectsInQuotes) {
  EXPECT_EQ(completions("sim:body(\""), "arm ball base hinge tip");
  EXPECT_EQ(completions("arm:part('t"), "tip");
  EXPECT_EQ(fixture.scene.complete("arm:part('t").word, 1U);
  EXPECT_EQ(completions("arm:part('tip'):apply_t"), "apply_torque") << "outside of quotes again";
  EXPECT_EQ(evaluate_text("arm:remove()"), "done");
  EXPECT_EQ(completions("sim:body(\""), "ball");
}

TEST_F(Console, CompletionAcceptsAnyText) {
  for (const char* odd : {"", ".", ":", "..", "a..b", ")", "](", "))))", "x[", "\"\\", "'\n", "1.", "(((.",
                          "\xff\xfe.x", "sim:body(sim:body('arm')).", "arm.parts[9].", "[1].x"}) {
    EXPECT_EQ(fixture.scene.complete(odd).kind, Kind::names) << odd;
  }
  for (const char* piece : {".", "()", "[]", "''", "(' ')", "\\'", "a:b(", ") ", "[1]"}) {
    std::string much;
    while (much.size() < kMaxEvaluatedBytes - 8) much += piece;
    EXPECT_EQ(fixture.scene.complete(much).kind, Kind::names) << piece;
    EXPECT_EQ(fixture.scene.complete(much + ".x").kind, Kind::names) << piece;
  }
  EXPECT_TRUE(fixture.logged().empty());
}

}  // namespace
}  // namespace limber::script
