// The exponential function in double-double, for exp, pow and the hyperbolic functions; for fixed_math*.cpp only.
#pragma once

#include "base/fixed_math_exp_table.h"
#include "base/fixed_math_sum.h"

namespace limber::fixed::detail {

/// (hi + lo) * 2^exponent; hi is in [0.99, 2), lo below 2^-8 hi.
struct ScaledSum {
  double hi, lo;
  int exponent;
};

/// e^(x + x_low) for |x| < 1000 and a small x_low, with a relative error of 2^-61: x = n ln2/128 + r, a table of
/// 2^(n/128) and a polynomial (Tang 1989).
inline ScaledSum exp_sum(double x, double x_low) {
  // ln2/128 in two parts; multiples of the first by up to 2^19 are exact
  constexpr double kStep1 = 0x1.62e42fef8p-8;
  constexpr double kStep2 = 0x1.1cf79abc9e3b4p-43;
  constexpr double kPerStep = 0x1.71547652b82fep+7;
  const double shifted = x * kPerStep + kRoundToInteger;
  const double n = shifted - kRoundToInteger;
  const int index = static_cast<int>(static_cast<std::uint32_t>(bits_of(shifted)));
  const double r = (x - n * kStep1) + (x_low - n * kStep2);
  const Sum& entry = kExps[index & 127];
  const double r2 = r * r;
  // minimax on |r| <= ln2/256: error 2^-63
  const double p = r + r2 * (0.5 + (r * 0x1.5555555555307p-3 + r2 * (0x1.55555a1861779p-5 + r * 0x1.11111bf2f342ap-7)));
  return {entry.hi, entry.lo + entry.hi * p, index >> 7};
}

/// (hi + lo) * 2^exponent where that is subnormal or overflows, rounded once.
double scale_slowly(const ScaledSum& s);

inline double scaled(const ScaledSum& s) {
  if (s.exponent < -1020 || s.exponent > 1022) return scale_slowly(s);
  return (s.hi + s.lo) * power_of_two(s.exponent);
}

}  // namespace limber::fixed::detail
