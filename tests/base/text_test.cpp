// Name comparison, patterns, suggestions, escaping and numbers, checked against tables.
#include "base/text.h"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <limits>

namespace limber {
namespace {

TEST(Text, ShortenedKeepsBothEnds) {
  EXPECT_EQ(shortened("short", 16), "short");
  EXPECT_EQ(shortened("0123456789abcdef", 16), "0123456789abcdef");
  EXPECT_EQ(shortened("0123456789abcdefg", 16), "01234 … bcdefg");
  // Multi-byte characters are not cut: ä has two bytes, and the middle is within one.
  const std::string umlauts = "äääääääääää";
  EXPECT_EQ(shortened(umlauts, 16), "ää … äää");
  EXPECT_LE(shortened(std::string(5000, 'x'), 1000).size(), 1000u);
}

TEST(Text, NamesAreComparedWithoutCaseAndUnderscores) {
  EXPECT_EQ(normalized_name("angular_Servo__Position_"), "angularservoposition");
  EXPECT_TRUE(same_name("appInterval", "app_interval"));
  EXPECT_TRUE(same_name("__a", "A"));
  EXPECT_TRUE(same_name("", "___"));
  EXPECT_FALSE(same_name("app_interval", "app_intervals"));
  EXPECT_FALSE(same_name("app", "apq"));
  EXPECT_FALSE(same_name("a", ""));
  // Only ASCII letters are compared without case.
  EXPECT_FALSE(same_name("\xc3\xa4", "\xc3\x84"));
}

struct PatternCase {
  const char* pattern;
  const char* name;
  bool hit;
};

TEST(Text, PatternsFollowOsc) {
  const PatternCase cases[] = {
      {"arm", "arm", true},
      {"arm", "Arm", false},
      {"arm", "arm1", false},
      {"a?m", "arm", true},
      {"a?m", "am", false},
      {"a?m", "aXYm", false},
      {"*", "", true},
      {"*", "anything", true},
      {"arm*", "arm", true},
      {"arm*", "arm16", true},
      {"arm*", "barm1", false},
      {"*_left", "leg_left", true},
      {"*_left", "leg_left_1", false},
      {"a*b*c", "aXbYc", true},
      {"a*b*c", "abbc", true},
      {"a*b*c", "acb", false},
      {"**", "x", true},
      {"a***", "a", true},
      {"arm[1-3]", "arm2", true},
      {"arm[1-3]", "arm4", false},
      {"arm[135]", "arm3", true},
      {"arm[135]", "arm2", false},
      {"arm[!1-3]", "arm4", true},
      {"arm[!1-3]", "arm2", false},
      {"arm[a-c1-3]", "armb", true},
      {"arm[a-c1-3]", "arm3", true},
      {"arm[a-c1-3]", "armd", false},
      {"arm[1-]", "arm-", true},
      {"arm[-1]", "arm-", true},
      {"x[!]", "xq", true},
      {"x[]", "xq", false},
      {"[ab][cd]", "bd", true},
      {"[ab][cd]", "db", false},
      {"{left,right}_leg", "right_leg", true},
      {"{left,right}_leg", "middle_leg", false},
      {"{a,ab}c", "abc", true},
      {"{ab,a}bc", "abc", true},
      {"{,x}y", "y", true},
      {"{,x}y", "xy", true},
      {"{}y", "y", true},
      {"leg_{a,b}*{1,2}", "leg_b_front2", true},
      {"leg_{a,b}*{1,2}", "leg_c_front2", false},
      {"?", "", false},
  };
  for (const PatternCase& c : cases) EXPECT_EQ(pattern_match(c.pattern, c.name), c.hit) << c.pattern << " " << c.name;
}

TEST(Text, AMalformedPatternMatchesOnlyItself) {
  for (const char* pattern : {"a[1-3", "a{b,c", "*[", "a*{", "[!", "{"}) {
    EXPECT_TRUE(pattern_match(pattern, pattern)) << pattern;
    for (const char* name : {"", "a", "a1", "ab", "a[1", "abc"}) EXPECT_FALSE(pattern_match(pattern, name)) << pattern;
  }
}

TEST(Text, IsPatternDetectsOscPatternCharacters) {
  for (const char* pattern : {"a*", "?", "[a]", "{a}"}) EXPECT_TRUE(is_pattern(pattern)) << pattern;
  for (const char* name : {"", "arm", "a]", "a}", "a,b", "a-b"}) EXPECT_FALSE(is_pattern(name)) << name;
}

// Without a bound these need 2^n steps or megabytes of stack; with it they match nothing, and the test ends.
TEST(Text, PatternMatchingIsBounded) {
  std::string stars;
  std::string braces;
  std::string choices = "{";
  for (int i = 0; i < 30000; i++) {
    stars += "*a";
    braces += "{}";
    choices += "a,";
  }
  choices += "}";
  const std::string name(128, 'a');
  EXPECT_FALSE(pattern_match(stars + "b", name));
  EXPECT_FALSE(pattern_match(braces + "b", name));
  EXPECT_FALSE(pattern_match(std::string(60000, '*') + "b", name));
  std::string chain;
  for (int i = 0; i < 64; i++) chain += choices.substr(0, 2000) + "}";
  EXPECT_FALSE(pattern_match(chain + "b", name));
  EXPECT_FALSE(pattern_match("[" + std::string(60000, 'b') + "]", "a"));
  // A run of stars equals one star, and a name that consists of wildcards still matches itself.
  EXPECT_TRUE(pattern_match(std::string(60000, '*') + "a", name));
  EXPECT_TRUE(pattern_match(std::string(128, '?'), name));
  EXPECT_TRUE(pattern_match("*a*a*a*a*a*a*", name));
}

TEST(Text, SuggestionsDifferByAtMostAThird) {
  const std::array<std::string_view, 4> names = {"angular_servo_position", "angular_velocity", "mass", "bounce"};
  EXPECT_EQ(nearest_name("angular_sevro_position", names), "angular_servo_position");
  EXPECT_EQ(nearest_name("MASS", names), "mass");
  EXPECT_EQ(nearest_name("mas", names), "mass");
  EXPECT_EQ(nearest_name("msas", names), "mass") << "swapped neighbors are one edit";
  EXPECT_EQ(nearest_name("amss", names), "mass");
  EXPECT_EQ(nearest_name("smsa", names), "") << "two swaps are two edits";
  EXPECT_EQ(nearest_name("bouncy", names), "bounce");
  // 'xyss' has distance 2 of 4 letters, more than a third.
  EXPECT_EQ(nearest_name("xyss", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(300, 'm'), names), "");
}

TEST(Text, HintsListAvailableNames) {
  const std::vector<std::string> none;
  EXPECT_EQ(name_hint("x", none), "; none exist");
  const std::vector<std::string> arms = {"arm1", "arm2"};
  EXPECT_EQ(name_hint("amr1", {"arm1"}), "; did you mean 'arm1'?");  // a swap is one edit, and a third of 4 is 1
  EXPECT_EQ(name_hint("ar1", arms), "; did you mean 'arm1'?");
  EXPECT_EQ(name_hint("quadruped", arms), "; there are: arm1, arm2");
  std::vector<std::string> many;
  for (int i = 0; i < 9; i++) many.push_back("leg_" + std::to_string(i));
  EXPECT_EQ(name_hint("floor", many), "; there are: leg_0, leg_1, leg_2, leg_3, leg_4, leg_5, leg_6, leg_7 …");
}

TEST(Text, PrintableEscapesControlCharacters) {
  EXPECT_EQ(printable("a\tb\nc"), "a\tb\nc");
  EXPECT_EQ(printable("\x1b[2J"), "\\x1b[2J");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("höhe 1½ 😀"), "höhe 1½ 😀");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");                    // a two-byte control character (CSI)
  EXPECT_EQ(printable("\xc3("), "\\xc3(");                           // truncated
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(printable("\xf0\x9f\x98"), "\\xf0\\x9f\\x98");
}

TEST(Text, NumbersMustFillTheText) {
  const std::pair<const char*, double> good[] = {{"0", 0},  {"-9.81", -9.81},       {" 1.5 ", 1.5},
                                                 {"+2", 2}, {"1e3", 1000},          {".5", 0.5},
                                                 {"5.", 5}, {"\t-1E-2\r\n", -0.01}, {"1e308", 1e308}};
  for (const auto& [text, value] : good) {
    ASSERT_TRUE(parse_number(text)) << text;
    EXPECT_EQ(*parse_number(text), value) << text;
  }
  for (const char* text : {"",   " ",  "+",   "-",   "+-1",  "--1",      "++1",   "1 2", "1,5",  "0x10",
                           "1e", "e5", "nan", "inf", "-inf", "infinity", "1e309", "one", "1.5m", "1..2"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  EXPECT_FALSE(parse_number(std::string_view("1\0", 2)));
}

TEST(Text, NumbersRoundTripInShortestForm) {
  for (const double v : {0.0, 0.1, -9.81, 1.0 / 3, 1e20, 5e-324, std::numeric_limits<double>::max(), 123456789.0}) {
    EXPECT_EQ(parse_number(number_text(v)).value_or(-1), v) << number_text(v);
  }
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-9.81), "-9.81");
  EXPECT_EQ(number_text(1e20), "1e+20");
  EXPECT_EQ(number_text(3), "3");
}

TEST(Text, NumbersIgnoreTheLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  // Uses an installed locale with a decimal comma; without one, tests the C locale only.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_NUMERIC, name) == nullptr) continue;
    EXPECT_EQ(parse_number("1.5").value_or(0), 1.5);
    EXPECT_EQ(number_text(1.5), "1.5");
  }
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(Text, EscapedNamesRoundTrip) {
  EXPECT_EQ(escape_name("left leg"), "left%20leg");
  EXPECT_EQ(escape_name("a/b#c*d,e?f[g]h{i}j%k"), "a%2Fb%23c%2Ad%2Ce%3Ff%5Bg%5Dh%7Bi%7Dj%25k");
  EXPECT_EQ(unescape_name("%2f%2F"), "//");
  for (const char* name : {"plain", "100%", "%20", "a b/c", "%%", "höhe", ""}) {
    EXPECT_EQ(unescape_name(escape_name(name)), name);
  }
  // Invalid escapes remain unchanged.
  for (const char* part : {"%", "%2", "%zz", "100%", "%2g"}) EXPECT_EQ(unescape_name(part), part);
}

TEST(Text, ChecksNames) {
  EXPECT_FALSE(name_error("arm"));
  EXPECT_FALSE(name_error("left leg / 2 höhe"));
  EXPECT_FALSE(name_error(std::string(128, 'a')));
  EXPECT_EQ(name_error("").value_or(""), "a name must not be empty");
  EXPECT_EQ(name_error(std::string(129, 'a')).value_or(""), "a name may have at most 128 bytes, not 129");
  for (const char* name : {"a\nb", "a\tb", "\x1b[0m", "\xff", "a\x7f"})
    EXPECT_TRUE(name_error(name)) << printable(name);
}

TEST(Text, SplitKeepsEmptyPieces) {
  const auto pieces = [](std::string_view text) {
    const auto views = split(text, '/');
    return std::vector<std::string>(views.begin(), views.end());
  };
  EXPECT_EQ(pieces(""), (std::vector<std::string>{""}));
  EXPECT_EQ(pieces("a"), (std::vector<std::string>{"a"}));
  EXPECT_EQ(pieces("a//b/"), (std::vector<std::string>{"a", "", "b", ""}));
}

}  // namespace
}  // namespace limber
