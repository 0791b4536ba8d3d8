// vec3, quat, colors, additions to math: compared with values calculated by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "stage.h"

namespace limber::script {
namespace {

struct Case {
  const char* expression;
  const char* result;
};

void expect_values(std::initializer_list<Case> cases) {
  for (const Case& c : cases) EXPECT_EQ(value_of(c.expression), c.result) << c.expression;
}

TEST(Values, Vec3MatchesHandCalculation) {
  expect_values({
      {"vec3()", "vec3(0, 0, 0)"},
      {"vec3(1)", "vec3(1, 0, 0)"},
      {"vec3(1, -2.5, 3)", "vec3(1, -2.5, 3)"},
      {"vec3({ 4, 5, 6 })", "vec3(4, 5, 6)"},
      {"vec3(1, 2, 3).x .. vec3(1, 2, 3).y .. vec3(1, 2, 3).z", "123"},
      {"vec3(1, 2, 3) + vec3(10, 20, 30)", "vec3(11, 22, 33)"},
      {"vec3(1, 2, 3) + { 10, 20, 30 }", "vec3(11, 22, 33)"},
      {"{ 10, 20, 30 } - vec3(1, 2, 3)", "vec3(9, 18, 27)"},
      {"vec3(1, 2, 3) * 2", "vec3(2, 4, 6)"},
      {"2 * vec3(1, 2, 3)", "vec3(2, 4, 6)"},
      {"vec3(1, 2, 3) * vec3(4, 5, 6)", "vec3(4, 10, 18)"},
      {"vec3(2, 4, 6) / 2", "vec3(1, 2, 3)"},
      {"vec3(8, 10, 18) / vec3(4, 5, 6)", "vec3(2, 2, 3)"},
      {"-vec3(1, -2, 3)", "vec3(-1, 2, -3)"},
      {"vec3(1, 2, 3) == vec3(1, 2, 3)", "true"},
      {"vec3(1, 2, 3) == vec3(1, 2, 4)", "false"},
      {"vec3(1, 2, 3) == nil", "false"},
      {"vec3(3, 4, 12):length()", "13"},
      {"vec3(0, 3, 4):normalized()", "vec3(0, 0.6, 0.8)"},
      {"vec3():normalized()", "vec3(0, 0, 0)"},
      {"vec3(1, 2, 3):dot(vec3(4, -5, 6))", "12"},
      {"vec3(1, 0, 0):cross(vec3(0, 1, 0))", "vec3(0, 0, 1)"},
      {"vec3(0, 1, 0):cross({ 0, 0, 1 })", "vec3(1, 0, 0)"},
      {"vec3(0, 10, 20):lerp(vec3(10, 20, 40), 0.25)", "vec3(2.5, 12.5, 25)"},
      {"tostring(vec3(0.1, 1e20, -0.5))", "vec3(0.1, 1e+20, -0.5)"},
  });
}

TEST(Values, QuatMatchesHandCalculation) {
  expect_values({
      {"quat()", "quat(0, 0, 0, 1)"},
      {"quat(0.5, -0.5, 0.5, 0.5)", "quat(0.5, -0.5, 0.5, 0.5)"},
      {"quat(1, 2, 3, 4).x .. quat(1, 2, 3, 4).w", "14"},
      {"quat(1, 2, 3, 4) == quat(1, 2, 3, 4)", "true"},
      {"quat() == vec3()", "false"},
      // q first, then p
      {"quat(0, 0, 1, 0) * quat(1, 0, 0, 0)", "quat(0, 1, 0, 0)"},
      // half a turn about z maps x to -x; half turns about x, y and z in sequence give the negative identity
      {"quat(0, 0, 1, 0) * vec3(1, 2, 3)", "vec3(-1, -2, 3)"},
      {"quat(0, 0, 0.6, 0.8) * vec3(1, 0, 0)", "vec3(0.28, 0.96, 0)"},
      {"quat(0, 0, 0.6, 0.8):inverse() * vec3(0.28, 0.96, 0)", "vec3(1, 0, 0)"},
      {"quat(0, 0, 3, 4):inverse()", "quat(-0, -0, -0.12, 0.16)"},
  });
}

double number_of(const std::string& expression) {
  const std::string text = value_of("string.format('%.17g', " + expression + ")");
  return std::stod(text);
}

TEST(Values, RotationsMatchTheEngine) {
  const Quat house = quat_euler(0.3, -0.8, 2.1);
  EXPECT_NEAR(number_of("quat.euler(0.3, -0.8, 2.1).x"), house.x, 1e-15);
  EXPECT_NEAR(number_of("quat.euler(0.3, -0.8, 2.1).y"), house.y, 1e-15);
  EXPECT_NEAR(number_of("quat.euler(0.3, -0.8, 2.1).z"), house.z, 1e-15);
  EXPECT_NEAR(number_of("quat.euler(0.3, -0.8, 2.1).w"), house.w, 1e-15);
  const Vec3 turned = house * Vec3(1, 2, 3);
  EXPECT_NEAR(number_of("(quat.euler(0.3, -0.8, 2.1) * vec3(1, 2, 3)).x"), turned.x, 1e-14);
  EXPECT_NEAR(number_of("(quat.euler(0.3, -0.8, 2.1) * vec3(1, 2, 3)).y"), turned.y, 1e-14);
  EXPECT_NEAR(number_of("(quat.euler(0.3, -0.8, 2.1) * vec3(1, 2, 3)).z"), turned.z, 1e-14);
  // the axis need not be normalized
  EXPECT_NEAR(number_of("quat.axis(vec3(0, 0, 5), math.pi / 2).z"), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(number_of("quat.axis(vec3(0, 0, 5), math.pi / 2).w"), std::sqrt(0.5), 1e-15);
  // a quarter of a third of a turn, along the shortest arc although the signs differ
  EXPECT_NEAR(number_of("quat():slerp(quat.axis(vec3(0, 0, 1), 2 * math.pi / 3), 0.25).z"), std::sin(kPi / 12), 1e-14);
  EXPECT_NEAR(number_of("quat(0, 0, 0, -1):slerp(quat.axis(vec3(0, 0, 1), 2 * math.pi / 3), 0.25).w"),
              -std::cos(kPi / 12), 1e-14);
}

TEST(Values, MathAndColorsMatchHandCalculation) {
  expect_values({
      {"math.clamp(5, 0, 1)", "1"},
      {"math.clamp(-5, 0, 1)", "0"},
      {"math.clamp(0.5, 0, 1)", "0.5"},
      {"math.clamp(7, -math.huge, math.huge)", "7"},
      {"math.clamp(0, 3, 2)", "3"},
      {"math.lerp(10, 20, 0.25)", "12.5"},
      {"math.map(5, 0, 10, 100, 200)", "150"},
      {"rgb(1, 0, 0)", "vec3(0, 1, 1)"},
      {"rgb(0, 0.5, 0)", "vec3(0.33333333333333, 1, 0.5)"},
      {"rgb(0.25, 0.25, 0.5)", "vec3(0.66666666666667, 0.5, 0.5)"},
      {"rgb(0, 0, 0)", "vec3(0, 0, 0)"},
      {"rgb(1, 0, 1)", "vec3(0.83333333333333, 1, 1)"},
      {"math.randomseed", "nil"},
  });
}

// A loop is compiled while it runs: values within the range are unchanged bit for bit, including the sign of zero.
TEST(Values, ClampIsTheSameWhenCompiled) {
  EXPECT_EQ(value_of("(function() local seen = {} for i = 1, 3000 do "
                     "for _, x in ipairs { -1 / math.huge, 1 / math.huge } do "
                     "for _, lo in ipairs { -1, -1 / math.huge, 1 / math.huge } do "
                     "seen[i] = (seen[i] or '') .. 1 / math.clamp(x, lo, 1) .. 1 / math.clamp(x, -1, -lo) "
                     "end end end for i = 2, #seen do if seen[i] ~= seen[1] then return i .. seen[i] end end "
                     "return seen[1] end)()"),
            "-inf-inf-inf-inf-inf-infinfinfinfinfinfinf");
}

TEST(Values, NoiseMatchesPerlin) {
  // zero on the lattice, bounded, and equal to the reference implementation between
  expect_values({{"math.noise(3)", "0"}, {"math.noise(3, -4, 250)", "0"}});
  EXPECT_NEAR(number_of("math.noise(3.14, 42, 7)"), 0.13691995878400012, 1e-15);
  EXPECT_NEAR(number_of("math.noise(-4.2, 1.7, 9.3)"), number_of("math.noise(251.8, 257.7, 265.3)"), 1e-9);
  EXPECT_EQ(
      value_of("(function() local low, high = 0, 0 for i = 1, 20000 do local n = math.noise(i * 0.137, i * 0.731, i "
               "* 0.317) low, high = math.min(low, n), math.max(high, n) end return low >= -1 and high <= 1 and "
               "low < -0.7 and high > 0.7 end)()"),
      "true");
}

TEST(Values, MistakesAreExplained) {
  const std::string at = "scripts/scene.lua:1: ";
  EXPECT_EQ(error_of("local v = vec3(1, 2, 3) v.x = 5"),
            at + "this member is read-only; of a vec3 or quat assign the whole value");
  EXPECT_EQ(error_of("local v = vec3() v.w = 5"), at + "a vec3 is immutable; assign the whole value");
  EXPECT_EQ(error_of("local v = vec3().lenght"), at + "a vec3 has no member 'lenght'; did you mean 'length'?");
  EXPECT_EQ(error_of("local v = vec3(1, 2, 3) + 1"), at + "can't add vec3(1, 2, 3) and 1");
  EXPECT_EQ(error_of("local v = vec3(1, 2, 3) * quat()"), at + "can't multiply vec3(1, 2, 3) and quat(0, 0, 0, 1)");
  EXPECT_EQ(error_of("local v = quat() * 2"),
            at + "can't multiply quat(0, 0, 0, 1) and 2; a quat rotates its right operand");
  EXPECT_EQ(error_of("vec3('a', 2)"), at + "vec3 takes three numbers, not 'a', 2, nothing");
  EXPECT_EQ(error_of("quat(1, 2)"), at + "quat takes four numbers x, y, z, w, or none");
  EXPECT_EQ(error_of("quat.axis(vec3(), 1)"), at + "quat.axis: the axis must not be zero");
  EXPECT_EQ(error_of("vec3():dot(3)"), at + "vec3:dot takes a vec3, not 3");
  EXPECT_EQ(error_of("vec3():length():x()"), at + "attempt to index a number value");
}

}  // namespace
}  // namespace limber::script
