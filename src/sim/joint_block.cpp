// The block's factor is built once a step, in single precision: what it lacks in accuracy the next sweep repairs, as
// each sweep starts from the true residual.
#include "sim/joint_block.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

/// Least pivot of the scaled matrix: smaller ones are rounding, raised so that the block stays a descent step.
constexpr float kLeastPivot = 1e-5f;

Lanes zero() { return Lanes{0, 0, 0, 0}; }

float total(const Lanes& v) { return (v[0] + v[1]) + v[2]; }

// Rate that the velocities change gives a row, still in lanes.
Lanes rate(const btSolverConstraint& row, const PairVelocity& v) {
  return (lanes(row.m_contactNormal1) * v.linear_a + lanes(row.m_relpos1CrossNormal) * v.angular_a) +
         (lanes(row.m_contactNormal2) * v.linear_b + lanes(row.m_relpos2CrossNormal) * v.angular_b);
}

void apply(const btSolverConstraint& row, float impulse, PairVelocity& v) {
  v.linear_a += lanes(row.m_contactNormal1) * v.mass_a * impulse;
  v.angular_a += lanes(row.m_angularComponentA) * impulse;
  v.linear_b += lanes(row.m_contactNormal2) * v.mass_b * impulse;
  v.angular_b += lanes(row.m_angularComponentB) * impulse;
}

}  // namespace

btScalar solve_row(const btSolverConstraint& row, PairVelocity& v) {
  const btScalar before = row.m_appliedImpulse;
  const btScalar wanted = before + (row.m_rhs - before * row.m_cfm) - total(rate(row, v)) * row.m_jacDiagABInv;
  const btScalar after = std::min(std::max(wanted, row.m_lowerLimit), row.m_upperLimit);
  const btScalar change = after - before;
  row.m_appliedImpulse = after;
  apply(row, change, v);
  return change * change;
}

void JointBlock::build(const btSolverConstraint* rows, bool bounded, int locked, const btVector3& inverse_mass_a,
                       const btVector3& inverse_mass_b) {
  bounded_ = bounded ? rows : nullptr;
  rows_ = rows + (bounded ? 1 : 0);
  locked_ = locked;
  for (int half = 0; half < 2; ++half) wanted_[half] = soft_[half] = impulse_[half] = lean_[half] = zero();
  const Lanes mass_a = lanes(inverse_mass_a);
  const Lanes mass_b = lanes(inverse_mass_b);

  // response of every row to an impulse on row i; softness was scaled by the row's own step
  const auto coupled = [&](const btSolverConstraint& i, const btSolverConstraint& j) {
    return total((lanes(i.m_contactNormal1) * mass_a * lanes(j.m_contactNormal1) +
                  lanes(i.m_angularComponentA) * lanes(j.m_relpos1CrossNormal)) +
                 (lanes(i.m_contactNormal2) * mass_b * lanes(j.m_contactNormal2) +
                  lanes(i.m_angularComponentB) * lanes(j.m_relpos2CrossNormal)));
  };
  const auto softness = [](const btSolverConstraint& r) { return r.m_cfm > 0 ? r.m_cfm / r.m_jacDiagABInv : 0; };
  float k[kMost][kMost] = {};
  for (int i = 0; i < locked; ++i) {
    wanted_[i / 4][i % 4] = rows_[i].m_rhsPenetration;
    soft_[i / 4][i % 4] = softness(rows_[i]);
    for (int j = 0; j <= i; ++j) k[i][j] = coupled(rows_[i], rows_[j]);
    k[i][i] += softness(rows_[i]);
  }
  invert(k);
  if (!bounded) return;

  // the bounded row after the locked ones: its Schur complement
  const float own = coupled(*bounded_, *bounded_);
  Lanes lean[2] = {zero(), zero()};
  float coupling[kMost] = {};
  for (int i = 0; i < locked; ++i) {
    coupling[i] = coupled(*bounded_, rows_[i]);
    for (int half = 0; half < 2; ++half) lean[half] += inverse_[i][half] * coupling[i];
  }
  float schur = own;
  for (int i = 0; i < locked; ++i) schur -= coupling[i] * lean[i / 4][i % 4];
  schur = std::max(schur, kLeastPivot * own);
  bounded_step_ = own > SIMD_EPSILON ? 1 / schur : 0;
  for (int half = 0; half < 2; ++half) lean_[half] = lean[half];
}

