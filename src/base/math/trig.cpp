// Sine, cosine and tangent, table-driven (Tang 1991): x = k pi/64 + r, a table with S and C, the sine and cosine of
// k pi/64, and polynomials for sin r and cos r - 1. In the sum S + (C r + S (cos r - 1) + C (sin r - r)), the leading
// product C r is exact: the table has C with 27 bits, and r is split in halves.
#include "base/math/double_double.h"
#include "base/math/fixed_math.h"
#include "base/math/trig_table.h"

namespace limber::fixed {

namespace {

using detail::bits_of;
using detail::fast_sum;
using detail::kNaN;
using detail::magnitude;
using detail::product;
using detail::SineEntry;
using detail::Sum;
using detail::upper_half;

__extension__ typedef unsigned __int128 Wide;

// The angle index * pi/64 + hi + lo.
struct ReducedAngle {
  unsigned index;
  double hi, lo;
};

// Minimax polynomials in z = r^2 for sin r - r and cos r - 1 on |r| <= pi/128: the relative error of the sine is 2^-67,
// the absolute error of the cosine is 2^-63.
double sine_minus_angle(double r, double z) {
  return r * z * (-0x1.5555555555551p-3 + z * (0x1.111111106b45fp-7 + z * -0x1.a0183ed7de51fp-13));
}
double cosine_minus_one(double z) { return z * (-0.5 + z * (0x1.555555549db93p-5 + z * -0x1.6c153094094dap-10)); }

// Copies 256 bits of 1/(2 pi), beginning at this bit of the table, the most significant word first.
void inverse_turn_window(int begin, std::uint64_t (&window)[4]) {
  const int first = begin >> 6;
  const int shift = begin & 63;
  for (int i = 0; i < 4; i++) {
    const std::uint64_t high = detail::kInverseTurn[first + i];
    const std::uint64_t low = detail::kInverseTurn[first + i + 1];
    window[i] = shift == 0 ? high : (high << shift) | (low >> (64 - shift));
  }
}

// Converts a fixed-point fraction of a turn, of which it uses the first 106 significant bits, to radians.
Sum radians_of(const std::uint64_t (&fraction)[4]) {
  int first = 0;
  while (first < 2 && fraction[first] == 0) first++;
  if (fraction[first] == 0) return {0, 0};
  const int shift = std::countl_zero(fraction[first]);
  const std::uint64_t third = first < 2 ? fraction[first + 2] : 0;
  Wide top = (Wide{fraction[first]} << 64 | fraction[first + 1]) << shift;
  if (shift != 0) top |= third >> (64 - shift);
  // the 106 leading bits as an integer: 2^53 * hi + lo
  const double hi = static_cast<double>(static_cast<std::uint64_t>(top >> 75));
  const double lo = static_cast<double>(static_cast<std::uint64_t>(top >> 22) & ((std::uint64_t{1} << 53) - 1));
  const double scale = detail::power_of_two(-53 - shift - 64 * first);
  const Sum turn{hi * scale, lo * scale * 0x1p-53};
  constexpr double kTwoPi = 0x1.921fb54442d18p+2;
  constexpr double kTwoPiLow = 0x1.1a62633145c07p-52;
  const Sum main = product(turn.hi, kTwoPi);
  return fast_sum(main.hi, main.lo + (turn.hi * kTwoPiLow + turn.lo * kTwoPi));
}

// Reduces any |x| >= 2^-6 (Payne, Hanek 1983): computes 256 bits of the fraction of x / (2 pi); the integer part is
// irrelevant. The absolute error of 2^-200 is small also for the doubles nearest to a multiple of pi/64, at about
// 2^-66.
ReducedAngle reduce_large(double x) {
  const std::uint64_t bits = bits_of(x) & ~detail::kSignBit;
  const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
  const int exponent = static_cast<int>(bits >> 52) - 1075;
  std::uint64_t fraction[4];
  inverse_turn_window(exponent + 64, fraction);
  std::uint64_t carry = 0;
  for (int i = 3; i >= 0; i--) {
    const Wide part = Wide{fraction[i]} * mantissa + carry;
    fraction[i] = static_cast<std::uint64_t>(part);
    carry = static_cast<std::uint64_t>(part >> 64);
  }
  // rounds to the nearest multiple of 1/128 turn
  unsigned index = (static_cast<unsigned>(fraction[0] >> 56) + 1) / 2;
  fraction[0] -= std::uint64_t{index} << 57;
  bool negative = (fraction[0] >> 63) != 0;
  if (negative) {
    for (int i = 3, borrow = 1; i >= 0; i--) {
      fraction[i] = ~fraction[i] + static_cast<std::uint64_t>(borrow);
      borrow = borrow != 0 && fraction[i] == 0 ? 1 : 0;
    }
  }
  const Sum r = radians_of(fraction);
  if (x < 0) {
    index = 0u - index;
    negative = !negative;
  }
  return {index & 127u, negative ? -r.hi : r.hi, negative ? -r.lo : r.lo};
}

// Reduces a finite x with |x| >= 2^-27 (Cody, Waite 1980).
inline ReducedAngle reduce(double x) {
  // pi/64 in three parts. Products of the first two with integers up to 2^22 are exact.
  constexpr double kStep1 = 0x1.921fb544p-5;
  constexpr double kStep2 = 0x1.0b4611a8p-39;
  constexpr double kStep3 = -0x1.d9cceba3f91f2p-71;
  constexpr double kPerStep = 0x1.45f306dc9c883p+4;
  const double size = magnitude(x);
  if (size > 0x1p17) return reduce_large(x);
  const double shifted = x * kPerStep + detail::kRoundToInteger;
  const double n = shifted - detail::kRoundToInteger;
  const double main = x - n * kStep1;
  const double second = n * kStep2;
  const double exact_hi = main - second;
  // Three parts do not suffice close to a multiple of pi/64.
  if (magnitude(exact_hi) < 0x1p-25 && size > 0x1p-6) return reduce_large(x);
  const double exact_lo = (main - exact_hi) - second;
  const double third = n * kStep3;
  const double hi = exact_hi - third;
  return {static_cast<unsigned>(bits_of(shifted)) & 127u, hi, ((exact_hi - hi) - third) + exact_lo};
}

// Polynomials and halves of r, shared by sine and cosine.
struct AngleTerms {
  double sine, cosine, top, rest, full_sine;
  explicit AngleTerms(const ReducedAngle& a)
      : sine(sine_minus_angle(a.hi, a.hi * a.hi)),
        cosine(cosine_minus_one(a.hi * a.hi)),
        top(upper_half(a.hi)),
        rest((a.hi - top) + a.lo),
        full_sine(a.hi + sine) {}
};

// Returns the sine of the entry's angle + r with a relative error of 2^-61.
inline Sum sine_sum(const SineEntry& e, const AngleTerms& t) {
  const Sum main = fast_sum(e.sine, e.cosine * t.top);
  return {main.hi,
          main.lo + ((e.sine_low + e.cosine_low * t.full_sine + e.sine * t.cosine) + e.cosine * (t.sine + t.rest))};
}

inline const SineEntry& sine_entry(const ReducedAngle& a) { return detail::kSines[a.index]; }
inline const SineEntry& cosine_entry(const ReducedAngle& a) { return detail::kSines[(a.index + 32) & 127u]; }

// True for |x| in [2^-27, infinity).
inline bool is_common(double x) {
  return bits_of(magnitude(x)) - bits_of(0x1p-27) < detail::kInfinityBits - bits_of(0x1p-27);
}
inline bool is_tiny(double x) { return magnitude(x) < 0x1p-27; }

}  // namespace

double sin(double x) {
  if (!is_common(x)) return is_tiny(x) ? x : kNaN;
  const ReducedAngle a = reduce(x);
  const Sum s = sine_sum(sine_entry(a), AngleTerms(a));
  return s.hi + s.lo;
}

double cos(double x) {
  if (!is_common(x)) return is_tiny(x) ? 1 : kNaN;
  const ReducedAngle a = reduce(x);
  const Sum c = sine_sum(cosine_entry(a), AngleTerms(a));
  return c.hi + c.lo;
}

SinCos sincos(double x) {
  if (!is_common(x)) return is_tiny(x) ? SinCos{x, 1} : SinCos{kNaN, kNaN};
  const ReducedAngle a = reduce(x);
  const AngleTerms terms(a);
  const Sum s = sine_sum(sine_entry(a), terms);
  const Sum c = sine_sum(cosine_entry(a), terms);
  return {s.hi + s.lo, c.hi + c.lo};
}

double tan(double x) {
  if (!is_common(x)) return is_tiny(x) ? x : kNaN;
  const ReducedAngle a = reduce(x);
  const AngleTerms terms(a);
  const Sum s_raw = sine_sum(sine_entry(a), terms);
  const Sum c_raw = sine_sum(cosine_entry(a), terms);
  const Sum s = fast_sum(s_raw.hi, s_raw.lo);
  const Sum c = fast_sum(c_raw.hi, c_raw.lo);
  // The remainder of the division corrects the quotient.
  const double inverse = 1 / c.hi;
  const double q = s.hi * inverse;
  const Sum back = product(q, c.hi);
  const double remainder = ((s.hi - back.hi) - back.lo) + (s.lo - q * c.lo);
  return q + remainder * inverse;
}

}  // namespace limber::fixed
