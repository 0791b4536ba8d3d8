// Coupled rows around the trees: contacts, friction, joints that close loops, gears, and deferred axes. All are solved
// as one LCP with the Delassus matrix of the trees.
#include <algorithm>
#include <cmath>

#include "sim/collision/contact_friction.h"
#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

/// Work budget of a step, in multiply-adds: constant, per body and per pair of contact rows. It is multiplied by
/// kUndeferredFactor while no motor is deferred, because the accuracy of contacts is visible then.
constexpr double kBaseWork = 5e4;
constexpr double kWorkPerBody = 2e3;
constexpr double kWorkPerContactPair = 1;
constexpr double kUndeferredFactor = 4;
/// Softness of contact and loop rows, relative to the response of their two bodies alone. Without it, if servos or
/// locks block both sides of a contact, or a loop locks an axis twice, the diagonal would be a rounding error and the
/// impulse unbounded.
constexpr double kMinSoftness = 1e-6;
/// The same for the split impulse: penetration is not corrected if joints reduce the response to less than about this
/// fraction of the response of the two bodies alone.
constexpr double kMinSplitSoftness = 1e-3;
/// Largest speed of penetration correction, m/s.
constexpr double kMaxSplitSpeed = 2;
/// Largest rotation of a body by the penetration correction of one step, rad. The correction of the whole island is
/// scaled down to it, because rotating a body without changing its velocity changes its energy.
constexpr double kMaxSplitRotation = 0.05;

// Inverse effective mass of one body alone.
double body_mobility(const btSolverBody& body, const Spatial& jacobian) {
  const btRigidBody* rigid = body.m_originalBody;
  if (rigid == nullptr) return 0;
  const btVector3 angular = to_bt(jacobian.angular);
  return glm::dot(jacobian.linear, jacobian.linear) * static_cast<double>(rigid->getInvMass()) +
         static_cast<double>(angular.dot(rigid->getInvInertiaTensorWorld() * angular));
}

/// Friction beyond the cone by this factor is reduced.
constexpr double kConeTolerance = 1.02;

Spatial make_spatial(const btVector3& linear, const btVector3& angular) { return {from_bt(linear), from_bt(angular)}; }

BoxedLcp::Status to_lcp_status(TreeRow::Status status) {
  return status == TreeRow::deferred   ? BoxedLcp::unknown
         : status == TreeRow::active   ? BoxedLcp::free
         : status == TreeRow::at_lower ? BoxedLcp::at_lower
                                       : BoxedLcp::at_upper;
}

TreeRow::Status to_tree_status(BoxedLcp::Status status) {
  return status == BoxedLcp::unknown    ? TreeRow::deferred
         : status == BoxedLcp::free     ? TreeRow::active
         : status == BoxedLcp::at_lower ? TreeRow::at_lower
                                        : TreeRow::at_upper;
}

}  // namespace

void DirectSolver::add_contact(btSolverConstraint& row, int normal, double max_impulse) {
  CoupledRow out;
  out.a = {node_of_[at(row.m_solverBodyIdA)], make_spatial(row.m_contactNormal1, row.m_relpos1CrossNormal)};
  out.b = {node_of_[at(row.m_solverBodyIdB)], make_spatial(row.m_contactNormal2, row.m_relpos2CrossNormal)};
  const double step = static_cast<double>(row.m_jacDiagABInv);
  out.contact = &row;
  out.mobility = step > 0 ? 1 / step : 0;
  out.target = step > 0 ? static_cast<double>(row.m_rhs) / step : 0;
  out.softness = step > 0 ? static_cast<double>(row.m_cfm) / step + kMinSoftness * out.mobility : 0;
  out.impulse = out.initial_impulse = static_cast<double>(row.m_appliedImpulse);
  // a normal's own softness acts on the change since the previous step, so that bodies at rest don't sink
  if (normal < 0 && step > 0) out.target += static_cast<double>(row.m_cfm) / step * out.impulse;
  out.lower = static_cast<double>(row.m_lowerLimit);
  out.upper = static_cast<double>(row.m_upperLimit);
  out.normal = normal;
  out.friction = static_cast<double>(row.m_friction);
  out.max_impulse = max_impulse;
  // inactive until activate_contacts() finds that it presses
  out.inactive = out.impulse == 0 && (normal < 0 || coupled_[at(normal)].inactive);
  if (normal >= 0 && !out.inactive) coupled_[at(normal)].inactive = false;
  coupled_.push_back(out);
}

