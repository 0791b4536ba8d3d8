// IslandSolver: contact rows with friction directions aligned to the slip, and sweeps over rolling friction.
#include <algorithm>
#include <cmath>

#include "base/memory/prefetch.h"
#include "sim/bullet/island_solver.h"
#include "sim/bullet/surface_motion.h"
#include "sim/collision/contact_friction.h"
#include "sim/collision/dispatcher.h"

namespace limber::sim::bullet {
namespace {

/// Prefetch distances, in manifolds: of their ends, then of the points and bodies that these refer to.
constexpr int kEndsAhead = 12;
constexpr int kPointsAhead = 6;

/// Softness of normals, relative to the response of the two bodies. Points that share a load (two of each wheel of a
/// cart, four of a box) could share it in any proportion, and friction with it; the softness makes them share it
/// evenly. A body at rest sinks by micrometers.
constexpr btScalar kNormalSoftness = 1e-4F;

struct Motion {
  btVector3 linear;
  btVector3 angular;
  btVector3 velocity_at(const btVector3& arm) const { return linear + angular.cross(arm); }
};

Motion current_motion(const btSolverBody& body) {
  if (body.m_originalBody == nullptr) return {{0, 0, 0}, {0, 0, 0}};
  return {body.m_linearVelocity, body.m_angularVelocity};
}

Motion expected_motion(const btSolverBody& body) {
  if (body.m_originalBody == nullptr) return {{0, 0, 0}, {0, 0, 0}};
  return {body.m_linearVelocity + body.m_externalForceImpulse, body.m_angularVelocity + body.m_externalTorqueImpulse};
}

// Adds external torques to the speed that friction has to stop; Bullet omits them.
void add_external_torque(btSolverConstraint& row, const btSolverBody& a, const btSolverBody& b) {
  const btScalar speed =
      row.m_relpos1CrossNormal.dot(a.m_externalTorqueImpulse) + row.m_relpos2CrossNormal.dot(b.m_externalTorqueImpulse);
  row.m_rhs -= speed * row.m_jacDiagABInv;
}

// Makes friction across the slip viscous, since it turns with the slip: the impulse per lateral speed is
// friction·normal impulse/slip. If the contact did not press in the previous step, the normal impulse is unknown and
// the row remains hard.
void add_viscous_friction(btSolverConstraint& across, const collision::FrictionFrame& frame,
                          btScalar last_normal_impulse) {
  across.m_cfm = 0;
  const btScalar max_impulse = frame.friction * last_normal_impulse;
  if (!(frame.speed > 0 && max_impulse > 0)) return;
  across.m_cfm = frame.speed / max_impulse * across.m_jacDiagABInv;
  across.m_rhs += frame.speed_across * across.m_jacDiagABInv;
}

}  // namespace

void IslandSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  for (int i = 0; i < count; ++i) {
    if (i + kEndsAhead < count) collision::prefetch_end(*manifolds[i + kEndsAhead]);
    if (i + kPointsAhead < count) {
      const btPersistentManifold& next = *manifolds[i + kPointsAhead];
      collision::prefetch_points(next);
      prefetch(next.getBody0(), sizeof(btRigidBody));
      prefetch(next.getBody1(), sizeof(btRigidBody));
    }
    convert_contact(*manifolds[i], info);
  }
}

