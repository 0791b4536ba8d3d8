// Functions of Lua's libraries give the same result compiled and interpreted, on every machine, unlike LuaJIT's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/math/fixed_math.h"
#include "stage.h"

namespace limber::script {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Plays a scene with a loop that is compiled after some 60 iterations, and returns its printed lines.
std::vector<std::string> lines_of(const std::string& text) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.play(text, 1), "");
  EXPECT_TRUE(fixture.host.faults.empty()) << fixture.host.faults[0].text;
  return fixture.host.printed;
}

std::string shown(double x) {
  if (std::isnan(x)) return "nan";
  return x == 0 ? (std::signbit(x) ? "-0" : "0") : fmt::format("{}", x);
}

constexpr const char* kShowNumber = R"(
local function shown(x)
  if x ~= x then return "nan" end
  if x == 0 then return 1 / x < 0 and "-0" or "0" end
  if x == math.huge or x == -math.huge then return x > 0 and "inf" or "-inf" end
  return tostring(x)
end
local values = { 0, -1 / math.huge, 1, -1, 0.5, -2, 1 / 0, -1 / 0, 0 / 0 }
)";
const std::vector<double> kValues = {0, -0.0, 1, -1, 0.5, -2, kInf, -kInf, kNan};

// like standard Lua's C code
double lua_min(double x, double y) { return y < x ? y : x; }
double lua_max(double x, double y) { return y > x ? y : x; }

TEST(Library, CeilKeepsMinusZero) {
  std::vector<std::string> expected(kValues.size());
  std::transform(kValues.begin(), kValues.end(), expected.begin(), [](double x) { return shown(std::ceil(x)); });
  EXPECT_EQ(lines_of(std::string(kShowNumber) + R"(
sim:on_step(function()
  for round = 1, 100 do
    for _, x in ipairs(values) do
      local text = shown(math.ceil(x))
      if round == 100 then print(text) end
    end
  end
end)
)"),
            expected);
  EXPECT_EQ(value_of("math.ceil('1.5')"), "2");
  EXPECT_EQ(error_of("math.ceil({})"), "scripts/scene.lua:1: math.ceil takes a number, not a table");
}

TEST(Library, MinAndMaxKeepNaNAndMinusZero) {
  std::vector<std::string> expected;
  for (const double x : kValues) {
    for (const double y : kValues) {
      expected.push_back(
          fmt::format("{} {} {}", shown(lua_min(x, y)), shown(lua_max(x, y)), shown(lua_max(lua_min(1, x), y))));
    }
  }
  const std::vector<std::string> lines = lines_of(std::string(kShowNumber) + R"(
local lines = {}
for round = 1, 20 do
  local k = 0
  for i = 1, #values do
    for j = 1, #values do
      local x, y = values[i], values[j]
      local low, high, clamped = math.min(x, y), math.max(x, y), math.max(math.min(1, x), y)
      k = k + 1
      local line = shown(low) .. " " .. shown(high) .. " " .. shown(clamped)
      assert(round == 1 or lines[k] == line, line)
      lines[k] = line
    end
  end
end
for _, line in ipairs(lines) do print(line) end)");
  EXPECT_EQ(lines, expected);
}

TEST(Library, MinAndMaxAcceptTheSameArgumentsAsLua) {
  const std::vector<std::string> lines = lines_of(R"(
print(math.min(3), math.min(3, 1, 2), math.max("3", 4), math.max(1, 2, 7, 5), math.min(2, "-1"))
print(select(2, pcall(math.min)))
print(select(2, pcall(math.max, 1, {})))
print(select(2, pcall(math.max, 1, 2, nil)))
)");
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "3\t1\t4\t7\t-1");
  EXPECT_NE(lines[1].find("math.min takes numbers, not nothing"), std::string::npos) << lines[1];
  EXPECT_NE(lines[2].find("math.max takes numbers, not "), std::string::npos) << lines[2];
  EXPECT_NE(lines[3].find("math.max takes numbers, not nothing"), std::string::npos) << lines[3];
}

