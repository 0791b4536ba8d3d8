// DirectSolver: order of the stages of a step, corrections of the solution, and its output.
#include "sim/solver/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {
namespace {

/// Exchanges of the active set of a tree before axes that have not converged are deferred.
constexpr int kMaxExchanges = 16;
/// Rounds in which axes may still be deferred once contacts are known.
constexpr int kMaxRounds = 8;
/// Motors and limits must not rotate a body by more than this in one step, rad; otherwise their rates are scaled down
/// to a rotation of kTurnGoal, which is less, since the other causes of the rotation don't scale with them.
constexpr double kMaxRotation = 0.5;
constexpr double kRotationGoal = 0.44;
/// Passes that restore the friction cone.
constexpr int kMaxConePasses = 2;
/// Passes of the drift correction.
constexpr int kMaxDriftPasses = 4;
/// The drift correction is removed if a pass changes it by more than this, m, and by more than twice an earlier change.
constexpr double kDivergingDrift = 1e-3;
/// Passes of the gyroscopic correction, and its tolerances: relative to the angular velocity perpendicular to the spin,
/// and to the whole angular velocity.
constexpr int kGyroPasses = 10;
constexpr double kGyroTolerance = 1e-5;
constexpr double kGyroSpinTolerance = 1e-7;
/// Passes that scale down drift corrections that add energy, by a little more than linear interpolation yields.
constexpr int kMaxEnergyPasses = 2;
constexpr double kEnergySafety = 0.95;
/// Fraction of the energy absorbed by locks that they may return, and the maximum of the stored energy, J.
constexpr double kReturnedFraction = 0.75;
constexpr double kMaxStoredEnergy = 1e6;
/// Velocity changes above this count as divergence: m/s, rad/s.
constexpr double kMaxVelocity = 1e5;

// Removes the warm-start impulses, which only the direct solver could have balanced, before the iterative solver
// starts.
void remove_warm_start(IslandPools& pools) {
  for (btConstraintArray* rows : {&pools.contacts, &pools.frictions, &pools.rollings}) {
    for (int i = 0; i < rows->size(); ++i) {
      btSolverConstraint& row = (*rows)[i];
      const btScalar impulse = -std::exchange(row.m_appliedImpulse, btScalar(0));
      btSolverBody& a = pools.bodies[row.m_solverBodyIdA];
      btSolverBody& b = pools.bodies[row.m_solverBodyIdB];
      a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
      b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
    }
  }
}

}  // namespace

void DirectSolver::begin() {
  links_.clear();
  gears_.clear();
}

void DirectSolver::add_joint(JointConstraint& joint, int body_a, int body_b) {
  links_.push_back({&joint, body_a, body_b, -1, 0, Vec3(0), Vec3(0)});
}

int DirectSolver::defer_violated() {
  int violated = 0;
  for (const Tree& t : trees_) violated += tree_rows_.defer_violated(t.first, t.last);
  return violated;
}

// Solves the trees with the present contact impulses, then the coupled rows, until no condition is violated.
bool DirectSolver::solve_velocities() {
  const double before = budget_.spent();
  const bool solved = solve_trees() && (coupled_.empty() || solve_coupled_rows()) && has_finite_velocities();
  solve_cost_ = budget_.spent() - before;
  return solved;
}

bool DirectSolver::solve_trees() {
  for (const Tree& t : trees_) {
    if (!tree_rows_.solve(t.first, t.last, kMaxExchanges)) return false;
    const bool has_deferred = !coupled_.empty() && tree_rows_.defer_remembered(t.first, t.last) > 0;
    if (has_deferred && !tree_rows_.factor_and_correct(t.first, t.last)) return false;
  }
  collect_deferred_axes();
  return true;
}

