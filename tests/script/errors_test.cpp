// Errors: file:line, what, the source line, the way there; of runs, callbacks, syntax, files that are not there.
#include <gtest/gtest.h>

#include "stage.h"

namespace limber {
namespace {

TEST(Errors, ARunTellsPlaceSourceLineAndTraceback) {
  Stage stage;
  EXPECT_EQ(
      stage.run("local function swing(arm)\n  return arm.speed\nend\n\nlocal function all()\n  local x = swing(nil)\n"
                "  return x\nend\nall()\n"),
      "scripts/scene.lua:2: attempt to index local 'arm' (a nil value)\n"
      "  2 |   return arm.speed\n"
      "stack traceback:\n"
      "  scripts/scene.lua:2: in function 'swing'\n"
      "  scripts/scene.lua:6: in function 'all'\n"
      "  scripts/scene.lua:9: in the main chunk");
}

TEST(Errors, ACallbackTellsThemToo) {
  Stage stage;
  ASSERT_EQ(
      stage.play("local function deep()\n  error('too deep')\nend\nsim:on_start(function()\n  local x = deep()\nend)"),
      "");
  ASSERT_EQ(stage.host.faults.size(), 1u);
  EXPECT_EQ(stage.host.faults[0].text,
            "scripts/scene.lua:2: too deep\n"
            "  2 |   error('too deep')\n"
            "stack traceback:\n"
            "  scripts/scene.lua:2: in function 'deep'\n"
            "  scripts/scene.lua:5: in the function of line 4");
  EXPECT_EQ(stage.host.faults[0].line, 2);
}

TEST(Errors, SyntaxErrorsHaveTheirLine) {
  Stage stage;
  EXPECT_EQ(stage.run("local x = 1\nlocal y = = 2\n"),
            "scripts/scene.lua:2: unexpected symbol near '='\n  2 | local y = = 2");
}

TEST(Errors, WhatIsThrownMayBeAnything) {
  EXPECT_EQ(error_of("error({})"), "scripts/scene.lua:1: an error that is no text but a table");
  EXPECT_EQ(error_of("error()"), "scripts/scene.lua:1: an error that is no text but a nil");
  EXPECT_EQ(error_of("error(vec3())"), "scripts/scene.lua:1: an error that is no text but a cdata");
  EXPECT_EQ(error_of("error('without a place', 0)"), "scripts/scene.lua:1: without a place");
  EXPECT_EQ(error_of("error('elsewhere:7: x', 0)"), "scripts/scene.lua:1: elsewhere:7: x");
  EXPECT_EQ(error_of("error(setmetatable({}, { __tostring = function() while true do end end }))"),
            "scripts/scene.lua:1: an error that is no text but a table");
  EXPECT_EQ(error_of("assert(false)"), "scripts/scene.lua:1: assertion failed!");
  EXPECT_EQ(error_of("assert(nil, 'so it is')"), "scripts/scene.lua:1: so it is");
}

TEST(Errors, DeepRecursionIsAnError) {
  const std::string fault = error_of("local function f() return 1 + f() end\nf()");
  EXPECT_NE(fault.find("stack overflow"), std::string::npos) << fault;
  Stage stage;
  ASSERT_EQ(stage.play("sim:on_step(function() local function f() return 1 + f() end f() end) "
                       "sim:on_step(function() print('still here') end)",
                       2),
            "");
  EXPECT_EQ(stage.host.faults.size(), 1u);
  EXPECT_EQ(stage.host.printed.size(), 2u);
}

TEST(Errors, FaultsInsideThePreludeStandAtTheScript) {
  EXPECT_EQ(error_of("math.clamp(nil, 1, 2)"), "scripts/scene.lua:1: attempt to compare nil with number");
  EXPECT_EQ(error_of("table.sort({ 1, {} })"), "scripts/scene.lua:1: attempt to compare table with number");
}

TEST(Errors, AMissingFileSaysWhereItLooked) {
  Stage stage;
  const std::string fault = stage.run("sim:load_urdf('urdf/nobody.urdf')");
  EXPECT_EQ(first_line(fault), "scripts/scene.lua:1: there is no file 'urdf/nobody.urdf'; looked for");
  EXPECT_NE(fault.find("\n  " + (stage.folder / "scripts/urdf/nobody.urdf").string()), std::string::npos) << fault;
  EXPECT_NE(fault.find("\n  " + (stage.folder / "urdf/nobody.urdf").string()), std::string::npos) << fault;
  Stage other;
  const Result<void> ran = other.scene.run((other.folder / "scripts/none.lua").string());
  ASSERT_FALSE(ran.ok());
  EXPECT_EQ(ran.error(), "there is no file '" + (other.folder / "scripts/none.lua").string() + "'");
}

TEST(Errors, LongNamesAreWhole) {
  Stage stage;
  const std::string name = "scripts/a_folder_with_a_long_name/another_folder_with_a_long_name/the_scene_itself.lua";
  stage.write(name, "local x = {}\nlocal y = x.z.w");
  const Result<void> ran = stage.scene.run((stage.folder / name).string());
  ASSERT_FALSE(ran.ok());
  EXPECT_EQ(first_line(ran.error()), name + ":2: attempt to index field 'z' (a nil value)");
}

TEST(Errors, BytecodeIsRefused) {
  Stage stage;
  EXPECT_NE(stage.run(std::string("\x1bLJ\x02\x00", 5)), "");
}

}  // namespace
}  // namespace limber
