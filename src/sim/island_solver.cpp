// IslandSolver: turns what joints plan into Bullet's solver rows, and hands the impulses back.
#include <cstring>

#include "sim/island_world.h"

namespace limber {

void IslandSolver::convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) {
  m_tmpConstraintSizesPool.resizeNoInitialize(count);
  int rows = 0;
  for (int i = 0; i < count; ++i) {
    btTypedConstraint::btConstraintInfo1& size = m_tmpConstraintSizesPool[i];
    size = {0, 0};
    if (!constraints[i]->isEnabled()) continue;
    if (constraints[i]->getConstraintType() == JointConstraint::kType) {
      static_cast<JointConstraint*>(constraints[i])->set_step(info.m_timeStep);
    }
    constraints[i]->getInfo1(&size);
    rows += size.m_numConstraintRows;
  }
  m_tmpSolverNonContactConstraintPool.resizeNoInitialize(rows);
  int row = 0;
  for (int i = 0; i < count; ++i) {
    const btTypedConstraint::btConstraintInfo1& size = m_tmpConstraintSizesPool[i];
    if (size.m_numConstraintRows == 0) continue;
    btSolverConstraint* first = &m_tmpSolverNonContactConstraintPool[row];
    row += size.m_numConstraintRows;
    if (constraints[i]->getConstraintType() == JointConstraint::kType) {
      convert_rows(static_cast<JointConstraint&>(*constraints[i]), first, size.m_numConstraintRows, info);
    } else {
      const int a = getOrInitSolverBody(constraints[i]->getRigidBodyA(), info.m_timeStep);
      const int b = getOrInitSolverBody(constraints[i]->getRigidBodyB(), info.m_timeStep);
      convertJoint(first, constraints[i], size, a, b, info);
    }
  }
}

void IslandSolver::convert_rows(JointConstraint& joint, btSolverConstraint* rows, int count,
                                const btContactSolverInfo& info) {
  const int id_a = getOrInitSolverBody(joint.getRigidBodyA(), info.m_timeStep);
  const int id_b = getOrInitSolverBody(joint.getRigidBodyB(), info.m_timeStep);
  std::memset(static_cast<void*>(rows), 0, sizeof(btSolverConstraint) * static_cast<std::size_t>(count));

  // let the joint fill in Jacobians, bounds, wanted velocity (m_rhs) and softness (m_cfm)
  btTypedConstraint::btConstraintInfo2 plan{};
  plan.fps = 1 / info.m_timeStep;
  plan.m_J1linearAxis = rows->m_contactNormal1;
  plan.m_J1angularAxis = rows->m_relpos1CrossNormal;
  plan.m_J2linearAxis = rows->m_contactNormal2;
  plan.m_J2angularAxis = rows->m_relpos2CrossNormal;
  plan.rowskip = static_cast<int>(sizeof(btSolverConstraint) / sizeof(btScalar));
  plan.m_constraintError = &rows->m_rhs;
  plan.cfm = &rows->m_cfm;
  plan.m_lowerLimit = &rows->m_lowerLimit;
  plan.m_upperLimit = &rows->m_upperLimit;
  joint.getInfo2(&plan);

  const btRigidBody& a = joint.getRigidBodyA();
  const btRigidBody& b = joint.getRigidBodyB();
  const btSolverBody& solver_a = m_tmpSolverBodyPool[id_a];
  const btSolverBody& solver_b = m_tmpSolverBodyPool[id_b];
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

    // mobility J M^-1 J' plus softness: with both in the step, any softness converges
    const btScalar mobility =
        row.m_contactNormal1.length2() * a.getInvMass() + row.m_contactNormal2.length2() * b.getInvMass() +
        row.m_relpos1CrossNormal.dot(row.m_angularComponentA) + row.m_relpos2CrossNormal.dot(row.m_angularComponentB);
    const btScalar step = mobility > SIMD_EPSILON ? 1 / (mobility + row.m_cfm) : btScalar(0);
    const btScalar rate = row.m_contactNormal1.dot(linear_a) + row.m_relpos1CrossNormal.dot(angular_a) +
                          row.m_contactNormal2.dot(linear_b) + row.m_relpos2CrossNormal.dot(angular_b);
    row.m_rhs = (row.m_rhs - rate) * step;
    row.m_jacDiagABInv = step;
    row.m_cfm *= step;
  }
  if (info.m_numIterations > m_maxOverrideNumSolverIterations) m_maxOverrideNumSolverIterations = info.m_numIterations;
}

btScalar IslandSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                     const btContactSolverInfo& info) {
  const int count = m_tmpSolverNonContactConstraintPool.size();
  for (int first = 0, last = 0; first < count; first = last) {
    auto* joint = static_cast<btTypedConstraint*>(m_tmpSolverNonContactConstraintPool[first].m_originalContactPoint);
    while (last < count && m_tmpSolverNonContactConstraintPool[last].m_originalContactPoint == joint) ++last;
    if (joint->getConstraintType() != JointConstraint::kType) continue;
    static_cast<JointConstraint*>(joint)->take_impulses(&m_tmpSolverNonContactConstraintPool[first], last - first);
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace limber
