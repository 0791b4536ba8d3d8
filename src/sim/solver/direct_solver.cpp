// DirectSolver: the stages of a substep, each with its own state, in the order in which they run.
#include "sim/solver/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/solver/coupled_system.h"
#include "sim/solver/gyroscopic_correction.h"
#include "sim/solver/lock_energy.h"
#include "sim/solver/position_correction.h"
#include "sim/solver/spin_clamp.h"
#include "sim/solver/split_impulse.h"

namespace limber::sim::solver {
namespace {

/// Islands with more contact and friction rows use the iterative solver, because the dense matrix would cost too much.
constexpr int kMaxContactRows = 360;
/// The same for an island without joints, where the iterative solver is cheaper and nearly as accurate.
constexpr int kMaxRowsWithoutJoints = 60;
/// Exchanges of the active set of a tree before axes that have not converged are deferred to the LCP.
constexpr int kMaxExchanges = 16;
// Repeated solves, at most, after:
constexpr int kMaxConePasses = 2;      // the friction was limited to the friction cone
constexpr int kMaxRotationPasses = 3;  // the target rates of motors were reduced
constexpr int kMaxDriftPasses = 4;     // the drift correction was updated (gyroscopes may need more)
constexpr int kMaxEnergyPasses = 2;    // the drift correction was reduced because it adds energy
/// Velocity changes above this count as divergence: m/s, rad/s.
constexpr double kMaxVelocity = 1e5;

// Natural residual of a row, m/s or rad/s: the change of its impulse in a Gauss-Seidel sweep, times the mobility.
double natural_residual(double residual, double impulse, double lower, double upper, double mobility) {
  const double after = std::clamp(impulse + residual / mobility, lower, std::max(lower, upper));
  return std::fabs(after - impulse) * mobility;
}

}  // namespace

/// The stages and the data that they share. The begin() of a stage must be called again after the trees were built
/// again.
class DirectSolver::Step {
 public:
  Island island;

  bool solve();
  void write();
  void correct_positions();
  void fall_back();
  DirectResiduals measure_residuals();

 private:
  bool build_trees();
  bool solve_without_corrections();
  bool solve_velocities();
  bool solve_trees();
  bool has_finite_velocities() const;
  bool apply_corrections();
  bool iterate_corrections();
  double axis_residual(const Island::Joint& joint, const AxisRow& row) const;
  double coupled_residual(int i);

  WorkBudget budget_;
  double solve_cost_ = 0;  // of the last solve_velocities()
  SpanningTrees trees_{island, budget_};
  SpinClamp spin_clamp_{island, trees_};
  CoupledSystem coupled_{island, trees_, budget_};
  GyroscopicCorrection gyroscopes_{island, trees_};
  DriftCorrection drift_{island, trees_, coupled_.rows};
  LockEnergy lock_energy_{island, trees_, coupled_.rows, drift_};
  SplitImpulse split_impulse_{island, trees_, coupled_.rows, coupled_.delassus, budget_};
  PositionCorrection position_correction_{island, trees_, budget_};
  IndexedArray<double> impulses_;
};

// Returns false if the island can't be solved.
bool DirectSolver::Step::solve() {
  spin_clamp_.begin();
  budget_.reset();
  bool solved = build_trees();
  if (solved && spin_clamp_.clamp_before()) solved = build_trees();
  if (solved) solved = solve_without_corrections();
  // if the budget is spent, the next step clamps the rotation before its solve
  if (solved && !budget_.exceeded() && spin_clamp_.clamp_after()) {
    solved = build_trees() && solve_without_corrections();
  }
  if (!solved || !apply_corrections()) return false;
  lock_energy_.store();
  return true;
}

bool DirectSolver::Step::build_trees() {
  position_correction_.reserve(island.pools->bodies.size());
  return trees_.build();
}

// Solves everything except drift and gyroscopic corrections.
bool DirectSolver::Step::solve_without_corrections() {
  coupled_.begin();
  bool solved = solve_velocities();
  for (int pass = 0; pass < kMaxConePasses && solved && coupled_.rows.restore_friction_cone(); ++pass)
    solved = solve_velocities();
  for (int pass = 0; pass < kMaxRotationPasses && solved && spin_clamp_.limit_target_rates(); ++pass)
    solved = solve_velocities();
  return solved;
}

// Solves the trees with the present contact impulses, then the coupled rows, until no condition is violated.
bool DirectSolver::Step::solve_velocities() {
  const double before = budget_.spent();
  const bool solved = solve_trees() && coupled_.solve() && has_finite_velocities();
  solve_cost_ = budget_.spent() - before;
  return solved;
}

bool DirectSolver::Step::solve_trees() {
  for (const Tree& t : trees_) {
    if (!trees_.axes.solve(t.first, t.last, kMaxExchanges)) return false;
    const bool has_deferred = !coupled_.rows.empty() && trees_.axes.defer_as_before(t.first, t.last) > 0;
    if (has_deferred && !trees_.axes.factor_and_solve_once(t.first, t.last)) return false;
  }
  coupled_.collect_deferred_axes();
  return true;
}

bool DirectSolver::Step::has_finite_velocities() const {
  for (int i = 0; i < trees_.node_count(); ++i) {
    const Spatial& c = trees_.axes.change(i);
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(c.linear[k]) < kMaxVelocity) || !(std::fabs(c.angular[k]) < kMaxVelocity)) return false;
    }
  }
  return true;
}

