// Row-wise LDLᵀ elimination of the columns that are not factored yet.
#include "sim/solver/incremental_ldlt.h"

#include <algorithm>
#include <cmath>

#include "base/capacity.h"
#include "sim/solver/dense_kernels.h"

namespace limber {

IncrementalLdlt::IncrementalLdlt(WorkBudget& budget, std::size_t usual_rows) : budget_(budget) {
  clear_and_reserve(factor_, usual_rows * usual_rows);
}

void IncrementalLdlt::reset(std::span<const double> matrix, int stride) {
  matrix_ = matrix;
  stride_ = stride;
  rows_.clear();
  selected_.assign(at(stride), 0);
  reserve(factor_, matrix.size());
  factor_.resize(matrix.size());
  inverse_.resize(at(stride));
  factored_count_ = 0;
}

bool IncrementalLdlt::select(std::span<const unsigned char> free, int max_rows) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto row = at(rows_[i]);
    if (free[row] != 0) {
      rows_[count++] = rows_[i];
    } else {
      factored_count_ = std::min(factored_count_, static_cast<int>(count));
      selected_[row] = 0;
    }
  }
  rows_.resize(count);
  for (std::size_t row = 0; row < free.size(); ++row) {
    if (free[row] == 0 || selected_[row] != 0) continue;
    selected_[row] = 1;
    rows_.push_back(static_cast<int>(row));
  }
  return static_cast<int>(rows_.size()) <= max_rows && factor(factored_count_);
}

bool IncrementalLdlt::factor(int valid_rows) {
  const int n = static_cast<int>(rows_.size());
  budget_.charge(0.5 * n * n, 0.5 * (n - valid_rows));
  for (int i = 0; i < n; ++i) {
    const double* from = &matrix_[at(rows_[at(i)] * stride_)];
    double* to = &factor_[at(i * stride_)];
    for (int k = std::max(i, valid_rows); k < n; ++k) to[k] = from[rows_[at(k)]];
  }
  for (int r = 0; r < n; ++r) {
    double* line = &factor_[at(r * stride_)];
    if (r >= valid_rows) {
      for (int c = 0; c < r; ++c) line[c] = factor_[at(c * stride_ + r)] * inverse_[at(c)];
    }
    const int from = std::max(r, valid_rows);
    subtract_sequence(line + from, &factor_[at(from)], stride_, std::span(line, at(r)), n - from);
    if (r < valid_rows) continue;
    factored_count_ = r;
    if (!(line[r] > 0) || !std::isfinite(line[r])) return false;
    inverse_[at(r)] = 1 / line[r];
  }
  factored_count_ = n;
  return true;
}

void IncrementalLdlt::solve(std::span<double> rhs) const {
  const int n = static_cast<int>(rows_.size());
  double* x = rhs.data();
  budget_.charge(2 * n, 0.5 * n);
  for (int r = 1; r < n; ++r) x[r] -= dot_product(&factor_[at(r * stride_)], x, r);
  for (int r = n; r-- > 0;) {
    const double* line = &factor_[at(r * stride_)];
    x[r] = (x[r] - dot_product(line + r + 1, x + r + 1, n - r - 1)) * inverse_[at(r)];
  }
}

}  // namespace limber
