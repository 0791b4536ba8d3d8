// Dense vector kernels (SIMD). Results are identical to the bit on every processor, whatever its vector width. [any]
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace limber::sim::solver {

struct ScaledVector {
  const double* values;
  double scale;
};

/// One implementation of the kernels; the functions below describe them. Element-wise operations don't depend on the
/// vector width; a dot product always adds four partial sums, each over every fourth element.
struct DenseKernels {
  void (*subtract_scaled)(double* y, const double* a, double x, int count);
  void (*subtract_vectors)(double* y, std::span<const ScaledVector> vectors, int count);
  void (*subtract_sequence)(double* y, const double* vectors, int stride, std::span<const double> scales, int count);
  double (*dot_product)(const double* a, const double* b, int count);

  /// Two elements at a time; runs on any processor.
  static const DenseKernels& width_2();
  /// Four elements at a time if the processor supports AVX2, else width_2().
  static const DenseKernels& widest();
};

namespace dense {

/// Shorter vectors are calculated inline, without a call through `kernels`.
constexpr int kMinCallLength = 12;
extern const DenseKernels& kernels;

using Double2 [[gnu::vector_size(16)]] = double;

inline Double2 load2(const double* v) {
  Double2 pair;
  std::memcpy(&pair, v, sizeof pair);
  return pair;
}

inline void subtract_scaled_width_2(double* y, const double* a, double x, int count) {
  const Double2 scale = {x, x};
  for (int i = 0; i < count; i += 2) {
    const Double2 changed = load2(y + i) - load2(a + i) * scale;
    std::memcpy(y + i, &changed, sizeof changed);
  }
}

inline double dot_product_width_2(const double* a, const double* b, int count) {
  Double2 first = {0, 0};
  Double2 second = {0, 0};
  int i = 0;
  for (; i + 3 < count; i += 4) {
    first += load2(a + i) * load2(b + i);
    second += load2(a + i + 2) * load2(b + i + 2);
  }
  first += second;
  double sum = first[0] + first[1];
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace dense

/// y -= x·a; `count` must be even.
inline void subtract_scaled(double* y, const double* a, double x, int count) {
  if (count < dense::kMinCallLength) return dense::subtract_scaled_width_2(y, a, x, count);
  dense::kernels.subtract_scaled(y, a, x, count);
}

/// y -= sum of scale·vector over all vectors, four at a time; `count` must be even.
inline void subtract_scaled(double* y, std::span<const ScaledVector> vectors, int count) {
  dense::kernels.subtract_vectors(y, vectors, count);
}

/// y -= scale·vector for each scale in order; the vectors begin `stride` elements apart, `count` is arbitrary.
inline void subtract_sequence(double* y, const double* vectors, int stride, std::span<const double> scales, int count) {
  dense::kernels.subtract_sequence(y, vectors, stride, scales, count);
}

/// Dot product.
inline double dot_product(const double* a, const double* b, int count) {
  if (count < dense::kMinCallLength) return dense::dot_product_width_2(a, b, count);
  return dense::kernels.dot_product(a, b, count);
}

}  // namespace limber::sim::solver
