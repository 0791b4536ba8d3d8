// Dense: lines of numbers, as many at a time as the processor takes; the same on every one, to the bit. [any]
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace limber {

struct ScaledLine {
  const double* numbers;
  double scale;
};

/// Element by element, so lanes of any width say the same; a sum is of four parts, that of every fourth number each.
struct DenseKernels {
  void (*subtract_scaled)(double* y, const double* a, double x, int count);
  void (*subtract_lines)(double* y, std::span<const ScaledLine> lines, int count);
  void (*subtract_in_turn)(double* y, const double* lines, int stride, std::span<const double> scales, int count);
  double (*product)(const double* a, const double* b, int count);

  static const DenseKernels& by_two();
  /// By four where the processor can (AVX2).
  static const DenseKernels& widest();
};

namespace dense {

/// Lines from this length on are worth a call.
constexpr int kLong = 12;
extern const DenseKernels& kernels;

using Pair [[gnu::vector_size(16)]] = double;

inline Pair load_pair(const double* v) {
  Pair pair;
  std::memcpy(&pair, v, sizeof pair);
  return pair;
}

inline void subtract_by_two(double* y, const double* a, double x, int count) {
  const Pair scale = {x, x};
  for (int i = 0; i < count; i += 2) {
    const Pair changed = load_pair(y + i) - load_pair(a + i) * scale;
    std::memcpy(y + i, &changed, sizeof changed);
  }
}

inline double product_by_two(const double* a, const double* b, int count) {
  Pair first = {0, 0};
  Pair second = {0, 0};
  int i = 0;
  for (; i + 3 < count; i += 4) {
    first += load_pair(a + i) * load_pair(b + i);
    second += load_pair(a + i + 2) * load_pair(b + i + 2);
  }
  first += second;
  double sum = first[0] + first[1];
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace dense

/// y -= a·x, over an even count.
inline void subtract_scaled(double* y, const double* a, double x, int count) {
  if (count < dense::kLong) return dense::subtract_by_two(y, a, x, count);
  dense::kernels.subtract_scaled(y, a, x, count);
}

/// y -= the sum of all lines, each times its scale, over an even count. Four lines are added up before.
inline void subtract_scaled(double* y, std::span<const ScaledLine> lines, int count) {
  dense::kernels.subtract_lines(y, lines, count);
}

/// y -= lines that begin `stride` after each other, each times its scale, one after the other, over any count.
inline void subtract_in_turn(double* y, const double* lines, int stride, std::span<const double> scales, int count) {
  dense::kernels.subtract_in_turn(y, lines, stride, scales, count);
}

/// The sum of a·b.
inline double product(const double* a, const double* b, int count) {
  if (count < dense::kLong) return dense::product_by_two(a, b, count);
  return dense::kernels.product(a, b, count);
}

}  // namespace limber
