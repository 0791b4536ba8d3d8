// Double-double arithmetic and access to the bits of doubles. Included in this folder only.
//
// The polynomials in these files are minimax approximations from the Remez algorithm in 400-bit arithmetic. Their
// coefficients were rounded to doubles one by one, the lowest first, and the remaining ones fitted again each time.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#ifdef __FAST_MATH__
#error "fixed_math.h needs the arithmetic of IEEE 754: compile without -ffast-math."
#endif

namespace limber::fixed::detail {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr std::uint64_t kSignBit = std::uint64_t{1} << 63;
inline constexpr std::uint64_t kInfinityBits = std::uint64_t{0x7ff} << 52;
/// Rounds |x| < 2^51 to an integer when it is added and subtracted again. The low bits of the sum are the integer.
inline constexpr double kRoundToInteger = 0x1.8p52;

inline std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
inline double from_bits(std::uint64_t bits) { return std::bit_cast<double>(bits); }
inline double magnitude(double x) { return from_bits(bits_of(x) & ~kSignBit); }
/// Returns x >= 0 with the sign of `from`.
inline double with_sign(double x, double from) { return from_bits(bits_of(x) | (bits_of(from) & kSignBit)); }
/// Returns 2^exponent for an exponent in [-1022, 1023].
inline double power_of_two(int exponent) { return from_bits(static_cast<std::uint64_t>(exponent + 1023) << 52); }

/// Returns the first 26 significant bits of x; the other 27 are x - upper_half(x). Products of two upper halves, or of
/// an upper half and a number of 27 bits, are exact.
inline double upper_half(double x) { return from_bits(bits_of(x) & ~((std::uint64_t{1} << 27) - 1)); }

/// The unevaluated sum hi + lo.
struct Sum {
  double hi, lo;
};

/// Returns a + b exactly if |a| >= |b| or a is 0 (Dekker 1971).
inline Sum fast_sum(double a, double b) {
  const double hi = a + b;
  return {hi, (a - hi) + b};
}

/// Returns a * b with a relative error of 2^-106 (Dekker 1971, the factors being split by truncation).
inline Sum product(double a, double b) {
  const double hi = a * b;
  const double ah = upper_half(a);
  const double al = a - ah;
  const double bh = upper_half(b);
  const double bl = b - bh;
  return {hi, ((ah * bh - hi) + ah * bl + al * bh) + al * bl};
}

}  // namespace limber::fixed::detail
