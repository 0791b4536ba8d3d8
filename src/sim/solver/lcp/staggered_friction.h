// StaggeredFriction: rounds that bound friction by the normals of the previous round (Kaufman, Sueda, James and Pai,
// Staggered projections for frictional contact in multibody systems, 2008). Doesn't depend on Bullet.
#pragma once

#include "sim/solver/lcp/subspace_descent.h"

namespace limber::sim::solver {

/// Each round is a convex problem, which always has a solution; pivoting with tied friction starts from it. [sim]
class StaggeredFriction {
 public:
  StaggeredFriction(LcpState& lcp, BlockPivoting& pivoting) : lcp_(lcp), pivoting_(pivoting), descent_(lcp, pivoting) {}

  /// Starts from the present impulses. If no round converges, friction stays frozen at the bounds of the last one.
  /// Returns false if a round has no solution, for numerical reasons.
  bool solve();

 private:
  void freeze_friction(double fraction);
  bool pivot();

  LcpState& lcp_;
  BlockPivoting& pivoting_;
  SubspaceDescent descent_;
  IndexedArray<double> friction_bounds_;  // frozen bounds of friction
  IndexedArray<double> saved_impulses_;
  IndexedArray<LcpState::Status> saved_status_;
};

}  // namespace limber::sim::solver
