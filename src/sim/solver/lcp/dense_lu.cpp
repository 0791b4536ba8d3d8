// DenseLu: elimination by rows.
#include "sim/solver/lcp/dense_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/solver/lcp/dense_kernels.h"

namespace limber::sim::solver {

void DenseLu::reset(int size) {
  size_ = size;
  width_ = (size + 1) / 2 * 2;
  lu_.assign(size * width_, 0);
}

bool DenseLu::factor() {
  const int n = size_;
  budget_.charge(0.5 * n * n, 0.7 * n);
  pivots_.resize(n);
  for (int c = 0; c < n; ++c) {
    int pivot_row = c;
    for (int r = c + 1; r < n; ++r) {
      if (std::fabs(row(r)[c]) > std::fabs(row(pivot_row)[c])) pivot_row = r;
    }
    double* line = row(c);
    pivots_[c] = pivot_row;
    if (pivot_row != c) std::swap_ranges(line, line + width_, row(pivot_row));
    if (!(std::fabs(line[c]) > 0) || !std::isfinite(line[c])) return false;
    const double inverse = 1 / line[c];
    for (int r = c + 1; r < n; ++r) {
      double* other = row(r);
      const double factor = other[c] * inverse;
      other[c] = factor;
      if (factor == 0) continue;
      int from = c + 1;
      if (from % 2 != 0) {
        other[from] -= factor * line[from];
        from++;
      }
      subtract_scaled(other + from, line + from, factor, width_ - from);
    }
  }
  return true;
}

void DenseLu::solve(IndexedSpan<double> x) {
  const int n = size_;
  budget_.charge(2 * n, 0.5 * n);
  for (int c = 0; c < n; ++c) std::swap(x[c], x[pivots_[c]]);
  for (int r = 0; r < n; ++r) x[r] -= dot_product(row(r), x.data(), r);
  for (int r = n; r-- > 0;) {
    const double* line = row(r);
    x[r] = (x[r] - dot_product(line + r + 1, x.data() + r + 1, n - r - 1)) / line[r];
  }
}

}  // namespace limber::sim::solver