void DirectSolver::collect_contacts(IslandPools& pools) {
  for (int i = 0; i < pools.contacts.size(); ++i) add_contact(pools.contacts[i], -1, 0);
  for (int i = 0; i < pools.frictions.size(); ++i) {
    add_contact(pools.frictions[i], pools.frictions[i].m_frictionIndex, 0);
  }
  for (int i = 0; i < pools.rollings.size(); ++i) {
    add_contact(pools.rollings[i], pools.rollings[i].m_frictionIndex, 0);
  }
}

void DirectSolver::collect_loops(const IslandPools& pools) {
  for (Link& link : links_) {
    if (link.node >= 0) continue;
    link.coupled_row = static_cast<int>(coupled_.size());
    for (const JointConstraint::Row& row : link.joint->planned()) {
      const JointConstraint::Jacobian j = link.joint->jacobian(row.axis);
      CoupledRow out;
      out.loop = true;
      out.a = {node_of_[at(link.body_a)], make_spatial(-j.linear, j.angular_a)};
      out.b = {node_of_[at(link.body_b)], make_spatial(j.linear, j.angular_b)};
      out.target = static_cast<double>(row.velocity) - dot(out.a.jacobian, velocity(link.body_a, pools)) -
                   dot(out.b.jacobian, velocity(link.body_b, pools));
      out.mobility = body_mobility(pools.bodies[link.body_a], out.a.jacobian) +
                     body_mobility(pools.bodies[link.body_b], out.b.jacobian);
      out.softness = static_cast<double>(row.softness) + kMinSoftness * out.mobility;
      out.lower = static_cast<double>(row.lower);
      out.upper = static_cast<double>(row.upper);
      coupled_.push_back(out);
    }
  }
}

// Each gear is one row on up to four bodies.
void DirectSolver::collect_gears(const IslandPools& pools) {
  gear_jacobians_.clear();
  for (GearLink& link : gears_) {
    link.coupled_row = static_cast<int>(coupled_.size());
    const GearConstraint::Row& row = link.gear->row();
    CoupledRow out;
    out.loop = true;
    out.gear = static_cast<int>(gear_jacobians_.size());
    std::array<BodyJacobian, 2>& extra_jacobians = gear_jacobians_.emplace_back();
    out.target = row.velocity;
    const std::span<const GearConstraint::BodyJacobian> bodies = link.gear->jacobians();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      BodyJacobian& body = i == 0 ? out.a : i == 1 ? out.b : extra_jacobians[i - 2];
      body = {node_of_[at(link.bodies[i])], make_spatial(bodies[i].linear, bodies[i].angular)};
      out.target -= dot(body.jacobian, velocity(link.bodies[i], pools));
    }
    out.softness = row.softness;
    out.mobility = row.mobility;
    out.lower = -row.bound;
    out.upper = row.bound;
    coupled_.push_back(out);
  }
}

// Replaces the deferred axes in coupled_, which follow contacts, loops and gears.
void DirectSolver::collect_deferred_axes() {
  coupled_.resize(fixed_coupled_);
  for (TreeRow& row : tree_rows_.rows()) {
    if (row.status != TreeRow::deferred) continue;
    CoupledRow out;
    out.axis = &row;
    out.a.node = row.node;
    out.softness = row.softness;
    out.impulse = row.impulse;
    out.lower = row.lower;
    out.upper = row.upper;
    out.initial_status = to_lcp_status(row.initial_status);
    out.initial_impulse = row.initial_impulse;
    coupled_.push_back(out);
  }
  set_work_limit();
}

