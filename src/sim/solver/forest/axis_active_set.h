// AxisActiveSet: constraint rows of the joint axes of a forest (locks, motors, servos, limits, friction, springs),
// solved exactly together with the trees by block principal pivoting (docs/understand/solver.md). Doesn't depend on
// Bullet.
#pragma once

#include <cstdint>
#include <span>

#include "sim/solver/forest/forest.h"
#include "sim/solver/indexed_array.h"
#include "sim/solver/work_budget.h"

namespace limber::sim::solver {

/// A constraint row: rate + softness·impulse = velocity, with the impulse in [lower, upper]. The left side may be
/// larger while the impulse is at its lower bound, and smaller while it is at its upper bound.
struct AxisRow {
  enum Kind : std::uint8_t { motor, friction, lower_limit, upper_limit, other };
  enum Status : std::uint8_t { active, at_lower, at_upper, deferred };
  static constexpr double kInfinity = 1e15;

  double velocity = 0;
  double softness = 0;  ///< >= 0; 0: a hard row.
  double lower = 0;     ///< Beyond ±kInfinity: no bound.
  double upper = 0;
  double impulse = 0;
  int node = 0;
  std::uint8_t axis = 0;
  /// Identifies the row among those of its axis from step to step; an axis has at most one hard row of each kind.
  Kind kind = other;
  Status status = active;
  /// The status with which the LCP solver starts a deferred row; `deferred`: unknown, it derives it from the impulse.
  Status initial_status = deferred;
  double initial_impulse = 0;  ///< The impulse with which the LCP solver starts a deferred row.

  bool hard() const { return softness == 0; }
  bool bounded() const { return lower > -kInfinity || upper < kInfinity; }
  bool constant() const { return lower == upper; }
};

/// Warm start of the active set of a joint: for each axis the row that was active in the previous step, and whether
/// contacts changed this. 0: unknown.
using ActiveSetWarmStart = FixedArray<std::uint8_t, 6>;

/// Constraint rows of a forest, their impulses and the bodies' velocity changes. Rows whose status depends on contacts
/// are deferred: the coupled system solves them, and applies impulses to them by add_pending(). [sim]
class AxisActiveSet {
 public:
  explicit AxisActiveSet(WorkBudget& budget) : budget_(budget) {}

  Forest forest;

  /// Removes all nodes and rows and reserves memory for `capacity` nodes.
  void clear(int capacity = 0);
  /// Adds a row to the last node of `forest`. Call between two calls of end_node().
  AxisRow& add(int axis, double velocity, double softness, double lower, double upper, AxisRow::Kind kind);
  /// Completes the last node. `rates`: of its axes before the step's impulses; `previous`: its active set in the last
  /// step.
  void end_node(const FixedArray<double, 6>& rates, const ActiveSetWarmStart& previous);
  ActiveSetWarmStart active_set(int node) const;

  IndexedSpan<AxisRow> rows(int node);
  int index_of(const AxisRow& row) const { return static_cast<int>(&row - rows_.data()); }
  IndexedSpan<const AxisRow> rows(int node) const {
    return IndexedSpan<const AxisRow>(rows_).subspan(row_start_[node], row_start_[node + 1] - row_start_[node]);
  }
  IndexedSpan<AxisRow> rows() { return rows_; }
  double rate(int node, int axis) const { return rates_[node][axis]; }
  /// Change of a node's velocity by all solves so far.
  const Spatial& change(int node) const { return changes_[node]; }
  /// Sets a velocity change that was applied to the body from outside; rates must include it already.
  void set_change(int node, const Spatial& change) { changes_[node] = change; }

