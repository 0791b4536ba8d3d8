// In lanes of two and of four.
#include "sim/dense.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace limber {
namespace {

using dense::load_pair;
using dense::Pair;

// What is left of each line where lanes end.
void subtract_rest_in_turn(double* y, const double* lines, int stride, std::span<const double> scales, int first,
                           int count) {
  for (int i = first; i < count; ++i) {
    const double* number = lines + i;
    double sum = y[i];
    for (const double scale : scales) {
      sum -= *number * scale;
      number += stride;
    }
    y[i] = sum;
  }
}

void subtract_lines_by_two(double* y, std::span<const ScaledLine> lines, int count) {
  std::size_t k = 0;
  for (; k + 3 < lines.size(); k += 4) {
    const Pair s0 = {lines[k].scale, lines[k].scale};
    const Pair s1 = {lines[k + 1].scale, lines[k + 1].scale};
    const Pair s2 = {lines[k + 2].scale, lines[k + 2].scale};
    const Pair s3 = {lines[k + 3].scale, lines[k + 3].scale};
    for (int i = 0; i < count; i += 2) {
      const Pair first = load_pair(lines[k].numbers + i) * s0 + load_pair(lines[k + 1].numbers + i) * s1;
      const Pair second = load_pair(lines[k + 2].numbers + i) * s2 + load_pair(lines[k + 3].numbers + i) * s3;
      const Pair changed = load_pair(y + i) - (first + second);
      std::memcpy(y + i, &changed, sizeof changed);
    }
  }
  for (; k < lines.size(); ++k) dense::subtract_by_two(y, lines[k].numbers, lines[k].scale, count);
}

void subtract_in_turn_by_two(double* y, const double* lines, int stride, std::span<const double> scales, int count) {
  int i = 0;
  for (; i + 7 < count; i += 8) {
    Pair y0 = load_pair(y + i);
    Pair y1 = load_pair(y + i + 2);
    Pair y2 = load_pair(y + i + 4);
    Pair y3 = load_pair(y + i + 6);
    const double* line = lines + i;
    for (const double number : scales) {
      const Pair scale = {number, number};
      y0 -= load_pair(line) * scale;
      y1 -= load_pair(line + 2) * scale;
      y2 -= load_pair(line + 4) * scale;
      y3 -= load_pair(line + 6) * scale;
      line += stride;
    }
    std::memcpy(y + i, &y0, sizeof y0);
    std::memcpy(y + i + 2, &y1, sizeof y1);
    std::memcpy(y + i + 4, &y2, sizeof y2);
    std::memcpy(y + i + 6, &y3, sizeof y3);
  }
  subtract_rest_in_turn(y, lines, stride, scales, i, count);
}

#if defined(__x86_64__)

// each has its own loop: only functions for the same processor are put into one another

[[gnu::target("avx2")]] void subtract_by_four(double* y, const double* a, double x, int count) {
  const __m256d scale = _mm256_set1_pd(x);
  int i = 0;
  for (; i + 3 < count; i += 4) {
    _mm256_storeu_pd(y + i, _mm256_sub_pd(_mm256_loadu_pd(y + i), _mm256_mul_pd(_mm256_loadu_pd(a + i), scale)));
  }
  for (; i < count; ++i) y[i] -= a[i] * x;
}

[[gnu::target("avx2")]] void subtract_lines_by_four(double* y, std::span<const ScaledLine> lines, int count) {
  std::size_t k = 0;
  for (; k + 3 < lines.size(); k += 4) {
    const ScaledLine &a = lines[k], &b = lines[k + 1], &c = lines[k + 2], &d = lines[k + 3];
    const __m256d sa = _mm256_set1_pd(a.scale), sb = _mm256_set1_pd(b.scale);
    const __m256d sc = _mm256_set1_pd(c.scale), sd = _mm256_set1_pd(d.scale);
    int i = 0;
    for (; i + 3 < count; i += 4) {
      const __m256d first = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(a.numbers + i), sa),
                                          _mm256_mul_pd(_mm256_loadu_pd(b.numbers + i), sb));
      const __m256d second = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(c.numbers + i), sc),
                                           _mm256_mul_pd(_mm256_loadu_pd(d.numbers + i), sd));
      _mm256_storeu_pd(y + i, _mm256_sub_pd(_mm256_loadu_pd(y + i), _mm256_add_pd(first, second)));
    }
    for (; i < count; ++i) {
      y[i] -= (a.numbers[i] * a.scale + b.numbers[i] * b.scale) + (c.numbers[i] * c.scale + d.numbers[i] * d.scale);
    }
  }
  for (; k < lines.size(); ++k) subtract_by_four(y, lines[k].numbers, lines[k].scale, count);
}

