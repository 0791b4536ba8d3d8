// LcpState: a boxed linear complementarity problem, and the impulses, residuals and row statuses by which the
// algorithms of BoxedLcp approach its solution. Doesn't depend on Bullet.
#pragma once

#include "sim/solver/indexed_array.h"
#include "sim/solver/lcp/dense_kernels.h"
#include "sim/solver/work_budget.h"

namespace limber::sim::solver {

/// The residual of a row is its target rate - (response·impulses). A row satisfies its complementarity condition if its
/// residual is 0 within the bounds, <= 0 at the lower and >= 0 at the upper bound. [sim]
class LcpState {
 public:
  enum Status : unsigned char { free, at_lower, at_upper, unknown };
  struct Row {
    double residual = 0;  ///< At the present impulse.
    double impulse = 0;
    double lower = 0;
    double upper = 0;
    int normal = -1;      ///< Friction: index of the normal row, which must be before this one.
    double friction = 0;  ///< Friction: the bounds are plus and minus this factor times the normal's impulse.
    Status initial_status = unknown;  ///< Status to start with; unknown: derived from the impulse.
    double initial_change = 0;        ///< Added to the impulse before the sweeps start.
  };

  explicit LcpState(WorkBudget& work_budget);

  // the problem
  void reset(int count);
  void remap(IndexedSpan<const int> from);
  void add_outer_products(IndexedSpan<const double> vectors, int width);
  int size() const { return rows.size(); }
  Row& row(int i) { return rows[i]; }
  double& response(int i, int j) { return matrix[i * stride + j]; }

  // a solve, from begin() to end(): meanwhile the diagonal includes the proximal softness
  void begin();
  void end();
  /// Returns to the impulses at begin(); restart_from_guess() adds the rows' initial changes.
  void restart();
  void restart_from_guess();
  /// Largest violation that counts as solved.
  double tolerance() const { return budget.tolerance(requested_tolerance); }
  /// Sets friction's bounds from its normal, unless they are frozen.
  void update_bounds(Row& row) const;
  /// Derives the status of each row from its impulse.
  void classify_rows();
  /// Changes an impulse and the residuals of all rows.
  void set_impulse(int i, double impulse);
  /// Changes an impulse; flush_changes() updates the residuals for all queued changes together.
  void queue_change(int i, double change);
  void queue_impulse(int i, double impulse) { queue_change(i, impulse - row(i).impulse); }
  void flush_changes();
  /// Subtracts the response to an impulse of row i from `rates`.
  void subtract_response(IndexedArray<double>& rates, int i, double impulse) const;
  /// One sweep of projected Gauss-Seidel; or sweeps until no row violates its condition by more than the tolerance.
  void sweep();
  void sweep(int max_sweeps);
  double max_violation();
  /// Returns the largest violation, and stores it in `violation` if it is the smallest so far.
  double record_violation();
  /// Proximal point: moves the center of the softness to the present impulses, so that it vanishes at convergence.
  void recenter();
  /// Copies the impulses to `saved`, and back.
  void save_impulses(IndexedArray<double>& saved) const;
  void restore_impulses(const IndexedArray<double>& saved);

  WorkBudget& budget;
  double requested_tolerance = 0;
  int stride = 0;  ///< Elements per row of the matrix; even.
  IndexedArray<Row> rows;
  IndexedArray<double> matrix;  ///< Responses.
  IndexedArray<double> inverse_diagonal;
  IndexedArray<double> residuals;
  IndexedArray<Status> status;
  double violation = 0;          ///< Of the best solution so far.
  bool friction_frozen = false;  ///< Friction's bounds don't follow the normals.

 private:
  IndexedArray<double> old_matrix_;
  IndexedArray<ScaledVector> changed_;   // queued changes of residuals
  IndexedArray<double> start_impulses_;  // impulses at begin()
  IndexedArray<double> center_;          // proximal point: impulses that the softness pulls to
};

}  // namespace limber::sim::solver
