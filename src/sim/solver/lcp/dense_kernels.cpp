// Kernels for vectors of two (any processor) and four (AVX2) elements.
#include "sim/solver/lcp/dense_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace limber::sim::solver {
namespace {

using dense::Double2;
using dense::load2;

// Subtracts at the elements from `first` on, after the last full SIMD vector.
void subtract_sequence_tail(double* y, const double* vectors, int stride, std::span<const double> scales, int first,
                            int count) {
  for (int i = first; i < count; ++i) {
    const double* number = vectors + i;
    double sum = y[i];
    for (const double scale : scales) {
      sum -= *number * scale;
      number += stride;
    }
    y[i] = sum;
  }
}

void subtract_vectors_width_2(double* y, std::span<const ScaledVector> vectors, int count) {
  std::size_t k = 0;
  for (; k + 3 < vectors.size(); k += 4) {
    const Double2 s0 = {vectors[k].scale, vectors[k].scale};
    const Double2 s1 = {vectors[k + 1].scale, vectors[k + 1].scale};
    const Double2 s2 = {vectors[k + 2].scale, vectors[k + 2].scale};
    const Double2 s3 = {vectors[k + 3].scale, vectors[k + 3].scale};
    for (int i = 0; i < count; i += 2) {
      const Double2 first = load2(vectors[k].values + i) * s0 + load2(vectors[k + 1].values + i) * s1;
      const Double2 second = load2(vectors[k + 2].values + i) * s2 + load2(vectors[k + 3].values + i) * s3;
      const Double2 changed = load2(y + i) - (first + second);
      std::memcpy(y + i, &changed, sizeof changed);
    }
  }
  for (; k < vectors.size(); ++k) dense::subtract_scaled_width_2(y, vectors[k].values, vectors[k].scale, count);
}

void subtract_sequence_width_2(double* y, const double* vectors, int stride, std::span<const double> scales,
                               int count) {
  int i = 0;
  for (; i + 7 < count; i += 8) {
    Double2 y0 = load2(y + i);
    Double2 y1 = load2(y + i + 2);
    Double2 y2 = load2(y + i + 4);
    Double2 y3 = load2(y + i + 6);
    const double* line = vectors + i;
    for (const double number : scales) {
      const Double2 scale = {number, number};
      y0 -= load2(line) * scale;
      y1 -= load2(line + 2) * scale;
      y2 -= load2(line + 4) * scale;
      y3 -= load2(line + 6) * scale;
      line += stride;
    }
    std::memcpy(y + i, &y0, sizeof y0);
    std::memcpy(y + i + 2, &y1, sizeof y1);
    std::memcpy(y + i + 4, &y2, sizeof y2);
    std::memcpy(y + i + 6, &y3, sizeof y3);
  }
  subtract_sequence_tail(y, vectors, stride, scales, i, count);
}

#if defined(__x86_64__)

// These functions don't share code with those above: only functions of the same target can be inlined into each other.

[[gnu::target("avx2")]] void subtract_scaled_width_4(double* y, const double* a, double x, int count) {
  const __m256d scale = _mm256_set1_pd(x);
  int i = 0;
  for (; i + 3 < count; i += 4) {
    _mm256_storeu_pd(y + i, _mm256_sub_pd(_mm256_loadu_pd(y + i), _mm256_mul_pd(_mm256_loadu_pd(a + i), scale)));
  }
  for (; i < count; ++i) y[i] -= a[i] * x;
}

[[gnu::target("avx2")]] void subtract_vectors_width_4(double* y, std::span<const ScaledVector> vectors, int count) {
  std::size_t k = 0;
  for (; k + 3 < vectors.size(); k += 4) {
    const ScaledVector &a = vectors[k], &b = vectors[k + 1], &c = vectors[k + 2], &d = vectors[k + 3];
    const __m256d sa = _mm256_set1_pd(a.scale), sb = _mm256_set1_pd(b.scale);
    const __m256d sc = _mm256_set1_pd(c.scale), sd = _mm256_set1_pd(d.scale);
    int i = 0;
    for (; i + 3 < count; i += 4) {
      const __m256d first = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(a.values + i), sa),
                                          _mm256_mul_pd(_mm256_loadu_pd(b.values + i), sb));
      const __m256d second = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(c.values + i), sc),
                                           _mm256_mul_pd(_mm256_loadu_pd(d.values + i), sd));
      _mm256_storeu_pd(y + i, _mm256_sub_pd(_mm256_loadu_pd(y + i), _mm256_add_pd(first, second)));
    }
    for (; i < count; ++i) {
      y[i] -= (a.values[i] * a.scale + b.values[i] * b.scale) + (c.values[i] * c.scale + d.values[i] * d.scale);
    }
  }
  for (; k < vectors.size(); ++k) subtract_scaled_width_4(y, vectors[k].values, vectors[k].scale, count);
}

[[gnu::target("avx2")]] void subtract_sequence_width_4(double* y, const double* vectors, int stride,
                                                       std::span<const double> scales, int count) {
  int i = 0;
  for (; i + 15 < count; i += 16) {
    __m256d y0 = _mm256_loadu_pd(y + i), y1 = _mm256_loadu_pd(y + i + 4);
    __m256d y2 = _mm256_loadu_pd(y + i + 8), y3 = _mm256_loadu_pd(y + i + 12);
    const double* line = vectors + i;
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
    const double* line = vectors + i;
    for (const double number : scales) {
      sum = _mm256_sub_pd(sum, _mm256_mul_pd(_mm256_loadu_pd(line), _mm256_set1_pd(number)));
      line += stride;
    }
    _mm256_storeu_pd(y + i, sum);
  }
  subtract_sequence_tail(y, vectors, stride, scales, i, count);
}

[[gnu::target("avx2")]] double dot_product_width_4(const double* a, const double* b, int count) {
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

const DenseKernels& DenseKernels::width_2() {
  static constexpr DenseKernels kWidth2{dense::subtract_scaled_width_2, subtract_vectors_width_2,
                                        subtract_sequence_width_2, dense::dot_product_width_2};
  return kWidth2;
}

const DenseKernels& DenseKernels::widest() {
#if defined(__x86_64__)
  static constexpr DenseKernels kWidth4{subtract_scaled_width_4, subtract_vectors_width_4, subtract_sequence_width_4,
                                        dot_product_width_4};
  if (__builtin_cpu_supports("avx2")) return kWidth4;
#endif
  return width_2();
}

const DenseKernels& dense::kernels = DenseKernels::widest();

}  // namespace limber::sim::solver