// Applies the drift and gyroscopic corrections, then limits the energy that they add to passive trees.
bool DirectSolver::Step::apply_corrections() {
  lock_energy_.begin();
  gyroscopes_.begin();
  drift_.begin();
  bool solved = iterate_corrections();
  for (int pass = 0; pass < kMaxEnergyPasses && solved && !drift_.diverged() && lock_energy_.limit(); ++pass)
    solved = solve_velocities();
  return solved;
}

bool DirectSolver::Step::iterate_corrections() {
  const double min_drift = !gyroscopes_.empty() ? DriftCorrection::kMinFastDrift
                           : trees_.has_loops() ? DriftCorrection::kMinLoopDrift
                                                : DriftCorrection::kMinDrift;
  bool solved = true;
  bool gyro_pending = true;
  for (int pass = 0; solved && (drift_.pending() || gyro_pending) && !budget_.exceeded(solve_cost_); ++pass) {
    gyro_pending = gyroscopes_.correct();
    if (pass < kMaxDriftPasses && drift_.pending()) drift_.update(min_drift);
    if (drift_.diverged()) return solve_velocities();  // the position correction follows
    if (!gyro_pending && (pass >= kMaxDriftPasses || !drift_.pending())) break;
    solved = solve_velocities();
  }
  return solved;
}

// Writes the velocities to Bullet's solver bodies, and the impulses to contacts, joints, gears and tendons.
void DirectSolver::Step::write() {
  for (int i = 0; i < trees_.node_count(); ++i) {
    const Spatial& change = trees_.axes.change(i);
    trees_.body(i).m_deltaLinearVelocity = bullet::to_bt(change.linear);
    trees_.body(i).m_deltaAngularVelocity = bullet::to_bt(change.angular);
  }
  CoupledRows& rows = coupled_.rows;
  for (const CoupledRow& row : rows) {
    if (row.contact != nullptr) row.contact->m_appliedImpulse = bullet::to_scalar(row.impulse);
  }
  for (int i = 0; i < island.joints.size(); ++i) {
    bullet::JointConstraint& joint = *island.joints[i].constraint;
    const int node = trees_.node_of_joint(i);
    for (int r = 0; r < joint.ball_limits().count(); ++r)
      joint.set_ball_impulse(r, bullet::to_scalar(rows[rows.first_ball_row(i) + r].impulse));
    impulses_.clear();
    if (node >= 0) {
      for (const AxisRow& row : trees_.axes.rows(node)) impulses_.push_back(row.impulse);
      joint.warm_start().active_set() = trees_.axes.active_set(node);
    } else {
      for (int r = 0; r < joint.rows().size(); ++r) impulses_.push_back(rows[rows.first_row_of_loop(i) + r].impulse);
    }
    joint.set_impulses(impulses_);
  }
  for (int i = 0; i < island.couplings.size(); ++i)
    island.couplings[i].constraint->set_impulse(rows[rows.row_of_coupling(i)].impulse);
}

// Corrects penetration, and the position errors of joints that the drift correction leaves. Call after write().
void DirectSolver::Step::correct_positions() {
  if (!island.info->m_splitImpulse || island.info->m_splitImpulseTurnErp <= 0) return;
  split_impulse_.apply();
  // it predicts the poses of dynamic bodies only
  if (drift_.leaves_errors() && !island.has_moving_static()) position_correction_.apply();
}