bool DirectSolver::solve_coupled_rows() {
  tree_rows_.save();
  for (CoupledRow& row : coupled_) row.saved_impulse = row.impulse;
  activate_contacts();
  for (int round = 0; round < kMaxRounds; ++round) {
    bool gears_deferred = false;
    double violation = 0;
    do {
      if (!update_delassus()) return false;
      gears_deferred = defer_ill_conditioned_gears();
      violation = gears_deferred ? 0 : solve_lcp(LcpSolve::full);
    } while (!gears_deferred && activate_contacts() > 0);
    int violated = gears_deferred ? 1 : defer_violated();
    // ill-conditioned: all motors and limits of trees with contacts are deferred, so that they yield within their force
    if ((!(violation < kMaxCoupledViolation) || round == kMaxRounds - 2) && defer_touched_trees() > 0) violated++;
    if (violated == 0) {
      if (!lcp_.friction_converged()) violation = solve_lcp(LcpSolve::refine);
      return std::isfinite(violation);
    }
    // impulses found with another active set must be discarded
    tree_rows_.restore();
    for (CoupledRow& row : coupled_) row.impulse = row.saved_impulse;
    for (const Tree& t : trees_) {
      if (!tree_rows_.factor_and_correct(t.first, t.last)) return false;
    }
    collect_deferred_axes();
  }
  return false;
}

RotationStep DirectSolver::rotation_step(int body, const Vec3& w, const IslandPools& pools, double h) const {
  const btRigidBody* rigid = pools.bodies[body].m_originalBody;
  if (rigid != nullptr) return split_rotation(*rigid, w, h);
  RotationStep turn;
  turn.tumble = w;
  return turn;
}

// Velocity of a body after the solve.
Spatial DirectSolver::solved_velocity(int body, const IslandPools& pools) const {
  const int node = node_of_[at(body)];
  return node < 0 ? velocity(body, pools) : velocity(body, pools) + tree_rows_.change(node);
}

// True if a motor on this axis of a joint drives a spin of one of its bodies.
bool DirectSolver::drives_spin(const Link& link, int axis, const IslandPools& pools, double h) const {
  if (axis < 3) return false;
  const Vec3 axis_direction = from_bt(link.joint->linear_axis(axis - 3));
  return std::ranges::any_of(std::array{link.body_a, link.body_b}, [&](int body) {
    const RotationStep turn = rotation_step(body, solved_velocity(body, pools).angular, pools, h);
    return turn.spin != 0 && std::fabs(glm::dot(turn.axis, axis_direction)) > 0.99;
  });
}

// Scales down the target rates of motors and limits in trees where a body would rotate too far in one step, spins
// excluded. Returns true if something changed.
bool DirectSolver::limit_rotation(const IslandPools& pools, double h) {
  bool changed = false;
  for (const Tree& t : trees_) {
    double fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      const Spatial v = velocity(body_of_[at(i)], pools) + tree_rows_.change(i);
      if (glm::dot(v.angular, v.angular) * h * h <= kMaxRotation * kMaxRotation) continue;
      const double tumble_speed = glm::length(rotation_step(body_of_[at(i)], v.angular, pools, h).tumble);
      if (t.last - t.first > 1 || link_of_[at(i)] >= 0) fastest = std::max(fastest, tumble_speed);
      if (tumble_speed * h > kMaxRotation)
        record_clamp(*pools.bodies[body_of_[at(i)]].m_originalBody, tumble_speed - kRotationGoal / h);
    }
    if (!(fastest * h > kMaxRotation)) continue;
    for (int i = t.first; i < t.last; ++i) {
      for (TreeRow& row : tree_rows_.rows(i)) {
        if (!row.bounded() || row.constant()) continue;
        if (link_of_[at(i)] >= 0 && drives_spin(links_[at(link_of_[at(i)])], row.axis, pools, h)) continue;
        row.velocity *= kRotationGoal / (fastest * h);
        changed = true;
      }
    }
  }
  return changed;
}

