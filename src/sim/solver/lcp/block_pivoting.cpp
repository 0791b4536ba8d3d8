// BlockPivoting: the matrix of the free rows, and exchanges of statuses.
#include "sim/solver/lcp/block_pivoting.h"

#include <algorithm>

namespace limber::sim::solver {
namespace {

/// After kTrialExchanges, pivoting is aborted if more than this fraction of the rows is still violated: it would rarely
/// converge.
constexpr int kTrialExchanges = 1;
constexpr double kMaxViolatedFraction = 0.2;
constexpr int kPatience = 3;  // exchanges without improvement before they are made one at a time

}  // namespace

void BlockPivoting::assemble() {
  const int size = lcp_.size();
  free_.clear();
  free_index_.resize(size);
  tied_normals_.resize(size);
  for (int i = 0; i < size; ++i) {
    const int normal = lcp_.row(i).normal;
    const bool bounded = lcp_.status[i] != LcpState::free;
    free_index_[i] = -1;
    tied_normals_[i] = bounded && normal >= 0 ? free_index_[normal] : -1;
    if (bounded || !(lcp_.response(i, i) > 0)) continue;
    free_index_[i] = free_.size();
    free_.push_back(i);
  }
  const int n = free_.size();
  lcp_.budget.charge(n + size, n);
  lu_.reset(n);
  for (int i = 0; i < n; ++i) {
    const double* from = &lcp_.response(free_[i], 0);
    double* to = lu_.row(i);
    for (int k = 0; k < n; ++k) to[k] = from[free_[k]];
  }
  for (int k = 0; k < size; ++k) {
    const int normal_index = tied_normal(k);
    if (normal_index < 0) continue;
    const double friction = lcp_.row(k).friction;
    const double factor = lcp_.status[k] == LcpState::at_upper ? friction : -friction;
    for (int i = 0; i < n; ++i) lu_.row(i)[normal_index] += factor * lcp_.response(free_[i], k);
  }
}

bool BlockPivoting::factor() {
  assemble();
  return free_.size() <= kMaxFree && lu_.factor();
}

// Applies the impulses that make the residuals of the free rows zero, and updates sliding rows.
void BlockPivoting::correct_free() {
  const int n = free_.size();
  step_.resize(n);
  for (int i = 0; i < n; ++i) step_[i] = lcp_.residuals[free_[i]];
  lu_.solve(step_);
  for (int i = 0; i < n; ++i) lcp_.queue_change(free_[i], step_[i]);
  update_bounded_rows();
}

void BlockPivoting::update_bounded_rows() {
  lcp_.budget.charge(lcp_.size(), 0);
  for (int i = 0; i < lcp_.size(); ++i) {
    if (lcp_.status[i] == LcpState::free) continue;
    Row& r = lcp_.row(i);
    const bool upper = lcp_.status[i] == LcpState::at_upper;
    if (tied_normal(i) >= 0) {
      // tied even if the normal pulls; the next exchange corrects that
      lcp_.queue_impulse(i, (upper ? r.friction : -r.friction) * lcp_.row(r.normal).impulse);
    } else {
      lcp_.update_bounds(r);
      lcp_.queue_impulse(i, upper ? r.upper : r.lower);
    }
  }
  lcp_.flush_changes();
}

bool BlockPivoting::solve_free() {
  if (!factored_ && !factor()) return false;
  factored_ = true;
  update_bounded_rows();
  correct_free();
  return true;
}

// Returns the status that the present impulse and residual of a row require.
LcpState::Status BlockPivoting::required_status(int i) {
  const double threshold = lcp_.tolerance();
  const LcpState::Status status = lcp_.status[i];
  Row& r = lcp_.row(i);
  if (!(lcp_.response(i, i) > 0)) return status;
  lcp_.update_bounds(r);
  if (status == LcpState::free) {
    const double slack = 0.1 * threshold * lcp_.inverse_diagonal[i];
    if (r.impulse > r.upper + slack) return LcpState::at_upper;
    return r.impulse < r.lower - slack ? LcpState::at_lower : LcpState::free;
  }
  const double residual = lcp_.residuals[i];
  const bool leaves_bound = status == LcpState::at_lower ? residual > threshold : residual < -threshold;
  return r.lower < r.upper && leaves_bound ? LcpState::free : status;
}

// Exchanges the status of rows that violate their condition (`only_last`: of the last one). Returns the number of
// violations.
int BlockPivoting::exchange(bool only_last) {
  lcp_.budget.charge(lcp_.size(), 0);
  int violated = 0;
  for (int i = lcp_.size(); i-- > 0;) {
    const LcpState::Status required = required_status(i);
    if (required == lcp_.status[i]) continue;
    violated++;
    if (!only_last || violated == 1) lcp_.status[i] = required;
  }
  return violated;
}

bool BlockPivoting::solve(int max_exchanges) {
  int fewest_violations = lcp_.size() + 1;
  int patience = kPatience;
  factored_ = false;
  double last_violation = 1e300;
  for (int round = 0; round < max_exchanges; ++round) {
    if (!solve_free()) return false;
    const int violated = exchange(patience == 0);
    if (violated == 0) {
      const double violation = lcp_.record_violation();
      if (lcp_.violation <= lcp_.tolerance()) return true;
      if (violation > 0.7 * last_violation) return false;
      last_violation = violation;
      continue;
    }
    factored_ = false;
    if (round >= kTrialExchanges && violated > kMaxViolatedFraction * lcp_.size()) return false;
    if (violated < fewest_violations) {
      fewest_violations = violated;
      patience = kPatience;
    } else {
      patience = std::max(patience - 1, 0);
    }
  }
  return false;
}

}  // namespace limber::sim::solver
