// IslandSolver: converts planned joint rows to Bullet's solver rows, sweeps them, and stores the impulses in the
// joints.
#include "sim/bullet/island_solver.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "sim/bullet/rotation_step.h"
#include "sim/bullet/surface_motion.h"

namespace limber::sim::bullet {

void IslandSolver::convertBodies(btCollisionObject** bodies, int count, const btContactSolverInfo& info) {
  moving_statics_.resizeNoInitialize(0);
  btSequentialImpulseConstraintSolver::convertBodies(bodies, count, info);
  for (int i = 0; i < count; ++i) {
    const btRigidBody* body = btRigidBody::upcast(bodies[i]);
    if (body == nullptr || body->isStaticOrKinematicObject()) continue;
    const btVector3 change = to_bt(gyroscopic_change(*body, static_cast<double>(info.m_timeStep)));
    m_tmpSolverBodyPool[body->getCompanionId()].m_externalTorqueImpulse += change * body->getAngularFactor();
  }
}

// Like getOrInitSolverBody(), except that a static body that moves gets a solver body with its velocity, without mass
// and without a rigid body, so that nothing is written to it. It may be shared by islands that other threads solve.
int IslandSolver::solver_body(btCollisionObject& object, btScalar h) {
  return is_moving_static(object) ? moving_static_body(static_cast<const btRigidBody&>(object))
                                  : getOrInitSolverBody(object, h);
}

int IslandSolver::moving_static_body(const btRigidBody& body) {
  for (int i = 0; i < moving_statics_.size(); ++i) {
    if (moving_statics_[i].body == &body) return moving_statics_[i].solver_body;
  }
  const int id = m_tmpSolverBodyPool.size();
  btSolverBody& solver_body = m_tmpSolverBodyPool.expandNonInitializing();
  initSolverBody(&solver_body, nullptr, 0);
  solver_body.m_linearVelocity = body.getLinearVelocity();
  solver_body.m_angularVelocity = body.getAngularVelocity();
  moving_statics_.push_back({&body, id});
  return id;
}

// Joints hold pointers to their rows, which therefore must not move until the step is solved.
void IslandSolver::reserve_rows(int joints) {
  planned_count_ = 0;
  const int max_rows = joints * JointRows::kMax;
  if (planned_.size() < max_rows) planned_.resize(max_rows);
}

void IslandSolver::plan(JointConstraint& joint, const btContactSolverInfo& info) {
  joint.set_step({info.m_timeStep, steps_left_, step_count_});
  planned_count_ += joint.plan(&planned_[planned_count_]).size();
}

void IslandSolver::convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  reserve_rows(count);
  use_direct_ = direct_enabled_ && plan_direct(constraints, count, info);
  if (use_direct_) {
    m_tmpSolverNonContactConstraintPool.resizeNoInitialize(0);
    joints_.resizeNoInitialize(0);
    couplings_swept_ = false;
    return;
  }
  for (int i = 0; i < count; ++i) {
    if (constraints[i]->getConstraintType() != JointConstraint::kType || !constraints[i]->isEnabled()) continue;
    plan(*static_cast<JointConstraint*>(constraints[i]), info);
  }
  plan_couplings(constraints, count, info);
  convert_constraints(constraints, count, info);
}

// Returns false if there is nothing to solve directly, or the island has one of Bullet's own constraints, which only
// the iterative solver supports.
bool IslandSolver::plan_direct(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  for (int i = 0; i < count; ++i) {
    if (constraints[i]->getConstraintType() != JointConstraint::kType && !is_coupled(*constraints[i])) return false;
  }
  direct_.begin();
  for (int i = 0; i < count; ++i) {
    if (is_coupled(*constraints[i])) continue;
    JointConstraint& joint = static_cast<JointConstraint&>(*constraints[i]);
    if (!joint.isEnabled()) continue;
    plan(joint, info);
    direct_.add_joint(joint, solver_body(joint.getRigidBodyA(), info.m_timeStep),
                      solver_body(joint.getRigidBodyB(), info.m_timeStep));
  }
  plan_couplings(constraints, count, info);
  for (const Coupling& coupling : couplings_) {
    direct_.add_coupling(*coupling.constraint);
    for (int i = 0; i < coupling.count; ++i) direct_.add_coupled_body(sides_[coupling.first + i].body);
  }
  return direct_.joint_count() > 0 || !couplings_.empty() || contacts_direct_;
}

