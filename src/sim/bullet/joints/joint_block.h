// JointBlock: rows of one joint that are solved together exactly: its locked axes and one bounded motor row.
// Gauss-Seidel over such blocks converges faster than over rows, and costs less because the rows' dot products are
// independent of each other.
#pragma once

#include <cstring>

#include "sim/bullet/bullet.h"
#include "sim/bullet/simd.h"

namespace limber::sim::bullet {

/// Bullet on Debian doesn't align its vectors; their fourth float is 0 in rows and bodies.
inline Float4 to_float4(const btVector3& v) {
  Float4 vector;
  std::memcpy(&vector, v.m_floats, sizeof vector);
  return vector;
}
inline void store_vector(const Float4& vector, btVector3& v) { std::memcpy(v.m_floats, &vector, sizeof vector); }

/// x + y + z of each of four vectors, added in that order.
inline Float4 sum_xyz(const Float4& a, const Float4& b, const Float4& c, const Float4& d) {
  const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);  // a0 b0 a1 b1
  const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);  // a2 b2 a3 b3
  const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const Float4 first = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  const Float4 second = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  const Float4 third = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  return (first + second) + third;
}

/// Velocity changes of two bodies while the rows between them are swept.
struct PairVelocity {
  PairVelocity(const btSolverBody& a, const btSolverBody& b)
      : linear_a(to_float4(a.m_deltaLinearVelocity)),
        angular_a(to_float4(a.m_deltaAngularVelocity)),
        linear_b(to_float4(b.m_deltaLinearVelocity)),
        angular_b(to_float4(b.m_deltaAngularVelocity)),
        mass_a(to_float4(a.m_invMass)),
        mass_b(to_float4(b.m_invMass)) {}
  void store(btSolverBody& a, btSolverBody& b) const {
    store_vector(linear_a, a.m_deltaLinearVelocity);
    store_vector(angular_a, a.m_deltaAngularVelocity);
    store_vector(linear_b, b.m_deltaLinearVelocity);
    store_vector(angular_b, b.m_deltaAngularVelocity);
  }

  Float4 linear_a, angular_a, linear_b, angular_b;
  Float4 mass_a, mass_b;  ///< Inverse masses.
};

/// The same for the split-impulse velocities.
struct PairPushVelocity : PairVelocity {
  PairPushVelocity(const btSolverBody& a, const btSolverBody& b) : PairVelocity(a, b) {
    linear_a = to_float4(a.m_pushVelocity);
    angular_a = to_float4(a.m_turnVelocity);
    linear_b = to_float4(b.m_pushVelocity);
    angular_b = to_float4(b.m_turnVelocity);
  }
  void store(btSolverBody& a, btSolverBody& b) const {
    store_vector(linear_a, a.m_pushVelocity);
    store_vector(angular_a, a.m_turnVelocity);
    store_vector(linear_b, b.m_pushVelocity);
    store_vector(angular_b, b.m_turnVelocity);
  }
};

/// One sequential-impulse step of a single row. Returns the squared change of its impulse.
btScalar solve_row(const btSolverConstraint& row, PairVelocity& v);

class JointBlock {
 public:
  static constexpr int kMaxRows = 6;

  /// Prepares the block for a step. `rows` contains the bounded row (if `bounded`; it must be hard), followed by
  /// `locked` rows of locked axes; at most six in total. A row's m_rhsPenetration is its target rate minus its present
  /// rate; IslandSolver has already scaled its m_cfm and m_jacDiagABInv.
  void build(const btSolverConstraint* rows, bool bounded, int locked, const btVector3& inverse_mass_a,
             const btVector3& inverse_mass_b);
  /// Starts from these impulses, in the order of the rows passed to build(), and applies them.
  void warm_start(const float* impulses, PairVelocity& v);
  /// Solves the block against the bodies' present velocities; returns the largest squared change of an impulse.
  btScalar solve(PairVelocity& v);
  /// Writes the impulses into the rows.
  void finish() const;

 private:
  void invert(const float (&k)[kMaxRows][kMaxRows]);
  template <int kLocked>
  btScalar solve_locked(PairVelocity& v);

  const btSolverConstraint* rows_ = nullptr;  // the locked rows
  const btSolverConstraint* bounded_ = nullptr;
  int locked_ = 0;
  float bounded_inverse_ = 0;    // 1 / Schur complement of the bounded row
  Float4 inverse_[kMaxRows][2];  // columns of K^-1, K = J M^-1 J' + softness of the locked rows
  Float4 bounded_coupling_[2];   // K^-1 k: change of the locked impulses per bounded impulse
  Float4 target_[2];
  Float4 softness_[2];
  Float4 impulse_[2];
};

}  // namespace limber::sim::bullet
