// JointBlock: the inverse is computed once per step in single precision; later sweeps correct its errors, since each
// starts from the exact residual.
#include "sim/bullet/joints/joint_block.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

/// Smallest pivot of the scaled matrix. Smaller ones are rounding errors and are raised to it, so that a solve of the
/// block never increases the error.
constexpr float kMinPivot = 1e-5f;

Float4 zero() { return Float4{0, 0, 0, 0}; }

float sum3(const Float4& v) { return (v[0] + v[1]) + v[2]; }

// Products of a row's Jacobian with the velocity changes, not yet summed.
Float4 rate_terms(const btSolverConstraint& row, const PairVelocity& v) {
  return (to_float4(row.m_contactNormal1) * v.linear_a + to_float4(row.m_relpos1CrossNormal) * v.angular_a) +
         (to_float4(row.m_contactNormal2) * v.linear_b + to_float4(row.m_relpos2CrossNormal) * v.angular_b);
}

void apply_impulse(const btSolverConstraint& row, float impulse, PairVelocity& v) {
  v.linear_a += to_float4(row.m_contactNormal1) * v.mass_a * impulse;
  v.angular_a += to_float4(row.m_angularComponentA) * impulse;
  v.linear_b += to_float4(row.m_contactNormal2) * v.mass_b * impulse;
  v.angular_b += to_float4(row.m_angularComponentB) * impulse;
}

}  // namespace

btScalar solve_row(const btSolverConstraint& row, PairVelocity& v) {
  const btScalar before = row.m_appliedImpulse;
  const btScalar unclamped = before + (row.m_rhs - before * row.m_cfm) - sum3(rate_terms(row, v)) * row.m_jacDiagABInv;
  const btScalar after = std::min(std::max(unclamped, row.m_lowerLimit), row.m_upperLimit);
  const btScalar change = after - before;
  row.m_appliedImpulse = after;
  apply_impulse(row, change, v);
  return change * change;
}

void JointBlock::build(const btSolverConstraint* rows, bool bounded, int locked, const btVector3& inverse_mass_a,
                       const btVector3& inverse_mass_b) {
  bounded_ = bounded ? rows : nullptr;
  rows_ = rows + (bounded ? 1 : 0);
  locked_ = locked;
  for (int half = 0; half < 2; ++half)
    target_[half] = softness_[half] = impulse_[half] = bounded_coupling_[half] = zero();
  const Float4 mass_a = to_float4(inverse_mass_a);
  const Float4 mass_b = to_float4(inverse_mass_b);

  // element of J M^-1 J' for two rows
  const auto matrix_element = [&](const btSolverConstraint& i, const btSolverConstraint& j) {
    return sum3((to_float4(i.m_contactNormal1) * mass_a * to_float4(j.m_contactNormal1) +
                 to_float4(i.m_angularComponentA) * to_float4(j.m_relpos1CrossNormal)) +
                (to_float4(i.m_contactNormal2) * mass_b * to_float4(j.m_contactNormal2) +
                 to_float4(i.m_angularComponentB) * to_float4(j.m_relpos2CrossNormal)));
  };
  // reverts the scaling of m_cfm by the row's step
  const auto softness = [](const btSolverConstraint& r) { return r.m_cfm > 0 ? r.m_cfm / r.m_jacDiagABInv : 0; };
  float k[kMaxRows][kMaxRows] = {};
  for (int i = 0; i < locked; ++i) {
    target_[i / 4][i % 4] = rows_[i].m_rhsPenetration;
    softness_[i / 4][i % 4] = softness(rows_[i]);
    for (int j = 0; j <= i; ++j) k[i][j] = matrix_element(rows_[i], rows_[j]);
    k[i][i] += softness(rows_[i]);
  }
  invert(k);
  if (!bounded) return;

  // Schur complement of the bounded row with respect to the locked ones
  const float diagonal = matrix_element(*bounded_, *bounded_);
  Float4 bounded_coupling[2] = {zero(), zero()};
  float coupling[kMaxRows] = {};
  for (int i = 0; i < locked; ++i) {
    coupling[i] = matrix_element(*bounded_, rows_[i]);
    for (int half = 0; half < 2; ++half) bounded_coupling[half] += inverse_[i][half] * coupling[i];
  }
  float schur = diagonal;
  for (int i = 0; i < locked; ++i) schur -= coupling[i] * bounded_coupling[i / 4][i % 4];
  schur = std::max(schur, kMinPivot * diagonal);
  bounded_inverse_ = diagonal > SIMD_EPSILON ? 1 / schur : 0;
  for (int half = 0; half < 2; ++half) bounded_coupling_[half] = bounded_coupling[half];
}