[[gnu::target("avx2")]] void subtract_in_turn_by_four(double* y, const double* lines, int stride,
                                                      std::span<const double> scales, int count) {
  int i = 0;
  for (; i + 15 < count; i += 16) {
    __m256d y0 = _mm256_loadu_pd(y + i), y1 = _mm256_loadu_pd(y + i + 4);
    __m256d y2 = _mm256_loadu_pd(y + i + 8), y3 = _mm256_loadu_pd(y + i + 12);
    const double* line = lines + i;
    for (const double number : scales) {
      const __m256d scale = _mm256_set1_pd(number);
      y0 = _mm256_sub_pd(y0, _mm256_mul_pd(_mm256_loadu_pd(line), scale));
      y1 = _mm256_sub_pd(y1, _mm256_mul_pd(_mm256_loadu_pd(line + 4), scale));
      y2 = _mm256_sub_pd(y2, _mm256_mul_pd(_mm256_loadu_pd(line + 8), scale));
      y3 = _mm256_sub_pd(y3, _mm256_mul_pd(_mm256_loadu_pd(line + 12), scale));
      line += stride;
    }
    _mm256_storeu_pd(y + i, y0);
    _mm256_storeu_pd(y + i + 4, y1);
    _mm256_storeu_pd(y + i + 8, y2);
    _mm256_storeu_pd(y + i + 12, y3);
  }
  for (; i + 3 < count; i += 4) {
    __m256d sum = _mm256_loadu_pd(y + i);
    const double* line = lines + i;
    for (const double number : scales) {
      sum = _mm256_sub_pd(sum, _mm256_mul_pd(_mm256_loadu_pd(line), _mm256_set1_pd(number)));
      line += stride;
    }
    _mm256_storeu_pd(y + i, sum);
  }
  subtract_rest_in_turn(y, lines, stride, scales, i, count);
}

[[gnu::target("avx2")]] double product_by_four(const double* a, const double* b, int count) {
  __m256d sums = _mm256_setzero_pd();
  int i = 0;
  for (; i + 3 < count; i += 4) {
    sums = _mm256_add_pd(sums, _mm256_mul_pd(_mm256_loadu_pd(a + i), _mm256_loadu_pd(b + i)));
  }
  const __m128d halves = _mm_add_pd(_mm256_castpd256_pd128(sums), _mm256_extractf128_pd(sums, 1));
  double sum = _mm_cvtsd_f64(halves) + _mm_cvtsd_f64(_mm_unpackhi_pd(halves, halves));
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

#endif

}  // namespace

const DenseKernels& DenseKernels::by_two() {
  static constexpr DenseKernels kByTwo{dense::subtract_by_two, subtract_lines_by_two, subtract_in_turn_by_two,
                                       dense::product_by_two};
  return kByTwo;
}

const DenseKernels& DenseKernels::widest() {
#if defined(__x86_64__)
  static constexpr DenseKernels kByFour{subtract_by_four, subtract_lines_by_four, subtract_in_turn_by_four,
                                        product_by_four};
  if (__builtin_cpu_supports("avx2")) return kByFour;
#endif
  return by_two();
}

const DenseKernels& dense::kernels = DenseKernels::widest();

}  // namespace limber