// Like Bullet's convertContact, except for the friction directions.
void IslandSolver::convert_contact(btPersistentManifold& manifold, const btContactSolverInfo& info) {
  auto* const object_a = const_cast<btCollisionObject*>(manifold.getBody0());
  auto* const object_b = const_cast<btCollisionObject*>(manifold.getBody1());
  const int id_a = solver_body(*object_a, info.m_timeStep);
  const int id_b = solver_body(*object_b, info.m_timeStep);
  const btSolverBody& a = m_tmpSolverBodyPool[id_a];
  const btSolverBody& b = m_tmpSolverBodyPool[id_b];
  if (a.m_invMass.fuzzyZero() && b.m_invMass.fuzzyZero()) return;
  const bool surface_moves = has_surface_motion(*object_a, a, *object_b, b);
  for (int j = 0; j < manifold.getNumContacts(); ++j) {
    btManifoldPoint& point = manifold.getContactPoint(j);
    if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
    const btVector3 arm_a = point.getPositionWorldOnA() - object_a->getWorldTransform().getOrigin();
    const btVector3 arm_b = point.getPositionWorldOnB() - object_b->getWorldTransform().getOrigin();
    const btScalar last_normal_impulse = point.m_appliedImpulse;
    const int index = m_tmpSolverContactConstraintPool.size();
    btSolverConstraint& normal = m_tmpSolverContactConstraintPool.expandNonInitializing();
    normal.m_solverBodyIdA = id_a;
    normal.m_solverBodyIdB = id_b;
    normal.m_originalContactPoint = &point;
    btScalar relaxation = 1;
    setupContactConstraint(normal, id_a, id_b, point, info, relaxation, arm_a, arm_b);
    normal.m_cfm += kNormalSoftness;
    normal.m_frictionIndex = m_tmpSolverContactFrictionConstraintPool.size();

    btVector3 slip = current_motion(a).velocity_at(arm_a) - current_motion(b).velocity_at(arm_b);
    btVector3 expected = expected_motion(a).velocity_at(arm_a) - expected_motion(b).velocity_at(arm_b);
    SurfaceMotion surface;
    if (surface_moves) {
      surface = surface_motion({*object_a, a, arm_a}, {*object_b, b, arm_b}, info.m_timeStep);
      add_body_motion(normal, point, slip, surface.body, info);
      slip += surface.velocity();
      expected += surface.velocity();
    }
    const collision::FrictionFrame frame = collision::sliding_frame(point, *object_a, *object_b, slip, expected);
    point.m_lateralFrictionDir1 = frame.along;
    point.m_lateralFrictionDir2 = frame.across;
    for (const btVector3* axis : {&point.m_lateralFrictionDir1, &point.m_lateralFrictionDir2}) {
      btSolverConstraint& row =
          addFrictionConstraint(*axis, id_a, id_b, index, point, arm_a, arm_b, object_a, object_b, relaxation, info,
                                surface_moves ? -axis->dot(surface.velocity()) : btScalar(0));
      row.m_friction = frame.friction;
      row.m_lowerLimit = -frame.friction;
      row.m_upperLimit = frame.friction;
      add_external_torque(row, a, b);
      row.m_overrideNumSolverIterations =
          axis == &point.m_lateralFrictionDir1 ? collision::friction_along : collision::friction_across;
      if (axis == &point.m_lateralFrictionDir2) add_viscous_friction(row, frame, last_normal_impulse);
    }
    convert_rolling(point, index, {id_a, id_b}, last_normal_impulse, surface.spin);
  }
}

// Adds the motion of static bodies to the normal's row, which Bullet sets up as if they were at rest. `slip`: velocity
// of A relative to B without it.
void IslandSolver::add_body_motion(btSolverConstraint& normal, const btManifoldPoint& point, const btVector3& slip,
                                   const btVector3& motion, const btContactSolverInfo& info) {
  const btScalar speed = point.m_normalWorldOnB.dot(motion);
  const btScalar approach = point.m_normalWorldOnB.dot(slip);
  const auto restitution = [&](btScalar relative_speed) {
    return std::max(btScalar(0),
                    restitutionCurve(relative_speed, point.m_combinedRestitution, info.m_restitutionVelocityThreshold));
  };
  normal.m_rhs += (restitution(approach + speed) - restitution(approach) - speed) * normal.m_jacDiagABInv;
}

