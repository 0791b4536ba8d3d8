// Texts that must not reach LuaJIT's compiler.
#include "script/vm/text_check.h"

#include <gtest/gtest.h>

#include "stage.h"

namespace limber::script {
namespace {

int line_of(const std::string& text) {
  const std::optional<TextFault> fault = text_fault(text);
  return fault ? fault->line : 0;
}

TEST(TextCheck, RejectsALoopOverNil) {
  EXPECT_EQ(line_of("local _\nfor _ in (nil):foo() do end"), 2);
  EXPECT_EQ(line_of("for a, b in nil do end"), 1);
  EXPECT_EQ(line_of("\n\nfor a,b in--[==[ ]] \n ]==]((  nil)) do end"), 4);
  EXPECT_EQ(line_of("for a in -- for x\n nil, 1 do end"), 2);
  EXPECT_EQ(line_of("local s = 'it\\'s' for a in (nil or pairs)(t) do end"), 1);
}

TEST(TextCheck, RejectsFfiNumbers) {
  EXPECT_EQ(line_of("local a = 1\nlocal b = 1LL"), 2);
  for (const char* text : {"x = 1ll", "x = 0xFFULL", "x = 2ULL + 1", "x = 3i", "x = 0.5i", "x = 7I"})
    EXPECT_EQ(line_of(text), 1) << text;
  for (const char* text : {"x = 0xFL1", "x1LL = 1", "x = '1LL'", "-- 1LL", "x = 1e5", "x = i", "x = 0x1f", "x = LL"})
    EXPECT_EQ(line_of(text), 0) << text;
}

TEST(TextCheck, AcceptsOtherTexts) {
  for (const char* text :
       {"", "local x = nil", "for i = nil, 3 do end", "for a in pairs(nil) do end", "for a in f, nil do end",
        "-- for a in nil do end", "--[[ for a in\n nil do end ]]", "local s = 'for a in nil do end'",
        "local s = [==[ for a in nil ]==]", "for a in nilly do end", "for a in (f)(nil) do end",
        "local t = { [nil] = 1 }", "for a in \"nil\" do end", "'unfinished \\", "[[ unfinished", "--[[ unfinished",
        "x.for_ = 1 y.in_ = nil"}) {
    EXPECT_EQ(line_of(text), 0) << text;
  }
}

TEST(TextCheck, ReportsTheLine) {
  ScriptFixture fixture;
  const std::string error = fixture.run("local _\nfor _ in (nil):foo() do end\n");
  EXPECT_TRUE(
      error.starts_with("scripts/scene.lua:2: the values of a loop can't begin with nil; put them into a local "
                        "variable before it"))
      << error;
  ScriptFixture another;
  EXPECT_EQ(another.run("local f, why = load('local _ for _ in (nil):foo() do end') print(f, why)"), "");
}

// similar texts that the check accepts do not crash
TEST(TextCheck, LoopsOverOtherThingsCompile) {
  ScriptFixture fixture;
  for (const char* value : {"(false):foo()", "not nil", "(1)", "...", "{ nil }", "function() end", "(a)", "a and nil",
                            "(-1)", "('x'):foo()", "a.b", "(a == nil)"}) {
    for (const char* before : {"local _", "local _ = nil", "local a, b, c", "local a = 1 local b", "_x = nil", ""}) {
      const std::string text = std::string(before) + "\nfor _ in " + value + " do end";
      EXPECT_EQ(fixture.run("local f, why = load([==[" + text + "]==]) assert(f, why)"), "") << text;
    }
  }
}

}  // namespace
}  // namespace limber::script