void JointBlock::invert(const float (&k)[kMost][kMost]) {
  // Cholesky of the matrix scaled to a diagonal of ones, inverse of the factor, product with its transpose
  const int n = locked_;
  float scale[kMost] = {};
  float factor[kMost][kMost] = {};
  float root[kMost][kMost] = {};
  for (int i = 0; i < n; ++i) scale[i] = k[i][i] > SIMD_EPSILON ? 1 / std::sqrt(k[i][i]) : 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      float sum = k[i][j] * scale[i] * scale[j];
      for (int m = 0; m < j; ++m) sum -= factor[i][m] * factor[j][m];
      factor[i][j] = sum * factor[j][j];
    }
    float pivot = 1;
    for (int m = 0; m < i; ++m) pivot -= factor[i][m] * factor[i][m];
    factor[i][i] = 1 / std::sqrt(std::max(pivot, kLeastPivot));  // the diagonal is kept inverted
  }
  for (int j = 0; j < n; ++j) {
    root[j][j] = factor[j][j];
    for (int i = j + 1; i < n; ++i) {
      float sum = 0;
      for (int m = j; m < i; ++m) sum -= factor[i][m] * root[m][j];
      root[i][j] = sum * factor[i][i];
    }
  }
  for (int i = 0; i < kMost; ++i) inverse_[i][0] = inverse_[i][1] = zero();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      float sum = 0;
      for (int m = i; m < n; ++m) sum += root[m][i] * root[m][j];
      sum *= scale[i] * scale[j];
      inverse_[i][j / 4][j % 4] = sum;
      inverse_[j][i / 4][i % 4] = sum;
    }
  }
}

// For each number of locked rows its own code, without loops.
template <int kLocked>
btScalar JointBlock::solve_locked(PairVelocity& v) {
  // residuals of the locked rows, and what they alone would give
  Lanes rates[8];
  for (int i = 0; i < 8; ++i) rates[i] = i < kLocked ? rate(rows_[i], v) : zero();
  const Lanes residual[2] = {
      wanted_[0] - soft_[0] * impulse_[0] - sums_of_three(rates[0], rates[1], rates[2], rates[3]),
      wanted_[1] - soft_[1] * impulse_[1] - sums_of_three(rates[4], rates[5], rates[6], rates[7])};
  Lanes change[2] = {inverse_[0][0] * residual[0][0], inverse_[0][1] * residual[0][0]};
  for (int i = 1; i < kLocked; ++i) {
    change[0] += inverse_[i][0] * residual[i / 4][i % 4];
    change[1] += inverse_[i][1] * residual[i / 4][i % 4];
  }
  btScalar largest = 0;
  if (bounded_) {
    const btSolverConstraint& row = *bounded_;
    const Lanes leaned = lean_[0] * residual[0] + lean_[1] * residual[1];
    const btScalar before = row.m_appliedImpulse;
    const btScalar left =
        row.m_rhsPenetration - total(rate(row, v)) - ((leaned[0] + leaned[1]) + (leaned[2] + leaned[3]));
    const btScalar after = std::min(std::max(before + left * bounded_step_, row.m_lowerLimit), row.m_upperLimit);
    const btScalar turned = after - before;
    row.m_appliedImpulse = after;
    change[0] -= lean_[0] * turned;
    change[1] -= lean_[1] * turned;
    apply(row, turned, v);
    largest = turned * turned;
  }
  impulse_[0] += change[0];
  impulse_[1] += change[1];
  for (int i = 0; i < kLocked; ++i) apply(rows_[i], change[i / 4][i % 4], v);
  const Lanes squares = change[0] * change[0] + change[1] * change[1];
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
    apply(*bounded_, *impulses++, v);
  }
  for (int i = 0; i < locked_; ++i) {
    impulse_[i / 4][i % 4] = impulses[i];
    apply(rows_[i], impulses[i], v);
  }
}

void JointBlock::finish() const {
  for (int i = 0; i < locked_; ++i) rows_[i].m_appliedImpulse = impulse_[i / 4][i % 4];
}

}  // namespace limber