// Removes the warm-start impulses, which only the direct solver could have balanced, before the iterative solver
// starts.
void DirectSolver::Step::fall_back() {
  spin_clamp_.undo();
  const IslandPools& pools = *island.pools;
  for (btConstraintArray* rows : {&pools.contacts, &pools.frictions, &pools.rollings}) {
    for (int i = 0; i < rows->size(); ++i) {
      btSolverConstraint& row = (*rows)[i];
      const btScalar impulse = -std::exchange(row.m_appliedImpulse, btScalar(0));
      btSolverBody& a = island.body(row.m_solverBodyIdA);
      btSolverBody& b = island.body(row.m_solverBodyIdB);
      a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
      b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
    }
  }
  for (const Island::Joint& joint : island.joints) {
    joint.constraint->warm_start().clear_block_impulses();
    joint.constraint->warm_start().active_set().fill(0);
  }
  for (const Island::Coupling& coupling : island.couplings) coupling.constraint->forget_impulses();
}

// Residual of a row of a joint, calculated from the bodies' velocities, independently of the solver's rates.
double DirectSolver::Step::axis_residual(const Island::Joint& joint, const AxisRow& row) const {
  const bullet::AxisJacobian j = joint.constraint->pose().jacobian(row.axis);
  const double rate = dot(make_spatial(-j.linear, j.angular_a), trees_.velocity(joint.body_a)) +
                      dot(make_spatial(j.linear, j.angular_b), trees_.velocity(joint.body_b));
  const TreeNode& n = trees_.axes.forest.node(row.node);
  const double mobility = 1 / dot(n.axis[row.axis], n.inertia * n.axis[row.axis]) + row.softness;
  return natural_residual(row.velocity - row.softness * row.impulse - rate, row.impulse, row.lower, row.upper,
                          mobility);
}

double DirectSolver::Step::coupled_residual(int i) {
  const CoupledRow& row = coupled_.rows[i];
  const double residual = coupled_.rows.residual(row);
  const double response = std::max(coupled_.own_response(i), 1e-9);
  if (row.normal < 0) return natural_residual(residual, row.impulse, row.lower, row.upper, response);
  const double bound = row.friction * std::max(coupled_.rows[row.normal].impulse, 0.0);
  return natural_residual(residual, row.impulse, -bound, bound, response);
}

DirectResiduals DirectSolver::Step::measure_residuals() {
  DirectResiduals out;
  for (int i = 0; i < island.joints.size(); ++i) {
    if (trees_.node_of_joint(i) < 0) continue;
    for (const AxisRow& row : trees_.axes.rows(trees_.node_of_joint(i))) {
      double& largest = row.bounded() ? out.bounded : out.unbounded;
      largest = std::max(largest, axis_residual(island.joints[i], row));
    }
  }
  for (int i = 0; i < coupled_.rows.fixed_count(); ++i) out.coupled = std::max(out.coupled, coupled_residual(i));
  return out;
}

DirectSolver::DirectSolver() : step_(std::make_unique<Step>()) {}

DirectSolver::~DirectSolver() = default;

void DirectSolver::begin() {
  step_->island.joints.clear();
  step_->island.couplings.clear();
  step_->island.coupled_bodies.clear();
}

void DirectSolver::add_joint(bullet::JointConstraint& joint, int body_a, int body_b) {
  step_->island.joints.push_back({&joint, body_a, body_b});
}

void DirectSolver::add_coupling(bullet::CoupledConstraint& coupling) {
  step_->island.couplings.push_back({&coupling, step_->island.coupled_bodies.size()});
}

void DirectSolver::add_coupled_body(int body) { step_->island.coupled_bodies.push_back(body); }

int DirectSolver::joint_count() const { return step_->island.joints.size(); }

bool DirectSolver::solve(const IslandPools& pools, const btContactSolverInfo& info) {
  const bool only_contacts = joint_count() == 0 && step_->island.couplings.empty();
  const int max_rows = only_contacts ? kMaxRowsWithoutJoints : kMaxContactRows;
  if (pools.contacts.size() + pools.frictions.size() + pools.rollings.size() > max_rows) {
    counts_.too_large++;
    return false;
  }
  step_->island.pools = &pools;
  step_->island.info = &info;
  step_->island.h = static_cast<double>(info.m_timeStep);
  if (!step_->solve()) {
    counts_.fallbacks++;
    step_->fall_back();
    return false;
  }
  counts_.direct++;
  step_->write();
  if (measured_) residuals_ = step_->measure_residuals();
  step_->correct_positions();
  return true;
}

}  // namespace limber::sim::solver
