// BlockPivoting: block principal pivoting (Júdice and Pires, A block principal pivoting algorithm for large-scale
// strictly monotone linear complementarity problems, 1994) for a boxed LCP with sliding friction. Doesn't depend on
// Bullet.
#pragma once

#include "sim/solver/lcp/dense_lu.h"
#include "sim/solver/lcp/lcp_state.h"

namespace limber::sim::solver {

/// Exchanges rows between free and bounded and solves for all free rows at once. The impulse of a friction row at a
/// bound is tied to that of its normal (a Newton step on both together), unless friction's bounds are frozen. [sim]
class BlockPivoting {
 public:
  explicit BlockPivoting(LcpState& lcp) : lcp_(lcp), lu_(lcp.budget, kMaxFree) {}

  /// Starts from the present statuses. Returns true if no row violates its condition.
  bool solve(int max_exchanges);
  /// Sets the impulses of all rows that are not free.
  void update_bounded_rows();

  /// Factors the matrix of the free rows, in which tied rows are eliminated. Returns false if it is singular or too
  /// large.
  bool factor();
  /// The free rows, in the order of the factor.
  IndexedSpan<const int> free_rows() const { return free_; }
  /// Solves in place for the right-hand side of each of free_rows().
  void solve_factored(IndexedSpan<double> rhs) { lu_.solve(rhs); }
  /// If row i slides with a free normal, whose impulse determines its own: index in free_rows() of the normal; else -1.
  int tied_normal(int i) const { return lcp_.friction_frozen ? -1 : tied_normals_[i]; }

  /// More free rows than this are not factored, because the cost is cubic.
  static constexpr int kMaxFree = 90;

 private:
  using Row = LcpState::Row;

  void assemble();
  bool solve_free();
  void correct_free();
  LcpState::Status required_status(int i);
  int exchange(bool only_last);

  LcpState& lcp_;
  DenseLu lu_;
  IndexedArray<int> free_;
  IndexedArray<int> free_index_;    // by row: index in free_, or -1
  IndexedArray<int> tied_normals_;  // by row: index in free_ of the normal that it slides with, or -1
  IndexedArray<double> step_;
  bool factored_ = false;  // the factor belongs to the present statuses
};

}  // namespace limber::sim::solver
