// BoxedLcp: solves a linear complementarity problem with bounds (boxed LCP) on a dense matrix, in which the bounds of
// friction rows depend on their normals. Block pivoting with sliding friction tied to its normal, then projected
// Gauss-Seidel, staggered convex problems and Lemke's path; docs/solver.md. Doesn't depend on Bullet.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/solver/dense_kernels.h"
#include "sim/solver/incremental_ldlt.h"
#include "sim/solver/work_budget.h"

namespace limber {

/// The residual of a row is its target rate - (response·impulses). A row satisfies its complementarity condition if its
/// residual is 0 within the bounds, <= 0 at the lower and >= 0 at the upper bound. [sim]
class BoxedLcp {
 public:
  enum Status : unsigned char { free, at_lower, at_upper, unknown };
  struct Row {
    double residual = 0;  ///< At the present impulse.
    double impulse = 0;
    double lower = 0;
    double upper = 0;
    int normal = -1;         ///< Friction: index of the normal row, which must be before this one.
    double friction = 0;     ///< Friction: the bounds are plus and minus this factor times the normal's impulse,
    double max_impulse = 0;  ///< or this, where it is less (0: no such limit).
    Status initial_status = unknown;  ///< Status to start with; unknown: derived from the impulse.
    double initial_change = 0;        ///< Added to the impulse before the sweeps start.
  };

  explicit BoxedLcp(WorkBudget& budget);
  /// Sets the number of rows; rows have their defaults, and the response matrix is zero.
  void reset(int rows);
  /// Changes the rows: row i was row from[i] before (-1: new). Responses between rows that existed are preserved,
  /// others are 0; all other values of rows get their defaults.
  void remap(std::span<const int> from);
  /// Adds the outer product of each vector with itself to the responses. Vectors are `width` (even) elements apart and
  /// have at least one element for each row.
  void add_outer_products(std::span<const double> vectors, int width);
  int size() const { return static_cast<int>(rows_.size()); }
  Row& row(int i) { return rows_[static_cast<std::size_t>(i)]; }
  /// Response of row i to a unit impulse of row j; symmetric, but both orders must be set. The diagonal includes the
  /// softness.
  double& response(int i, int j) {
    return response_[static_cast<std::size_t>(i) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(j)];
  }

  /// Solves until no row violates its condition by more than `tolerance` (rate), which is relaxed once the work budget
  /// is exceeded. Returns the largest violation. If friction doesn't converge with its normals (a solution needn't
  /// exist, or the budget may not suffice), friction's bounds are those of the normals in the previous round; all other
  /// conditions are met.
  double solve(double tolerance);
  /// True if friction's bounds are those of the final normals.
  bool friction_converged() const { return !friction_frozen_; }
  /// If not converged: sweeps from the present impulses and keeps the result if it is better. Returns the largest
  /// violation.
  double refine_friction();
  /// Status of a row in the last solution.
  Status status(int i) const { return status_[static_cast<std::size_t>(i)]; }

 private:
  /// More free rows than this are not factored, because the cost is cubic.
  static constexpr int kMaxFree = 90;
  /// Up to this number of rows nothing is allocated.
  static constexpr std::size_t kReservedRows = 160;
  static std::size_t nth(int i) { return static_cast<std::size_t>(i); }
  void update_bounds(Row& row) const;
  double tolerance() const { return budget_.tolerance(requested_tolerance_); }
  void begin();
  void end();
  void solve_fully();
  void solve_approximately();
  void final_sweeps();
  void restart_from_guess();
  void restart();
  void recenter();
  void change_impulse(int i, double change);
  void set_impulse(int i, double impulse) { change_impulse(i, impulse - row(i).impulse); }
  void queue_change(int i, double change);
  void queue_impulse(int i, double impulse) { queue_change(i, impulse - row(i).impulse); }
  void apply_changes();
  void sweep();
  void sweep(int max_sweeps);
  double max_violation();
  double record_violation();
  void classify_rows();
  bool pivot(int max_exchanges);
  int exchange(bool only_last);
  void update_bounded_rows();
  bool solve_free();
  void assemble();
  int tied_normal(int i) const;
  bool factor_lu();
  void solve_lu();
  void correct_free();
  bool descend();
  bool factor_free();
  void step_free();
  bool project_step();
  int release_rows(bool only_one);
  struct StatusChange {  // of a row's status, on Lemke's path
    int row = -1;
    double distance = 0;
    Status to = free;
  };
  bool follow_path(int max_changes);
  void add_covering();
  void remove_covering(double fraction);
  bool find_direction();
  double slack_rate(int i, Status side) const;
  StatusChange ratio_test(double sign, double max_distance);
  void update_ratio_test(StatusChange& next, int i, double slack, double rate, Status to) const;
  void advance(double distance);
  bool apply_status_change(const StatusChange& change);
  void apply_changes(std::vector<double>& to, int i, double change) const;
  void freeze_friction(double fraction);
  bool solve_staggered();
  void solve_by_path();

  WorkBudget& budget_;
  double requested_tolerance_ = 0;  // tolerance passed to solve()
  int stride_ = 0;                  // elements per row of the response matrix
  std::vector<Row> rows_;
  std::vector<double> residuals_;
  std::vector<double> response_;
  std::vector<double> old_response_;
  std::vector<double> inverse_diagonal_;  // 1 / diagonal of the response
  std::vector<ScaledVector> changed_;     // queued changes of residuals
  std::vector<double> start_impulses_;    // impulses at the call of solve()
  std::vector<double> center_;            // proximal point: impulses that the softness pulls to
  std::vector<Status> status_;
  std::vector<Status> saved_status_;
  std::vector<double> saved_impulses_;
  std::vector<double> friction_bounds_;  // frozen bounds of friction
  IncrementalLdlt free_factor_;          // of the free rows, while friction's bounds are frozen
  std::vector<unsigned char> is_free_;
  std::vector<double> impulses_before_;
  std::vector<double> residuals_before_;
  std::vector<int> free_;
  std::vector<int> free_index_;    // row: index in free_, or -1
  std::vector<int> tied_normals_;  // row: index in free_ of the normal that it slides with, or -1
  std::vector<double> lu_;
  std::vector<int> pivots_;  // pivot rows of the LU factor
  std::vector<double> step_;
  std::vector<double> covering_;  // covering vector; added to the residuals, times the remaining fraction of the path
  std::vector<double> impulse_rates_;  // rates of impulses and of residuals, per distance along the path
  std::vector<double> residual_rates_;
  double violation_ = 0;
  int width_ = 0;                 // row length of the LU factor
  bool friction_frozen_ = false;  // friction's bounds don't follow the normals
  bool lu_valid_ = false;         // the LU factor belongs to the present statuses
};

}  // namespace limber
