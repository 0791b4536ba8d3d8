// Island: input of the direct solver, and Bullet's velocities and rotations in its types.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/bullet/rotation_step.h"
#include "sim/bullet/surface_motion.h"
#include "sim/solver/direct_solver.h"
#include "sim/solver/forest/axis_active_set.h"
#include "sim/solver/forest/spatial_algebra.h"
#include "sim/solver/indexed_array.h"

namespace limber::sim::solver {

inline Spatial make_spatial(const btVector3& linear, const btVector3& angular) {
  return {bullet::from_bt(linear), bullet::from_bt(angular)};
}

/// One island of bodies during one substep. [sim]
struct Island {
  struct Joint {  ///< A joint between two solver bodies.
    bullet::JointConstraint* constraint;
    int body_a;
    int body_b;
  };
  struct Coupling {  ///< A gear or tendon.
    bullet::CoupledConstraint* constraint;
    int first;  ///< Index of its first body in coupled_bodies; the others follow.
  };

  IndexedArray<Joint> joints;
  IndexedArray<Coupling> couplings;
  IndexedArray<int> coupled_bodies;  ///< Solver bodies, in the order of CoupledConstraint::jacobians().
  // set by DirectSolver::solve()
  const IslandPools* pools = nullptr;
  const btContactSolverInfo* info = nullptr;
  double h = 0;  ///< Length of the step, s.

  int body_of(const Coupling& coupling, int jacobian) const { return coupled_bodies[coupling.first + jacobian]; }
  btSolverBody& body(int i) const { return pools->bodies[i]; }
  btRigidBody& rigid(int i) const { return *body(i).m_originalBody; }
  bool is_dynamic(int i) const { return body(i).m_invMass.x() > 0; }
  /// True if a static body of a joint or contact moves.
  bool has_moving_static() const {
    for (int i = 0; i < pools->bodies.size(); ++i) {
      if (bullet::is_moving_static(body(i))) return true;
    }
    return false;
  }
  /// Velocity at the start of the step.
  Spatial start_velocity(int i) const { return make_spatial(body(i).m_linearVelocity, body(i).m_angularVelocity); }
  /// Velocity that external forces give the body, before the solve.
  Spatial velocity(int i) const {
    const btSolverBody& b = body(i);
    return make_spatial(b.m_linearVelocity + b.m_externalForceImpulse, b.m_angularVelocity + b.m_externalTorqueImpulse);
  }
  /// Splits the angular velocity `w` of a body into spin and rest.
  bullet::RotationStep rotation_step(int i, const Vec3& w) const {
    if (body(i).m_originalBody != nullptr) return bullet::split_rotation(rigid(i), w, h);
    bullet::RotationStep turn;
    turn.tumble = w;
    return turn;
  }
};

/// True for a lock without bounds or softness.
inline bool is_hard_lock(const bullet::JointRow& row) {
  return row.softness == 0 && static_cast<double>(row.lower) <= -AxisRow::kInfinity &&
         static_cast<double>(row.upper) >= AxisRow::kInfinity;
}

}  // namespace limber::sim::solver
