// SubspaceDescent: steps, projections, and the release of rows.
#include "sim/solver/lcp/subspace_descent.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Up to this number of rows nothing is allocated.
constexpr int kReservedFreeRows = 160;
constexpr int kMaxDescents = 60;
constexpr int kBriefDescents = 10;  // once the work budget is exceeded
constexpr int kMaxBlockReleases = 30;
constexpr int kMaxRecenterings = 5;

}  // namespace

SubspaceDescent::SubspaceDescent(LcpState& lcp, BlockPivoting& pivoting)
    : lcp_(lcp), pivoting_(pivoting), factor_(lcp.budget, kReservedFreeRows) {}

bool SubspaceDescent::solve() {
  impulses_before_.resize(lcp_.size());
  pivoting_.update_bounded_rows();
  int recenterings = 0;
  for (int round = 0; round < (lcp_.budget.exceeded() ? kBriefDescents : kMaxDescents); ++round) {
    if (!factor_free()) return false;
    step_free();
    if (!project_step()) continue;
    if (release_rows(round > kMaxBlockReleases) > 0) continue;
    lcp_.recenter();
    lcp_.violation = lcp_.max_violation();
    if (lcp_.violation <= lcp_.tolerance() || ++recenterings == kMaxRecenterings) return true;
  }
  lcp_.recenter();
  lcp_.violation = lcp_.max_violation();
  return lcp_.budget.exceeded();
}

bool SubspaceDescent::factor_free() {
  is_free_.resize(lcp_.size());
  for (int i = 0; i < lcp_.size(); ++i)
    is_free_[i] = lcp_.status[i] == LcpState::free && lcp_.response(i, i) > 0 ? 1 : 0;
  return factor_.select(is_free_, BlockPivoting::kMaxFree);
}

// Applies the impulses that make the residuals of the free rows zero.
void SubspaceDescent::step_free() {
  const IndexedSpan<const int> rows = factor_.rows();
  residuals_before_ = lcp_.residuals;
  step_.resize(rows.size());
  for (int k = 0; k < rows.size(); ++k) {
    impulses_before_[rows[k]] = lcp_.row(rows[k]).impulse;
    step_[k] = lcp_.residuals[rows[k]];
  }
  factor_.solve(step_);
  for (int k = 0; k < rows.size(); ++k) lcp_.queue_change(rows[k], step_[k]);
  lcp_.flush_changes();
}

// Fraction of the step up to the first bound; 1: the full step is within the bounds.
double SubspaceDescent::longest_step() const {
  double length = 1;
  for (const int i : factor_.rows()) {
    const LcpState::Row& r = lcp_.row(i);
    const double from = impulses_before_[i];
    if (r.impulse > r.upper) length = std::min(length, (r.upper - from) / (r.impulse - from));
    if (r.impulse < r.lower) length = std::min(length, (r.lower - from) / (r.impulse - from));
  }
  return length;
}

// Projects the step from impulses_before_ to the bounds, or shortens it if the projection increases the energy. Returns
// true if the full step is within the bounds.
bool SubspaceDescent::project_step() {
  lcp_.budget.charge(2 * lcp_.size(), 0);
  const IndexedSpan<const int> rows = factor_.rows();
  const double step_length = longest_step();
  if (step_length == 1) return true;
  for (int k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    const LcpState::Row& r = lcp_.row(i);
    step_[k] = r.impulse - impulses_before_[i];
    lcp_.queue_impulse(i, std::clamp(r.impulse, r.lower, r.upper));
  }
  lcp_.flush_changes();
  double energy_decrease = 0;
  for (const int i : rows)
    energy_decrease += (lcp_.row(i).impulse - impulses_before_[i]) * (residuals_before_[i] + lcp_.residuals[i]);
  shorten_step(step_length, energy_decrease > 0);
  return false;
}

// Sets the status of the rows that reach their bounds. Unless the projection decreases the energy, shortens the step to
// the first of them.
void SubspaceDescent::shorten_step(double step_length, bool decreases) {
  const IndexedSpan<const int> rows = factor_.rows();
  for (int k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    const LcpState::Row& r = lcp_.row(i);
    const double from = impulses_before_[i];
    const double to = from + step_[k];
    const bool above = to > r.upper;
    if (!above && to >= r.lower) {
      if (!decreases) lcp_.queue_impulse(i, from + step_length * step_[k]);
      continue;
    }
    const double bound = above ? r.upper : r.lower;
    if (decreases || std::fabs(bound - from) <= step_length * std::fabs(step_[k]) * (1 + 1e-12)) {
      lcp_.queue_impulse(i, bound);
      lcp_.status[i] = above ? LcpState::at_upper : LcpState::at_lower;
    } else {
      lcp_.queue_impulse(i, from + step_length * step_[k]);
    }
  }
  lcp_.flush_changes();
}

// Frees rows whose residual points away from their bound: all of them, or the one with the largest residual. Returns
// the number of such rows.
int SubspaceDescent::release_rows(bool only_one) {
  lcp_.budget.charge(lcp_.size(), 0);
  const double threshold = 0.5 * lcp_.tolerance();
  int released = 0;
  int best = -1;
  double largest = 0;
  for (int i = 0; i < lcp_.size(); ++i) {
    const LcpState::Row& r = lcp_.row(i);
    LcpState::Status& status = lcp_.status[i];
    if (status == LcpState::free || !(lcp_.response(i, i) > 0) || !(r.lower < r.upper)) continue;
    const double violation = status == LcpState::at_lower ? lcp_.residuals[i] : -lcp_.residuals[i];
    if (!(violation > threshold)) continue;
    released++;
    if (!only_one) status = LcpState::free;
    if (violation > largest) {
      largest = violation;
      best = i;
    }
  }
  if (only_one && best >= 0) lcp_.status[best] = LcpState::free;
  return released;
}

}  // namespace limber::sim::solver
