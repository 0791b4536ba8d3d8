// FreeFactor: the response of some rows to each other, factored (L·D·Lᵀ). What a choice of rows has in common with the
// one before, from its beginning, is not factored again. No Bullet.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/effort.h"

namespace limber {

/// Golub and Van Loan, Matrix Computations, 4.1: without exchanges, since what it factors is positive. [sim]
class FreeFactor {
 public:
  /// Matrices of up to `usual_rows` need no memory later.
  explicit FreeFactor(Effort& effort, std::size_t usual_rows = 0);
  /// Of a symmetric matrix, `stride` (even) numbers a line, which stays as it is while rows are chosen. None are.
  void start(std::span<const double> matrix, int stride);
  /// The rows that are to be free (not 0), one mark each; those that were free keep their order, and others come behind
  /// them. False, and nothing can be solved: more than `most`, or no positive matrix.
  bool choose(std::span<const unsigned char> free, int most);
  std::span<const int> rows() const { return rows_; }
  /// In place: what each of rows() misses becomes the impulse it needs.
  void solve(std::span<double> missing) const;

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool factor(int kept);

  Effort& effort_;
  std::span<const double> matrix_;
  int stride_ = 0;
  std::vector<int> rows_;
  std::vector<unsigned char> chosen_;  // of each row of the matrix
  std::vector<double> lines_;          // parts L below, D·Lᵀ above
  std::vector<double> inverse_;        // of D
  int factored_ = 0;                   // so many of rows_, from the first
};

}  // namespace limber
