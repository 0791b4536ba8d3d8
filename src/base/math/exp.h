// The exponential function in double-double, for exp(), pow() and the hyperbolic functions. Included in this
// folder only.
#pragma once

#include "base/math/double_double.h"
#include "base/math/exp_table.h"

namespace limber::fixed::detail {

/// (hi + lo) * 2^exponent; hi is in [0.99, 2), lo below 2^-8 hi.
struct ScaledSum {
  double hi, lo;
  int exponent;
};

/// The parts of x = index ln2/128 + r, |r| <= 1.01 ln2/256.
struct ExpTerms {
  int index;
  double r;
};

/// Reduces x + x_low, which is sum when rounded, for |x| < 1000 and |x_low| < 0.02 (Cody, Waite 1980).
inline ExpTerms exp_terms(double x, double x_low, double sum) {
  // ln2/128 in two parts. Products of the first with integers up to 2^19 are exact.
  constexpr double kStep1 = 0x1.62e42fef8p-8;
  constexpr double kStep2 = 0x1.1cf79abc9e3b4p-43;
  constexpr double kPerStep = 0x1.71547652b82fep+7;
  const double shifted = sum * kPerStep + kRoundToInteger;
  const double n = shifted - kRoundToInteger;
  return {static_cast<int>(static_cast<std::uint32_t>(bits_of(shifted))), (x - n * kStep1) + (x_low - n * kStep2)};
}

/// Odd and even part of e^r - 1, by a minimax polynomial on |r| <= 1.01 ln2/256 with an error of 2^-63.
struct ExpSeries {
  double odd, even;
  explicit ExpSeries(double r) {
    const double r2 = r * r;
    odd = r + (r * r2) * (0x1.55555555552f5p-3 + r2 * 0x1.11111c178549dp-7);
    even = r2 * (0.5 + r2 * 0x1.55555a2e6677bp-5);
  }
};

/// Returns 2^(index/128) (1 + growth).
inline ScaledSum exp_entry(int index, double growth) {
  const Sum& entry = kExps[index & 127];
  return {entry.hi, entry.lo + entry.hi * growth, index >> 7};
}

/// Returns e raised to the number of these terms, by a table of 2^(k/128) and a polynomial (Tang 1989). The relative
/// error is 2^-61.
inline ScaledSum exp_sum(const ExpTerms& t) {
  const ExpSeries series(t.r);
  return exp_entry(t.index, series.odd + series.even);
}

/// Returns (hi + lo) * 2^exponent, rounded once also if the result is subnormal or overflows.
double scaled_at_limits(const ScaledSum& s);

inline double scaled(const ScaledSum& s) {
  if (s.exponent < -1020 || s.exponent > 1022) return scaled_at_limits(s);
  return (s.hi + s.lo) * power_of_two(s.exponent);
}

}  // namespace limber::fixed::detail
