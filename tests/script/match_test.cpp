// Patterns: the same results as Lua's matcher for random patterns and texts, and a step limit.
#include "script/vm/pattern_match.h"

#include <gtest/gtest.h>

#include <memory>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/random.h"
#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

// runs Lua's own library on the same text and returns its output
Lines native_lines(const std::string& text) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), lua_close);
  lua_State* const L = state.get();
  luaL_openlibs(L);
  const std::string whole = "local out = {} local function print(x) out[#out + 1] = x end " + text + " return out";
  const bool success = luaL_loadbuffer(L, whole.data(), whole.size(), "native") == 0 && lua_pcall(L, 0, 1, 0) == 0;
  EXPECT_TRUE(success) << lua_tostring(L, -1);
  Lines lines;
  for (int i = 1; success; i++) {
    lua_rawgeti(L, 1, i);
    std::size_t size = 0;
    const char* line = lua_tolstring(L, -1, &size);
    if (line == nullptr) break;
    lines.emplace_back(line, size);
    lua_settop(L, 1);
  }
  return lines;
}

std::string random_text(Random& random, std::string_view letters, int max_length) {
  std::string text;
  const int length = static_cast<int>(random.uniform(0, max_length + 1));
  for (int i = 0; i < length; i++) {
    text += letters[static_cast<std::size_t>(random.uniform(0, static_cast<double>(letters.size())))];
  }
  return text;
}

std::string random_pattern(Random& random) {
  static const std::vector<std::string> pieces = {
      "a",      "b",    "c",    ".",     "%a",     "%d",     "%S",     "%p",    "%w",
      "%x",     "%u",   "%g",   "%z",    "%C",     "[abc]",  "[^a]",   "[a-c]", "[%d%s]",
      "[]]",    "[^]]", "[a-]", "[-a]",  "[%a_]",  "%%",     "%.",     "%(",    "(",
      ")",      "()",   "*",    "+",     "-",      "?",      "^",      "$",     "%b()",
      "%bab",   "%1",   "%2",   "%f[a]", "%f[%w]", "%f[^b]", "%f[%z]", "(a*)",  "(.-)",
      "([ab])", "[",    "%",    "%b",    "%f",     "%9",     "%0",     "]",     "(a)",
      "a*",     "b-",   ".*",   "[^%w]", "[%]]",   "%Z",     "[a%-c]", "\\0",   "[\\200-\\255]"};
  std::string pattern = random.uniform() < 0.15 ? "^" : "";
  const int count = static_cast<int>(random.uniform(0, 6));
  for (int i = 0; i < count; i++) {
    pattern += pieces[static_cast<std::size_t>(random.uniform(0, static_cast<double>(pieces.size())))];
  }
  return pattern;
}

// a chunk that prints one line per case, in a format shared by both sides
std::string cases(std::uint64_t seed, int count) {
  Random random(seed);
  std::string text = R"(
local function show(...)
  local list = { ... }
  for i = 1, select("#", ...) do list[i] = type(list[i]) .. ":" .. tostring(list[i]) end
  return table.concat(list, ",")
end
-- an error is compared without its text, which has the script's line here
local function try(f, ...)
  local function result(ok, ...) return ok and show(...) or "error" end
  return result(pcall(f, ...))
end
local function each(s, p)
  local list, n = {}, 0
  for a, b, c in string.gmatch(s, p) do
    n = n + 1
    list[n] = show(a, b, c)
    if n > 30 then break end
  end
  return table.concat(list, ";")
end
local function case(s, p, r, init, most)
  print(try(string.find, s, p))
  print(try(string.find, s, p, init))
  print(try(string.find, s, p, init, true))
  print(try(string.match, s, p, init))
  print(try(each, s, p))
  print(try(string.gsub, s, p, r))
  print(try(string.gsub, s, p, r, most))
  print(try(string.gsub, s, p, { a = "A", b = 1, ab = false, [1] = "first" }))
  print(try(string.gsub, s, p, function(x, y) if y then return y end if x == "a" then return 7 end end))
end
)";
  for (int i = 0; i < count; i++) {
    text += fmt::format("case(\"{}\", \"{}\", \"{}\", {}, {})\n", random_text(random, "aabbcc1 _()[]%.", 12),
                        random_pattern(random), random_text(random, "xy%%%0123", 5),
                        static_cast<int>(random.uniform(-6, 8)), static_cast<int>(random.uniform(-1, 4)));
  }
  return text;
}

TEST(Match, MatchesLikeLua) {
  for (std::uint64_t seed = 1; seed <= 12; seed++) {
    const std::string text = cases(seed, 300);
    const Lines native = native_lines(text);
    ASSERT_EQ(native.size(), 2700u);
    ScriptFixture fixture;
    ASSERT_EQ(fixture.run(text), "");
    ASSERT_EQ(fixture.host.printed.size(), native.size());
    int wrong = 0;
    for (std::size_t i = 0; i < native.size() && wrong < 5; i++) {
      if (fixture.host.printed[i] == native[i]) continue;
      wrong++;
      const std::string from = text.substr(text.find("case(\""));
      std::istringstream lines(from);
      std::string line;
      for (std::size_t k = 0; k <= i / 9; k++) std::getline(lines, line);
      ADD_FAILURE() << "seed " << seed << ", " << line << ", call " << i % 9 << ": " << fixture.host.printed[i]
                    << " instead of " << native[i];
    }
  }
}

