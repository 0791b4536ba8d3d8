// Double-double arithmetic and access to bits, for the files fixed_math*.cpp only.
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
/// Added to |x| < 2^51 and subtracted again, it rounds x to an integer; in between, the low bits are that integer.
inline constexpr double kRoundToInteger = 0x1.8p52;

inline std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
inline double from_bits(std::uint64_t bits) { return std::bit_cast<double>(bits); }
inline double magnitude(double x) { return from_bits(bits_of(x) & ~kSignBit); }
/// |x| with the sign of `from`, for x >= 0.
inline double with_sign(double x, double from) { return from_bits(bits_of(x) | (bits_of(from) & kSignBit)); }
/// 2^exponent, of a normal number.
inline double power_of_two(int exponent) { return from_bits(static_cast<std::uint64_t>(exponent + 1023) << 52); }

/// The first 26 significant bits of x. Products of two of these, and with the 27 bits that are left, are exact.
inline double upper_half(double x) { return from_bits(bits_of(x) & ~((std::uint64_t{1} << 27) - 1)); }

/// hi + lo, unevaluated.
struct Sum {
  double hi, lo;
};

/// a + b without an error, if |a| >= |b| or a is 0 (Dekker 1971).
inline Sum fast_sum(double a, double b) {
  const double hi = a + b;
  return {hi, (a - hi) + b};
}

/// a * b with a relative error of 2^-106 (Dekker 1971, with factors split by truncation).
inline Sum product(double a, double b) {
  const double hi = a * b;
  const double ah = upper_half(a);
  const double al = a - ah;
  const double bh = upper_half(b);
  const double bl = b - bh;
  return {hi, ((ah * bh - hi) + ah * bl + al * bh) + al * bl};
}

}  // namespace limber::fixed::detail
