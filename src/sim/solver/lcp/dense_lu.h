// DenseLu: LU factor of a square matrix with partial pivoting (Golub and Van Loan, Matrix Computations, section 3.4).
// Doesn't depend on Bullet.
#pragma once

#include "sim/solver/indexed_array.h"
#include "sim/solver/work_budget.h"

namespace limber::sim::solver {

/// reset(), set the elements, factor(), then solve() for any number of right-hand sides. [sim]
class DenseLu {
 public:
  /// Reserves memory for matrices of up to `usual_size` rows.
  DenseLu(WorkBudget& budget, int usual_size) : budget_(budget) { lu_.clear_and_reserve(usual_size * usual_size); }
  /// Sets the size; all elements are 0.
  void reset(int size);
  double* row(int i) { return &lu_[i * width_]; }
  /// Returns false if the matrix is singular.
  bool factor();
  /// Solves in place: the right-hand side becomes the solution.
  void solve(IndexedSpan<double> x);

 private:
  WorkBudget& budget_;
  IndexedArray<double> lu_;
  IndexedArray<int> pivots_;  // row exchanged with each column
  int size_ = 0;
  int width_ = 0;  // elements per row, even
};

}  // namespace limber::sim::solver