// Collects bodies that rotate so fast that their gyroscopic torque depends on the joints' reactions.
void DirectSolver::collect_gyroscopes(const IslandPools& pools, double h) {
  gyroscopic_.clear();
  gyro_passes_ = 0;
  for (const Tree& t : trees_) {
    if (t.last - t.first == 1 && link_of_[at(t.first)] < 0) continue;
    for (int i = t.first; i < t.last; ++i) {
      const btSolverBody& b = pools.bodies[body_of_[at(i)]];
      const double before = static_cast<double>(b.m_angularVelocity.length());
      const double after = glm::length(solved_velocity(body_of_[at(i)], pools).angular);
      if (!(std::max(before, after) * h > kSlowRotation)) continue;
      const Sym3& moment = tree_rows_.forest.node(i).inertia.moment;
      const Vec3 applied = moment * gyroscopic_change(*b.m_originalBody, h);
      gyroscopic_.push_back({i, (moment.xx + moment.yy + moment.zz) / 3, applied, Vec3(0), {}, {}});
    }
  }
}

// Evaluates gyroscopic torques at the middle of the step, with the velocities found: a fixed point, accelerated by
// Anderson mixing (1965). Returns true if loads have changed and everything must be solved again.
bool DirectSolver::correct_gyroscopes(const IslandPools& pools, double h) {
  if (gyroscopic_.empty() || gyro_passes_ >= kGyroPasses) return false;
  bool pending = false;
  for (GyroscopicImpulse& g : gyroscopic_) {
    const int body = body_of_[at(g.node)];
    const Vec3 before = from_bt(pools.bodies[body].m_angularVelocity);
    const Vec3 middle = (before + solved_velocity(body, pools).angular) / 2.0;
    const btRigidBody& rigid = *pools.bodies[body].m_originalBody;
    const Vec3 residual = h * gyroscopic_torque(rigid, middle, h) - g.impulse;
    g.residual_changes[1] = g.residual_changes[0];
    g.residual_changes[0] = residual - g.residual;
    g.residual = residual;
    const double tumble_speed = glm::length(split_rotation(rigid, middle, h).tumble);
    const double tolerance = kGyroTolerance * tumble_speed + kGyroSpinTolerance * glm::length(middle);
    pending = pending || glm::length(residual) > tolerance * g.scale;
  }
  if (!pending) return false;
  // least squares: |residual - sum of weight·change| over the last one or two passes
  const int history = std::min(gyro_passes_++, 2);
  double normal[2][2] = {};
  double rhs[2] = {};
  for (const GyroscopicImpulse& g : gyroscopic_) {
    const double scale = 1 / (g.scale * g.scale);
    for (int i = 0; i < history; ++i) {
      rhs[i] += scale * glm::dot(g.residual_changes[at(i)], g.residual);
      for (int j = 0; j < history; ++j)
        normal[i][j] += scale * glm::dot(g.residual_changes[at(i)], g.residual_changes[at(j)]);
    }
  }
  double weight[2] = {};
  const double determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
  if (history == 2 && determinant > 1e-9 * normal[0][0] * normal[1][1]) {
    weight[0] = (rhs[0] * normal[1][1] - rhs[1] * normal[0][1]) / determinant;
    weight[1] = (rhs[1] * normal[0][0] - rhs[0] * normal[1][0]) / determinant;
  } else if (history > 0 && normal[0][0] > 0) {
    weight[0] = rhs[0] / normal[0][0];
  }
  for (GyroscopicImpulse& g : gyroscopic_) {
    Vec3 change = g.residual;
    for (int i = 0; i < history; ++i) change -= weight[i] * (g.impulse_changes[at(i)] + g.residual_changes[at(i)]);
    g.impulse_changes[1] = g.impulse_changes[0];
    g.impulse_changes[0] = change;
    g.impulse += change;
    tree_rows_.forest.node(g.node).load.angular += change;
  }
  return true;
}

