// JointBlock: the rows of one joint that are solved together, exactly: its locked axes, and one bounded motor row.
// Gauss-Seidel over such blocks converges faster than over rows, and costs less, as the rows' dots don't wait for
// each other.
#pragma once

#include <cstring>

#include "sim/bullet.h"

namespace limber {

/// Four floats at once. Debian's Bullet does not align its vectors; their fourth float is 0 in rows and bodies.
using Lanes = float __attribute__((vector_size(16)));
inline Lanes lanes(const btVector3& v) {
  Lanes l;
  std::memcpy(&l, v.m_floats, sizeof l);
  return l;
}
inline void put(const Lanes& l, btVector3& v) { std::memcpy(v.m_floats, &l, sizeof l); }

/// x + y + z of four vectors, in that order.
inline Lanes sums_of_three(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);  // a0 b0 a1 b1
  const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Lanes ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);  // a2 b2 a3 b3
  const Lanes cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const Lanes first = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  const Lanes second = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  const Lanes third = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  return (first + second) + third;
}

/// Change of velocity of two bodies while the rows between them are swept.
struct PairVelocity {
  PairVelocity(const btSolverBody& a, const btSolverBody& b)
      : linear_a(lanes(a.m_deltaLinearVelocity)),
        angular_a(lanes(a.m_deltaAngularVelocity)),
        linear_b(lanes(b.m_deltaLinearVelocity)),
        angular_b(lanes(b.m_deltaAngularVelocity)),
        mass_a(lanes(a.m_invMass)),
        mass_b(lanes(b.m_invMass)) {}
  void store(btSolverBody& a, btSolverBody& b) const {
    put(linear_a, a.m_deltaLinearVelocity);
    put(angular_a, a.m_deltaAngularVelocity);
    put(linear_b, b.m_deltaLinearVelocity);
    put(angular_b, b.m_deltaAngularVelocity);
  }

  Lanes linear_a, angular_a, linear_b, angular_b;
  Lanes mass_a, mass_b;  ///< Inverse masses.
};

/// The same of the velocity that only pushes them apart.
struct PairPush : PairVelocity {
  PairPush(const btSolverBody& a, const btSolverBody& b) : PairVelocity(a, b) {
    linear_a = lanes(a.m_pushVelocity);
    angular_a = lanes(a.m_turnVelocity);
    linear_b = lanes(b.m_pushVelocity);
    angular_b = lanes(b.m_turnVelocity);
  }
  void store(btSolverBody& a, btSolverBody& b) const {
    put(linear_a, a.m_pushVelocity);
    put(angular_a, a.m_turnVelocity);
    put(linear_b, b.m_pushVelocity);
    put(angular_b, b.m_turnVelocity);
  }
};

/// One sequential-impulse step of a single row; returns the squared change of its impulse.
btScalar solve_row(const btSolverConstraint& row, PairVelocity& v);

class JointBlock {
 public:
  static constexpr int kMost = 6;

  /// `rows`: first the bounded row, a stiff one, if there is one, then `locked` rows, at most six in number. A row's
  /// m_rhsPenetration holds the rate it wants, less the rate it has; its m_cfm and m_jacDiagABInv are already scaled by
  /// IslandSolver.
  void build(const btSolverConstraint* rows, bool bounded, int locked, const btVector3& inverse_mass_a,
             const btVector3& inverse_mass_b);
  /// Starts from these impulses, in the order of the rows given to build(), and applies them.
  void warm_start(const float* impulses, PairVelocity& v);
  /// Solves the block against the bodies' present velocities; returns the largest squared change of an impulse.
  btScalar solve(PairVelocity& v);
  /// Writes the impulses into the rows.
  void finish() const;

 private:
  void invert(const float (&k)[kMost][kMost]);
  template <int kLocked>
  btScalar solve_locked(PairVelocity& v);

  const btSolverConstraint* rows_ = nullptr;  // the locked ones
  const btSolverConstraint* bounded_ = nullptr;
  int locked_ = 0;
  float bounded_step_ = 0;   // 1 / Schur complement of the bounded row
  Lanes inverse_[kMost][2];  // columns of K^-1, K = J M^-1 J' + softness of the locked rows
  Lanes lean_[2];            // K^-1 k: what the locked impulses give per bounded impulse
  Lanes wanted_[2];
  Lanes soft_[2];
  Lanes impulse_[2];
};

}  // namespace limber
