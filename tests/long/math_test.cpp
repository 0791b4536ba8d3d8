// Long tests of the fixed math functions against MPFR: ten million arguments of each function, and all floats.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>

#include "base/fixed_math_reference.h"

namespace limber::base_test {
namespace {

unsigned thread_count() { return std::max(1u, std::thread::hardware_concurrency()); }

class LongMath : public testing::TestWithParam<MathFunction> {};

INSTANTIATE_TEST_SUITE_P(LongMath, LongMath, testing::ValuesIn(math_functions()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(LongMath, ErrorsOfTenMillionAreBelowTheBound) {
  const MathFunction& f = GetParam();
  const unsigned parts = thread_count();
  std::vector<WorstCase> worst(parts);
  std::vector<std::thread> threads;
  for (unsigned part = 0; part < parts; part++) {
    threads.emplace_back([&, part] {
      worst[part] = worst_case(f, 100 + part, static_cast<int>(10'000'000 / parts));
      mpfr_free_cache();
    });
  }
  for (std::thread& thread : threads) thread.join();
  const WorstCase all =
      *std::max_element(worst.begin(), worst.end(), [](const auto& a, const auto& b) { return a.ulps < b.ulps; });
  std::printf("%s: %.5f ulp at %a, %a\n", f.name, all.ulps, all.x, all.y);
  EXPECT_LE(all.ulps, f.max_ulps) << std::hexfloat << all.x << ", " << all.y;
}

// A function in single and double precision, the C library's double function, and MPFR's.
struct FloatFunction {
  const char* name;
  float (*single)(float);
  double (*other)(double);
  ExactUnary exact;
};

std::ostream& operator<<(std::ostream& out, const FloatFunction& f) { return out << f.name; }

const auto kFloatFunctions = std::to_array<FloatFunction>({
    {"sinf", fixed::sinf, std::sin, mpfr_sin},
    {"cosf", fixed::cosf, std::cos, mpfr_cos},
    {"tanf", fixed::tanf, std::tan, mpfr_tan},
    {"asinf", fixed::asinf, std::asin, mpfr_asin},
    {"acosf", fixed::acosf, std::acos, mpfr_acos},
    {"atanf", fixed::atanf, std::atan, mpfr_atan},
    {"expf", fixed::expf, std::exp, mpfr_exp},
    {"exp2f", fixed::exp2f, std::exp2, mpfr_exp2},
    {"logf", fixed::logf, std::log, mpfr_log},
    {"log2f", fixed::log2f, std::log2, mpfr_log2},
    {"log10f", fixed::log10f, std::log10, mpfr_log10},
    {"sinhf", fixed::sinhf, std::sinh, mpfr_sinh},
    {"coshf", fixed::coshf, std::cosh, mpfr_cosh},
    {"tanhf", fixed::tanhf, std::tanh, mpfr_tanh},
    {"cbrtf", fixed::cbrtf, std::cbrt, mpfr_cbrt},
});

// Numbers of results that are adjacent to the correctly rounded float, and of results that are further off.
struct FloatErrors {
  std::atomic<std::uint64_t> misrounded{0}, wrong{0}, first_wrong{0};
};

void compare_with_exact(const FloatFunction& f, float x, float result, FloatErrors& errors) {
  Exact argument, out;
  mpfr_set_flt(argument.get(), x, MPFR_RNDN);
  f.exact(out.get(), argument.get(), MPFR_RNDN);
  const float nearest = mpfr_get_flt(out.get(), MPFR_RNDN);
  if (result == nearest || (result != result && nearest != nearest)) return;
  if (result == std::nextafter(nearest, INFINITY) || result == std::nextafter(nearest, -INFINITY)) {
    errors.misrounded++;
    return;
  }
  errors.first_wrong = std::bit_cast<std::uint32_t>(x);
  errors.wrong++;
}

// Compares with the C library's double result, which has an error below 2^-51, if all doubles that close round to the
// same float; otherwise with MPFR, which is a hundred times slower.
void compare_floats(const FloatFunction& f, std::uint64_t begin, std::uint64_t end, FloatErrors& errors) {
  for (std::uint64_t i = begin; i < end; i++) {
    const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(i));
    const float result = f.single(x);
    const double other = f.other(double{x});
    if (static_cast<float>(other * (1 - 0x1p-51)) == result && static_cast<float>(other * (1 + 0x1p-51)) == result)
      continue;
    if (other != other && result != result) continue;
    compare_with_exact(f, x, result, errors);
  }
  mpfr_free_cache();
}

class LongMathFloats : public testing::TestWithParam<FloatFunction> {};

INSTANTIATE_TEST_SUITE_P(LongMath, LongMathFloats, testing::ValuesIn(kFloatFunctions),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(LongMathFloats, AlmostAllAreRoundedCorrectly) {
  const FloatFunction& f = GetParam();
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
  const std::uint64_t parts = thread_count();
  FloatErrors errors;
  std::vector<std::thread> threads;
  for (std::uint64_t part = 0; part < parts; part++) {
    threads.emplace_back([&, part] {
      compare_floats(f, kAll / parts * part, part + 1 < parts ? kAll / parts * (part + 1) : kAll, errors);
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::printf("%s: %llu of 2^32 results are not correctly rounded\n", f.name,
              static_cast<unsigned long long>(errors.misrounded));
  EXPECT_EQ(errors.wrong, 0u) << "first at bits " << errors.first_wrong;
  EXPECT_LE(errors.misrounded, 10u);
}

}  // namespace
}  // namespace limber::base_test