// Work of a tree's locks in the step, J: each impulse times the mean of its rate before and after the step. Ideal locks
// do no work.
double DirectSolver::work_of_locks(const Tree& tree, const IslandPools& pools) const {
  double work = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    if (link_of_[at(i)] < 0) continue;
    const Link& link = links_[at(link_of_[at(i)])];
    const JointConstraint& joint = *link.joint;
    const auto velocity_before = [&](int body) {
      const btSolverBody& b = pools.bodies[body];
      return Spatial{from_bt(b.m_linearVelocity), from_bt(b.m_angularVelocity)};
    };
    const Spatial a = velocity_before(link.body_a);
    const Spatial b = velocity_before(link.body_b);
    const Vec3 drift = translated(b, from_bt(joint.arm_b())).linear - translated(a, from_bt(joint.arm_a())).linear;
    const Vec3 spin = b.angular - a.angular;
    for (const TreeRow& row : tree_rows_.rows(i)) {
      if (row.bounded() || !row.hard()) continue;
      const double rate = row.axis < 3 ? glm::dot(from_bt(joint.linear_axis(row.axis)), drift)
                                       : glm::dot(from_bt(joint.dual_axis(row.axis - 3)), spin);
      work += row.impulse * (rate + tree_rows_.rate(i, row.axis)) / 2;
    }
  }
  return work;
}

// The tree's first joint, which stores the energy of all its locks.
JointConstraint& DirectSolver::first_joint(const Tree& tree) const {
  const int root = link_of_[at(tree.first)] < 0 ? tree.first + 1 : tree.first;
  return *links_[at(link_of_[at(root)])].joint;
}

// True if the tree has joints, and no motor drives any of them.
bool DirectSolver::is_passive(const Tree& tree) const {
  if (tree.last - tree.first == 1 && link_of_[at(tree.first)] < 0) return false;
  return !has_motors(tree);
}

bool DirectSolver::has_motors(const Tree& tree) const {
  for (int i = tree.first; i < tree.last; ++i) {
    for (const TreeRow& row : tree_rows_.rows(i)) {
      if (row.kind == TreeRow::motor && row.upper > row.lower) return true;
    }
  }
  return false;
}

// Scales down drift corrections of passive trees whose locks would add energy. Returns true if something changed.
bool DirectSolver::limit_drift_energy(const IslandPools& pools, double h) {
  bool changed = false;
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const Tree& tree = trees_[t];
    if (!is_passive(tree)) continue;
    const double work = work_of_locks(tree, pools);
    const double allowed_work = first_joint(tree).lock_energy();
    if (!(work > allowed_work)) continue;
    const double uncorrected = uncorrected_work_[t];
    const double fraction =
        uncorrected < allowed_work ? kEnergySafety * (allowed_work - uncorrected) / (work - uncorrected) : 0;
    for (int i = tree.first; i < tree.last; ++i) {
      if (link_of_[at(i)] < 0) continue;
      Link& link = links_[at(link_of_[at(i)])];
      changed = changed || link.applied_drift != Vec3(0);
      link.predicted_drift = link.applied_drift * fraction;
      apply_drift_correction(link, h);
    }
  }
  return changed;
}

bool DirectSolver::has_finite_velocities() const {
  for (int i = 0; i < static_cast<int>(body_of_.size()); ++i) {
    const Spatial& c = tree_rows_.change(i);
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(c.linear[k]) < kMaxVelocity) || !(std::fabs(c.angular[k]) < kMaxVelocity)) return false;
    }
  }
  return true;
}

// Solves everything except drift and gyroscopic corrections.
bool DirectSolver::solve_without_corrections(IslandPools& pools, double h) {
  coupled_.clear();
  lcp_factor_version_ = 0;
  known_row_ids_.clear();
  known_axes_.clear();
  collect_contacts(pools);
  collect_loops(pools);
  collect_gears(pools);
  fixed_coupled_ = coupled_.size();
  bool solved = solve_velocities();
  for (int pass = 0; pass < kMaxConePasses && solved && restore_friction_cone(); ++pass) solved = solve_velocities();
  for (int pass = 0; pass < 3 && solved && limit_rotation(pools, h); ++pass) solved = solve_velocities();
  return solved;
}