TEST(Match, ReportsResultsLikeLua) {
  for (const char* expression : {"string.find('abc', 'b')",
                                 "string.find('a.c', '.', 1, true)",
                                 "string.find('abc', '')",
                                 "string.find('abc', 'b', 10)",
                                 "string.find('', '')",
                                 "string.match('key = value', '(%w+)%s*=%s*(%w+)')",
                                 "string.match('hello', '()ll()')",
                                 "string.gsub('hello world', '%w+', '<%0>')",
                                 "string.gsub('abc', '', '-')",
                                 "string.gsub('abc', '%w*', 'x')",
                                 "string.gsub('hello', 'l', '%%')",
                                 "string.gsub('abc', '%w', '%', 1)",
                                 "('THE (quick) fox'):find('%((%a+)%)')",
                                 "string.find('a\\0b', 'b')",
                                 "string.find('a\\0b', '%z')",
                                 "string.match(123, '%d')",
                                 "string.gsub('x = 1', '(%w) = (%w)', '%2 = %1')",
                                 "string.match('2026-11-21', '(%d+)-(%d+)-(%d+)')",
                                 "string.gsub('THE (quick) fox', '%f[%a]%a+', function(w) return w:lower() end)",
                                 "string.find('f(a(b)c)d', '%b()')",
                                 "string.match('  trim  ', '^%s*(.-)%s*$')"}) {
    ScriptFixture fixture;
    ASSERT_EQ(fixture.run(fmt::format("print({})", expression)), "") << expression;
    const Lines native = native_lines(
        fmt::format("local list = {{ {0} }} for i = 1, select('#', {0}) do list[i] = tostring(list[i]) end "
                    "print(table.concat(list, '\\t'))",
                    expression));
    EXPECT_EQ(fixture.host.printed, native) << expression;
  }
}

TEST(Match, ReportsPatternFaultsLikeLua) {
  for (const auto& [pattern, fault] : std::vector<std::pair<std::string, std::string>>{
           {"%", "malformed pattern (ends with '%')"},
           {"[a", "malformed pattern (missing ']')"},
           {"(a))", "invalid pattern capture"},
           {"%1", "invalid capture index"},
           {"%bx", "unbalanced pattern"},
           {"%fa", "missing '[' after '%f' in pattern"},
           {std::string(33, '(') + "a" + std::string(33, ')'), "too many captures"}}) {
    PatternMatcher search([] { return false; });
    EXPECT_EQ(search.find("aaaa", pattern, 0, true), SearchResult::bad_pattern) << pattern;
    EXPECT_STREQ(search.fault(), fault.c_str()) << pattern;
  }
  EXPECT_EQ(error_of("('aaa'):find('[a')"), "scripts/scene.lua:1: string.find: malformed pattern (missing ']')");
  EXPECT_EQ(error_of("('aaa'):find(nil)"), "scripts/scene.lua:1: string.find takes text, not nothing");
}

TEST(Match, EndsExponentialPatterns) {
  PatternMatcher search([] { return false; });
  const std::string text(1000, 'a');
  std::string stars;
  for (int i = 0; i < 20; i++) stars += "a*";
  EXPECT_EQ(search.find(text, stars + "b", 0, true), SearchResult::too_long);
  EXPECT_EQ(search.find(text, ".-.-.-.-.-.-b", 0, true), SearchResult::too_long);
  // a long text is searched to its end
  const std::string long_text(6'000'000, 'x');
  EXPECT_EQ(search.find(long_text, "%d", 0, true), SearchResult::not_found);
  EXPECT_EQ(error_of("(('a'):rep(1000)):find(('a*'):rep(20) .. 'b')"),
            "scripts/scene.lua:1: string.find: this pattern takes too many steps on this text; make it simpler (fewer "
            "* + - next to each other), or the text shorter");
}

TEST(Match, PollsForAStop) {
  int polls = 0;
  PatternMatcher search([&] { return ++polls == 3; });
  EXPECT_EQ(search.find(std::string(1 << 20, 'x'), "%d", 0, true), SearchResult::too_long);
  EXPECT_EQ(polls, 3);
}

TEST(Match, FindsPlainTextInALongText) {
  PatternMatcher search([] { return false; });
  std::string text(300'000, 'a');
  const std::string wanted = "aab" + std::string(100, 'a');
  for (const std::size_t at : {std::size_t{0}, std::size_t{65'500}, std::size_t{131'000}, std::size_t{299'897}}) {
    std::string with = text;
    with.replace(at, wanted.size(), wanted);
    EXPECT_EQ(search.find_plain(with, wanted, 0), with.find(wanted)) << at;
  }
  EXPECT_EQ(search.find_plain(text, wanted, 0), std::string_view::npos);
  EXPECT_EQ(search.find_plain(text, "", 17), 17u);
  EXPECT_EQ(search.find_plain("", "", 0), 0u);
}

}  // namespace
}  // namespace limber::script