void JointBlock::invert(const float (&k)[kMaxRows][kMaxRows]) {
  // Cholesky of the matrix scaled to a diagonal of ones, inverse of the factor, product with its transpose
  const int n = locked_;
  float scale[kMaxRows] = {};
  float factor[kMaxRows][kMaxRows] = {};
  float inverse_factor[kMaxRows][kMaxRows] = {};
  for (int i = 0; i < n; ++i) scale[i] = k[i][i] > SIMD_EPSILON ? 1 / std::sqrt(k[i][i]) : 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      float sum = k[i][j] * scale[i] * scale[j];
      for (int m = 0; m < j; ++m) sum -= factor[i][m] * factor[j][m];
      factor[i][j] = sum * factor[j][j];
    }
    float pivot = 1;
    for (int m = 0; m < i; ++m) pivot -= factor[i][m] * factor[i][m];
    factor[i][i] = 1 / std::sqrt(std::max(pivot, kMinPivot));  // the diagonal is stored inverted
  }
  for (int j = 0; j < n; ++j) {
    inverse_factor[j][j] = factor[j][j];
    for (int i = j + 1; i < n; ++i) {
      float sum = 0;
      for (int m = j; m < i; ++m) sum -= factor[i][m] * inverse_factor[m][j];
      inverse_factor[i][j] = sum * factor[i][i];
    }
  }
  for (int i = 0; i < kMaxRows; ++i) inverse_[i][0] = inverse_[i][1] = zero();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      float sum = 0;
      for (int m = i; m < n; ++m) sum += inverse_factor[m][i] * inverse_factor[m][j];
      sum *= scale[i] * scale[j];
      inverse_[i][j / 4][j % 4] = sum;
      inverse_[j][i / 4][i % 4] = sum;
    }
  }
}

// Unrolled for each number of locked rows.
template <int kLocked>
btScalar JointBlock::solve_locked(PairVelocity& v) {
  // residuals of the locked rows, and their impulses without the bounded row
  Float4 terms[8];
  for (int i = 0; i < 8; ++i) terms[i] = i < kLocked ? rate_terms(rows_[i], v) : zero();
  const Float4 residual[2] = {
      target_[0] - softness_[0] * impulse_[0] - sum_xyz(terms[0], terms[1], terms[2], terms[3]),
      target_[1] - softness_[1] * impulse_[1] - sum_xyz(terms[4], terms[5], terms[6], terms[7])};
  Float4 change[2] = {inverse_[0][0] * residual[0][0], inverse_[0][1] * residual[0][0]};
  for (int i = 1; i < kLocked; ++i) {
    change[0] += inverse_[i][0] * residual[i / 4][i % 4];
    change[1] += inverse_[i][1] * residual[i / 4][i % 4];
  }
  btScalar largest = 0;
  if (bounded_) {
    const btSolverConstraint& row = *bounded_;
    const Float4 coupling = bounded_coupling_[0] * residual[0] + bounded_coupling_[1] * residual[1];
    const btScalar before = row.m_appliedImpulse;
    const btScalar residual_rate =
        row.m_rhsPenetration - sum3(rate_terms(row, v)) - ((coupling[0] + coupling[1]) + (coupling[2] + coupling[3]));
    const btScalar after =
        std::min(std::max(before + residual_rate * bounded_inverse_, row.m_lowerLimit), row.m_upperLimit);
    const btScalar bounded_change = after - before;
    row.m_appliedImpulse = after;
    change[0] -= bounded_coupling_[0] * bounded_change;
    change[1] -= bounded_coupling_[1] * bounded_change;
    apply_impulse(row, bounded_change, v);
    largest = bounded_change * bounded_change;
  }
  impulse_[0] += change[0];
  impulse_[1] += change[1];
  for (int i = 0; i < kLocked; ++i) apply_impulse(rows_[i], change[i / 4][i % 4], v);
  const Float4 squares = change[0] * change[0] + change[1] * change[1];
  return std::max(largest, (squares[0] + squares[1]) + (squares[2] + squares[3]));
}

btScalar JointBlock::solve(PairVelocity& v) {
  switch (locked_) {
    case 0:
      return solve_locked<0>(v);
    case 1:
      return solve_locked<1>(v);
    case 2:
      return solve_locked<2>(v);
    case 3:
      return solve_locked<3>(v);
    case 4:
      return solve_locked<4>(v);
    case 5:
      return solve_locked<5>(v);
    default:
      return solve_locked<6>(v);
  }
}

void JointBlock::warm_start(const float* impulses, PairVelocity& v) {
  if (bounded_) {
    bounded_->m_appliedImpulse = *impulses;
    apply_impulse(*bounded_, *impulses++, v);
  }
  for (int i = 0; i < locked_; ++i) {
    impulse_[i / 4][i % 4] = impulses[i];
    apply_impulse(rows_[i], impulses[i], v);
  }
}

void JointBlock::finish() const {
  for (int i = 0; i < locked_; ++i) rows_[i].m_appliedImpulse = impulse_[i / 4][i % 4];
}

}  // namespace limber::sim::bullet
