// CoupledSystem: rounds of LCP solves, and the axes that they defer.
#include "sim/solver/coupled_system.h"

#include <cmath>

namespace limber::sim::solver {
namespace {

/// Rounds in which axes may still be deferred once contacts are known.
constexpr int kMaxRounds = 8;
/// Largest violation of coupled rows that is accepted, m/s and rad/s.
constexpr double kMaxViolation = 1e-2;
/// A gear or limit of a ball joint is ill-conditioned if its response is below this fraction of the response of its
/// bodies alone.
constexpr double kIllConditioned = 1e-6;
/// Work budget of a step, in multiply-adds: constant, per body and per pair of contact rows. It is multiplied by
/// kUndeferredFactor while no motor is deferred, because the accuracy of contacts is visible then. If nothing but axes
/// is coupled, there is no limit: such steps are rare, and motors that violate their conditions tear a tree apart.
constexpr double kBaseWork = 5e4;
constexpr double kWorkPerBody = 2e3;
constexpr double kWorkPerContactPair = 1;
constexpr double kUndeferredFactor = 4;

AxisRow::Status to_axis_status(BoxedLcp::Status status) {
  return status == BoxedLcp::unknown    ? AxisRow::deferred
         : status == BoxedLcp::free     ? AxisRow::active
         : status == BoxedLcp::at_lower ? AxisRow::at_lower
                                        : AxisRow::at_upper;
}

}  // namespace

void CoupledSystem::begin() {
  delassus.clear();
  rows.collect();
}

void CoupledSystem::collect_deferred_axes() {
  rows.collect_deferred_axes();
  const auto fixed = static_cast<double>(rows.fixed_count());
  const double limit = kBaseWork + kWorkPerBody * trees_.node_count() + kWorkPerContactPair * fixed * fixed;
  if (rows.size() == rows.fixed_count()) return budget_.set_limit(kUndeferredFactor * limit);
  budget_.set_limit(rows.fixed_count() == 0 ? WorkBudget::kUnlimited : limit);
}

bool CoupledSystem::solve() {
  if (rows.empty()) return true;
  trees_.axes.save();
  for (CoupledRow& row : rows) row.saved_impulse = row.impulse;
  rows.activate_contacts();
  for (int round = 0; round < kMaxRounds; ++round) {
    double violation = 0;
    int deferred = 0;
    if (!solve_round(violation, deferred)) return false;
    // ill-conditioned: all motors and limits of trees with contacts are deferred, so that they yield within their force
    if (!(violation < kMaxViolation) || round == kMaxRounds - 2) deferred += defer_touched_trees();
    if (deferred == 0) {
      if (!lcp_.friction_converged()) violation = solve_lcp(LcpSolve::refine);
      return std::isfinite(violation);
    }
    if (!discard_impulses()) return false;
  }
  return false;
}

// Solves until no inactive contact is violated. Sets the number of axes that it defers because they are violated, or
// because a gear requires it. Returns false if the matrix is not finite.
bool CoupledSystem::solve_round(double& violation, int& deferred) {
  do {
    gather_lcp_rows();
    if (!delassus.update(lcp_, lcp_rows_)) return false;
    violation = 0;
    deferred = defer_ill_conditioned();
    if (deferred > 0) return true;
    violation = solve_lcp(LcpSolve::full);
  } while (rows.activate_contacts() > 0);
  deferred = defer_violated();
  return true;
}

// Discards all impulses, because they were found with another active set.
bool CoupledSystem::discard_impulses() {
  trees_.axes.restore();
  for (CoupledRow& row : rows) row.impulse = row.saved_impulse;
  for (const Tree& t : trees_) {
    if (!trees_.axes.factor_and_solve_once(t.first, t.last)) return false;
  }
  collect_deferred_axes();
  return true;
}

// Collects the rows of the LCP (those not inactive) in their order.
void CoupledSystem::gather_lcp_rows() {
  lcp_index_.resize(rows.size());
  lcp_rows_.clear();
  for (int i = 0; i < rows.size(); ++i) {
    lcp_index_[i] = rows[i].inactive ? -1 : lcp_rows_.size();
    if (!rows[i].inactive) lcp_rows_.push_back(i);
  }
}

double CoupledSystem::own_response(int row) {
  const int i = lcp_index_[row];
  return i < 0 ? rows[row].mobility : lcp_.response(i, i);
}

int CoupledSystem::defer_violated() {
  int violated = 0;
  for (const Tree& t : trees_) violated += trees_.axes.defer_violated(t.first, t.last);
  return violated;
}

// Defers the motors and limits of the axes of gears and ball joints whose rows' impulses the trees (nearly) don't
// respond to, because motors, limits or locks hold these axes; where only locks do, disables the row for the step.
int CoupledSystem::defer_ill_conditioned() {
  int deferred = 0;
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = rows[lcp_rows_[i]];
    const bool gear = row.coupling >= 0 && row.loop;
    if (!gear && row.ball < 0) continue;
    if (lcp_.response(i, i) - row.softness > kIllConditioned * row.mobility) continue;
    const int axes = gear ? defer_gear(row) : defer_ball(row);
    if (axes == 0) row.lower = row.upper = 0;
    deferred += axes;
  }
  return deferred;
}

