// Coulomb friction: rounds of a convex problem in which friction's bounds are frozen, each followed by pivoting with
// friction tied to its normals.
#include <algorithm>
#include <cmath>

#include "sim/solver/boxed_lcp.h"

namespace limber {
namespace {

constexpr int kMaxTiedExchanges = 4;
constexpr int kMaxDescents = 60;
constexpr int kBriefDescents = 10;  // once the work budget is exceeded
constexpr int kMaxBlockReleases = 30;
constexpr int kMaxRecenterings = 5;
constexpr int kMaxFrictionRounds = 12;
/// Status changes per row before the path is aborted.
constexpr int kMaxChangesPerRow = 4;
constexpr int kUndampedRounds = 3;  // later rounds move friction's bounds only halfway

}  // namespace

// Active-set descent of the convex problem with frozen bounds (subspace minimization): steps to the minimum of the free
// rows, projected to the bounds if that decreases the dual energy. Each step decreases it.
bool BoxedLcp::descend() {
  impulses_before_.resize(rows_.size());
  update_bounded_rows();
  int recenterings = 0;
  for (int round = 0; round < (budget_.exceeded() ? kBriefDescents : kMaxDescents); ++round) {
    if (!factor_free()) return false;
    step_free();
    if (!project_step()) continue;
    if (release_rows(round > kMaxBlockReleases) > 0) continue;
    recenter();
    violation_ = max_violation();
    if (violation_ <= tolerance() || ++recenterings == kMaxRecenterings) return true;
  }
  recenter();
  violation_ = max_violation();
  return budget_.exceeded();  // then this result is accepted
}

bool BoxedLcp::factor_free() {
  is_free_.resize(rows_.size());
  for (int i = 0; i < size(); ++i) is_free_[nth(i)] = status_[nth(i)] == free && response(i, i) > 0 ? 1 : 0;
  return free_factor_.select(is_free_, kMaxFree);
}

// Applies the impulses that make the residuals of the free rows zero.
void BoxedLcp::step_free() {
  const std::span<const int> rows = free_factor_.rows();
  residuals_before_ = residuals_;
  step_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    impulses_before_[nth(rows[k])] = row(rows[k]).impulse;
    step_[k] = residuals_[nth(rows[k])];
  }
  free_factor_.solve(step_);
  for (std::size_t k = 0; k < rows.size(); ++k) queue_change(rows[k], step_[k]);
  apply_changes();
}

// Projects the step from impulses_before_ to the bounds, or shortens it if the projection increases the dual energy.
// Returns true if the full step is within the bounds.
bool BoxedLcp::project_step() {
  budget_.charge(2 * size(), 0);
  const std::span<const int> rows = free_factor_.rows();
  double step_length = 1;
  for (const int i : rows) {
    const Row& r = row(i);
    const double from = impulses_before_[nth(i)];
    if (r.impulse > r.upper) step_length = std::min(step_length, (r.upper - from) / (r.impulse - from));
    if (r.impulse < r.lower) step_length = std::min(step_length, (r.lower - from) / (r.impulse - from));
  }
  if (step_length == 1) return true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    step_[k] = row(i).impulse - impulses_before_[nth(i)];
    queue_impulse(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
  }
  apply_changes();
  double energy_decrease = 0;
  for (const int i : rows)
    energy_decrease += (row(i).impulse - impulses_before_[nth(i)]) * (residuals_before_[nth(i)] + residuals_[nth(i)]);
  const bool decreases = energy_decrease > 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    Row& r = row(i);
    const double from = impulses_before_[nth(i)];
    const double to = from + step_[k];
    const bool above = to > r.upper;
    if (!above && to >= r.lower) {
      if (!decreases) queue_impulse(i, from + step_length * step_[k]);
      continue;
    }
    const double bound = above ? r.upper : r.lower;
    if (decreases || std::fabs(bound - from) <= step_length * std::fabs(step_[k]) * (1 + 1e-12)) {
      queue_impulse(i, bound);
      status_[nth(i)] = above ? at_upper : at_lower;
    } else {
      queue_impulse(i, from + step_length * step_[k]);
    }
  }
  apply_changes();
  return false;
}