void IslandSolver::convert_rolling(btManifoldPoint& point, int contact, const ContactBodies& bodies,
                                   btScalar last_normal_impulse, const btVector3& surface_spin) {
  const bool spins = surface_spin != btVector3(0, 0, 0);
  const auto target_speed = [&](const btVector3& axis) { return spins ? -axis.dot(surface_spin) : btScalar(0); };
  const auto add = [&](const btVector3& axis, btScalar friction, collision::FrictionRow kind) -> btSolverConstraint& {
    btSolverConstraint& row = addTorsionalFrictionConstraint(axis, bodies.a, bodies.b, contact, point, friction, axis,
                                                             axis, nullptr, nullptr, 1, target_speed(axis));
    row.m_overrideNumSolverIterations = kind;
    add_external_torque(row, m_tmpSolverBodyPool[bodies.a], m_tmpSolverBodyPool[bodies.b]);
    return row;
  };
  if (point.m_combinedSpinningFriction > 0) {
    add(point.m_normalWorldOnB, point.m_combinedSpinningFriction, collision::friction_spin);
  }
  if (!(point.m_combinedRollingFriction > 0)) return;
  const btSolverBody& a = m_tmpSolverBodyPool[bodies.a];
  const btSolverBody& b = m_tmpSolverBodyPool[bodies.b];
  btVector3 spin = current_motion(a).angular - current_motion(b).angular;
  btVector3 expected = expected_motion(a).angular - expected_motion(b).angular;
  if (spins) {
    spin += surface_spin;
    expected += surface_spin;
  }
  const collision::FrictionFrame frame = collision::rolling_frame(point, spin, expected);
  add(frame.along, frame.friction, collision::friction_along);
  add_viscous_friction(add(frame.across, frame.friction, collision::friction_across), frame, last_normal_impulse);
}

// Sweeps rolling friction with both directions projected onto a disc; spinning friction separately.
btScalar IslandSolver::sweep_rolling() {
  btScalar largest = 0;
  const auto unclamped_change = [this](const btSolverConstraint& row) {
    const btScalar speed =
        row.m_relpos1CrossNormal.dot(m_tmpSolverBodyPool[row.m_solverBodyIdA].m_deltaAngularVelocity) +
        row.m_relpos2CrossNormal.dot(m_tmpSolverBodyPool[row.m_solverBodyIdB].m_deltaAngularVelocity);
    return row.m_rhs - speed * row.m_jacDiagABInv;
  };
  const auto set_impulse = [this, &largest](btSolverConstraint& row, btScalar impulse) {
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
    const btScalar normal_impulse = contacts_.impulse(row.m_frictionIndex);
    if (!(normal_impulse > 0)) continue;
    const btScalar max_impulse = row.m_friction * normal_impulse;
    const btScalar first = row.m_appliedImpulse + unclamped_change(row);
    if (row.m_overrideNumSolverIterations == collision::friction_spin) {
      set_impulse(row, std::clamp(first, -max_impulse, max_impulse));
      continue;
    }
    if (row.m_overrideNumSolverIterations != collision::friction_along) continue;
    btSolverConstraint& across = rows[i + 1];
    const btScalar second = across.m_appliedImpulse + unclamped_change(across);
    const btScalar length = fixed::hypotf(first, second);
    const btScalar fraction = length > max_impulse ? max_impulse / length : btScalar(1);
    set_impulse(row, fraction * first);
    set_impulse(across, fraction * second);
  }
  return largest;
}

// Stores the rolling friction for the friction frames of the next step.
void IslandSolver::save_rolling_friction() {
  const btConstraintArray& rows = m_tmpSolverContactRollingFrictionConstraintPool;
  for (int i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i].m_overrideNumSolverIterations != collision::friction_along) continue;
    auto* point =
        static_cast<btManifoldPoint*>(m_tmpSolverContactConstraintPool[rows[i].m_frictionIndex].m_originalContactPoint);
    collision::store_rolling_friction(*point, rows[i].m_relpos2CrossNormal * rows[i].m_appliedImpulse +
                                                  rows[i + 1].m_relpos2CrossNormal * rows[i + 1].m_appliedImpulse);
  }
}

}  // namespace limber::sim::bullet
