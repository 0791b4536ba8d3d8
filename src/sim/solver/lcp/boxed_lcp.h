// BoxedLcp: solves a linear complementarity problem with bounds (boxed LCP) on a dense matrix, in which the bounds of
// friction rows depend on their normals: by block pivoting with sliding friction tied to its normal, then projected
// Gauss-Seidel, staggered friction and Lemke's path; docs/understand/solver.md. Doesn't depend on Bullet.
#pragma once

#include "sim/solver/lcp/lemke_path.h"
#include "sim/solver/lcp/staggered_friction.h"

namespace limber::sim::solver {

/// reset(), set the rows and responses, then solve(). [sim]
class BoxedLcp : private LcpState {
 public:
  using LcpState::Row;
  using LcpState::Status;
  using enum LcpState::Status;

  explicit BoxedLcp(WorkBudget& work_budget) : LcpState(work_budget) {}

  /// Sets the number of rows; rows have their defaults, and the response matrix is zero.
  using LcpState::reset;
  /// Changes the rows: row i was row from[i] before (-1: new). Responses between rows that existed are preserved,
  /// others are 0; all other values of rows get their defaults.
  using LcpState::remap;
  /// Adds the outer product of each vector with itself to the responses. Vectors are `width` (even) elements apart and
  /// have at least one element for each row.
  using LcpState::add_outer_products;
  using LcpState::row;
  using LcpState::size;
  /// Response of row i to a unit impulse of row j; symmetric, but both orders must be set. The diagonal includes the
  /// softness.
  using LcpState::response;

  /// Solves until no row violates its condition by more than `tolerance` (rate), which is relaxed once the work budget
  /// is exceeded. Returns the largest violation. If friction doesn't converge with its normals (a solution needn't
  /// exist, or the budget may not suffice), friction's bounds are those of the normals in the previous round; all other
  /// conditions are met.
  double solve(double tolerance);
  /// True if friction's bounds are those of the final normals.
  bool friction_converged() const { return !friction_frozen; }
  /// If not converged: sweeps from the present impulses and keeps the result if it is better. Returns the largest
  /// violation.
  double refine_friction();
  /// Status of a row in the last solution.
  Status status_of(int i) const { return status[i]; }

 private:
  void solve_fully();
  void solve_approximately();
  void initialize_statuses();
  void final_sweeps();

  BlockPivoting pivoting_{*this};
  StaggeredFriction staggered_{*this, pivoting_};
  LemkePath path_{*this, pivoting_};
};

}  // namespace limber::sim::solver
