// Inverse trigonometric functions. The arctangent is table-driven (Tang 1991): with c = k/64 near a / b,
// atan(a / b) = atan(c) + atan((a - c b) / (b + c a)), and the table has atan(c). The arcsine is a polynomial on
// [0, 1/2]; for larger arguments, asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2)).
#include "base/math/atan_table.h"
#include "base/math/double_double.h"
#include "base/math/fixed_math.h"

namespace limber::fixed {

namespace {

using detail::bits_of;
using detail::fast_sum;
using detail::from_bits;
using detail::kInfinity;
using detail::kNaN;
using detail::magnitude;
using detail::Sum;
using detail::upper_half;
using detail::with_sign;

constexpr double kPiHigh = 0x1.921fb54442d18p+1;
constexpr double kPiLow = 0x1.1a62633145c07p-53;

// Returns atan(a / b) for 0 <= a <= b with a relative error of 2^-60. Quotients and products of a and b must be normal
// numbers.
inline Sum atan_of_ratio(double a, double b) {
  const double shifted = a / b * 64 + detail::kRoundToInteger;
  const Sum& entry = detail::kAtans[bits_of(shifted) & 127];
  const double c = (shifted - detail::kRoundToInteger) * 0x1p-6;
  const double b_top = upper_half(b);
  // The dividend is exact, because it is a multiple of 2^-60 b and at most 2^-7 b.
  const double dividend = (a - c * b_top) - c * (b - b_top);
  const double ca = c * a;
  const double divisor = b + ca;
  const double divisor_low = (b - divisor) + ca;
  const double inverse = 1 / divisor;
  const double t = dividend * inverse;
  // The remainder of the division by the upper half of t gives the quotient with twice the digits.
  const double top = upper_half(t);
  const double divisor_top = upper_half(divisor);
  const double remainder = ((dividend - top * divisor_top) - top * (divisor - divisor_top)) - t * divisor_low;
  const double z = t * t;
  // minimax polynomial for atan(t) - t on |t| <= 1/128, relative error of atan(t) 2^-65
  const double series = t * z * (-0x1.55555555554fdp-2 + z * (0x1.9999998925c2ep-3 + z * -0x1.248b52b1bee78p-3));
  const Sum main = fast_sum(entry.hi, top);
  return {main.hi, main.lo + (entry.lo + (remainder * inverse + series))};
}

// The angle that an octant's arctangent is added to, or subtracted from if the sign is -1.
struct Octant {
  double hi, lo, sign;
};
constexpr Octant kOctants[] = {
    {0, 0, 1}, {kPiHigh / 2, kPiLow / 2, -1}, {kPiHigh, kPiLow, -1}, {kPiHigh / 2, kPiLow / 2, 1}};

// Returns atan2(y, x) for magnitudes in [2^-500, 2^500].
inline double atan2_common(double y, double x, double y_size, double x_size) {
  const bool steep = y_size > x_size;
  const Sum angle = steep ? atan_of_ratio(x_size, y_size) : atan_of_ratio(y_size, x_size);
  const Octant& octant = kOctants[(steep ? 1u : 0u) + (x < 0 ? 2u : 0u)];
  const Sum main = fast_sum(octant.hi, octant.sign * angle.hi);
  return with_sign(main.hi + (main.lo + (octant.lo + octant.sign * angle.lo)), y);
}

double atan2_special(double y, double x) {
  if (x != x || y != y) return kNaN;
  const bool left = (bits_of(x) & detail::kSignBit) != 0;
  const double y_size = magnitude(y);
  const double x_size = magnitude(x);
  if (y_size == 0) return with_sign(left ? kPiHigh : 0, y);
  if (x_size == 0) return with_sign(kPiHigh / 2, y);
  if (x_size == kInfinity) {
    if (y_size == kInfinity) return with_sign(left ? 0x1.2d97c7f3321d2p+1 : kPiHigh / 4, y);
    return with_sign(left ? kPiHigh : 0, y);
  }
  if (y_size == kInfinity) return with_sign(kPiHigh / 2, y);
  int y_exponent = 0;
  int x_exponent = 0;
  (void)std::frexp(y_size, &y_exponent);
  (void)std::frexp(x_size, &x_exponent);
  // If one is far larger, the result is a multiple of pi/2, rounded, or the quotient.
  if (y_exponent - x_exponent > 60) return with_sign(kPiHigh / 2, y);
  if (y_exponent - x_exponent < -60) return left ? with_sign(kPiHigh, y) : y / x;
  const double y_scaled = std::ldexp(y, -y_exponent);
  const double x_scaled = std::ldexp(x, -y_exponent);
  return atan2_common(y_scaled, x_scaled, magnitude(y_scaled), magnitude(x_scaled));
}

inline bool is_moderate(double size) {
  constexpr double kMin = 0x1p-500;
  constexpr double kMax = 0x1p+500;
  return bits_of(size) - bits_of(kMin) < bits_of(kMax) - bits_of(kMin);
}

// Returns asin(x) - x for |x| <= 1/2 and z = x^2, by a minimax polynomial; the relative error of asin(x) is 2^-59. hi
// is the upper part of the leading term x^3/6 and exact, so that rounding affects the small rest only.
inline Sum asin_minus_argument(double x, double z) {
  constexpr double kLeadingCoefficient = 0x1.5555555555578p-3;
  constexpr double kLeadingCoefficientHigh = 0x1.55p-3;                          // 9 bits
  const double x_top = from_bits(bits_of(x) & ~((std::uint64_t{1} << 39) - 1));  // 14 bits
  const double square = x_top * x_top;
  const double leading_term_low = kLeadingCoefficientHigh * ((x - x_top) * ((z + x * x_top) + square));
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double p0 = (kLeadingCoefficient - kLeadingCoefficientHigh) + z * 0x1.333333332df16p-4;
  const double p2 = 0x1.6db6db722b6bap-5 + z * 0x1.f1c71a8b9b3e5p-6;
  const double p4 = 0x1.6e8bdfe6582cdp-6 + z * 0x1.1c49de0ed236bp-6;
  const double p6 = 0x1.ca21424010f68p-7 + z * 0x1.7577a3b19cd04p-7;
  const double p8 = 0x1.618a201a248bep-7 + z * 0x1.e165c566d5af4p-9;
  const double p10 = 0x1.64fe73ea36059p-6 + z * -0x1.59f110b6f02bfp-6;
  const double p12 = 0x1.0be295edded06p-5;
  const double p = (p0 + z2 * p2) + z4 * ((p4 + z2 * p6) + z4 * ((p8 + z2 * p10) + z4 * p12));
  return {square * x_top * kLeadingCoefficientHigh, leading_term_low + (x * z) * p};
}

// Returns asin(sqrt(w)) for 0 < w <= 1/4.
inline Sum asin_of_root(double w) {
  const double root = std::sqrt(w);
  const double top = upper_half(root);
  const double rest = (w - top * top) / (root + top);
  const Sum more = asin_minus_argument(root, w);
  // corrects for the rounding error of the root: the derivative of asin(x) - x is x^2 / 2 + 3/8 x^4 + ...
  const double correction = (rest - (root - top)) * (w * (0.5 + 0.375 * w));
  const Sum main = fast_sum(top, more.hi);
  return {main.hi, main.lo + (rest + (more.lo + correction))};
}

}  // namespace

double atan(double x) {
  const double size = magnitude(x);
  if (!(size < 0x1p60)) return x == x ? with_sign(kPiHigh / 2, x) : kNaN;
  if (size < 0x1p-27) return x;
  const bool steep = size > 1;
  const Sum angle = steep ? atan_of_ratio(1, size) : atan_of_ratio(size, 1);
  const Octant& octant = kOctants[steep ? 1 : 0];
  const Sum main = fast_sum(octant.hi, octant.sign * angle.hi);
  return with_sign(main.hi + (main.lo + (octant.lo + octant.sign * angle.lo)), x);
}

double atan2(double y, double x) {
  const double y_size = magnitude(y);
  const double x_size = magnitude(x);
  if (is_moderate(y_size) && is_moderate(x_size)) return atan2_common(y, x, y_size, x_size);
  return atan2_special(y, x);
}

double asin(double x) {
  const double size = magnitude(x);
  if (size <= 0.5) {
    if (size < 0x1p-27) return x;
    const Sum more = asin_minus_argument(x, x * x);
    const Sum main = fast_sum(x, more.hi);
    return main.hi + (main.lo + more.lo);
  }
  if (!(size < 1)) return size == 1 ? with_sign(kPiHigh / 2, x) : kNaN;
  const Sum half = asin_of_root((1 - size) * 0.5);
  const Sum main = fast_sum(kPiHigh / 2, -2 * half.hi);
  return with_sign(main.hi + (main.lo + (kPiLow / 2 - 2 * half.lo)), x);
}

double acos(double x) {
  const double size = magnitude(x);
  if (size <= 0.5) {
    const Sum more = asin_minus_argument(x, x * x);
    const Sum main = fast_sum(kPiHigh / 2, -x);
    return main.hi + (main.lo + ((kPiLow / 2 - more.lo) - more.hi));
  }
  if (!(size < 1)) return size == 1 ? (x < 0 ? kPiHigh : 0) : kNaN;
  const Sum half = asin_of_root((1 - size) * 0.5);
  if (x > 0) return 2 * (half.hi + half.lo);
  const Sum main = fast_sum(kPiHigh, -2 * half.hi);
  return main.hi + (main.lo + (kPiLow - 2 * half.lo));
}

}  // namespace limber::fixed
