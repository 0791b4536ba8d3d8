// Row-wise LDLᵀ elimination of the columns that are not factored yet.
#include "sim/solver/lcp/incremental_ldlt.h"

#include <algorithm>
#include <cmath>

#include "base/capacity.h"
#include "sim/solver/lcp/dense_kernels.h"

namespace limber::sim::solver {

IncrementalLdlt::IncrementalLdlt(WorkBudget& budget, int usual_rows) : budget_(budget) {
  factor_.clear_and_reserve(usual_rows * usual_rows);
}

void IncrementalLdlt::reset(IndexedSpan<const double> matrix, int stride) {
  matrix_ = matrix;
  stride_ = stride;
  rows_.clear();
  selected_.assign(stride, 0);
  factor_.reserve_ahead(matrix.size());
  factor_.resize(matrix.size());
  inverse_.resize(stride);
  factored_count_ = 0;
}

bool IncrementalLdlt::select(IndexedSpan<const unsigned char> free, int max_rows) {
  int count = 0;
  for (int i = 0; i < rows_.size(); ++i) {
    const int row = rows_[i];
    if (free[row] != 0) {
      rows_[count++] = rows_[i];
    } else {
      factored_count_ = std::min(factored_count_, count);
      selected_[row] = 0;
    }
  }
  rows_.resize(count);
  for (int row = 0; row < free.size(); ++row) {
    if (free[row] == 0 || selected_[row] != 0) continue;
    selected_[row] = 1;
    rows_.push_back(row);
  }
  return rows_.size() <= max_rows && factor(factored_count_);
}

bool IncrementalLdlt::factor(int valid_rows) {
  const int n = rows_.size();
  budget_.charge(0.5 * n * n, 0.5 * (n - valid_rows));
  for (int i = 0; i < n; ++i) {
    const double* from = &matrix_[rows_[i] * stride_];
    double* to = &factor_[i * stride_];
    for (int k = std::max(i, valid_rows); k < n; ++k) to[k] = from[rows_[k]];
  }
  for (int r = 0; r < n; ++r) {
    double* line = &factor_[r * stride_];
    if (r >= valid_rows) {
      for (int c = 0; c < r; ++c) line[c] = factor_[c * stride_ + r] * inverse_[c];
    }
    const int from = std::max(r, valid_rows);
    subtract_sequence(line + from, &factor_[from], stride_, IndexedSpan<const double>(line, r), n - from);
    if (r < valid_rows) continue;
    factored_count_ = r;
    if (!(line[r] > 0) || !std::isfinite(line[r])) return false;
    inverse_[r] = 1 / line[r];
  }
  factored_count_ = n;
  return true;
}

void IncrementalLdlt::solve(IndexedSpan<double> rhs) const {
  const int n = rows_.size();
  double* x = rhs.data();
  budget_.charge(2 * n, 0.5 * n);
  for (int r = 1; r < n; ++r) x[r] -= dot_product(&factor_[r * stride_], x, r);
  for (int r = n; r-- > 0;) {
    const double* line = &factor_[r * stride_];
    x[r] = (x[r] - dot_product(line + r + 1, x + r + 1, n - r - 1)) * inverse_[r];
  }
}

}  // namespace limber::sim::solver