void DirectSolver::set_work_limit() {
  const auto rows = static_cast<double>(fixed_coupled_);
  const double limit = kBaseWork + kWorkPerBody * tree_rows_.forest.size() + kWorkPerContactPair * rows * rows;
  budget_.set_limit(coupled_.size() > fixed_coupled_ ? limit : kUndeferredFactor * limit);
}

// Present rate of a row, as a change from the start of the step.
double DirectSolver::rate_of(const CoupledRow& row) const {
  double rate = 0;
  for_each_jacobian(row, [&](const BodyJacobian& body) { rate += dot(body.jacobian, tree_rows_.change(body.node)); });
  return rate;
}

void DirectSolver::apply_load(const CoupledRow& row, double impulse) {
  if (row.axis != nullptr) {
    tree_rows_.forest.node(row.axis->node).input[row.axis->axis] = impulse;
    return;
  }
  for_each_jacobian(
      row, [&](const BodyJacobian& body) { tree_rows_.forest.node(body.node).load += body.jacobian * impulse; });
}

// Activates inactive contacts that the present velocities would violate, and their friction. Returns the number of
// rows.
int DirectSolver::activate_contacts() {
  int activated = 0;
  for (std::size_t i = 0; i < fixed_coupled_; ++i) {
    CoupledRow& row = coupled_[i];
    if (!row.inactive) continue;
    row.inactive = row.normal < 0 ? row.target - rate_of(row) <= kCoupledTolerance : coupled_[at(row.normal)].inactive;
    activated += row.inactive ? 0 : 1;
  }
  return activated;
}

// Each friction row has its own bounds; those of both rows form a square that touches the cone on its axes only. Where
// both rows together exceed the cone, their bounds are replaced by the rectangle within the cone that has its corner in
// the direction of the present force. Returns true if something changed.
bool DirectSolver::restore_friction_cone() {
  bool changed = false;
  for (std::size_t i = 0; i + 1 < fixed_coupled_; ++i) {
    CoupledRow& first = coupled_[i];
    CoupledRow& second = coupled_[i + 1];
    if (first.contact == nullptr || first.normal < 0) continue;
    if (first.contact->m_overrideNumSolverIterations != friction_along) continue;
    const double max_force = static_cast<double>(first.contact->m_friction) * coupled_[at(first.normal)].impulse;
    const double force = fixed::hypot(first.impulse, second.impulse);
    if (!(force > kConeTolerance * max_force)) continue;
    for (CoupledRow* row : {&first, &second}) {
      row->friction = static_cast<double>(row->contact->m_friction) * std::fabs(row->impulse) / force;
    }
    changed = true;
  }
  return changed;
}

// Defers the axes of gears whose impulses the trees (nearly) don't respond to, because motors, limits or locks hold
// both axes.
bool DirectSolver::defer_ill_conditioned_gears() {
  int deferred = 0;
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = coupled_[at(lcp_rows_[at(i)])];
    const bool ill_conditioned =
        row.gear >= 0 && !(lcp_.response(i, i) - row.softness > kIllConditioned * row.mobility);
    if (ill_conditioned) deferred += defer_gear(row);
  }
  return deferred > 0;
}

// Defers the motors and limits of a gear's axes; where locks hold these, disables the gear for the step.
int DirectSolver::defer_gear(CoupledRow& row) {
  int deferred = 0;
  const GearConstraint& gear = *gears_[at(row.gear)].gear;
  for (const Link& link : links_) {
    if (link.node < 0) continue;
    if (link.joint == &gear.joint_a()) deferred += tree_rows_.defer_axis(link.node, gear.axis_a());
    if (link.joint == &gear.joint_b()) deferred += tree_rows_.defer_axis(link.node, gear.axis_b());
  }
  if (deferred == 0) row.lower = row.upper = 0;
  return deferred;
}

