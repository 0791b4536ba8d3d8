// Sine, cosine and tangent: x = k pi/64 + r, a table of sines of k pi/64, and short polynomials for sin r and cos r - 1
// (Tang 1991, table-driven). The sum sin(k pi/64 + r) = S + (C r + S (cos r - 1) + C (sin r - r)) is formed so that the
// leading product C r is exact: C is in the table with 27 bits, and r is split in halves.
#include "base/fixed_math.h"
#include "base/fixed_math_sum.h"
#include "base/fixed_math_trig_table.h"

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

// An angle of index * pi/64 + hi + lo.
struct ReducedAngle {
  unsigned index;
  double hi, lo;
};

// Minimax polynomials on |r| <= pi/128, in z = r^2: relative error 2^-67 and absolute error 2^-63.
double sine_minus_angle(double r, double z) {
  return r * z * (-0x1.5555555555551p-3 + z * (0x1.111111106b45fp-7 + z * -0x1.a0183ed7de51fp-13));
}
double cosine_minus_one(double z) { return z * (-0.5 + z * (0x1.555555549db93p-5 + z * -0x1.6c153094094dap-10)); }

// 256 bits from this bit of 1/(2 pi) on, the most significant word first.
void inverse_turn_window(int begin, std::uint64_t (&window)[4]) {
  const int first = begin >> 6;
  const int shift = begin & 63;
  for (int i = 0; i < 4; i++) {
    const std::uint64_t high = detail::kInverseTurn[first + i];
    const std::uint64_t low = detail::kInverseTurn[first + i + 1];
    window[i] = shift == 0 ? high : (high << shift) | (low >> (64 - shift));
  }
}

// The first 106 significant bits of a fixed-point fraction of a turn, in radians.
Sum radians_of(const std::uint64_t (&fraction)[4]) {
  int first = 0;
  while (first < 2 && fraction[first] == 0) first++;
  if (fraction[first] == 0) return {0, 0};
  const int shift = std::countl_zero(fraction[first]);
  const std::uint64_t third = first < 2 ? fraction[first + 2] : 0;
  Wide top = (Wide{fraction[first]} << 64 | fraction[first + 1]) << shift;
  if (shift != 0) top |= third >> (64 - shift);
  // 2^53 * hi + lo is the integer of the 106 leading bits
  const double hi = static_cast<double>(static_cast<std::uint64_t>(top >> 75));
  const double lo = static_cast<double>(static_cast<std::uint64_t>(top >> 22) & ((std::uint64_t{1} << 53) - 1));
  const double scale = detail::power_of_two(-53 - shift - 64 * first);
  const Sum turn{hi * scale, lo * scale * 0x1p-53};
  constexpr double kTwoPi = 0x1.921fb54442d18p+2;
  constexpr double kTwoPiLow = 0x1.1a62633145c07p-52;
  const Sum main = product(turn.hi, kTwoPi);
  return fast_sum(main.hi, main.lo + (turn.hi * kTwoPiLow + turn.lo * kTwoPi));
}

// Exact reduction of any |x| >= 2^-6 (Payne, Hanek 1983): of x / (2 pi), only the bits that matter below the binary
// point are computed. What is left out is below 2^-200; no double comes nearer to a multiple of pi/64 than 2^-70.
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
  // to the nearest 1/128 of a turn
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

// Of a finite x with |x| >= 2^-27 (Cody, Waite 1980).
inline ReducedAngle reduce(double x) {
  // pi/64 in three parts; multiples of the first two by up to 2^22 are exact
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
  // close to a multiple of pi/64: three parts are too few
  if (magnitude(exact_hi) < 0x1p-25 && size > 0x1p-6) return reduce_large(x);
  const double exact_lo = (main - exact_hi) - second;
  const double third = n * kStep3;
  const double hi = exact_hi - third;
  return {static_cast<unsigned>(bits_of(shifted)) & 127u, hi, ((exact_hi - hi) - third) + exact_lo};
}

// The polynomials and halves of r, which the sine and the cosine share.
struct AngleTerms {
  double sine, cosine, top, rest, full_sine;
  explicit AngleTerms(const ReducedAngle& a)
      : sine(sine_minus_angle(a.hi, a.hi * a.hi)),
        cosine(cosine_minus_one(a.hi * a.hi)),
        top(upper_half(a.hi)),
        rest((a.hi - top) + a.lo),
        full_sine(a.hi + sine) {}
};

// The sine of an entry's angle + r, with a relative error of 2^-61.
inline Sum sine_sum(const SineEntry& e, const AngleTerms& t) {
  const Sum main = fast_sum(e.sine, e.cosine * t.top);
  return {main.hi,
          main.lo + ((e.sine_low + e.cosine_low * t.full_sine + e.sine * t.cosine) + e.cosine * (t.sine + t.rest))};
}

inline const SineEntry& sine_entry(const ReducedAngle& a) { return detail::kSines[a.index]; }
inline const SineEntry& cosine_entry(const ReducedAngle& a) { return detail::kSines[(a.index + 32) & 127u]; }

// |x| is in [2^-27, infinity)
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
  // the quotient, and once more what it leaves of the dividend
  const double inverse = 1 / c.hi;
  const double q = s.hi * inverse;
  const Sum back = product(q, c.hi);
  const double left = ((s.hi - back.hi) - back.lo) + (s.lo - q * c.lo);
  return q + left * inverse;
}

}  // namespace limber::fixed
