// CoupledRows: converts contacts, loops, gears, tendons, limits of ball joints and deferred axes to rows.
#include "sim/solver/coupled_rows.h"

#include <algorithm>
#include <cmath>

#include "sim/collision/contact_friction.h"

namespace limber::sim::solver {
namespace {

/// Softness of contact and loop rows, relative to the response of their two bodies alone. Without it, if servos or
/// locks block both sides of a contact, or a loop locks an axis twice, the diagonal would be a rounding error and the
/// impulse unbounded.
constexpr double kMinSoftness = 1e-6;
/// Friction beyond the cone by this factor is reduced.
constexpr double kConeTolerance = 1.02;

// Inverse effective mass of one body alone.
double body_mobility(const btSolverBody& body, const Spatial& jacobian) {
  const btRigidBody* rigid = body.m_originalBody;
  if (rigid == nullptr) return 0;
  const btVector3 angular = bullet::to_bt(jacobian.angular);
  return glm::dot(jacobian.linear, jacobian.linear) * static_cast<double>(rigid->getInvMass()) +
         static_cast<double>(angular.dot(rigid->getInvInertiaTensorWorld() * angular));
}

BoxedLcp::Status to_lcp_status(AxisRow::Status status) {
  return status == AxisRow::deferred   ? BoxedLcp::unknown
         : status == AxisRow::active   ? BoxedLcp::free
         : status == AxisRow::at_lower ? BoxedLcp::at_lower
                                       : BoxedLcp::at_upper;
}

}  // namespace

void CoupledRows::collect() {
  rows_.clear();
  collect_contacts();
  collect_loops();
  collect_couplings();
  collect_ball_limits();
  fixed_count_ = rows_.size();
}

void CoupledRows::add_contact(btSolverConstraint& row, int normal) {
  CoupledRow out;
  out.a = {trees_.node_of(row.m_solverBodyIdA), make_spatial(row.m_contactNormal1, row.m_relpos1CrossNormal)};
  out.b = {trees_.node_of(row.m_solverBodyIdB), make_spatial(row.m_contactNormal2, row.m_relpos2CrossNormal)};
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
  // inactive until activate_contacts() finds that it presses
  out.inactive = out.impulse == 0 && (normal < 0 || rows_[normal].inactive);
  if (normal >= 0 && !out.inactive) rows_[normal].inactive = false;
  rows_.push_back(out);
}

void CoupledRows::collect_contacts() {
  const IslandPools& pools = *island_.pools;
  for (int i = 0; i < pools.contacts.size(); ++i) add_contact(pools.contacts[i], -1);
  for (btConstraintArray* frictions : {&pools.frictions, &pools.rollings}) {
    for (int i = 0; i < frictions->size(); ++i) add_contact((*frictions)[i], (*frictions)[i].m_frictionIndex);
  }
}

void CoupledRows::collect_loops() {
  loop_rows_.assign(island_.joints.size(), -1);
  for (int i = 0; i < island_.joints.size(); ++i) {
    const Island::Joint& joint = island_.joints[i];
    if (trees_.node_of_joint(i) >= 0) continue;
    loop_rows_[i] = rows_.size();
    for (const bullet::JointRow& row : joint.constraint->rows()) {
      set_pair(rows_.emplace_back(), joint, joint.constraint->pose().jacobian(row.axis), row);
    }
  }
}

// Sets a row between the two bodies of a joint.
void CoupledRows::set_pair(CoupledRow& row, const Island::Joint& joint, const bullet::AxisJacobian& jacobian,
                           const bullet::JointRow& planned) {
  row.loop = true;
  row.a = {trees_.node_of(joint.body_a), make_spatial(-jacobian.linear, jacobian.angular_a)};
  row.b = {trees_.node_of(joint.body_b), make_spatial(jacobian.linear, jacobian.angular_b)};
  row.target = static_cast<double>(planned.velocity) - dot(row.a.jacobian, island_.velocity(joint.body_a)) -
               dot(row.b.jacobian, island_.velocity(joint.body_b));
  row.mobility = body_mobility(island_.body(joint.body_a), row.a.jacobian) +
                 body_mobility(island_.body(joint.body_b), row.b.jacobian);
  row.softness = static_cast<double>(planned.softness) + kMinSoftness * row.mobility;
  row.lower = static_cast<double>(planned.lower);
  row.upper = static_cast<double>(planned.upper);
}

// The axes of these rows are no axes of the trees.
void CoupledRows::collect_ball_limits() {
  ball_rows_.resize(island_.joints.size());
  for (int i = 0; i < island_.joints.size(); ++i) {
    const bullet::BallLimits& limits = island_.joints[i].constraint->ball_limits();
    ball_rows_[i] = rows_.size();
    for (int r = 0; r < limits.count(); ++r) {
      CoupledRow& row = rows_.emplace_back();
      set_pair(row, island_.joints[i], limits[r].jacobian(), limits[r].row);
      row.ball = i;
    }
  }
}

// Each gear or tendon is one row.
void CoupledRows::collect_couplings() {
  first_coupling_ = rows_.size();
  extra_jacobians_.clear();
  extra_start_.clear();
  for (const Island::Coupling& coupling : island_.couplings) {
    const bullet::CoupledConstraint::Row& row = coupling.constraint->row();
    CoupledRow out;
    out.loop = bullet::is_gear(*coupling.constraint);
    out.coupling = extra_start_.size();
    extra_start_.push_back(extra_jacobians_.size());
    out.target = row.velocity;
    const IndexedSpan<const bullet::CoupledConstraint::BodyJacobian> bodies = coupling.constraint->jacobians();
    for (int i = 0; i < bodies.size(); ++i) {
      const int index = island_.body_of(coupling, i);
      const BodyJacobian body{trees_.node_of(index), make_spatial(bodies[i].linear, bodies[i].angular)};
      out.target -= dot(body.jacobian, island_.velocity(index));
      if (i == 0) {
        out.a = body;
      } else if (i == 1) {
        out.b = body;
      } else {
        extra_jacobians_.push_back(body);
      }
    }
    out.softness = row.softness;
    out.mobility = row.mobility;
    out.lower = row.lower;
    out.upper = row.upper;
    rows_.push_back(out);
  }
  extra_start_.push_back(extra_jacobians_.size());
}

void CoupledRows::collect_deferred_axes() {
  rows_.resize(fixed_count_);
  for (AxisRow& row : trees_.axes.rows()) {
    if (row.status != AxisRow::deferred) continue;
    CoupledRow out;
    out.axis = &row;
    out.a.node = row.node;
    out.softness = row.softness;
    out.impulse = row.impulse;
    out.lower = row.lower;
    out.upper = row.upper;
    out.initial_status = to_lcp_status(row.initial_status);
    out.initial_impulse = row.initial_impulse;
    rows_.push_back(out);
  }
}

double CoupledRows::rate(const CoupledRow& row) const {
  double rate = 0;
  for_each_jacobian(row, [&](const BodyJacobian& body) { rate += dot(body.jacobian, trees_.axes.change(body.node)); });
  return rate;
}

void CoupledRows::apply_load(const CoupledRow& row, double impulse) {
  if (row.axis != nullptr) {
    trees_.axes.forest.node(row.axis->node).input[row.axis->axis] = impulse;
    return;
  }
  for_each_jacobian(
      row, [&](const BodyJacobian& body) { trees_.axes.forest.node(body.node).load += body.jacobian * impulse; });
}

int CoupledRows::activate_contacts() {
  int activated = 0;
  for (int i = 0; i < fixed_count_; ++i) {
    CoupledRow& row = rows_[i];
    if (!row.inactive) continue;
    row.inactive = row.normal < 0 ? row.target - rate(row) <= kTolerance : rows_[row.normal].inactive;
    activated += row.inactive ? 0 : 1;
  }
  return activated;
}

bool CoupledRows::restore_friction_cone() {
  bool changed = false;
  for (int i = 0; i + 1 < fixed_count_; ++i) {
    CoupledRow& first = rows_[i];
    CoupledRow& second = rows_[i + 1];
    if (first.contact == nullptr || first.normal < 0) continue;
    if (first.contact->m_overrideNumSolverIterations != collision::friction_along) continue;
    const double max_force = static_cast<double>(first.contact->m_friction) * rows_[first.normal].impulse;
    const double force = fixed::hypot(first.impulse, second.impulse);
    if (!(force > kConeTolerance * max_force)) continue;
    for (CoupledRow* row : {&first, &second}) {
      row->friction = static_cast<double>(row->contact->m_friction) * std::fabs(row->impulse) / force;
    }
    changed = true;
  }
  return changed;
}

}  // namespace limber::sim::solver
