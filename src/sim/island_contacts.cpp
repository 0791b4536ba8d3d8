// IslandSolver: contact rows, with friction in the direction in which it acts, and the sweeps over rolling friction.
#include <algorithm>
#include <cmath>

#include "base/prefetch.h"
#include "sim/contact_friction.h"
#include "sim/dispatcher.h"
#include "sim/island_world.h"

namespace limber {
namespace {

/// So many manifolds ahead their ends are asked for, and then what those tell of.
constexpr int kEndsAhead = 12;
constexpr int kPointsAhead = 6;

/// Softness of normals, as part of the response of the two bodies. Points that share a load (two of each wheel of a
/// cart, four of a box) could take it in any proportion, and friction would follow; with it they share evenly. A body
/// at rest sinks by micrometers.
constexpr btScalar kNormalSoftness = 1e-4F;

struct Motion {
  btVector3 linear;
  btVector3 angular;
  btVector3 at(const btVector3& arm) const { return linear + angular.cross(arm); }
};

Motion present(const btSolverBody& body) {
  if (body.m_originalBody == nullptr) return {{0, 0, 0}, {0, 0, 0}};
  return {body.m_linearVelocity, body.m_angularVelocity};
}

Motion expected(const btSolverBody& body) {
  if (body.m_originalBody == nullptr) return {{0, 0, 0}, {0, 0, 0}};
  return {body.m_linearVelocity + body.m_externalForceImpulse, body.m_angularVelocity + body.m_externalTorqueImpulse};
}

// Bullet leaves the external torques out of the speed that friction has to stop.
void add_external_torque(btSolverConstraint& row, const btSolverBody& a, const btSolverBody& b) {
  const btScalar speed =
      row.m_relpos1CrossNormal.dot(a.m_externalTorqueImpulse) + row.m_relpos2CrossNormal.dot(b.m_externalTorqueImpulse);
  row.m_rhs -= speed * row.m_jacDiagABInv;
}

// Friction across the slip turns with it: a speed across needs friction·pressing/slip as much impulse. Contacts that
// did not press in the step before don't know how much that is.
void follow_slip(btSolverConstraint& across, const FrictionFrame& frame, btScalar pressing) {
  across.m_cfm = 0;
  const btScalar most = frame.friction * pressing;
  if (!(frame.speed > 0 && most > 0)) return;
  across.m_cfm = frame.speed / most * across.m_jacDiagABInv;
  across.m_rhs += frame.speed_across * across.m_jacDiagABInv;
}

}  // namespace

void IslandSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  for (int i = 0; i < count; ++i) {
    if (i + kEndsAhead < count) prefetch_end(*manifolds[i + kEndsAhead]);
    if (i + kPointsAhead < count) {
      const btPersistentManifold& next = *manifolds[i + kPointsAhead];
      prefetch_points(next);
      prefetch(next.getBody0(), sizeof(btRigidBody));
      prefetch(next.getBody1(), sizeof(btRigidBody));
    }
    convert_contact(*manifolds[i], info);
  }
}

// As Bullet's convertContact, but for the directions of friction.
void IslandSolver::convert_contact(btPersistentManifold& manifold, const btContactSolverInfo& info) {
  auto* const object_a = const_cast<btCollisionObject*>(manifold.getBody0());
  auto* const object_b = const_cast<btCollisionObject*>(manifold.getBody1());
  const int id_a = getOrInitSolverBody(*object_a, info.m_timeStep);
  const int id_b = getOrInitSolverBody(*object_b, info.m_timeStep);
  const btSolverBody& a = m_tmpSolverBodyPool[id_a];
  const btSolverBody& b = m_tmpSolverBodyPool[id_b];
  if (a.m_invMass.fuzzyZero() && b.m_invMass.fuzzyZero()) return;
  for (int j = 0; j < manifold.getNumContacts(); ++j) {
    btManifoldPoint& point = manifold.getContactPoint(j);
    if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
    const btVector3 arm_a = point.getPositionWorldOnA() - object_a->getWorldTransform().getOrigin();
    const btVector3 arm_b = point.getPositionWorldOnB() - object_b->getWorldTransform().getOrigin();
    const btScalar pressing = point.m_appliedImpulse;
    const int index = m_tmpSolverContactConstraintPool.size();
    btSolverConstraint& normal = m_tmpSolverContactConstraintPool.expandNonInitializing();
    normal.m_solverBodyIdA = id_a;
    normal.m_solverBodyIdB = id_b;
    normal.m_originalContactPoint = &point;
    btScalar relaxation = 1;
    setupContactConstraint(normal, id_a, id_b, point, info, relaxation, arm_a, arm_b);
    normal.m_cfm += kNormalSoftness;
    normal.m_frictionIndex = m_tmpSolverContactFrictionConstraintPool.size();

    const FrictionFrame frame = sliding_frame(point, *object_a, *object_b, present(a).at(arm_a) - present(b).at(arm_b),
                                              expected(a).at(arm_a) - expected(b).at(arm_b));
    point.m_lateralFrictionDir1 = frame.along;
    point.m_lateralFrictionDir2 = frame.across;
    for (const btVector3* axis : {&point.m_lateralFrictionDir1, &point.m_lateralFrictionDir2}) {
      btSolverConstraint& row =
          addFrictionConstraint(*axis, id_a, id_b, index, point, arm_a, arm_b, object_a, object_b, relaxation, info);
      row.m_friction = frame.friction;
      row.m_lowerLimit = -frame.friction;
      row.m_upperLimit = frame.friction;
      add_external_torque(row, a, b);
      row.m_overrideNumSolverIterations = axis == &point.m_lateralFrictionDir1 ? friction_along : friction_across;
      if (axis == &point.m_lateralFrictionDir2) follow_slip(row, frame, pressing);
    }
    convert_rolling(point, index, id_a, id_b, pressing);
  }
}