int CoupledSystem::defer_gear(const CoupledRow& row) {
  int deferred = 0;
  const auto& gear = static_cast<const bullet::GearConstraint&>(*island_.couplings[row.coupling].constraint);
  for (int i = 0; i < island_.joints.size(); ++i) {
    const int node = trees_.node_of_joint(i);
    if (node < 0) continue;
    if (island_.joints[i].constraint == &gear.joint_a()) deferred += trees_.axes.defer_axis(node, gear.axis_a());
    if (island_.joints[i].constraint == &gear.joint_b()) deferred += trees_.axes.defer_axis(node, gear.axis_b());
  }
  return deferred;
}

int CoupledSystem::defer_ball(const CoupledRow& row) {
  const int node = trees_.node_of_joint(row.ball);
  int deferred = 0;
  for (int axis = 3; node >= 0 && axis < 6; ++axis) deferred += trees_.axes.defer_axis(node, axis);
  return deferred;
}

int CoupledSystem::defer_touched_trees() {
  int deferred = 0;
  for (const int i : lcp_rows_) {
    rows.for_each_jacobian(rows[i], [&](const BodyJacobian& body) {
      const Tree& tree = trees_[trees_.tree_of(body.node)];
      deferred += trees_.axes.defer_all(tree.first, tree.last);
    });
  }
  return deferred;
}

// Solves the LCP with the present matrix and applies its impulses to the trees. Returns the largest violation.
double CoupledSystem::solve_lcp(LcpSolve how) {
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = rows[lcp_rows_[i]];
    row.start_impulse = row.axis != nullptr ? row.axis->impulse : row.impulse;
    lcp_.row(i) = {rows.residual(row),
                   row.start_impulse,
                   row.lower,
                   row.upper,
                   row.normal < 0 ? -1 : lcp_index_[row.normal],
                   row.friction,
                   row.initial_status,
                   row.initial_impulse - row.start_impulse};
  }
  const double violation = how == LcpSolve::full ? lcp_.solve(CoupledRows::kTolerance) : lcp_.refine_friction();
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = rows[lcp_rows_[i]];
    row.impulse = lcp_.row(i).impulse;
    row.initial_impulse = std::isfinite(row.impulse) ? row.impulse : row.start_impulse;
    row.initial_status = lcp_.status_of(i);
    const double change = row.impulse - row.start_impulse;
    if (row.axis != nullptr) {
      row.axis->initial_status = to_axis_status(row.initial_status);
      row.axis->initial_impulse = row.initial_impulse;
      trees_.axes.add_pending(*row.axis, change);
    } else {
      rows.apply_load(row, change);
    }
  }
  for (const Tree& t : trees_) trees_.axes.solve_once(t.first, t.last);
  return violation;
}

}  // namespace limber::sim::solver
