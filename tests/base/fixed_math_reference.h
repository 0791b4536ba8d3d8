// Reference for fixed_math.h: a list of the functions and their MPFR counterparts, generated arguments, and errors in
// ulps.
#pragma once

#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <vector>

#include "base/hash.h"
#include "base/math/fixed_math.h"
#include "base/random.h"

namespace limber::base_test {

/// An MPFR number with 120 bits.
class Exact {
 public:
  Exact() { mpfr_init2(value_, 120); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(value_); }

  mpfr_ptr get() { return value_; }

  /// Returns the distance to a double, in ulps of the doubles at this value; 0 if both are NaN or the same infinity or
  /// zero. Overwrites the value.
  double ulps_from(double result) {
    if (mpfr_nan_p(value_)) return result != result ? 0 : kFar;
    if (result != result) return kFar;
    if (mpfr_inf_p(value_)) return result == mpfr_get_d(value_, MPFR_RNDN) ? 0 : kFar;
    if (std::isinf(result)) return result == mpfr_get_d(value_, MPFR_RNDN) ? 0.5 : kFar;
    if (mpfr_zero_p(value_)) return result == 0 ? 0 : kFar;
    const auto exponent = std::max<long>(mpfr_get_exp(value_) - 53, -1074);
    mpfr_sub_d(value_, value_, result, MPFR_RNDN);
    mpfr_mul_2si(value_, value_, -exponent, MPFR_RNDN);
    return std::abs(mpfr_get_d(value_, MPFR_RNDN));
  }

  static constexpr double kFar = 1e9;

 private:
  mpfr_t value_;
};

using Unary = double (*)(double);
using Binary = double (*)(double, double);
using ExactUnary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using ExactBinary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

/// A function of one or two arguments, its error bound in ulps, and the range of half of the generated arguments.
struct MathFunction {
  const char* name;
  Unary unary;
  ExactUnary exact_unary;
  Binary binary;
  ExactBinary exact_binary;
  double max_ulps, low, high;
  std::uint64_t golden;  // hash_of_results()

  double call(double x, double y) const { return unary != nullptr ? unary(x) : binary(x, y); }
};

inline std::ostream& operator<<(std::ostream& out, const MathFunction& f) { return out << f.name; }

inline const std::vector<MathFunction>& math_functions() {
  static const std::vector<MathFunction> functions{
      {"sin", fixed::sin, mpfr_sin, nullptr, nullptr, 0.51, -30, 30, 0x93d5644ec531771d},
      {"cos", fixed::cos, mpfr_cos, nullptr, nullptr, 0.51, -30, 30, 0xd0351e648da9f765},
      {"tan", fixed::tan, mpfr_tan, nullptr, nullptr, 0.51, -30, 30, 0xadedb98175a2877e},
      {"asin", fixed::asin, mpfr_asin, nullptr, nullptr, 0.55, -1, 1, 0x29665afa790e9d9f},
      {"acos", fixed::acos, mpfr_acos, nullptr, nullptr, 0.55, -1, 1, 0x969ec2b016898252},
      {"atan", fixed::atan, mpfr_atan, nullptr, nullptr, 0.51, -8, 8, 0x260102935db3ac6a},
      {"exp", fixed::exp, mpfr_exp, nullptr, nullptr, 0.51, -30, 30, 0x409cfe28f6167b9f},
      {"exp2", fixed::exp2, mpfr_exp2, nullptr, nullptr, 0.51, -30, 30, 0x29504c4e7adc314a},
      {"log", fixed::log, mpfr_log, nullptr, nullptr, 0.51, 0, 8, 0x81dcb04e2e76a46c},
      {"log2", fixed::log2, mpfr_log2, nullptr, nullptr, 0.51, 0, 8, 0x362a40f343a8888e},
      {"log10", fixed::log10, mpfr_log10, nullptr, nullptr, 0.51, 0, 8, 0x373b52703d480642},
      {"sinh", fixed::sinh, mpfr_sinh, nullptr, nullptr, 0.55, -8, 8, 0x268e551530c4a6fc},
      {"cosh", fixed::cosh, mpfr_cosh, nullptr, nullptr, 0.51, -8, 8, 0x7ed121902149c4b6},
      {"tanh", fixed::tanh, mpfr_tanh, nullptr, nullptr, 0.52, -8, 8, 0xed64bfd42c005439},
      {"cbrt", fixed::cbrt, mpfr_cbrt, nullptr, nullptr, 0.51, -8, 8, 0xc85f9b9c73cce24d},
      {"atan2", nullptr, nullptr, fixed::atan2, mpfr_atan2, 0.51, -8, 8, 0x13d94e9893b860cf},
      {"pow", nullptr, nullptr, fixed::pow, mpfr_pow, 0.51, 0, 30, 0x9c46c502a1ca3fc2},
      {"hypot", nullptr, nullptr, fixed::hypot, mpfr_hypot, 0.51, -8, 8, 0x79a428e5217a17ca},
  };
  return functions;
}

/// Generates arguments in the common range, of all magnitudes, and next to special values.
class MathArguments {
 public:
  MathArguments(const MathFunction& function, std::uint64_t seed) : function_(function), random_(seed, function.name) {}