// Plans the gears and tendons, after all joints. One that can't move anything has no row.
void IslandSolver::plan_couplings(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  couplings_.clear();
  sides_.clear();
  for (int i = 0; i < count; ++i) {
    if (!is_coupled(*constraints[i]) || !constraints[i]->isEnabled()) continue;
    auto& constraint = static_cast<CoupledConstraint&>(*constraints[i]);
    constraint.plan(info.m_timeStep);
    if (!(constraint.row().mobility > 0)) continue;
    Coupling& coupling = couplings_.emplace_back();
    coupling.constraint = &constraint;
    coupling.first = sides_.size();
    coupling.count = constraint.jacobians().size();
    for (const CoupledConstraint::BodyJacobian& jacobian : constraint.jacobians())
      sides_.emplace_back().body = solver_body(*jacobian.body, info.m_timeStep);
  }
}

btScalar IslandSolver::solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                                         btPersistentManifold** manifolds, int manifold_count,
                                                         btTypedConstraint** constraints, int constraint_count,
                                                         const btContactSolverInfo& info, btIDebugDraw* drawer) {
  // Bullet solves an island of one resting body without setting it up
  if (std::exchange(use_direct_, false)) {
    const solver::IslandPools pools{m_tmpSolverBodyPool, m_tmpSolverContactConstraintPool,
                                    m_tmpSolverContactFrictionConstraintPool,
                                    m_tmpSolverContactRollingFrictionConstraintPool};
    if (direct_.solve(pools, info)) return 0;
    convert_constraints(constraints, constraint_count, info);
  }
  contacts_.begin(m_tmpSolverBodyPool, m_tmpSolverContactConstraintPool, m_tmpSolverContactFrictionConstraintPool);
  const btScalar residual = btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  contacts_.finish();
  return residual;
}

void IslandSolver::solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int, btPersistentManifold**, int,
                                                                 btTypedConstraint**, int,
                                                                 const btContactSolverInfo& info, btIDebugDraw*) {
  for (int i = 0; i < info.m_numIterations; ++i) {
    if (contacts_.sweep_split_impulse() <= info.m_leastSquaresResidualThreshold) return;
  }
}

// Converts the rows of joints, which are planned already.
void IslandSolver::convert_constraints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  m_tmpConstraintSizesPool.resizeNoInitialize(count);
  int rows = 0;
  for (int i = 0; i < count; ++i) {
    btTypedConstraint::btConstraintInfo1& size = m_tmpConstraintSizesPool[i];
    size = {0, 0};
    if (!constraints[i]->isEnabled()) continue;
    if (constraints[i]->getConstraintType() == JointConstraint::kType) {
      const auto& joint = static_cast<const JointConstraint&>(*constraints[i]);
      size.m_numConstraintRows = joint.ball_limits().count() + joint.rows().size();
    } else {
      constraints[i]->getInfo1(&size);
    }
    rows += size.m_numConstraintRows;
  }
  m_tmpSolverNonContactConstraintPool.resizeNoInitialize(rows);
  joints_.resizeNoInitialize(0);
  int row = 0;
  for (int i = 0; i < count; ++i) {
    const btTypedConstraint::btConstraintInfo1& size = m_tmpConstraintSizesPool[i];
    if (size.m_numConstraintRows == 0) continue;
    btSolverConstraint* first = &m_tmpSolverNonContactConstraintPool[row];
    row += size.m_numConstraintRows;
    if (constraints[i]->getConstraintType() == JointConstraint::kType) {
      convert_rows(static_cast<JointConstraint&>(*constraints[i]), first, size.m_numConstraintRows, info);
    } else {
      // Bullet's own constraints: rows are swept one by one
      const int a = solver_body(constraints[i]->getRigidBodyA(), info.m_timeStep);
      const int b = solver_body(constraints[i]->getRigidBodyB(), info.m_timeStep);
      convertJoint(first, constraints[i], size, a, b, info);
      add_rows(first, size.m_numConstraintRows, false, 0);
    }
  }
  convert_couplings(info);
}

// Sets up the rows of gears and tendons for the sweeps, after those of all joints.
void IslandSolver::convert_couplings(const btContactSolverInfo& info) {
  couplings_swept_ = true;
  for (Coupling& coupling : couplings_) {
    const CoupledConstraint::Row& planned = coupling.constraint->row();
    const auto jacobians = coupling.constraint->jacobians();
    btScalar rate = 0;
    for (int k = 0; k < coupling.count; ++k) {
      CoupledSide& side = sides_[coupling.first + k];
      const CoupledConstraint::BodyJacobian& from = jacobians[k];
      const btSolverBody& body = m_tmpSolverBodyPool[side.body];
      side.linear = from.linear;
      side.angular = from.angular;
      side.linear_per_impulse = from.linear * from.body->getInvMass() * from.body->getLinearFactor();
      side.angular_per_impulse = from.body->getInvInertiaTensorWorld() * from.angular * from.body->getAngularFactor();
      rate += side.linear.dot(body.m_linearVelocity + body.m_externalForceImpulse) +
              side.angular.dot(body.m_angularVelocity + body.m_externalTorqueImpulse);
    }
    coupling.target_rate = to_scalar(planned.velocity) - rate;
    coupling.softness = to_scalar(planned.softness);
    coupling.step = to_scalar(1 / (planned.mobility + planned.softness));
    const auto infinity = static_cast<double>(SIMD_INFINITY);
    coupling.lower = to_scalar(std::max(planned.lower, -infinity));
    coupling.upper = to_scalar(std::min(planned.upper, infinity));
    coupling.impulse = std::clamp(to_scalar(coupling.constraint->warm_impulse()), coupling.lower, coupling.upper);
    apply_coupled_impulse(coupling, coupling.impulse);
    m_maxOverrideNumSolverIterations = std::max(info.m_numIterations, m_maxOverrideNumSolverIterations);
  }
}

