// Dense: lines of numbers, two at a time; the same on every processor, whatever its vectors are. [any]
#pragma once

#include <cstring>

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
