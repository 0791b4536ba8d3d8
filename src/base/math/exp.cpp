// Exponential and hyperbolic functions.
#include "base/math/exp.h"

#include "base/math/fixed_math.h"

namespace limber::fixed {

double detail::scaled_at_limits(const ScaledSum& s) {
  if (s.exponent > 1024) return kInfinity;
  if (s.exponent < -1080) return 0;
  if (s.exponent > 0) return std::ldexp(s.hi + s.lo, s.exponent);
  const Sum sum = fast_sum(s.hi, s.lo);
  if (s.exponent > -1022 || (s.exponent == -1022 && sum.hi >= 1)) return std::ldexp(sum.hi, s.exponent);
  // The result is subnormal: rounds the sum to a multiple of 2^-1074 / 2^exponent.
  const double magic = std::ldexp(1, 52 - 1074 - s.exponent);
  const Sum rounded = fast_sum(magic, sum.hi);
  return std::ldexp((rounded.hi + (rounded.lo + sum.lo)) - magic, s.exponent);
}

namespace {

using detail::bits_of;
using detail::exp_sum;
using detail::exp_terms;
using detail::fast_sum;
using detail::kInfinity;
using detail::kNaN;
using detail::magnitude;
using detail::power_of_two;
using detail::product;
using detail::ScaledSum;
using detail::Sum;
using detail::with_sign;

// Returns (sinh(x) - x) / x^3 for z = x^2 by a minimax polynomial on |x| <= 0.35; the relative error of sinh is 2^-65.
double sinh_series(double z) {
  const double z2 = z * z;
  const double p0 = 0x1.5555555555555p-3 + z * 0x1.111111111137bp-7;
  const double p2 = 0x1.a01a019eaebap-13 + z * 0x1.71de4029adfbap-19;
  const double p4 = 0x1.ae4e8e2ca0345p-26 + z * 0x1.7fad5f2f863afp-33;
  return p0 + z2 * (p2 + z2 * p4);
}

// Returns (tanh(x) - x) / x^3 for z = x^2 by a minimax polynomial on |x| <= 1/8; the relative error of tanh is 2^-64.
double tanh_series(double z) {
  const double z2 = z * z;
  const double p0 = -0x1.5555555555552p-2 + z * 0x1.111111110f10cp-3;
  const double p2 = -0x1.ba1ba1ad4ded9p-5 + z * 0x1.664f35ac54c75p-6;
  const double p4 = -0x1.22602f2e700d8p-7 + z * 0x1.cc885a66cc846p-9;
  return p0 + z2 * (p2 + z2 * p4);
}

// e^x / 2 and e^-x / 2, for 0 <= x <= 40.
struct HalfExponentials {
  Sum up, down;
};
HalfExponentials half_exponentials(double x) {
  const detail::ExpTerms t = exp_terms(x, 0, x);
  const detail::ExpSeries series(t.r);
  const ScaledSum up = detail::exp_entry(t.index, series.even + series.odd);
  const ScaledSum down = detail::exp_entry(-t.index, series.even - series.odd);
  const double up_scale = power_of_two(up.exponent - 1);
  const double down_scale = power_of_two(down.exponent - 1);
  return {fast_sum(up.hi * up_scale, up.lo * up_scale), fast_sum(down.hi * down_scale, down.lo * down_scale)};
}

// Returns e^x / 2 for x > 40, infinity included.
double half_exponential(double x) {
  if (x > 711) return kInfinity;
  ScaledSum s = exp_sum(exp_terms(x, 0, x));
  s.exponent--;
  return detail::scaled(s);
}

}  // namespace

double exp(double x) {
  const double size = magnitude(x);
  if (!(size < 746)) return x != x ? kNaN : x > 0 ? kInfinity : 0;
  if (size < 0x1p-54) return 1;
  return detail::scaled(exp_sum(exp_terms(x, 0, x)));
}

double exp2(double x) {
  const double size = magnitude(x);
  if (!(size < 1080)) return x != x ? kNaN : x > 0 ? kInfinity : 0;
  if (size < 0x1p-54) return 1;
  const double shifted = x * 128 + detail::kRoundToInteger;
  const double r = x - (shifted - detail::kRoundToInteger) * 0x1p-7;
  const int index = static_cast<int>(static_cast<std::uint32_t>(bits_of(shifted)));
  // minimax polynomial for 2^r - 1 on |r| <= 1/256, error 2^-64
  const double r2 = r * r;
  const double p = r * 0x1.62e42fefa39efp-1 + r2 * ((0x1.ebfbdff82c2aap-3 + r * 0x1.c6b08d715d0ecp-5) +
                                                    r2 * (0x1.3b2abeecfe87ep-7 + r * 0x1.5d6952afe05c8p-10));
  return detail::scaled(detail::exp_entry(index, p));
}

double sinh(double x) {
  const double size = magnitude(x);
  if (size < 0.35) {
    if (size < 0x1p-27) return x;
    const double z = x * x;
    return x + x * (z * sinh_series(z));
  }
  if (!(size <= 40)) return x == x ? with_sign(half_exponential(size), x) : kNaN;
  const HalfExponentials e = half_exponentials(size);
  const Sum main = fast_sum(e.up.hi, -e.down.hi);
  return with_sign(main.hi + (main.lo + (e.up.lo - e.down.lo)), x);
}

double cosh(double x) {
  const double size = magnitude(x);
  if (!(size <= 40)) return x == x ? half_exponential(size) : kNaN;
  const HalfExponentials e = half_exponentials(size);
  const Sum main = fast_sum(e.up.hi, e.down.hi);
  return main.hi + (main.lo + (e.up.lo + e.down.lo));
}

double tanh(double x) {
  const double size = magnitude(x);
  if (size < 0.125) {
    if (size < 0x1p-27) return x;
    const double z = x * x;
    return x + x * (z * tanh_series(z));
  }
  if (!(size <= 20)) return x == x ? with_sign(1, x) : kNaN;
  // tanh x = 1 - 2 / (e^2x + 1)
  const ScaledSum e = exp_sum(exp_terms(2 * size, 0, 2 * size));
  const double scale = power_of_two(e.exponent);
  const Sum power = fast_sum(e.hi * scale, e.lo * scale);
  const Sum raw = fast_sum(power.hi, 1);
  const Sum divisor = fast_sum(raw.hi, raw.lo + power.lo);
  const double inverse = 1 / divisor.hi;
  const double q = 2 * inverse;
  const Sum back = product(q, divisor.hi);
  // The remainder of the division corrects the quotient.
  const double remainder = ((2 - back.hi) - back.lo) - q * divisor.lo;
  const Sum main = fast_sum(1, -q);
  return with_sign(main.hi + (main.lo - remainder * inverse), x);
}

}  // namespace limber::fixed
