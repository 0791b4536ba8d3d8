// IncrementalLdlt: LDLᵀ factor of selected rows and columns of a symmetric matrix. Leading rows that a selection has in
// common with the previous one are not factored again. Doesn't depend on Bullet.
#pragma once

#include <cstddef>
#include <span>
#include "sim/solver/indexed_array.h"

#include "sim/solver/work_budget.h"

namespace limber::sim::solver {

/// Golub and Van Loan, Matrix Computations, section 4.1; without pivoting, since the matrix is positive definite. [sim]
class IncrementalLdlt {
 public:
  /// Reserves memory for matrices of up to `usual_rows` rows.
  explicit IncrementalLdlt(WorkBudget& budget, int usual_rows = 0);
  /// Sets a symmetric matrix with `stride` (even) elements per line, which must not change while rows are selected. No
  /// rows are selected at first.
  void reset(IndexedSpan<const double> matrix, int stride);
  /// Selects the rows with a nonzero element in `free` and factors them. Rows that were selected before keep their
  /// order, new ones are appended. Returns false if there are more than `max_rows`, or the matrix is not positive
  /// definite; solve() must not be called then.
  bool select(IndexedSpan<const unsigned char> free, int max_rows);
  /// The selected rows, in the order of the factor.
  IndexedSpan<const int> rows() const { return rows_; }
  /// Solves in place: the right-hand side of each of rows() becomes its solution.
  void solve(IndexedSpan<double> rhs) const;

 private:
  bool factor(int valid_rows);

  WorkBudget& budget_;
  IndexedSpan<const double> matrix_;
  int stride_ = 0;
  IndexedArray<int> rows_;
  IndexedArray<unsigned char> selected_;  // by row of the matrix
  IndexedArray<double> factor_;           // L below the diagonal, D·Lᵀ on and above it
  IndexedArray<double> inverse_;          // of D
  int factored_count_ = 0;                // number of leading rows_ that are factored
};

}  // namespace limber::sim::solver
