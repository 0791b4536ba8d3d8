// Cube root, hypotenuse, the single-precision functions and the check of the arithmetic.
#include "base/math/fixed_math.h"

#include <cfenv>

#include "base/math/double_double.h"

namespace limber::fixed {

namespace {

using detail::bits_of;
using detail::fast_sum;
using detail::from_bits;
using detail::kInfinity;
using detail::kInfinityBits;
using detail::kNaN;
using detail::magnitude;
using detail::Sum;
using detail::upper_half;
using detail::with_sign;

}  // namespace

bool is_arithmetic_exact() {
  // Reads from volatile variables keep the compiler from evaluating this at compile time.
  volatile double near_one = 1 + 0x1p-30;
  volatile double min_normal = std::numeric_limits<double>::min();
  volatile double half_digit = 0x1p-53;
  const double a = near_one;
  const double b = -(1 + 0x1p-29);
  // The rounded square of a is -b; the exact one is larger.
  const bool is_contracted = a * a + b != 0;
  const double half = min_normal * 0.5;
  const bool flushes = half == 0 || half * 2 != min_normal;
  const double up = 1 + half_digit;
  const double down = -1 - half_digit;
  const double odd = (1 + 0x1p-52) + half_digit;
  const bool rounds_to_nearest = up == 1 && down == -1 && odd == 1 + 0x1p-51;
  return !is_contracted && !flushes && rounds_to_nearest;
}

void reset_arithmetic() { std::fesetenv(FE_DFL_ENV); }

// With y the root rounded to 17 bits, y^3 is exact. Multiplies y by the series of (1 + u)^(1/3), u = (x - y^3) / y^3.
double cbrt(double x) {
  const double size = magnitude(x);
  if (size == 0 || size == kInfinity) return x;
  if (x != x) return kNaN;
  std::uint64_t bits = bits_of(size);
  int exponent = 0;
  if (bits < std::uint64_t{1} << 52) {
    bits = bits_of(size * 0x1p54);
    exponent = -54;
  }
  exponent += static_cast<int>(bits >> 52) - 1023;
  // exponent = 3 * third + part, part in 0 .. 2
  const int third = (exponent + 3 * 400) / 3 - 400;
  const int part = exponent - 3 * third;
  constexpr double kRoots[] = {1, 0x1.428a2f98d728bp+0, 0x1.965fea53d6e3dp+0};
  const double m = from_bits((bits & ((std::uint64_t{1} << 52) - 1)) | bits_of(1));
  // minimax polynomial for the root on [1, 2], relative error 2^-19
  const double m2 = m * m;
  const double guess = (0x1.e53b8ad33220ap-2 + m * 0x1.ac2d3fc09ab82p-1) +
                       m2 * ((-0x1.ddcdbf9221fa9p-2 + m * 0x1.9b96abdef0885p-3) +
                             m2 * (-0x1.97bea2e604ab7p-5 + m * 0x1.592433e18829bp-8));
  constexpr double kToSixteenBits = 0x1.8p+36;
  const double y = (guess * kRoots[part] + kToSixteenBits) - kToSixteenBits;
  const double cube = y * y * y;
  const double z = m * detail::power_of_two(part);
  const double u = (z - cube) / cube;
  const double more = u * (0x1.5555555555555p-2 + u * (-0x1.c71c71c71c71cp-4 + u * 0x1.f9add3c0ca458p-5));
  return with_sign((y + y * more) * detail::power_of_two(third), x);
}

namespace {

// Returns the square root of a^2 + b^2, which is computed as a sum of doubles, and applies one Newton step to the root.
// a >= b > 0; their squares must be normal numbers.
double hypot_common(double a, double b) {
  const double a_top = upper_half(a);
  const double b_top = upper_half(b);
  const Sum main = fast_sum(a_top * a_top, b_top * b_top);
  const double low = main.lo + ((a - a_top) * (a + a_top) + (b - b_top) * (b + b_top));
  const double root = std::sqrt(main.hi + low);
  const double half_inverse = 0.5 / root;
  const double top = upper_half(root);
  const double remainder = ((main.hi - top * top) - (root - top) * (root + top)) + low;
  return root + remainder * half_inverse;
}

}  // namespace

double hypot(double x, double y) {
  const double x_size = magnitude(x);
  const double y_size = magnitude(y);
  const double a = x_size > y_size ? x_size : y_size;
  const double b = x_size > y_size ? y_size : x_size;
  if (a < 0x1p500 && b > 0x1p-450) return hypot_common(a, b);
  if (x_size == kInfinity || y_size == kInfinity) return kInfinity;
  if (x != x || y != y) return kNaN;
  if (b <= a * 0x1p-54) return a + b;
  return a > 1 ? hypot_common(a * 0x1p-600, b * 0x1p-600) * 0x1p600 : hypot_common(a * 0x1p600, b * 0x1p600) * 0x1p-600;
}

float sinf(float x) { return static_cast<float>(sin(double{x})); }
float cosf(float x) { return static_cast<float>(cos(double{x})); }
float tanf(float x) { return static_cast<float>(tan(double{x})); }
float asinf(float x) { return static_cast<float>(asin(double{x})); }
float acosf(float x) { return static_cast<float>(acos(double{x})); }
float atanf(float x) { return static_cast<float>(atan(double{x})); }
float atan2f(float y, float x) { return static_cast<float>(atan2(double{y}, double{x})); }
float expf(float x) { return static_cast<float>(exp(double{x})); }
float exp2f(float x) { return static_cast<float>(exp2(double{x})); }
float logf(float x) { return static_cast<float>(log(double{x})); }
float log2f(float x) { return static_cast<float>(log2(double{x})); }
float log10f(float x) { return static_cast<float>(log10(double{x})); }
float powf(float x, float y) { return static_cast<float>(pow(double{x}, double{y})); }
float sinhf(float x) { return static_cast<float>(sinh(double{x})); }
float coshf(float x) { return static_cast<float>(cosh(double{x})); }
float tanhf(float x) { return static_cast<float>(tanh(double{x})); }
float cbrtf(float x) { return static_cast<float>(cbrt(double{x})); }
float hypotf(float x, float y) { return static_cast<float>(hypot(double{x}, double{y})); }

}  // namespace limber::fixed