// Standard Lua's rule: negative positions count from the end, and positions outside are clamped.
std::string text_part(const std::string& text, double first, double last) {
  const auto n = static_cast<double>(text.size());
  if (first < 0) first = std::max(n + first + 1, 1.0);
  if (first < 1) first = 1;
  if (last < 0) last = n + last + 1;
  last = std::min(last, n);
  if (!(first <= last)) return "";
  return text.substr(static_cast<std::size_t>(first) - 1, static_cast<std::size_t>(last - first) + 1);
}

TEST(Library, SubstringPositionsAreClamped) {
  const std::vector<double> positions = {0, 1, 2, 3, 5, 6, 100, -1, -2, -5, -6, -100, 1e300, -1e300, kInf, -kInf};
  std::vector<std::string> expected;
  for (const char* text : {"", "a", "hello"}) {
    for (const double i : positions) {
      for (const double j : positions) {
        const std::string bytes = text_part(text, i, j);
        expected.push_back(fmt::format("{}|{}", bytes, bytes.empty() ? 0 : static_cast<int>(bytes[0])));
      }
    }
  }
  const std::vector<std::string> lines = lines_of(R"(
local positions = { 0, 1, 2, 3, 5, 6, 100, -1, -2, -5, -6, -100, 1e300, -1e300, math.huge, -math.huge }
local lines = {}
for round = 1, 8 do
  local k = 0
  for _, text in ipairs { "", "a", "hello" } do
    for i = 1, #positions do
      for j = 1, #positions do
        k = k + 1
        local line = text:sub(positions[i], positions[j]) .. "|" .. (text:byte(positions[i], positions[j]) or 0)
        assert(round == 1 or lines[k] == line, line)
        lines[k] = line
      end
    end
  end
end
for _, line in ipairs(lines) do print(line) end
assert(("hello"):sub(2) == "ello" and ("hello"):sub("2", 3.7) == "el" and string.sub(1234, 2, 3) == "23")
assert(("hello"):byte() == 104 and select("#", ("hello"):byte(2, 4)) == 3)
)");
  EXPECT_EQ(lines, expected);
}

struct Unary {
  const char* name;
  double (*function)(double);
  double low, high;
};

TEST(Library, MathUsesTheFixedFunctions) {
  const std::vector<Unary> functions = {
      {"sin", fixed::sin, -40, 40},   {"cos", fixed::cos, -40, 40},   {"tan", fixed::tan, -40, 40},
      {"asin", fixed::asin, -1, 1},   {"acos", fixed::acos, -1, 1},   {"atan", fixed::atan, -9, 9},
      {"exp", fixed::exp, -20, 20},   {"log", fixed::log, 0, 90},     {"log10", fixed::log10, 0, 90},
      {"sinh", fixed::sinh, -20, 20}, {"cosh", fixed::cosh, -20, 20}, {"tanh", fixed::tanh, -5, 5}};
  constexpr int kCount = 3000;
  std::string script = "local function put(name, f, low, high)\n  for i = 1, " + std::to_string(kCount) + R"( do
    local x = low + (high - low) * (i / 3001)
    print(string.format("%.17g", f(x)))
  end
end
)";
  std::vector<std::string> expected;
  for (const Unary& each : functions) {
    script += fmt::format("put('{0}', math.{0}, {1}, {2})\n", each.name, each.low, each.high);
    for (int i = 1; i <= kCount; i++) {
      expected.push_back(fmt::format("{:.17g}", each.function(each.low + (each.high - each.low) * (i / 3001.0))));
    }
  }
  script += "for i = 1, 3000 do print(string.format('%.17g', (i / 100) ^ (i / 3001 * 3 - 1))) end\n";
  for (int i = 1; i <= kCount; i++) {
    expected.push_back(fmt::format("{:.17g}", fixed::pow(i / 100.0, i / 3001.0 * 3 - 1)));
  }
  const std::vector<std::string> lines = lines_of(script);
  ASSERT_EQ(lines.size(), expected.size());
  const auto differs = std::mismatch(lines.begin(), lines.end(), expected.begin());
  EXPECT_TRUE(differs.first == lines.end()) << *differs.first << " instead of " << *differs.second << " in line "
                                            << std::distance(lines.begin(), differs.first);
}

}  // namespace
}  // namespace limber::script
