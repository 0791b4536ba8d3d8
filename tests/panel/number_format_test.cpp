// Numbers that fit a width: sign, exponent and the digits before the point are never lost.
#include "ui/panel/text/number_format.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace limber::panel::test {
namespace {

// Each character is one unit wide.
float one_each(std::string_view text) { return static_cast<float>(text.size()); }

std::string fitted(double value, float width, const NumberFormat& format = {}) {
  return fitted_number(value, format, width, one_each);
}

TEST(NumberFormat, ShowsFewerDigitsInNarrowFields) {
  EXPECT_EQ(fitted(3.14159265, 20), "3.14159");
  EXPECT_EQ(fitted(3.14159265, 6), "3.1416");
  EXPECT_EQ(fitted(3.14159265, 4), "3.14");
  EXPECT_EQ(fitted(3.14159265, 1), "3");
  EXPECT_EQ(fitted(-6.1232e-17, 20), "-6.1232e-17");
  EXPECT_EQ(fitted(-6.1232e-17, 8), "-6.1e-17");
  EXPECT_EQ(fitted(-6.1232e-17, 7), "-6e-17");
  EXPECT_EQ(fitted(-6.1232e-17, 3), "-6e-17") << "too long rather than wrong";
  EXPECT_EQ(fitted(123456, 6), "123456");
  EXPECT_EQ(fitted(123456, 5), "1.2e5");
  EXPECT_EQ(fitted(1234567, 20), "1234567") << "all digits before the point";
  EXPECT_EQ(fitted(12345678, 20), "1.23457e7");
  EXPECT_EQ(fitted(0.00012, 20), "0.00012");
  EXPECT_EQ(fitted(0.000012, 20), "1.2e-5");
  EXPECT_EQ(fitted(0.00012, 6), "1.2e-4") << "as many digits in less space";
  EXPECT_EQ(fitted(999999.7, 7), "1000000");
  EXPECT_EQ(fitted(0.30000001192, 20), "0.3") << "the precision of 32-bit floats";
}

TEST(NumberFormat, ShowsNoiseAsZero) {
  EXPECT_EQ(fitted(-6e-17, 20, {.zero_below = 2e-6}), "0");
  EXPECT_EQ(fitted(1.9e-6, 20, {.zero_below = 2e-6}), "0");
  EXPECT_EQ(fitted(2e-6, 20, {.zero_below = 2e-6}), "2e-6");
  EXPECT_EQ(fitted(-0.0, 20), "0");
  EXPECT_EQ(fitted(-0.2, 20, {.integer = true}), "0");
}

TEST(NumberFormat, ShowsSpecialValues) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const NumberFormat& format :
       {NumberFormat{}, NumberFormat{.integer = true}, NumberFormat{.decimals = 2}, NumberFormat{.zero_below = 1e-6}}) {
    EXPECT_EQ(fitted(inf, 20, format), "inf");
    EXPECT_EQ(fitted(-inf, 20, format), "-inf");
    EXPECT_EQ(fitted(std::nan(""), 20, format), "nan");
    EXPECT_EQ(fitted(-std::nan(""), 20, format), "nan");
  }
  EXPECT_EQ(fitted(5e-324, 20), "4.94066e-324");
  EXPECT_EQ(fitted(1.7976931348623157e308, 20), "1.79769e308");
  EXPECT_EQ(fitted(-1.7976931348623157e308, 7), "-2e308");
}

TEST(NumberFormat, ShowsAllDigitsOfIntegers) {
  EXPECT_EQ(fitted(123456789, 20, {.integer = true}), "123456789");
  EXPECT_EQ(fitted(123456789, 6, {.integer = true}), "1.23e8");
  EXPECT_EQ(fitted(-7, 20, {.integer = true}), "-7");
}

TEST(NumberFormat, HasFixedDecimals) {
  EXPECT_EQ(fitted(1.5, 20, {.decimals = 2}), "1.50");
  EXPECT_EQ(fitted(-0.001, 20, {.decimals = 2}), "0.00") << "no sign without digits";
  EXPECT_EQ(fitted(-12.345, 5, {.decimals = 2}), "-12.3");
  EXPECT_EQ(fitted(1e20, 20, {.decimals = 2}), "1e20");
}

// The place of the last digit shown: 0.01 for "3.14", 1e-18 for "-6.1e-17".
double last_place(const std::string& text) {
  const std::size_t e = text.find('e');
  const std::string mantissa = text.substr(0, e);
  const std::size_t point = mantissa.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  const int exponent = e == std::string::npos ? 0 : std::atoi(text.c_str() + e + 1);
  return std::pow(10.0, exponent - decimals);
}

// For random bits of doubles (denormal and huge ones included) and numbers of usual size: the text fits if it can, and
// parses back to the value, rounded to the last digit shown.
TEST(NumberFormat, ParsesBackWithinTheDigitsShown) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-20, 20);
  for (int i = 0; i < 20000; i++) {
    double value = 0;
    if (i % 2 == 0) {
      const std::uint64_t bits = random();
      static_assert(sizeof value == sizeof bits);
      std::memcpy(&value, &bits, sizeof value);
      if (!std::isfinite(value)) continue;
    } else {
      value = (random() % 2 == 0 ? 1 : -1) * std::pow(10.0, exponent(random));
    }
    for (float width = 7; width <= 14; width++) {
      const std::string text = fitted(value, width);
      const double parsed = std::strtod(text.c_str(), nullptr);
      ASSERT_LE(text.size(), std::max(width, std::abs(value) < 1e-99 ? 8.0F : 7.0F)) << text << " for " << value;
      ASSERT_LE(std::abs(parsed / last_place(text) - value / last_place(text)), 0.5 + 1e-5) << text << " for " << value;
      ASSERT_EQ(std::signbit(parsed), std::signbit(value)) << text;
    }
  }
}

TEST(NumberFormat, NeverShowsFewerDigitsInWiderFields) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> exponent(-9, 9);
  for (int i = 0; i < 2000; i++) {
    const double value = std::pow(10.0, exponent(random));
    double error = std::numeric_limits<double>::infinity();
    for (float width = 5; width < 14; width++) {
      const double parsed = std::strtod(fitted(value, width).c_str(), nullptr);
      ASSERT_LE(std::abs(parsed - value), error + value * 1e-15) << value << " at " << width;
      error = std::max(std::abs(parsed - value), 0.5 * last_place(fitted(value, width)));
    }
  }
}

}  // namespace
}  // namespace limber::panel::test
