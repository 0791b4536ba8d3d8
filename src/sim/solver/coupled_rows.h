// CoupledRows: constraint rows that couple the trees of an island: contacts with friction, joints that close loops,
// gears, tendons, limits of ball joints, and axes that were deferred from the trees.
#pragma once

#include "sim/solver/forest/spanning_trees.h"
#include "sim/solver/lcp/boxed_lcp.h"

namespace limber::sim::solver {

/// Jacobian of a row with respect to one body.
struct BodyJacobian {
  int node = -1;
  Spatial jacobian;
};

struct CoupledRow {
  BodyJacobian a, b;
  int coupling = -1;                      // in the island's couplings: the row may act on more bodies
  int ball = -1;                          // in the island's joints: a row of its BallLimits
  AxisRow* axis = nullptr;                // set if the row is a deferred row of a tree
  btSolverConstraint* contact = nullptr;  // receives the impulse
  double target = 0;  // right-hand side of rate + softness·impulse, as a change from the start of the step
  double softness = 0;
  double start_impulse = 0;  // impulse before the current LCP solve
  double impulse = 0;
  double saved_impulse = 0;  // impulse before the first LCP solve
  double mobility = 0;       // inverse effective mass: rate per impulse of the two bodies alone
  double lower = 0;
  double upper = 0;
  int normal = -1;
  double friction = 0;
  bool loop = false;      // closes a loop of joints; also of gears and balls, not of tendons
  bool softened = false;  // DelassusMatrix has increased its softness
  bool inactive = false;  // contact that doesn't press: its rows are not in the LCP
  BoxedLcp::Status initial_status = BoxedLcp::unknown;  // status in the previous LCP solve
  double initial_impulse = 0;                           // impulse in the previous LCP solve

  bool is_normal() const { return contact != nullptr && normal < 0; }
};

/// Valid from collect() on, as long as the trees are. Contacts, loops, gears, tendons and limits of ball joints come
/// first, then deferred axes. [sim]
class CoupledRows {
 public:
  CoupledRows(const Island& island, SpanningTrees& trees) : island_(island), trees_(trees) {}

  /// Collects contacts, loops, gears, tendons and limits of ball joints.
  void collect();
  /// Replaces the deferred axes by those that are deferred now.
  void collect_deferred_axes();

  CoupledRow& operator[](int i) { return rows_[i]; }
  const CoupledRow& operator[](int i) const { return rows_[i]; }
  CoupledRow* begin() { return rows_.data(); }
  CoupledRow* end() { return rows_.data() + rows_.size(); }
  int size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }
  /// Number of rows without deferred axes.
  int fixed_count() const { return fixed_count_; }
  /// First row of a joint that closes a loop; row of a gear or tendon.
  int first_row_of_loop(int index) const { return loop_rows_[index]; }
  int row_of_coupling(int coupling) const { return first_coupling_ + coupling; }
  /// First row of a ball joint's limits; the others follow it.
  int first_ball_row(int joint) const { return ball_rows_[joint]; }

  /// Calls f(jacobian) for each body that the row acts on.
  template <class Row, class F>
  void for_each_jacobian(const Row& row, F&& f) const {
    if (row.a.node >= 0) f(row.a);
    if (row.b.node >= 0) f(row.b);
    if (row.coupling < 0) return;
    for (int i = extra_start_[row.coupling]; i < extra_start_[row.coupling + 1]; ++i) {
      if (extra_jacobians_[i].node >= 0) f(extra_jacobians_[i]);
    }
  }
  /// Present rate of a row, as a change from the start of the step.
  double rate(const CoupledRow& row) const;
  /// Residual of a row's equation at the present rates and impulses.
  double residual(const CoupledRow& row) const {
    return row.axis != nullptr ? trees_.axes.residual(*row.axis) : row.target - rate(row) - row.softness * row.impulse;
  }
  /// Adds an impulse of the row to the inputs of the trees' next solve.
  void apply_load(const CoupledRow& row, double impulse);

  /// Activates inactive contacts that the present velocities would violate, and their friction. Returns the number of
  /// rows.
  int activate_contacts();
  /// Each friction row has its own bounds; those of both rows form a square that touches the cone on its axes only.
  /// Where both rows together exceed the cone, their bounds are replaced by the rectangle within the cone that has its
  /// corner in the direction of the present force. Returns true if something changed.
  bool restore_friction_cone();

  /// Tolerance of rows, m/s and rad/s.
  static constexpr double kTolerance = 1e-6;

 private:
  void add_contact(btSolverConstraint& row, int normal);
  void collect_contacts();
  void collect_loops();
  void collect_couplings();
  void collect_ball_limits();
  void set_pair(CoupledRow& row, const Island::Joint& joint, const bullet::AxisJacobian& jacobian,
                const bullet::JointRow& planned);

  const Island& island_;
  SpanningTrees& trees_;
  IndexedArray<CoupledRow> rows_;
  IndexedArray<BodyJacobian> extra_jacobians_;  // of couplings: of their third and further bodies
  IndexedArray<int> extra_start_;               // by coupling: its first extra Jacobian; one more at the end
  IndexedArray<int> loop_rows_;                 // by joint
  IndexedArray<int> ball_rows_;                 // by joint
  int first_coupling_ = 0;
  int fixed_count_ = 0;
};

}  // namespace limber::sim::solver
