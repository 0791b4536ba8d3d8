// Math functions with bit-identical results: errors against MPFR, special cases, exact results, golden bits.
#include "base/math/fixed_math.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <string>
#include <utility>

#include "base/fixed_math_reference.h"
#include "base/hash.h"
#include "base/random.h"
#include "support/skip.h"

namespace limber::base_test {
namespace {

namespace m = fixed;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kMost = std::numeric_limits<double>::max();

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

class FixedMath : public testing::TestWithParam<MathFunction> {};

INSTANTIATE_TEST_SUITE_P(Each, FixedMath, testing::ValuesIn(math_functions()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(FixedMath, ErrorIsBelowTheBound) {
  LIMBER_SKIP_IF(is_emulated(), "thousands of values");
  const MathFunction& f = GetParam();
  const WorstCase worst = worst_case(f, 1, 20000);
  EXPECT_LE(worst.ulps, f.max_ulps) << std::hexfloat << worst.x << ", " << worst.y;
  EXPECT_GT(worst.ulps, 0.49) << "The arguments do not test the rounding.";
}

// Fails if a compiler or processor produces a different bit in one of 20,000 results.
TEST_P(FixedMath, BitsAreTheSameEverywhere) {
  const MathFunction& f = GetParam();
  EXPECT_EQ(hash_of_results(f), f.golden) << std::hex << "0x" << hash_of_results(f);
}

TEST_P(FixedMath, NaNsAreAllTheSame) {
  const MathFunction& f = GetParam();
  for (const double nan : {kNan, -kNan, std::bit_cast<double>(std::uint64_t{0xfff8000000001234})}) {
    EXPECT_EQ(bits(f.call(nan, 2)), bits(kNan));
    EXPECT_EQ(bits(f.call(f.binary != nullptr ? 2 : nan, nan)), bits(kNan));
  }
}

TEST(FixedMathArithmetic, IsExact) { EXPECT_TRUE(m::is_arithmetic_exact()); }

TEST(FixedMathArithmetic, IsResetAfterALibraryHasChangedIt) {
  std::fesetround(FE_UPWARD);
  EXPECT_FALSE(m::is_arithmetic_exact());
  m::reset_arithmetic();
  EXPECT_TRUE(m::is_arithmetic_exact());
}

// The C library's functions, called through their names as another library calls them.
template <typename Function>
Function* library(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

TEST(LibmReplacement, GivesLibrariesTheFixedFunctions) {
  LIMBER_SKIP_IF(is_emulated(), "thousands of values");
  EXPECT_TRUE(m::is_libm_replaced());
  Random random(7);
  for (int i = 0; i < 20000; i++) {
    const double x = random.uniform(-20, 20);
    const double y = random.uniform(0, 20);
    const auto f = static_cast<float>(x);
    ASSERT_EQ(library<double(double)>("sin")(x), m::sin(x)) << x;
    ASSERT_EQ(library<double(double)>("tan")(x), m::tan(x)) << x;
    ASSERT_EQ(library<double(double)>("exp")(x), m::exp(x)) << x;
    ASSERT_EQ(library<double(double)>("log10")(y), m::log10(y)) << y;
    ASSERT_EQ(library<double(double, double)>("pow")(y, x), m::pow(y, x)) << x;
    ASSERT_EQ(library<float(float)>("tanf")(f), m::tanf(f)) << f;
    ASSERT_EQ(library<float(float, float)>("atan2f")(f, 1), m::atan2f(f, 1)) << f;
    float sine = 0;
    float cosine = 0;
    library<void(float, float*, float*)>("sincosf")(f, &sine, &cosine);
    ASSERT_EQ(sine, m::sinf(f)) << f;
    ASSERT_EQ(cosine, m::cosf(f)) << f;
  }
}

TEST(LibmReplacement, SquaresAsCompiledLuaDoes) {
  LIMBER_SKIP_IF(is_emulated(), "thousands of values");
  Random random(8);
  for (int i = 0; i < 20000; i++) {
    const double x = random.uniform(-1e3, 1e3);
    ASSERT_EQ(library<double(double, double)>("pow")(x, 2), x * x);
  }
}

// An argument and its result. Results are compared bit by bit, including signs of zeros and NaNs.
using Case = std::pair<double, double>;
void expect_cases(double (*f)(double), std::initializer_list<Case> cases) {
  for (const auto& [x, result] : cases) EXPECT_EQ(bits(f(x)), bits(result)) << x << " gives " << f(x);
}
// Checks both signs of the arguments of a function with f(-x) = -f(x).
void expect_odd_cases(double (*f)(double), std::initializer_list<Case> cases) {
  for (const auto& [x, result] : cases) {
    const double opposite = result != result ? result : -result;
    expect_cases(f, {{x, result}, {-x, opposite}});
  }
}
void expect_pairs(double (*f)(double, double), std::initializer_list<std::array<double, 3>> cases) {
  for (const auto& [x, y, result] : cases) {
    EXPECT_EQ(bits(f(x, y)), bits(result)) << x << ", " << y << " gives " << f(x, y);
  }
}

TEST(FixedMathSpecialCases, TrigonometricFunctions) {
  for (const auto f : {m::sin, m::tan}) expect_odd_cases(f, {{0.0, 0.0}, {kLeast, kLeast}, {kInf, kNan}});
  expect_cases(m::cos, {{0.0, 1}, {-0.0, 1}, {kLeast, 1}, {kInf, kNan}, {-kInf, kNan}});
  expect_odd_cases(m::asin, {{0.0, 0.0}, {kLeast, kLeast}, {1, 0x1.921fb54442d18p+0}, {1.5, kNan}, {kInf, kNan}});
  expect_cases(m::acos, {{1, 0}, {-1, 0x1.921fb54442d18p+1}, {0, 0x1.921fb54442d18p+0}, {1.5, kNan}, {-kInf, kNan}});
  expect_odd_cases(m::atan, {{0.0, 0.0}, {kLeast, kLeast}, {kInf, 0x1.921fb54442d18p+0}, {1, 0x1.921fb54442d18p-1}});
}

TEST(FixedMathSpecialCases, Atan2) {
  constexpr double kPi1 = 0x1.921fb54442d18p+1;
  for (const double sign : {1.0, -1.0}) {
    expect_pairs(m::atan2, {{sign * 0.0, 1, sign * 0.0},
                            {sign * 0.0, 0.0, sign * 0.0},
                            {sign * 0.0, kInf, sign * 0.0},
                            {sign * 0.0, -0.0, sign * kPi1},
                            {sign * 0.0, -1, sign * kPi1},
                            {sign * 0.0, -kInf, sign * kPi1},
                            {sign, 0.0, sign * kPi1 / 2},
                            {sign, -0.0, sign * kPi1 / 2},
                            {sign, kInf, sign * 0.0},
                            {sign, -kInf, sign * kPi1},
                            {sign * kInf, 5, sign * kPi1 / 2},
                            {sign * kInf, -kMost, sign * kPi1 / 2},
                            {sign * kInf, kInf, sign * kPi1 / 4},
                            {sign * kInf, -kInf, sign * 0x1.2d97c7f3321d2p+1},
                            {sign * kLeast, kMost, sign * 0.0},
                            {sign * kLeast, -kMost, sign * kPi1},
                            {sign * kLeast, 1, sign * kLeast},
                            {sign * kMost, kMost, sign * kPi1 / 4},
                            {sign * kLeast, kLeast, sign * kPi1 / 4}});
  }
}

TEST(FixedMathSpecialCases, ExponentialsAndLogarithms) {
  for (const auto f : {m::exp, m::exp2}) {
    expect_cases(f, {{0.0, 1}, {-0.0, 1}, {kLeast, 1}, {kInf, kInf}, {-kInf, 0}, {kMost, kInf}, {-kMost, 0}});
  }
  expect_cases(m::exp, {{0x1.62e42fefa39efp+9, 0x1.fffffffffff2ap+1023}, {0x1.62e42fefa39fp+9, kInf}});
  expect_cases(m::exp, {{-0x1.74910d52d3051p+9, kLeast}, {-0x1.74910d52d3052p+9, 0}});
  expect_cases(m::exp2, {{1024, kInf}, {-1074, kLeast}, {-1075, 0}});
  for (const auto f : {m::log, m::log2, m::log10}) {
    expect_cases(f, {{1, 0}, {0.0, -kInf}, {-0.0, -kInf}, {kInf, kInf}, {-kInf, kNan}, {-1, kNan}, {-kLeast, kNan}});
  }
  expect_odd_cases(m::sinh, {{0.0, 0.0}, {kLeast, kLeast}, {kInf, kInf}, {711, kInf}});
  expect_odd_cases(m::tanh, {{0.0, 0.0}, {kLeast, kLeast}, {kInf, 1}, {30, 1}});
  expect_cases(m::cosh, {{0.0, 1}, {-0.0, 1}, {kInf, kInf}, {-kInf, kInf}, {-711, kInf}});
}

TEST(FixedMathSpecialCases, PowerOfZeroAndInfinity) {
  for (const double y : {1.0, 3.0, 0x1.fffffffffffffp52}) {  // odd
    expect_pairs(m::pow, {{0.0, y, 0.0}, {-0.0, y, -0.0}, {0.0, -y, kInf}, {-0.0, -y, -kInf}});
    expect_pairs(m::pow, {{kInf, y, kInf}, {-kInf, y, -kInf}, {kInf, -y, 0.0}, {-kInf, -y, -0.0}});
  }
  for (const double y : {2.0, 0.5, 1.5, 0x1p53, kInf, kLeast}) {
    expect_pairs(m::pow, {{0.0, y, 0.0}, {-0.0, y, 0.0}, {0.0, -y, kInf}, {-0.0, -y, kInf}});
    expect_pairs(m::pow, {{kInf, y, kInf}, {-kInf, y, kInf}, {kInf, -y, 0.0}, {-kInf, -y, 0.0}});
  }
}

TEST(FixedMathSpecialCases, PowerOfOthers) {
  for (const double zero : {0.0, -0.0}) {
    expect_pairs(m::pow, {{kNan, zero, 1}, {kInf, zero, 1}, {-3, zero, 1}, {zero, zero, 1}});
  }
  expect_pairs(m::pow, {{1, kNan, 1}, {1, kInf, 1}, {-1, kInf, 1}, {-1, -kInf, 1}, {-1, 3, -1}, {-1, 0x1p60, 1}});
  expect_pairs(m::pow, {{-8, 1.0 / 3, kNan}, {-2, 3, -8}, {-2, 4, 16}, {-2, -1, -0.5}, {-0.5, 0.5, kNan}});
  expect_pairs(m::pow, {{2, kInf, kInf}, {2, -kInf, 0}, {0.5, kInf, 0}, {-0.5, -kInf, kInf}, {kLeast, 1, kLeast}});
  expect_pairs(m::pow, {{1 + 0x1p-52, 0x1p63, kInf}, {1 - 0x1p-53, 0x1p70, 0}, {kMost, kLeast, 1}, {-2, 1025, -kInf}});
  expect_pairs(m::pow, {{2, -1074, kLeast}, {2, -1075, 0}, {-2, -1075, -0.0}, {kLeast, -1, kInf}, {kMost, 1, kMost}});
}

TEST(FixedMathSpecialCases, Roots) {
  expect_odd_cases(m::cbrt, {{0.0, 0.0}, {kInf, kInf}, {27, 3}, {0x1p-1074, 0x1p-358}, {0x1p1023, 0x1p341}});
  expect_pairs(m::hypot, {{0.0, -0.0, 0}, {kInf, kNan, kInf}, {kNan, -kInf, kInf}, {-3, 0.0, 3}, {kLeast, 0, kLeast}});
  expect_pairs(m::hypot, {{3 * kLeast, -4 * kLeast, 5 * kLeast}, {kMost, kMost, kInf}, {kMost, 1, kMost}});
}

TEST(FixedMathExactResults, PowersAndRoots) {
  double power = 1;
  for (int n = 0; n <= 22; n++, power *= 10) {
    EXPECT_EQ(m::pow(10, n), power);
    EXPECT_EQ(m::log10(power), n);
  }
  for (int n = -1074; n < 1024; n++) {
    EXPECT_EQ(m::exp2(n), std::ldexp(1, n));
    EXPECT_EQ(m::pow(2, n), std::ldexp(1, n));
    EXPECT_EQ(m::log2(std::ldexp(1, n)), n);
  }
  for (int n = -1000; n <= 1000; n++) {
    EXPECT_EQ(m::cbrt(double{1} * n * n * n), n);
    EXPECT_EQ(m::pow(n, 2), double{1} * n * n);
    EXPECT_EQ(m::hypot(3 * n, 4 * n), std::abs(5 * n));
  }
}

// Arguments next to multiples of pi/2, of which the first is the nearest that a double is (Muller, Elementary
// Functions, 2016, section 11.3), and the largest double.
TEST(FixedMathTrigonometry, HugeArgumentsAreReducedExactly) {
  EXPECT_EQ(m::cos(0x1.6ac5b262ca1ffp+849), -4.68716592425462761112e-19);
  for (const double x : {0x1.6ac5b262ca1ffp+849, kMost, 0x1p1000, 0x1p17, 0x1.921fb54442d18p+1}) {
    for (const auto& f : math_functions()) {
      if (f.unary != m::sin && f.unary != m::cos && f.unary != m::tan) continue;
      Exact a, b, out;
      EXPECT_LE(ulps(f, x, 0, f.unary(x), a, b, out), f.max_ulps) << f.name << " " << x;
    }
  }
}

TEST(FixedMathTrigonometry, SinCosIsSinAndCos) {
  MathArguments arguments(math_functions()[0], 2);
  for (int i = 0; i < 20000; i++) {
    const double x = arguments.next();
    const m::SinCos both = m::sincos(x);
    ASSERT_EQ(bits(both.sin), bits(m::sin(x))) << x;
    ASSERT_EQ(bits(both.cos), bits(m::cos(x))) << x;
  }
}

// The result depends on the last digits of the logarithm if y is large and x is near 1.
TEST(FixedMathPower, LargePowersOfNumbersNearOneAreAccurate) {
  const auto& functions = math_functions();
  const auto f = std::find_if(functions.begin(), functions.end(), [](const auto& g) { return g.binary == m::pow; });
  ASSERT_NE(f, functions.end());
  Random random(5, "near one");
  Exact a, b, out;
  for (int i = 0; i < 20000; i++) {
    const int distance = static_cast<int>(random.next() % 52);
    const double x = 1 + std::ldexp(random.uniform(-1, 1), -distance);
    const double y = random.uniform(-745, 710) / m::log(x);
    if (!std::isfinite(y)) continue;
    ASSERT_LE(ulps(*f, x, y, m::pow(x, y), a, b, out), f->max_ulps) << std::hexfloat << x << ", " << y;
  }
}

TEST(FixedMathFloats, AreTheDoublesRounded) {
  Random random(3, "floats");
  for (int i = 0; i < 5000; i++) {
    const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
    const auto y = static_cast<float>(random.uniform(-4, 4));
    for (const auto& [single, whole] :
         std::initializer_list<std::pair<float (*)(float), double (*)(double)>>{{m::sinf, m::sin},
                                                                                {m::cosf, m::cos},
                                                                                {m::tanf, m::tan},
                                                                                {m::asinf, m::asin},
                                                                                {m::acosf, m::acos},
                                                                                {m::atanf, m::atan},
                                                                                {m::expf, m::exp},
                                                                                {m::exp2f, m::exp2},
                                                                                {m::logf, m::log},
                                                                                {m::log2f, m::log2},
                                                                                {m::log10f, m::log10},
                                                                                {m::sinhf, m::sinh},
                                                                                {m::coshf, m::cosh},
                                                                                {m::tanhf, m::tanh},
                                                                                {m::cbrtf, m::cbrt}}) {
      for (const float argument : {x, y}) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(single(argument)),
                  std::bit_cast<std::uint32_t>(static_cast<float>(whole(double{argument}))))
            << argument;
      }
    }
    if (x != x) continue;
    ASSERT_EQ(m::atan2f(x, y), static_cast<float>(m::atan2(x, y)));
    ASSERT_EQ(m::powf(std::abs(x), y), static_cast<float>(m::pow(std::abs(x), y)));
    ASSERT_EQ(m::hypotf(x, y), static_cast<float>(m::hypot(x, y)));
  }
}

}  // namespace
}  // namespace limber::base_test
