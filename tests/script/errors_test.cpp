// Error messages with file:line, source line and traceback: of runs, callbacks, syntax errors, missing files.
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "stage.h"

namespace limber::script {
namespace {

TEST(Errors, ARunReportsPlaceSourceLineAndTraceback) {
  ScriptFixture fixture;
  EXPECT_EQ(
      fixture.run("local function swing(arm)\n  return arm.speed\nend\n\nlocal function all()\n  local x = swing(nil)\n"
                  "  return x\nend\nall()\n"),
      "scripts/scene.lua:2: attempt to index local 'arm' (a nil value)\n"
      "  2 |   return arm.speed\n"
      "stack traceback:\n"
      "  scripts/scene.lua:2: in function 'swing'\n"
      "  scripts/scene.lua:6: in function 'all'\n"
      "  scripts/scene.lua:9: in the main chunk");
}

TEST(Errors, ACallbackReportsPlaceSourceLineAndTraceback) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(
                "local function deep()\n  error('too deep')\nend\nsim:on_start(function()\n  local x = deep()\nend)"),
            "");
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(fixture.host.faults[0].text,
            "scripts/scene.lua:2: too deep\n"
            "  2 |   error('too deep')\n"
            "stack traceback:\n"
            "  scripts/scene.lua:2: in function 'deep'\n"
            "  scripts/scene.lua:5: in the function of line 4");
  EXPECT_EQ(fixture.host.faults[0].line, 2);
}

TEST(Errors, SyntaxErrorsHaveTheirLine) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.run("local x = 1\nlocal y = = 2\n"),
            "scripts/scene.lua:2: unexpected symbol near '='\n  2 | local y = = 2");
}

TEST(Errors, SuggestsWhereAnEndIsMissing) {
  const auto hint = [](const std::string& text) {
    const std::string fault = error_of(text);
    const std::size_t at = fault.find("; ");
    return at == std::string::npos ? "none: " + fault : fault.substr(at + 2);
  };
  // the compiler reports the error at the comma
  EXPECT_EQ(
      error_of("t = {\n  step = function(self)\n    for i = 1, 3 do\n      print(i)\n  end,\n}"),
      "scripts/scene.lua:5: unexpected symbol near ','; the 'end' in line 5 closes the 'for' of line 3: is an 'end' "
      "missing between them?");
  const std::string missing = ": is an 'end' missing between them?";
  EXPECT_EQ(hint("sim:on_step(function()\n  if a then\n    b = 1\nend)\nsim:after(1, print)"),
            "the 'end' in line 4 closes the 'if' of line 2" + missing);
  EXPECT_EQ(hint("local function f()\n\twhile x do\n\t\tx = 1\nend\nprint(1)\n"),
            "the 'end' in line 4 closes the 'while' of line 2" + missing);
  EXPECT_EQ(hint("local function f()\n  local g = function()\n  return 1\nend\nprint(1)\n"),
            "the 'end' in line 4 closes the 'function' of line 2" + missing);
  EXPECT_EQ(hint("if a then\n  b = 1\nend\nend"), "the 'end' in line 4 closes no block");
  EXPECT_EQ(hint("repeat\n  for i = 1, 2 do\n    x = i\nuntil x\n"),
            "the 'until' in line 4 closes the 'for' of line 2" + missing);
  // words in comments and strings are ignored, and correct code is not blamed
  EXPECT_EQ(hint("-- end\n--[==[ end\nend ]==]\nx = 'end' .. \"\\\" end\" .. [[\nend]]\nfor i = 1, 2 do\n  if x then "
                 "y() end\nend\n"
                 "x = = 2"),
            "none: scripts/scene.lua:9: unexpected symbol near '='");
  EXPECT_EQ(
      hint(
          "local function f() if a then b() else c() end end for i in (function() return pairs end)() do end\nx = = 2"),
      "none: scripts/scene.lua:2: unexpected symbol near '='");
  EXPECT_EQ(hint("x = 'open"), "none: scripts/scene.lua:1: unfinished string near '<eof>'");
}