// Returns the squared change of the impulse.
btScalar IslandSolver::sweep_coupling(int coupling) {
  Coupling& row = couplings_[coupling];
  btScalar residual = row.target_rate - row.softness * row.impulse;
  for (int k = 0; k < row.count; ++k) {
    const CoupledSide& side = sides_[row.first + k];
    const btSolverBody& body = m_tmpSolverBodyPool[side.body];
    residual -= side.linear.dot(body.m_deltaLinearVelocity) + side.angular.dot(body.m_deltaAngularVelocity);
  }
  const btScalar after = std::clamp(row.impulse + residual * row.step, row.lower, row.upper);
  const btScalar change = after - std::exchange(row.impulse, after);
  apply_coupled_impulse(row, change);
  return change * change;
}

void IslandSolver::apply_coupled_impulse(const Coupling& coupling, btScalar impulse) {
  for (int k = 0; k < coupling.count; ++k) {
    const CoupledSide& side = sides_[coupling.first + k];
    btSolverBody& body = m_tmpSolverBodyPool[side.body];
    body.m_deltaLinearVelocity += side.linear_per_impulse * impulse;
    body.m_deltaAngularVelocity += side.angular_per_impulse * impulse;
  }
}

// Registers `count` rows for the sweeps; the last ones, one bounded row (if any) and `locked` ones, form the block.
JointBlock& IslandSolver::add_rows(const btSolverConstraint* rows, int count, bool bounded, int locked) {
  SweptJoint& entry = joints_.expandNonInitializing();
  entry.first = static_cast<int>(rows - &m_tmpSolverNonContactConstraintPool[0]);
  entry.scalar = count - locked - (bounded ? 1 : 0);
  entry.body_a = rows->m_solverBodyIdA;
  entry.body_b = rows->m_solverBodyIdB;
  entry.block.build(rows + entry.scalar, bounded, locked, m_tmpSolverBodyPool[entry.body_a].internalGetInvMass(),
                    m_tmpSolverBodyPool[entry.body_b].internalGetInvMass());
  return entry.block;
}

