// LemkePath: Lemke's method for bounded rows (Lemke, Bimatrix equilibrium points and mathematical programming, 1965;
// with friction: Anitescu and Potra, 1997). Doesn't depend on Bullet.
#pragma once

#include "sim/solver/lcp/block_pivoting.h"

namespace limber::sim::solver {

/// Follows the solution along a path from a problem that the present impulses solve to the given one, from one change
/// of a row's status to the next. A covering vector makes the difference between the two problems. [sim]
class LemkePath {
 public:
  LemkePath(LcpState& lcp, BlockPivoting& pivoting) : lcp_(lcp), pivoting_(pivoting) {}

  /// Follows the path from the present impulses, and if that fails, from zero. If both fail, returns to the present
  /// impulses, with friction's bounds no longer frozen.
  void solve();

 private:
  using Status = LcpState::Status;
  struct StatusChange {  // of a row's status
    int row = -1;
    double distance = 0;
    Status to = LcpState::free;
  };

  bool follow(int max_changes);
  void start();
  void add_covering();
  void remove_covering(double fraction);
  double bound_sign(int i) const;
  bool find_direction();
  double opening_rate(int i, Status left) const;
  double slack_rate(int i, Status side) const;
  StatusChange ratio_test(double sign, double max_distance);
  void test_free_row(StatusChange& next, int i, double sign, double min_rate);
  void test_bounded_row(StatusChange& next, int i, double sign, double min_rate);
  void advance(double distance);
  bool apply(const StatusChange& change);

  LcpState& lcp_;
  BlockPivoting& pivoting_;
  IndexedArray<double> covering_;  // added to the residuals, times the remaining fraction of the path
  IndexedArray<double> step_;
  IndexedArray<double> impulse_rates_;  // rates of impulses and of residuals, per distance along the path
  IndexedArray<double> residual_rates_;
  IndexedArray<double> saved_impulses_;
};

}  // namespace limber::sim::solver
