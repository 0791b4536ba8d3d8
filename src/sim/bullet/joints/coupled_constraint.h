// CoupledConstraint: one solver row that acts on any number of bodies; the base of gears and tendons.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/solver/indexed_array.h"

namespace limber::sim::bullet {

/// For IslandSolver, DirectSolver and IslandWorld. All memory is that of the BulletMemory::Scope of its construction.
/// [sim]
class CoupledConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Jacobian with respect to one body: impulse on the body per impulse of the row.
  struct BodyJacobian {
    btRigidBody* body = nullptr;
    btVector3 linear{0, 0, 0};
    btVector3 angular{0, 0, 0};
  };
  /// rate + softness·impulse = velocity, where rate is that of the dynamic bodies' motion.
  struct Row {
    double velocity = 0;
    double softness = 0;
    double lower = 0;  ///< Bounds of the impulse.
    double upper = 0;
    double mobility = 0;  ///< Inverse effective mass: rate per impulse of the dynamic bodies without joints.
  };
  /// Plans the row of the next substep of length h; the joints must have been planned.
  virtual void plan(btScalar h) = 0;
  const Row& row() const { return row_; }
  /// Dynamic bodies, each once.
  solver::IndexedSpan<const BodyJacobian> jacobians() const {
    return jacobian_count_ > 0 ? solver::IndexedSpan<const BodyJacobian>(&jacobians_[0], jacobian_count_)
                               : solver::IndexedSpan<const BodyJacobian>();
  }
  /// Warm-start impulse of the sweeps.
  double warm_impulse() const { return static_cast<double>(warm_impulse_); }
  /// Stores the impulse of the step, for warm starting and the mean force.
  void set_impulse(double impulse);
  void forget_impulses() { last_impulse_ = 0; }
  /// Mean force (impulse per time) in the last tick.
  double applied() const { return static_cast<double>(applied_); }
  /// To be called after a part was teleported: resets impulses.
  virtual void reset() { last_impulse_ = applied_ = 0; }
  /// Ends a tick: averages the applied force.
  virtual void end_tick();

  void getInfo1(btConstraintInfo1* info) override { *info = {0, 0}; }
  void getInfo2(btConstraintInfo2*) override {}
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  /// Types of the derived classes: from kFirstType on.
  static constexpr auto kFirstType = static_cast<btTypedConstraintType>(MAX_CONSTRAINT_TYPE + 1);
  static constexpr auto kLastType = static_cast<btTypedConstraintType>(MAX_CONSTRAINT_TYPE + 2);

 protected:
  CoupledConstraint(btTypedConstraintType type, btRigidBody& a, btRigidBody& b, int max_bodies);

  /// Starts a row without Jacobians.
  void begin_row(btScalar h);
  /// Adds to the Jacobian of a body; for a static one that moves, to the row's rate by the motion of static bodies.
  void add_jacobian(btRigidBody& body, const btVector3& linear, const btVector3& angular);
  double mobility() const;
  double static_rate() const { return static_rate_; }
  float tick_time() const { return tick_time_; }

  Row row_;

 private:
  btAlignedObjectArray<BodyJacobian> jacobians_;
  int jacobian_count_ = 0;
  double static_rate_ = 0;
  btScalar h_ = 0;
  float last_impulse_ = 0;
  float warm_impulse_ = 0;
  float tick_impulse_ = 0;
  float tick_time_ = 0;
  float applied_ = 0;
};

inline bool is_coupled(const btTypedConstraint& constraint) {
  const int type = constraint.getConstraintType();
  return type >= CoupledConstraint::kFirstType && type <= CoupledConstraint::kLastType;
}

}  // namespace limber::sim::bullet