// Frees rows whose residual points away from their bound: all of them, or the one with the largest residual. Returns
// the number of such rows.
int BoxedLcp::release_rows(bool only_one) {
  budget_.charge(size(), 0);
  const double threshold = 0.5 * tolerance();
  int released = 0;
  int best = -1;
  double largest = 0;
  for (int i = 0; i < size(); ++i) {
    const Row& r = row(i);
    if (status_[nth(i)] == free || !(response(i, i) > 0) || !(r.lower < r.upper)) continue;
    const double violation = status_[nth(i)] == at_lower ? residuals_[nth(i)] : -residuals_[nth(i)];
    if (!(violation > threshold)) continue;
    released++;
    if (!only_one) status_[nth(i)] = free;
    if (violation > largest) {
      largest = violation;
      best = i;
    }
  }
  if (only_one && best >= 0) status_[nth(best)] = free;
  return released;
}

// Moves friction's bounds by `fraction` of the way to those of the present normals and freezes them.
void BoxedLcp::freeze_friction(double fraction) {
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (r.normal < 0) continue;
    const double before = friction_bounds_[nth(i)];
    friction_frozen_ = false;
    update_bounds(r);
    const double max_friction = fraction == 1 ? r.upper : before + fraction * (r.upper - before);
    friction_bounds_[nth(i)] = r.upper = max_friction;
    r.lower = -max_friction;
  }
  friction_frozen_ = true;
}

// Staggered friction (Kaufman and others, 2008): each round bounds friction by the normals of the previous round, a
// convex problem that always has a solution, and starts pivoting with tied friction from that solution. Returns false
// if a matrix could not be factored.
bool BoxedLcp::solve_staggered() {
  free_factor_.reset(response_, stride_);
  for (int round = 0; round < kMaxFrictionRounds; ++round) {
    freeze_friction(round < kUndampedRounds ? 1 : 0.5);
    for (int i = 0; i < size(); ++i) queue_impulse(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
    apply_changes();
    if (round == 0) classify_rows();
    if (!descend()) return false;
    if (round + 1 == kMaxFrictionRounds || budget_.exceeded()) break;
    friction_frozen_ = false;
    violation_ = max_violation();
    if (violation_ <= tolerance()) return true;
    for (int i = 0; i < size(); ++i) saved_impulses_[nth(i)] = row(i).impulse;
    saved_status_ = status_;
    const double saved_violation = violation_;
    violation_ = 1e300;
    if (pivot(kMaxTiedExchanges)) return true;
    violation_ = saved_violation;
    for (int i = 0; i < size(); ++i) queue_impulse(i, saved_impulses_[nth(i)]);
    apply_changes();
    recenter();
    status_ = saved_status_;
  }
  return true;
}

// Called if no round has converged: follows Lemke's path from the present impulses, and if that fails, from zero. If
// both fail, restores the last round's result.
void BoxedLcp::solve_by_path() {
  for (int i = 0; i < size(); ++i) saved_impulses_[nth(i)] = row(i).impulse;
  const double saved_violation = violation_;
  friction_frozen_ = false;
  violation_ = 1e300;
  const int changes = kMaxChangesPerRow * (size() + 8);
  if (follow_path(changes)) return;
  for (int i = 0; i < size(); ++i) queue_impulse(i, std::clamp(0.0, row(i).lower, row(i).upper));
  apply_changes();
  if (follow_path(changes)) return;
  for (int i = 0; i < size(); ++i) queue_impulse(i, saved_impulses_[nth(i)]);
  apply_changes();
  violation_ = saved_violation;
}

}  // namespace limber