int DirectSolver::defer_touched_trees() {
  int deferred = 0;
  for (const int i : lcp_rows_) {
    for_each_jacobian(coupled_[at(i)], [&](const BodyJacobian& body) {
      const Tree& tree = trees_[at(tree_at(body.node))];
      deferred += tree_rows_.defer_all(tree.first, tree.last);
    });
  }
  return deferred;
}

// Solves the LCP with the present matrix and applies its impulses to the trees. Returns the largest violation.
double DirectSolver::solve_lcp(LcpSolve how) {
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = coupled_[at(lcp_rows_[at(i)])];
    row.start_impulse = row.axis != nullptr ? row.axis->impulse : row.impulse;
    lcp_.row(i) = {
        row.axis != nullptr ? tree_rows_.residual(*row.axis) : row.target - rate_of(row) - row.softness * row.impulse,
        row.start_impulse,
        row.lower,
        row.upper,
        row.normal < 0 ? -1 : lcp_index_[at(row.normal)],
        row.friction,
        row.max_impulse,
        row.initial_status,
        row.initial_impulse - row.start_impulse};
  }
  const double violation = how == LcpSolve::full ? lcp_.solve(kCoupledTolerance) : lcp_.refine_friction();
  for (int i = 0; i < lcp_.size(); ++i) {
    CoupledRow& row = coupled_[at(lcp_rows_[at(i)])];
    row.impulse = lcp_.row(i).impulse;
    row.initial_impulse = std::isfinite(row.impulse) ? row.impulse : row.start_impulse;
    row.initial_status = lcp_.status(i);
    const double change = row.impulse - row.start_impulse;
    if (row.axis != nullptr) {
      row.axis->initial_status = to_tree_status(row.initial_status);
      row.axis->initial_impulse = row.initial_impulse;
      tree_rows_.add_pending(*row.axis, change);
    } else {
      apply_load(row, change);
    }
  }
  for (const Tree& t : trees_) tree_rows_.correct(t.first, t.last);
  return violation;
}

// Split impulse: corrects penetration by displacements that leave no velocity, as Bullet does, but with the response of
// the trees, so that joints stay closed.
void DirectSolver::apply_split_impulse(IslandPools& pools, const btContactSolverInfo& info) {
  if (!info.m_splitImpulse || info.m_splitImpulseTurnErp <= 0) return;
  const auto is_normal = [](const CoupledRow& row) { return row.contact != nullptr && row.normal < 0; };
  const auto target_speed = [](const CoupledRow& row) {
    const double step = static_cast<double>(row.contact->m_jacDiagABInv);
    return step > 0 ? std::min(static_cast<double>(row.contact->m_rhsPenetration) / step, kMaxSplitSpeed) : 0;
  };
  if (std::none_of(coupled_.begin(), coupled_.end(),
                   [&](const CoupledRow& r) { return is_normal(r) && target_speed(r) > 0; }))
    return;
  for (CoupledRow& row : coupled_) row.start_impulse = 0;
  split_rows_.clear();
  for (int i = 0; i < static_cast<int>(fixed_coupled_); ++i) {
    const CoupledRow& row = coupled_[at(i)];
    if (is_normal(row) || (row.loop && row.lower < -kTreeInfinity && row.upper > kTreeInfinity))
      split_rows_.push_back(i);
  }
  const int count = static_cast<int>(split_rows_.size());
  build_delassus(split_lcp_, split_rows_);
  for (int i = 0; i < count; ++i) {
    const CoupledRow& row = coupled_[at(split_rows_[at(i)])];
    BoxedLcp::Row& lcp_row = split_lcp_.row(i);
    lcp_row.residual = row.loop ? 0 : target_speed(row);
    lcp_row.lower = row.loop ? row.lower : 0;
    lcp_row.upper = row.upper;
    split_lcp_.response(i, i) += row.softness + kMinSplitSoftness * row.mobility;
  }
  split_lcp_.solve(kCoupledTolerance);
  for (int i = 0; i < tree_rows_.forest.size(); ++i) {
    tree_rows_.forest.node(i).input.fill(0);
    tree_rows_.forest.node(i).load = {};
  }
  for (int i = 0; i < count; ++i) apply_load(coupled_[at(split_rows_[at(i)])], split_lcp_.row(i).impulse);
  for (const Tree& t : trees_) tree_rows_.forest.respond(t.first, t.last);
  double fastest = kMaxSplitRotation / static_cast<double>(info.m_timeStep);
  const double max_angular = fastest;
  for (int i = 0; i < tree_rows_.forest.size(); ++i) {
    fastest = std::max(fastest, glm::length(tree_rows_.forest.node(i).velocity_change.angular));
  }
  const double turn_erp = static_cast<double>(info.m_splitImpulseTurnErp);  // Bullet multiplies by it
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const Spatial change = tree_rows_.forest.node(static_cast<int>(i)).velocity_change * (max_angular / fastest);
    pools.bodies[body_of_[i]].m_pushVelocity = to_bt(change.linear);
    pools.bodies[body_of_[i]].m_turnVelocity = to_bt(change.angular / turn_erp);
  }
}