TEST(Errors, SuggestsAMissingComma) {
  EXPECT_EQ(error_of("params {\n  { 'a', 1 }\n  { 'b', 2 },\n}"),
            "scripts/scene.lua:3: '}' expected (to close '{' at line 1) near '{'; is a comma missing before it?");
  EXPECT_EQ(error_of("params {\n  { 'a', 1, max = 2 doc = 'x' },\n}"),
            "scripts/scene.lua:2: '}' expected near 'doc'; is a comma missing before it?");
  EXPECT_EQ(error_of("t = {\n  a = 1\n  b = 2,\n}"),
            "scripts/scene.lua:3: '}' expected (to close '{' at line 1) near 'b'; is a comma missing before it?");
}

TEST(Errors, AnyValueCanBeThrown) {
  EXPECT_EQ(error_of("error({})"), "scripts/scene.lua:1: an error that is not text but a table");
  EXPECT_EQ(error_of("error()"), "scripts/scene.lua:1: an error that is not text but a nil");
  EXPECT_EQ(error_of("error(vec3())"), "scripts/scene.lua:1: an error that is not text but a cdata");
  EXPECT_EQ(error_of("error('without a place', 0)"), "scripts/scene.lua:1: without a place");
  EXPECT_EQ(error_of("error('elsewhere:7: x', 0)"), "scripts/scene.lua:1: elsewhere:7: x");
  EXPECT_EQ(error_of("error(setmetatable({}, { __tostring = function() while true do end end }))"),
            "scripts/scene.lua:1: an error that is not text but a table");
  EXPECT_EQ(error_of("assert(false)"), "scripts/scene.lua:1: assertion failed!");
  EXPECT_EQ(error_of("assert(nil, 'so it is')"), "scripts/scene.lua:1: so it is");
}

TEST(Errors, DeepRecursionIsAnError) {
  const std::string fault = error_of("local function f() return 1 + f() end\nf()");
  EXPECT_NE(fault.find("stack overflow"), std::string::npos) << fault;
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("sim:on_step(function() local function f() return 1 + f() end f() end) "
                         "sim:on_step(function() print('still here') end)",
                         2),
            "");
  EXPECT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(fixture.host.printed.size(), 2u);
}

TEST(Errors, ErrorsInsideThePreludeHaveTheScriptsLine) {
  EXPECT_EQ(error_of("math.clamp(nil, 1, 2)"),
            "scripts/scene.lua:1: math.clamp takes three numbers: value, minimum, maximum");
  EXPECT_EQ(
      error_of("math.randomseed(3)"),
      "scripts/scene.lua:1: math.randomseed is not available; sim.seed (or --seed) seeds every generator of a scene");
  EXPECT_EQ(error_of("table.sort({ 1, {} })"), "scripts/scene.lua:1: attempt to compare table with number");
}

TEST(Errors, AMissingFileListsTheSearchedPlaces) {
  ScriptFixture fixture;
  const std::string fault = fixture.run("sim:load_urdf('urdf/missing.urdf')");
  EXPECT_EQ(first_line(fault), "scripts/scene.lua:1: there is no file 'urdf/missing.urdf'; looked for");
  EXPECT_NE(fault.find("\n  " + (fixture.folder / "scripts/urdf/missing.urdf").string()), std::string::npos) << fault;
  EXPECT_NE(fault.find("\n  " + (fixture.folder / "urdf/missing.urdf").string()), std::string::npos) << fault;
  std::set<std::string> places;
  std::istringstream lines(fault.substr(0, fault.find("\n  1 |")));
  std::string line;
  while (std::getline(lines, line)) EXPECT_TRUE(places.insert(line).second) << "twice: " << line;
  EXPECT_GT(places.size(), 2u);
  ScriptFixture other;
  const Result<void> result = other.scene.run((other.folder / "scripts/none.lua").string());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error(), "there is no file '" + (other.folder / "scripts/none.lua").string() + "'");
}

TEST(Errors, LongNamesAreComplete) {
  ScriptFixture fixture;
  const std::string name = "scripts/a_folder_with_a_long_name/another_folder_with_a_long_name/the_scene_itself.lua";
  fixture.write(name, "local x = {}\nlocal y = x.z.w");
  const Result<void> result = fixture.scene.run((fixture.folder / name).string());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(first_line(result.error()), name + ":2: attempt to index field 'z' (a nil value)");
}

TEST(Errors, BytecodeIsRejected) {
  ScriptFixture fixture;
  EXPECT_NE(fixture.run(std::string("\x1bLJ\x02\x00", 5)), "");
}

}  // namespace
}  // namespace limber::script
