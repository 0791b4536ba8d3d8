// Elimination line by line, of columns that are new.
#include "sim/free_factor.h"

#include <algorithm>
#include <cmath>

#include "base/room.h"
#include "sim/dense.h"

namespace limber {

FreeFactor::FreeFactor(Effort& effort, std::size_t usual_rows) : effort_(effort) {
  take_room(lines_, usual_rows * usual_rows);
}

void FreeFactor::start(std::span<const double> matrix, int stride) {
  matrix_ = matrix;
  stride_ = stride;
  rows_.clear();
  chosen_.assign(at(stride), 0);
  make_room(lines_, matrix.size());
  lines_.resize(matrix.size());
  inverse_.resize(at(stride));
  factored_ = 0;
}

bool FreeFactor::choose(std::span<const unsigned char> free, int most) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto row = at(rows_[i]);
    if (free[row] != 0) {
      rows_[kept++] = rows_[i];
    } else {
      factored_ = std::min(factored_, static_cast<int>(kept));
      chosen_[row] = 0;
    }
  }
  rows_.resize(kept);
  for (std::size_t row = 0; row < free.size(); ++row) {
    if (free[row] == 0 || chosen_[row] != 0) continue;
    chosen_[row] = 1;
    rows_.push_back(static_cast<int>(row));
  }
  return static_cast<int>(rows_.size()) <= most && factor(factored_);
}

bool FreeFactor::factor(int kept) {
  const int n = static_cast<int>(rows_.size());
  effort_.lines(0.5 * n * n, 0.5 * (n - kept));
  for (int i = 0; i < n; ++i) {
    const double* from = &matrix_[at(rows_[at(i)] * stride_)];
    double* to = &lines_[at(i * stride_)];
    for (int k = std::max(i, kept); k < n; ++k) to[k] = from[rows_[at(k)]];
  }
  for (int r = 0; r < n; ++r) {
    double* line = &lines_[at(r * stride_)];
    if (r >= kept) {
      for (int c = 0; c < r; ++c) line[c] = lines_[at(c * stride_ + r)] * inverse_[at(c)];
    }
    const int from = std::max(r, kept);
    subtract_in_turn(line + from, &lines_[at(from)], stride_, std::span(line, at(r)), n - from);
    if (r < kept) continue;
    factored_ = r;
    if (!(line[r] > 0) || !std::isfinite(line[r])) return false;
    inverse_[at(r)] = 1 / line[r];
  }
  factored_ = n;
  return true;
}

void FreeFactor::solve(std::span<double> missing) const {
  const int n = static_cast<int>(rows_.size());
  double* x = missing.data();
  effort_.lines(2 * n, 0.5 * n);
  for (int r = 1; r < n; ++r) x[r] -= product(&lines_[at(r * stride_)], x, r);
  for (int r = n; r-- > 0;) {
    const double* line = &lines_[at(r * stride_)];
    x[r] = (x[r] - product(line + r + 1, x + r + 1, n - r - 1)) * inverse_[at(r)];
  }
}

}  // namespace limber