// Measures the natural residuals of all rows at the solved velocities.
void DirectSolver::measure_residuals(const IslandPools& pools) {
  residuals_ = {};
  const auto natural_residual = [](double residual, double impulse, double lower, double upper, double mobility) {
    const double after = std::clamp(impulse + residual / mobility, lower, std::max(lower, upper));
    return std::fabs(after - impulse) * mobility;
  };
  // calculated from the bodies' velocities, independently of the solver's rates
  const auto velocity_of = [&](int body) {
    const int node = node_of_[at(body)];
    return node < 0 ? velocity(body, pools) : velocity(body, pools) + tree_rows_.change(node);
  };
  for (const Link& link : links_) {
    if (link.node < 0) continue;
    const Spatial a = velocity_of(link.body_a);
    const Spatial b = velocity_of(link.body_b);
    for (const TreeRow& row : tree_rows_.rows(link.node)) {
      const JointConstraint::Jacobian j = link.joint->jacobian(row.axis);
      const double rate = dot(make_spatial(-j.linear, j.angular_a), a) + dot(make_spatial(j.linear, j.angular_b), b);
      const TreeNode& n = tree_rows_.forest.node(row.node);
      const double mobility = 1 / dot(n.axis[row.axis], n.inertia * n.axis[row.axis]) + row.softness;
      const double violation = natural_residual(row.velocity - row.softness * row.impulse - rate, row.impulse,
                                                row.lower, row.upper, mobility);
      double& largest = row.bounded() ? residuals_.bounded : residuals_.locked;
      largest = std::max(largest, violation);
    }
  }
  for (int i = 0; i < static_cast<int>(coupled_.size()); ++i) {
    const CoupledRow& row = coupled_[at(i)];
    if (row.axis != nullptr) continue;
    const double max_friction = row.normal < 0 ? 0 : row.friction * std::max(coupled_[at(row.normal)].impulse, 0.0);
    const double bound = row.max_impulse > 0 ? std::min(max_friction, row.max_impulse) : max_friction;
    const double residual = row.target - rate_of(row) - row.softness * row.impulse;
    const double violation = natural_residual(
        residual, row.impulse, row.normal < 0 ? row.lower : -bound, row.normal < 0 ? row.upper : bound,
        std::max(lcp_index_[at(i)] < 0 ? row.mobility : lcp_.response(lcp_index_[at(i)], lcp_index_[at(i)]), 1e-9));
    residuals_.contact = std::max(residuals_.contact, violation);
  }
}

}  // namespace limber
