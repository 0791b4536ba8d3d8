// Dense: lines of numbers, two at a time; the same on every processor, whatever its vectors are. [any]
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace limber {

using Pair [[gnu::vector_size(16)]] = double;

inline Pair load_pair(const double* v) {
  Pair pair;
  std::memcpy(&pair, v, sizeof pair);
  return pair;
}

/// y -= a·x, over an even count.
inline void subtract_scaled(double* y, const double* a, double x, int count) {
  const Pair scale = {x, x};
  for (int i = 0; i < count; i += 2) {
    const Pair changed = load_pair(y + i) - load_pair(a + i) * scale;
    std::memcpy(y + i, &changed, sizeof changed);
  }
}

struct ScaledLine {
  const double* numbers;
  double scale;
};

/// y -= the sum of all lines, each times its scale, over an even count.
inline void subtract_scaled(double* y, std::span<const ScaledLine> lines, int count) {
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
  for (; k < lines.size(); ++k) subtract_scaled(y, lines[k].numbers, lines[k].scale, count);
}

/// The sum of a·b.
inline double product(const double* a, const double* b, int count) {
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

}  // namespace limber
