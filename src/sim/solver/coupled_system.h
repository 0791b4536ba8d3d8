// CoupledSystem: solves the coupled rows together with the trees, in rounds: one boxed LCP, then another one with the
// axes deferred whose conditions it violates.
#pragma once

#include "sim/solver/coupled_rows.h"
#include "sim/solver/delassus.h"
#include "sim/solver/lcp/boxed_lcp.h"

namespace limber::sim::solver {

/// begin(), then solve() after each solve of the trees. [sim]
class CoupledSystem {
 public:
  CoupledSystem(const Island& island, SpanningTrees& trees, WorkBudget& budget)
      : rows(island, trees),
        delassus(trees, rows, budget),
        lcp_(budget),
        island_(island),
        trees_(trees),
        budget_(budget) {}

  /// Collects the rows of the island; call after the trees were built.
  void begin();
  /// Collects the axes that the trees have deferred, and sets the work limit of the step.
  void collect_deferred_axes();
  /// Solves until no condition of rows or axes is violated. Returns false if that fails.
  bool solve();
  /// Response of a row to its own impulse in the last solve.
  double own_response(int row);

  CoupledRows rows;
  DelassusMatrix delassus;

 private:
  enum class LcpSolve : std::uint8_t { full, refine };

  void gather_lcp_rows();
  bool solve_round(double& violation, int& deferred);
  double solve_lcp(LcpSolve how);
  int defer_ill_conditioned();
  int defer_gear(const CoupledRow& row);
  int defer_ball(const CoupledRow& row);
  int defer_violated();
  int defer_touched_trees();
  bool discard_impulses();

  BoxedLcp lcp_;
  const Island& island_;
  SpanningTrees& trees_;
  WorkBudget& budget_;
  IndexedArray<int> lcp_rows_;   // rows in the LCP
  IndexedArray<int> lcp_index_;  // by row: index in lcp_rows_; -1: inactive
};

}  // namespace limber::sim::solver