void IslandSolver::convert_rolling(btManifoldPoint& point, int contact, int id_a, int id_b, btScalar pressing) {
  const auto add = [&](const btVector3& axis, btScalar friction, FrictionRow kind) -> btSolverConstraint& {
    btSolverConstraint& row =
        addTorsionalFrictionConstraint(axis, id_a, id_b, contact, point, friction, axis, axis, nullptr, nullptr, 1);
    row.m_overrideNumSolverIterations = kind;
    add_external_torque(row, m_tmpSolverBodyPool[id_a], m_tmpSolverBodyPool[id_b]);
    return row;
  };
  if (point.m_combinedSpinningFriction > 0) {
    add(point.m_normalWorldOnB, point.m_combinedSpinningFriction, friction_spin);
  }
  if (!(point.m_combinedRollingFriction > 0)) return;
  const btSolverBody& a = m_tmpSolverBodyPool[id_a];
  const btSolverBody& b = m_tmpSolverBodyPool[id_b];
  const FrictionFrame frame =
      rolling_frame(point, present(a).angular - present(b).angular, expected(a).angular - expected(b).angular);
  add(frame.along, frame.friction, friction_along);
  follow_slip(add(frame.across, frame.friction, friction_across), frame, pressing);
}

// Rolling friction in two directions together, within a disc; friction against spinning by itself.
btScalar IslandSolver::sweep_rolling() {
  btScalar largest = 0;
  const auto free_impulse = [this](const btSolverConstraint& row) {
    const btScalar speed =
        row.m_relpos1CrossNormal.dot(m_tmpSolverBodyPool[row.m_solverBodyIdA].m_deltaAngularVelocity) +
        row.m_relpos2CrossNormal.dot(m_tmpSolverBodyPool[row.m_solverBodyIdB].m_deltaAngularVelocity);
    return row.m_rhs - speed * row.m_jacDiagABInv;
  };
  const auto set = [this, &largest](btSolverConstraint& row, btScalar impulse) {
    const btScalar change = impulse - row.m_appliedImpulse;
    row.m_appliedImpulse = impulse;
    btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    a.internalApplyImpulse(btVector3(0, 0, 0), row.m_angularComponentA, change);
    b.internalApplyImpulse(btVector3(0, 0, 0), row.m_angularComponentB, change);
    largest = std::max(largest, change * change);
  };
  btConstraintArray& rows = m_tmpSolverContactRollingFrictionConstraintPool;
  for (int i = 0; i < rows.size(); ++i) {
    btSolverConstraint& row = rows[i];
    const btScalar pressing = contacts_.impulse(row.m_frictionIndex);
    if (!(pressing > 0)) continue;
    const btScalar most = row.m_friction * pressing;
    const btScalar first = row.m_appliedImpulse + free_impulse(row);
    if (row.m_overrideNumSolverIterations == friction_spin) {
      set(row, std::clamp(first, -most, most));
      continue;
    }
    if (row.m_overrideNumSolverIterations != friction_along) continue;
    btSolverConstraint& across = rows[i + 1];
    const btScalar second = across.m_appliedImpulse + free_impulse(across);
    const btScalar length = fixed::hypotf(first, second);
    const btScalar part = length > most ? most / length : btScalar(1);
    set(row, part * first);
    set(across, part * second);
  }
  return largest;
}

// For the frames of the next step.
void IslandSolver::remember_rolling_friction() {
  const btConstraintArray& rows = m_tmpSolverContactRollingFrictionConstraintPool;
  for (int i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i].m_overrideNumSolverIterations != friction_along) continue;
    auto* point =
        static_cast<btManifoldPoint*>(m_tmpSolverContactConstraintPool[rows[i].m_frictionIndex].m_originalContactPoint);
    remember_rolling(*point, rows[i].m_relpos2CrossNormal * rows[i].m_appliedImpulse +
                                 rows[i + 1].m_relpos2CrossNormal * rows[i + 1].m_appliedImpulse);
  }
}

}  // namespace limber