  /// Factors and solves the whole trees of nodes first .. last - 1 until no row is violated: in at most `max_exchanges`
  /// exchanges of the active set, and then by exchanging the largest violations only. Rows of axes that have not
  /// converged by then are deferred. Returns false if the system is singular because an axis has no inertia.
  bool solve_from_scratch(int first, int last, int max_exchanges);
  /// Like solve_from_scratch(), but first tries the existing factor, if there is one.
  bool solve(int first, int last, int max_exchanges);
  /// Solves once, with the existing factor, the loads of the nodes and the pending impulses of deferred rows; clears
  /// the loads. Doesn't change the active set.
  void solve_once(int first, int last);
  /// Defers rows that are violated now. Returns the number of axes; if it isn't 0, call factor() next.
  int defer_violated(int first, int last);
  /// Defers the axes where contacts changed the active set in the previous step, since they probably will again.
  /// Returns their number.
  int defer_as_before(int first, int last);
  /// Defers the bounded hard rows of one axis. Returns 0 if it has none or they were deferred before.
  int defer_axis(int node, int axis);
  /// Defers all bounded hard rows. Returns the number of axes.
  int defer_all(int first, int last);
  /// save() stores impulses, rates and changes; restore() restores them. Rows deferred in between stay deferred.
  void save();
  void restore();
  /// Clears loads, then factors and solves once. Call after restore(). Returns false if the system is singular.
  bool factor_and_solve_once(int first, int last);
  /// Factors the trees for the present status of the rows. Returns false if the system is singular.
  bool factor(int first, int last);
  /// Adds an impulse of a deferred row that the next solve_once() applies.
  void add_pending(AxisRow& row, double impulse) { pending_[index_of(row)] += impulse; }
  /// Violation of the row's equation: velocity - softness·impulse - rate.
  double residual(const AxisRow& row) const {
    return row.velocity - row.softness * row.impulse - rate(row.node, row.axis);
  }

  /// Changes with each factorization.
  std::uint64_t factor_version() const { return factor_version_; }

 private:
  // The bounded hard rows of one axis, sorted by velocity. At most one is active: in state 2i + 1 row i is active, rows
  // before it are at their lower bounds and rows after it at their upper bounds; in state 2i none is active, and the
  // boundary is between rows i - 1 and i.
  struct BoundedRows {
    int node = 0;
    int axis = 0;
    int first = 0;  // in bounded_row_indices_
    int count = 0;
    int state = 0;
    int next_state = 0;
    bool deferred = false;
    bool deferred_before = false;  // contacts changed its state in the step before
  };
  struct Violation {
    double size = 0;
    int index = 0;  // in bounded_rows_, or of a soft row
    bool soft = false;
  };
  AxisRow& row_of(const BoundedRows& bounded, int i) { return rows_[bounded_row_indices_[bounded.first + i]]; }
  const AxisRow& row_of(const BoundedRows& bounded, int i) const {
    return rows_[bounded_row_indices_[bounded.first + i]];
  }
  void build_bounds(int node, int axis, std::uint8_t previous);
  void reconcile_limits(const BoundedRows& bounded);
  void sort_bounds(const BoundedRows& bounded);
  bool admissible(const BoundedRows& bounded, int state) const;
  int previous_state(const BoundedRows& bounded, std::uint8_t code) const;
  int default_state(const BoundedRows& bounded) const;
  int final_state(const BoundedRows& bounded) const;
  void apply_state(BoundedRows& bounded);
  template <class F>
  int defer_if(int first, int last, F&& matches);
  int required_state(const BoundedRows& bounded) const;
  int find_violations(int first, int last);
  void exchange(int first, int last, bool only_last);
  double violation_of(const BoundedRows& bounded) const;
  void exchange_worst(int first, int last, int divisor);
  void prepare_node(int i);
  void accumulate_node(int i);
  IndexedSpan<BoundedRows> bounded_rows(int first, int last);

  /// Cost of a factorization or of a solve per node, in vectors of six elements.
  static constexpr int kNodeVectors = 28;

  WorkBudget& budget_;
  IndexedArray<AxisRow> rows_;
  IndexedArray<double> pending_;
  IndexedArray<int> row_start_;  // by node
  IndexedArray<BoundedRows> bounded_rows_;
  IndexedArray<int> bounded_rows_start_;  // by node
  IndexedArray<int> bounded_row_indices_;
  IndexedArray<Violation> violations_;  // scratch
  IndexedArray<FixedArray<double, 6>> rates_;
  IndexedArray<FixedArray<double, 6>> known_impulses_;  // known impulse changes on prescribed axes
  IndexedArray<Spatial> changes_;
  IndexedArray<double> saved_impulses_;
  IndexedArray<FixedArray<double, 6>> saved_rates_;
  IndexedArray<Spatial> saved_changes_;
  IndexedArray<unsigned char> factored_;  // by node: the factor of its tree is that of the present states
  std::uint64_t factor_version_ = 0;
};

}  // namespace limber::sim::solver