void IslandSolver::convert_rows(JointConstraint& joint, btSolverConstraint* rows, int count,
                                const btContactSolverInfo& info) {
  const int id_a = solver_body(joint.getRigidBodyA(), info.m_timeStep);
  const int id_b = solver_body(joint.getRigidBodyB(), info.m_timeStep);
  std::memset(static_cast<void*>(rows), 0, sizeof(btSolverConstraint) * static_cast<std::size_t>(count));

  // getInfo2() writes Jacobians, bounds, target velocity (m_rhs) and softness (m_cfm)
  btTypedConstraint::btConstraintInfo2 constraint_info{};
  constraint_info.fps = 1 / info.m_timeStep;
  constraint_info.m_J1linearAxis = rows->m_contactNormal1;
  constraint_info.m_J1angularAxis = rows->m_relpos1CrossNormal;
  constraint_info.m_J2linearAxis = rows->m_contactNormal2;
  constraint_info.m_J2angularAxis = rows->m_relpos2CrossNormal;
  constraint_info.rowskip = static_cast<int>(sizeof(btSolverConstraint) / sizeof(btScalar));
  constraint_info.m_constraintError = &rows->m_rhs;
  constraint_info.cfm = &rows->m_cfm;
  constraint_info.m_lowerLimit = &rows->m_lowerLimit;
  constraint_info.m_upperLimit = &rows->m_upperLimit;
  joint.getInfo2(&constraint_info);

  const btRigidBody& a = joint.getRigidBodyA();
  const btRigidBody& b = joint.getRigidBodyB();
  btSolverBody& solver_a = m_tmpSolverBodyPool[id_a];
  btSolverBody& solver_b = m_tmpSolverBodyPool[id_b];
  const btVector3 linear_a = solver_a.m_linearVelocity + solver_a.m_externalForceImpulse;
  const btVector3 linear_b = solver_b.m_linearVelocity + solver_b.m_externalForceImpulse;
  const btVector3 angular_a = solver_a.m_angularVelocity + solver_a.m_externalTorqueImpulse;
  const btVector3 angular_b = solver_b.m_angularVelocity + solver_b.m_externalTorqueImpulse;
  for (int r = 0; r < count; ++r) {
    btSolverConstraint& row = rows[r];
    row.m_solverBodyIdA = id_a;
    row.m_solverBodyIdB = id_b;
    row.m_overrideNumSolverIterations = info.m_numIterations;
    row.m_originalContactPoint = &joint;
    row.m_angularComponentA = a.getInvInertiaTensorWorld() * row.m_relpos1CrossNormal * a.getAngularFactor();
    row.m_angularComponentB = b.getInvInertiaTensorWorld() * row.m_relpos2CrossNormal * b.getAngularFactor();

    // inverse effective mass J M^-1 J' plus softness: with both in the step, any softness converges
    const btScalar mobility =
        row.m_contactNormal1.length2() * a.getInvMass() + row.m_contactNormal2.length2() * b.getInvMass() +
        row.m_relpos1CrossNormal.dot(row.m_angularComponentA) + row.m_relpos2CrossNormal.dot(row.m_angularComponentB);
    const btScalar step = mobility > SIMD_EPSILON ? 1 / (mobility + row.m_cfm) : btScalar(0);
    const btScalar rate = row.m_contactNormal1.dot(linear_a) + row.m_relpos1CrossNormal.dot(angular_a) +
                          row.m_contactNormal2.dot(linear_b) + row.m_relpos2CrossNormal.dot(angular_b);
    row.m_rhsPenetration = row.m_rhs - rate;  // unused in joints otherwise: input of the block
    row.m_rhs = row.m_rhsPenetration * step;
    row.m_jacDiagABInv = step;
    row.m_cfm *= step;
  }
  JointBlock& block = add_rows(rows, count, joint.rows().has_bounded(), joint.rows().locked());
  PairVelocity v(solver_a, solver_b);
  block.warm_start(joint.warm_start().block_impulses(), v);
  v.store(solver_a, solver_b);
  if (info.m_numIterations > m_maxOverrideNumSolverIterations) m_maxOverrideNumSolverIterations = info.m_numIterations;
}

// One sweep over gears and tendons, then over all joints, so that locks take precedence: single rows first, then
// blocks. Returns the largest squared change of an impulse.
btScalar IslandSolver::sweep_joints() {
  btScalar largest = 0;
  for (int i = 0; i < couplings_.size(); ++i) largest = std::max(largest, sweep_coupling(i));
  for (int i = 0; i < joints_.size(); ++i) {
    SweptJoint& joint = joints_[i];
    btSolverBody& a = m_tmpSolverBodyPool[joint.body_a];
    btSolverBody& b = m_tmpSolverBodyPool[joint.body_b];
    PairVelocity v(a, b);
    for (int r = joint.first; r < joint.first + joint.scalar; ++r) {
      largest = std::max(largest, solve_row(m_tmpSolverNonContactConstraintPool[r], v));
    }
    largest = std::max(largest, joint.block.solve(v));
    v.store(a, b);
  }
  return largest;
}

btScalar IslandSolver::solveSingleIteration(int iteration, btCollisionObject**, int, btPersistentManifold**, int,
                                            btTypedConstraint**, int, const btContactSolverInfo& info, btIDebugDraw*) {
  const btScalar joints = sweep_joints();
  if (iteration >= info.m_numIterations) return joints;
  return std::max({joints, contacts_.sweep(), sweep_rolling()});
}

btScalar IslandSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                     const btContactSolverInfo& info) {
  save_rolling_friction();
  for (int i = 0; i < joints_.size(); ++i) joints_[i].block.finish();
  for (const Coupling& coupling : couplings_) {
    if (couplings_swept_) coupling.constraint->set_impulse(static_cast<double>(coupling.impulse));
  }
  couplings_.clear();
  const int count = m_tmpSolverNonContactConstraintPool.size();
  for (int first = 0, last = 0; first < count; first = last) {
    auto* joint = static_cast<btTypedConstraint*>(m_tmpSolverNonContactConstraintPool[first].m_originalContactPoint);
    while (last < count && m_tmpSolverNonContactConstraintPool[last].m_originalContactPoint == joint) ++last;
    if (joint->getConstraintType() != JointConstraint::kType) continue;
    static_cast<JointConstraint*>(joint)->set_impulses(&m_tmpSolverNonContactConstraintPool[first], last - first);
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace limber::sim::bullet
