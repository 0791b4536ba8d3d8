// SubspaceDescent: minimizes the dual energy of a boxed LCP with frozen friction bounds, a convex problem, over the
// rows that are free (Silcowitz, Niebel and Erleben, Interactive rigid body dynamics using a projected Gauss-Seidel
// subspace minimization method, 2010). Doesn't depend on Bullet.
#pragma once

#include "sim/solver/lcp/block_pivoting.h"
#include "sim/solver/lcp/incremental_ldlt.h"

namespace limber::sim::solver {

/// An active-set descent: steps to the minimum of the free rows, projected to the bounds if that decreases the energy,
/// then releases rows from their bounds. Each step decreases the energy. [sim]
class SubspaceDescent {
 public:
  SubspaceDescent(LcpState& lcp, BlockPivoting& pivoting);

  /// Call when the matrix has changed.
  void reset() { factor_.reset(lcp_.matrix, lcp_.stride); }
  /// Starts from the present impulses and statuses. Returns false if it has not converged, or if a matrix could not be
  /// factored; beyond the work budget every result is accepted.
  bool solve();

 private:
  bool factor_free();
  void step_free();
  bool project_step();
  double longest_step() const;
  void shorten_step(double step_length, bool decreases);
  int release_rows(bool only_one);

  LcpState& lcp_;
  BlockPivoting& pivoting_;
  IncrementalLdlt factor_;  // of the free rows
  IndexedArray<unsigned char> is_free_;
  IndexedArray<double> step_;
  IndexedArray<double> impulses_before_;
  IndexedArray<double> residuals_before_;
};

}  // namespace limber::sim::solver