// Iterates the drift and gyroscopic corrections until they converge, then limits the energy that they add to passive
// trees.
bool DirectSolver::correct_drift(const IslandPools& pools, double h) {
  needs_closing_ = false;
  uncorrected_work_.clear();
  for (const Tree& t : trees_) uncorrected_work_.push_back(is_passive(t) ? work_of_locks(t, pools) : 0);
  bool solved = true;
  bool drift_pending = true;
  bool gyro_pending = true;
  double smallest_change = kMaxVelocity;
  const auto budget_left = [this] { return !budget_.exceeded(solve_cost_); };
  collect_gyroscopes(pools, h);
  for (int pass = 0; solved && (drift_pending || gyro_pending) && budget_left(); ++pass) {
    gyro_pending = correct_gyroscopes(pools, h);
    if (pass < kMaxDriftPasses && drift_pending) {
      const double change = update_drift_correction(pools, h);
      drift_pending = change > 0;
      if (change > kDivergingDrift && change > 2 * smallest_change) {
        remove_drift_correction(h);  // close_joints() corrects the position error afterwards
        needs_closing_ = true;
        return solve_velocities();
      }
      smallest_change = std::min(smallest_change, change);
    }
    if (pass >= kMaxDriftPasses && !gyro_pending) break;
    if (drift_pending || gyro_pending) solved = solve_velocities();
  }
  needs_closing_ = needs_closing_ || drift_pending;
  for (int pass = 0; pass < kMaxEnergyPasses && solved && limit_drift_energy(pools, h); ++pass)
    solved = solve_velocities();
  return solved;
}

bool DirectSolver::solve(IslandPools pools, const btContactSolverInfo& info) {
  const int max_rows = links_.empty() ? kMaxRowsWithoutJoints : kMaxContactRows;
  if (pools.contacts.size() + pools.frictions.size() + pools.rollings.size() > max_rows) {
    counts_.too_large++;
    return false;
  }
  const double h = static_cast<double>(info.m_timeStep);
  step_ = h;
  before_clamp_.clear();
  budget_.reset();
  bool solved = build_forest(pools);
  if (solved && clamp_spin(pools, h, ClampStage::before)) solved = build_forest(pools);
  if (solved) solved = solve_without_corrections(pools, h);
  // beyond the budget the clamp waits for the next step
  if (solved && !budget_.exceeded() && clamp_spin(pools, h, ClampStage::after)) {
    solved = build_forest(pools) && solve_without_corrections(pools, h);
  }
  if (solved) solved = correct_drift(pools, h);
  if (!solved) {
    counts_.fallbacks++;
    undo_spin_clamp(pools);
    remove_warm_start(pools);
    for (const Link& link : links_) {
      link.joint->reset_warm_start();
      link.joint->active_set_memory().fill(0);
    }
    for (const GearLink& link : gears_) link.gear->forget_impulses();
    return false;
  }
  counts_.direct++;
  for (const Tree& t : trees_) {
    if (!is_passive(t)) continue;
    double& lock_energy = first_joint(t).lock_energy();
    const double work = work_of_locks(t, pools);
    lock_energy = std::clamp(lock_energy - (work < 0 ? kReturnedFraction : 1.0) * work, 0.0, kMaxStoredEnergy);
  }
  write(pools);
  apply_split_impulse(pools, info);
  if (measured_) measure_residuals(pools);
  if (needs_closing_) close_joints(pools, info);
  return true;
}

void DirectSolver::write(IslandPools& pools) {
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    btSolverBody& body = pools.bodies[body_of_[i]];
    const Spatial& change = tree_rows_.change(static_cast<int>(i));
    body.m_deltaLinearVelocity = to_bt(change.linear);
    body.m_deltaAngularVelocity = to_bt(change.angular);
  }
  for (const CoupledRow& row : coupled_) {
    if (row.contact != nullptr) row.contact->m_appliedImpulse = to_scalar(row.impulse);
  }
  for (const Link& link : links_) {
    impulses_.clear();
    if (link.node >= 0) {
      for (const TreeRow& row : tree_rows_.rows(link.node)) impulses_.push_back(row.impulse);
      link.joint->active_set_memory() = tree_rows_.active_set(link.node);
    } else {
      for (int r = 0; r < static_cast<int>(link.joint->planned().size()); ++r) {
        impulses_.push_back(coupled_[at(link.coupled_row + r)].impulse);
      }
    }
    link.joint->set_impulses(impulses_);
  }
  for (const GearLink& link : gears_) link.gear->set_impulse(coupled_[at(link.coupled_row)].impulse);
}

}  // namespace limber