  double next() {
    const std::uint64_t kind = random_.next() & 15;
    if (kind < 8) return random_.uniform(function_.low, function_.high);
    if (kind < 11) return with_exponent(random_.next() % 120 + 963);  // 2^-60 .. 2^59
    if (kind == 11) return std::bit_cast<double>(random_.next());
    if (kind == 12) return next_to(special());
    // near a multiple of pi/4, a power of two, or 1
    if (kind == 13) {
      const std::uint64_t digits = random_.next() % 18 + 2;
      return next_to(static_cast<double>(random_.next() >> (64 - digits)) * 0.78539816339744831);
    }
    if (kind == 14) return next_to(with_exponent(random_.next() % 60 + 993, 0));
    const int distance = static_cast<int>(random_.next() % 50);
    const double close = 1 + std::ldexp(random_.uniform(-1, 1), -distance);
    return (random_.next() & 1) != 0 ? close : -close;
  }

 private:
  double with_exponent(std::uint64_t exponent, std::uint64_t mantissa_mask = ~std::uint64_t{0}) {
    const std::uint64_t bits = random_.next();
    return std::bit_cast<double>((bits & (std::uint64_t{1} << 63)) | exponent << 52 |
                                 (bits & mantissa_mask & ((std::uint64_t{1} << 52) - 1)));
  }
  double next_to(double x) { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) + random_.next() % 9 - 4); }
  double special() {
    // Thresholds between methods, and arguments with results that overflow or become subnormal.
    constexpr double kSpecial[] = {0.0625, 0.25,    0.3,     0.35,   0.5,     0.6875,   0.75,     1.375,     2,
                                   20,     22,      40,      708.4,  709.782, 710.475,  745.133,  1022,      1023.99,
                                   1074.5, 0x1p-27, 0x1p-54, 0x1p17, 0x1p500, 0x1p-500, 0x1p1023, 0x1p-1022, 0x1p-1070};
    const double x = kSpecial[random_.next() % std::size(kSpecial)];
    return (random_.next() & 1) != 0 ? x : -x;
  }

  const MathFunction& function_;
  Random random_;
};

/// Returns the error of a result in ulps. a, b and out are scratch values.
inline double ulps(const MathFunction& f, double x, double y, double result, Exact& a, Exact& b, Exact& out) {
  mpfr_set_d(a.get(), x, MPFR_RNDN);
  if (f.unary != nullptr) {
    f.exact_unary(out.get(), a.get(), MPFR_RNDN);
  } else {
    mpfr_set_d(b.get(), y, MPFR_RNDN);
    f.exact_binary(out.get(), a.get(), b.get(), MPFR_RNDN);
  }
  return out.ulps_from(result);
}

/// The largest error of many results and its arguments.
struct WorstCase {
  double ulps = 0, x = 0, y = 0;
};

inline WorstCase worst_case(const MathFunction& f, std::uint64_t seed, int count) {
  MathArguments arguments(f, seed);
  Exact a, b, out;
  WorstCase worst;
  for (int i = 0; i < count; i++) {
    const double x = arguments.next();
    const double y = f.unary != nullptr ? 0 : arguments.next();
    const double error = ulps(f, x, y, f.call(x, y), a, b, out);
    if (error > worst.ulps) worst = {error, x, y};
  }
  return worst;
}

/// Hashes the results of 20,000 arguments.
inline std::uint64_t hash_of_results(const MathFunction& f) {
  MathArguments arguments(f, 4);
  NumberHash hash(1);
  for (int i = 0; i < 20000; i++) {
    const double x = arguments.next();
    const double result = f.call(x, f.unary != nullptr ? 0 : arguments.next());
    hash.add({&result, 1});
  }
  return hash.value();
}

}  // namespace limber::base_test
