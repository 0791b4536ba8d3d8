// Logarithms and powers, table-driven (Tang 1990): x = 2^e z with z in [0.6875, 1.375), a table of c near 1 / z and of
// log c, and a polynomial for log(1 + r), r = c z - 1. c has 11 bits, so that r is exact as a sum of two doubles.
// Around x = 1, c is 1 and e is 0, so that results near 0 have a small relative error.
#include "base/math/double_double.h"
#include "base/math/exp.h"
#include "base/math/fixed_math.h"

namespace limber::fixed {

namespace {

using detail::bits_of;
using detail::fast_sum;
using detail::from_bits;
using detail::kInfinity;
using detail::kInfinityBits;
using detail::kNaN;
using detail::kSignBit;
using detail::LogEntry;
using detail::magnitude;
using detail::Sum;
using detail::upper_half;

constexpr std::uint64_t kMinNormalBits = std::uint64_t{1} << 52;

// The parts of log x = e ln2 + log of the entry + log(1 + r + r_low). e * kLn2, log_high of the entry and r are
// multiples of 2^-42 below 2^10, so that their sums are exact.
struct LogTerms {
  const LogEntry& entry;
  double e, r, r_low;
};
constexpr double kLn2 = 0x1.62e42fefa38p-1;
constexpr double kLn2Low = 0x1.ef35793c7673p-45;

// Takes the bits of a positive normal number. For a subnormal one: the bits of 2^52 times the number, minus 52 << 52.
inline LogTerms log_terms(std::uint64_t bits) {
  constexpr std::uint64_t kBegin = 0x3fe6000000000000;  // 0.6875
  const std::uint64_t offset = bits - kBegin;
  const LogEntry& entry = detail::kLogs[(offset >> 45) & 127];
  const std::uint64_t z_bits = bits - (offset & (std::uint64_t{0xfff} << 52));
  const double z_top = from_bits(z_bits & ~((std::uint64_t{1} << 21) - 1));
  const double z_rest = from_bits(z_bits) - z_top;
  return {entry, static_cast<double>(static_cast<std::int64_t>(offset) >> 52), z_top * entry.inverse - 1,
          z_rest * entry.inverse};
}

// Returns log(1 + r) - r by a minimax polynomial on [-0.0042, 0.0078]; the relative error of the logarithm is 2^-67.
inline double log_series(double r) {
  const double r2 = r * r;
  const double p = (0x1.5555555555551p-2 + r * -0x1.fffffffffdd7dp-3) +
                   r2 * ((0x1.9999999b7d53dp-3 + r * -0x1.55555a51549bep-3) +
                         r2 * (0x1.24920525ef1f4p-3 + r * -0x1.fa6e1bbeb9cb3p-4));
  return r2 * (-0.5 + r * p);
}

// Returns log x with a relative error of 2^-67, as pow() needs it. |lo| is below 2^-15 |hi|.
inline Sum log_sum(const LogTerms& t) {
  const double r = t.r + t.r_low;
  const double top = upper_half(r);
  const double rest = (t.r - top) + t.r_low;
  const double r2 = r * r;
  // r^3 p is log(1 + r) - r + r^2 / 2, a minimax polynomial on the same interval; relative error of the logarithm 2^-73
  const double p = (0x1.5555555555555p-2 + r * -0x1.ffffffffffe5fp-3) +
                   r2 * ((0x1.99999999b3c89p-3 + r * -0x1.5555558d96366p-3) +
                         r2 * ((0x1.249247335a9a9p-3 + r * -0x1.ffc4f1782502ap-4) + r2 * 0x1.b0d98d4474b3ap-4));
  const Sum linear = fast_sum((t.e * kLn2 + t.entry.log_high) + t.r, t.r_low);
  // The upper part of -r^2 / 2 is exact.
  const Sum main = fast_sum(linear.hi, -0.5 * (top * top));
  const double low = (t.e * kLn2Low + t.entry.log_low) + r2 * (r * p);
  return {main.hi, main.lo + (linear.lo + (low - 0.5 * (rest * (top + r))))};
}

// Sets `bits` for log_terms() and returns true, or returns false and sets `result` if the logarithm is not finite.
inline bool has_finite_log(double x, std::uint64_t& bits, double& result) {
  bits = bits_of(x);
  if (bits - kMinNormalBits < kInfinityBits - kMinNormalBits) return true;
  if (magnitude(x) == 0) {
    result = -kInfinity;
  } else if (x != x || x < 0) {
    result = kNaN;
  } else if (x == kInfinity) {
    result = kInfinity;
  } else {
    bits = bits_of(x * 0x1p52) - (std::uint64_t{52} << 52);
    return true;
  }
  return false;
}

// Returns e * unit + log z * factor, unit being the logarithm of 2 and factor 1 / log(base). unit.hi has 42 bits and
// factor.hi has 27, so that their products are exact.
inline double log_of_base(const LogTerms& t, const Sum& unit, const Sum& factor) {
  const Sum z = fast_sum(t.entry.log_high + t.r, t.r_low);
  const double top = upper_half(z.hi);
  const double low = z.lo + (t.entry.log_low + log_series(t.r + t.r_low));
  const Sum main = fast_sum(t.e * unit.hi, top * factor.hi);
  return main.hi + (main.lo + ((t.e * unit.lo + top * factor.lo) + ((z.hi - top) + low) * (factor.hi + factor.lo)));
}

enum class Parity { not_integer, even, odd };

Parity parity_of(double y) {
  const double size = magnitude(y);
  if (size >= 0x1p53) return Parity::even;
  if (size != std::floor(size)) return Parity::not_integer;
  return (static_cast<std::uint64_t>(size) & 1) != 0 ? Parity::odd : Parity::even;
}

// Returns the power of the number with these bits (see log_terms()), for |y| in [2^-65, 2^63).
inline double pow_common(std::uint64_t x_bits, double y) {
  const Sum l = log_sum(log_terms(x_bits));
  const double l_top = upper_half(l.hi);
  const double y_top = upper_half(y);
  const double exponent = l_top * y_top;
  const double low = ((l.hi - l_top) + l.lo) * y + l_top * (y - y_top);
  if (!(magnitude(exponent) < 746)) return exponent > 0 ? kInfinity : 0;
  return detail::scaled(detail::exp_sum(detail::exp_terms(exponent, low, exponent + low)));
}

// The power if it is too large or too small for a number: infinity or 0.
double infinite_power(double x_size, double y) { return (x_size > 1) == (y > 0) ? kInfinity : 0; }

// The bits of a positive number; a subnormal one gets a negative exponent instead.
std::uint64_t normalized_bits(double x_size) {
  const std::uint64_t bits = bits_of(x_size);
  return bits < kMinNormalBits ? bits_of(x_size * 0x1p52) - (std::uint64_t{52} << 52) : bits;
}

double pow_of_negative_or_special(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return kNaN;
  const double x_size = magnitude(x);
  const double y_size = magnitude(y);
  if (y_size == kInfinity) return x_size == 1 ? 1 : infinite_power(x_size, y);
  const bool negative = (bits_of(x) & kSignBit) != 0;
  const Parity parity = negative ? parity_of(y) : Parity::even;
  const double sign = parity == Parity::odd ? -1 : 1;
  if (x_size == 0 || x_size == kInfinity) return sign * infinite_power(x_size, y);
  if (parity == Parity::not_integer) return kNaN;
  if (x_size == 1 || y_size < 0x1p-65) return sign;
  if (y_size >= 0x1p63) return sign * infinite_power(x_size, y);
  return sign * pow_common(normalized_bits(x_size), y);
}

}  // namespace

double log(double x) {
  std::uint64_t bits = 0;
  double result = 0;
  if (!has_finite_log(x, bits, result)) return result;
  const LogTerms t = log_terms(bits);
  const double low = (t.e * kLn2Low + t.entry.log_low) + log_series(t.r + t.r_low);
  const Sum linear = fast_sum((t.e * kLn2 + t.entry.log_high) + t.r, t.r_low);
  return linear.hi + (linear.lo + low);
}

double log2(double x) {
  std::uint64_t bits = 0;
  double result = 0;
  if (!has_finite_log(x, bits, result)) return result;
  return log_of_base(log_terms(bits), {1, 0}, {0x1.7154764p+0, 0x1.2b82fe1777d1p-28});
}

double log10(double x) {
  std::uint64_t bits = 0;
  double result = 0;
  if (!has_finite_log(x, bits, result)) return result;
  return log_of_base(log_terms(bits), {0x1.34413509f8p-2, -0x1.80433b83b532ap-44},
                     {0x1.bcb7b14p-2, 0x1.26e50e32a6ab7p-30});
}

double pow(double x, double y) {
  const std::uint64_t x_bits = bits_of(x);
  const std::uint64_t y_bits = bits_of(magnitude(y));
  if (x_bits - kMinNormalBits < kInfinityBits - kMinNormalBits &&
      y_bits - bits_of(0x1p-65) < bits_of(0x1p63) - bits_of(0x1p-65)) {
    return pow_common(x_bits, y);
  }
  return pow_of_negative_or_special(x, y);
}

}  // namespace limber::fixed
