// IslandSolver: sets up the constraint rows of the joints and contacts of an island, solves them, and stores the
// joints' impulses.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/bullet/contact_solver.h"
#include "sim/bullet/joints/coupled_constraint.h"
#include "sim/bullet/joints/joint_block.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/solver/direct_solver.h"

namespace limber::sim::bullet {

/// Sequential impulses with our own joint rows, whose softness has physical units (rate + softness·impulse = velocity)
/// and which are stable for any softness. Also applies gyroscopic torques, which Bullet omits for light bodies (its 3x3
/// solver treats determinants below 1.2e-7 as zero). [sim]
class IslandSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  void set_direct(bool on) { direct_enabled_ = on; }
  bool direct_enabled() const { return direct_enabled_; }
  /// Sets the number of substeps per tick, and of those that are left, the current one included.
  void set_substep(int steps_left, int count) {
    steps_left_ = steps_left;
    step_count_ = count;
  }
  /// True: the next islands use the direct solver even if they have no joints.
  void set_contacts_direct(bool on) { contacts_direct_ = on; }
  solver::DirectSolver& direct() { return direct_; }
  const solver::DirectSolver& direct() const { return direct_; }

 protected:
  void convertBodies(btCollisionObject** bodies, int count, const btContactSolverInfo& info) override;
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  void convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  void solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject** bodies, int body_count,
                                                     btPersistentManifold** manifolds, int manifold_count,
                                                     btTypedConstraint** constraints, int constraint_count,
                                                     const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  int solver_body(btCollisionObject& object, btScalar h);
  int moving_static_body(const btRigidBody& body);
  void reserve_rows(int joints);
  void plan(JointConstraint& joint, const btContactSolverInfo& info);
  bool plan_direct(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_constraints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_rows(JointConstraint& joint, btSolverConstraint* rows, int count, const btContactSolverInfo& info);
  JointBlock& add_rows(const btSolverConstraint* rows, int count, bool bounded, int locked);
  void plan_couplings(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_couplings(const btContactSolverInfo& info);
  btScalar sweep_joints();
  void convert_contact(btPersistentManifold& manifold, const btContactSolverInfo& info);
  void add_body_motion(btSolverConstraint& normal, const btManifoldPoint& point, const btVector3& slip,
                       const btVector3& motion, const btContactSolverInfo& info);
  struct ContactBodies {  // solver bodies
    int a;
    int b;
  };
  void convert_rolling(btManifoldPoint& point, int contact, const ContactBodies& bodies, btScalar last_normal_impulse,
                       const btVector3& surface_spin);
  btScalar sweep_coupling(int coupling);
  btScalar sweep_rolling();
  void save_rolling_friction();

  struct SweptJoint {  // of one joint: `scalar` single rows from `first` on, then the rows of the block
    int first;
    int scalar;
    int body_a;
    int body_b;
    JointBlock block;
  };
  struct CoupledSide {  // Jacobian with respect to a body, and the body's velocity change per impulse
    int body;
    btVector3 linear, angular;
    btVector3 linear_per_impulse, angular_per_impulse;
  };
  struct Coupling {  // a gear or tendon
    CoupledConstraint* constraint;
    int first;  // its sides, in sides_
    int count;
    btScalar target_rate;  // rate that is missing without the impulses of this step
    btScalar softness;
    btScalar step;  // impulse per missing rate
    btScalar lower, upper;
    btScalar impulse;
  };
  void apply_coupled_impulse(const Coupling& coupling, btScalar impulse);

  struct MovingStatic {
    const btRigidBody* body;
    int solver_body;
  };
  btAlignedObjectArray<MovingStatic> moving_statics_;  // of the present island

  solver::IndexedArray<Coupling> couplings_;  // of the present island
  solver::IndexedArray<CoupledSide> sides_;
  bool couplings_swept_ = false;
  solver::IndexedArray<JointRow> planned_;  // of all joints of the island, in their order
  int planned_count_ = 0;
  btAlignedObjectArray<SweptJoint> joints_;
  ContactSolver contacts_;
  solver::DirectSolver direct_;
  int steps_left_ = 1;
  int step_count_ = 1;
  bool direct_enabled_ = false;
  bool contacts_direct_ = false;
  bool use_direct_ = false;  // in the present island
};

}  // namespace limber::sim::bullet
