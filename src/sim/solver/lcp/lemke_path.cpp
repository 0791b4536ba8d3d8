// LemkePath: the covering vector, the path's direction, and the ratio test.
#include "sim/solver/lcp/lemke_path.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Status changes per row before the path is aborted.
constexpr int kMaxChangesPerRow = 4;
/// Exchanges that make the end of the path exact.
constexpr int kFinalExchanges = 8;
/// Rates below this fraction of the largest one count as zero.
constexpr double kMinRelativeRate = 1e-12;

double largest_magnitude(const IndexedArray<double>& values, int count) {
  double largest = 0;
  for (int i = 0; i < count; ++i) largest = std::max(largest, std::fabs(values[i]));
  return largest;
}

}  // namespace

void LemkePath::solve() {
  lcp_.save_impulses(saved_impulses_);
  const double saved_violation = lcp_.violation;
  lcp_.friction_frozen = false;
  lcp_.violation = 1e300;
  const int changes = kMaxChangesPerRow * (lcp_.size() + 8);
  if (follow(changes)) return;
  for (int i = 0; i < lcp_.size(); ++i) lcp_.queue_impulse(i, std::clamp(0.0, lcp_.row(i).lower, lcp_.row(i).upper));
  lcp_.flush_changes();
  if (follow(changes)) return;
  lcp_.restore_impulses(saved_impulses_);
  lcp_.violation = saved_violation;
}

// Starts a path: puts the impulses within their bounds, and adds the covering vector.
void LemkePath::start() {
  for (int i = 0; i < lcp_.size(); ++i) {
    LcpState::Row& r = lcp_.row(i);
    lcp_.update_bounds(r);
    lcp_.set_impulse(i, std::clamp(r.impulse, r.lower, r.upper));
  }
  lcp_.classify_rows();
  add_covering();
}

double LemkePath::bound_sign(int i) const {
  return lcp_.status[i] == LcpState::free ? 0 : lcp_.status[i] == LcpState::at_upper ? 1 : -1;
}

// Adds the covering vector to the residuals, so that the present impulses solve the problem. Its spread makes rows
// leave their bounds one at a time as it is removed.
void LemkePath::add_covering() {
  covering_.assign(lcp_.stride, 0);
  double largest = 0;
  for (int i = 0; i < lcp_.size(); ++i) {
    if (lcp_.response(i, i) > 0 && lcp_.row(i).lower < lcp_.row(i).upper)
      largest = std::max(largest, -bound_sign(i) * lcp_.residuals[i]);
  }
  for (int i = 0; i < lcp_.size(); ++i) {
    if (!(lcp_.response(i, i) > 0)) continue;
    const double residual = lcp_.residuals[i];
    if (lcp_.status[i] == LcpState::free) {
      covering_[i] = -residual;
    } else if (lcp_.row(i).lower < lcp_.row(i).upper) {
      const double spread = 0.1 + std::fmod(0.6180339887498949 * (i + 1), 1.0);
      covering_[i] = bound_sign(i) * (std::max(-bound_sign(i) * residual, 0.0) + largest * spread);
    }
  }
  remove_covering(-1);
}

void LemkePath::remove_covering(double fraction) {
  for (int i = 0; i < covering_.size(); ++i) lcp_.residuals[i] -= fraction * covering_[i];
}

// Finds the path's direction: rates of impulses and residuals per unit of the covering, at the present statuses.
// Returns false if the matrix is singular or too large.
bool LemkePath::find_direction() {
  if (!pivoting_.factor()) return false;
  const IndexedSpan<const int> free = pivoting_.free_rows();
  step_.resize(free.size());
  for (int k = 0; k < free.size(); ++k) step_[k] = covering_[free[k]];
  pivoting_.solve_factored(step_);
  impulse_rates_.assign(lcp_.stride, 0);
  for (int k = 0; k < free.size(); ++k) impulse_rates_[free[k]] = step_[k];
  for (int i = 0; i < lcp_.size(); ++i) {
    if (pivoting_.tied_normal(i) >= 0)
      impulse_rates_[i] = (lcp_.status[i] == LcpState::at_upper ? 1 : -1) * slack_rate(i, LcpState::free);
  }
  residual_rates_ = covering_;
  lcp_.budget.charge(lcp_.size(), static_cast<double>(free.size()));
  for (int i = 0; i < lcp_.size(); ++i) {
    if (impulse_rates_[i] != 0) lcp_.subtract_response(residual_rates_, i, impulse_rates_[i]);
  }
  return true;
}

// Rate of the distance between a row's impulse and one of its bounds; for `free`: rate of its upper bound.
double LemkePath::slack_rate(int i, Status side) const {
  const LcpState::Row& r = lcp_.rows[i];
  const double bound_rate =
      r.normal >= 0 && lcp_.status[r.normal] == LcpState::free ? r.friction * impulse_rates_[r.normal] : 0;
  if (side == LcpState::free) return bound_rate;
  return side == LcpState::at_upper ? bound_rate - impulse_rates_[i] : bound_rate + impulse_rates_[i];
}

void LemkePath::test_free_row(StatusChange& next, int i, double sign, double min_rate) {
  const LcpState::Row& r = lcp_.row(i);
  for (const Status side : {LcpState::at_lower, LcpState::at_upper}) {
    const double slack = side == LcpState::at_upper ? r.upper - r.impulse : r.impulse - r.lower;
    const double rate = sign * slack_rate(i, side);
    if (!(rate < -min_rate)) continue;
    const double distance = std::max(slack, 0.0) / -rate;
    if (distance < next.distance) next = {i, distance, side};
  }
}

void LemkePath::test_bounded_row(StatusChange& next, int i, double sign, double min_rate) {
  const double side = bound_sign(i);
  const double rate = side * sign * residual_rates_[i];
  if (!(rate < -min_rate)) return;
  const double distance = std::max(side * lcp_.residuals[i], 0.0) / -rate;
  if (distance < next.distance) next = {i, distance, LcpState::free};
}

// Ratio test: finds the first status change within `max_distance`, where the covering grows (sign 1) or shrinks (-1).
LemkePath::StatusChange LemkePath::ratio_test(double sign, double max_distance) {
  StatusChange next{-1, max_distance, LcpState::free};
  const double min_rate = kMinRelativeRate * largest_magnitude(impulse_rates_, lcp_.size());
  const double min_residual_rate = kMinRelativeRate * largest_magnitude(residual_rates_, lcp_.size());
  for (int i = 0; i < lcp_.size(); ++i) {
    LcpState::Row& r = lcp_.row(i);
    if (!(lcp_.response(i, i) > 0)) continue;
    lcp_.update_bounds(r);
    if (lcp_.status[i] == LcpState::free) {
      test_free_row(next, i, sign, min_rate);
    } else if (r.normal >= 0 || r.lower < r.upper) {
      test_bounded_row(next, i, sign, min_residual_rate);
    }
  }
  return next;
}

void LemkePath::advance(double distance) {
  for (int i = 0; i < lcp_.size(); ++i) {
    lcp_.row(i).impulse += distance * impulse_rates_[i];
    lcp_.residuals[i] += distance * residual_rates_[i];
  }
}

// Applies a status change. Returns false if the path's direction doesn't change: friction without a normal impulse may
// be at either bound.
bool LemkePath::apply(const StatusChange& change) {
  const int i = change.row;
  LcpState::Row& r = lcp_.row(i);
  Status& status = lcp_.status[i];
  if (change.to == LcpState::free && r.normal >= 0 && lcp_.status[r.normal] != LcpState::free) {
    status = status == LcpState::at_upper ? LcpState::at_lower : LcpState::at_upper;
    return false;
  }
  status = change.to;
  if (change.to == LcpState::free) return true;
  lcp_.update_bounds(r);
  lcp_.set_impulse(i, change.to == LcpState::at_upper ? r.upper : r.lower);
  for (int k = 0; k < lcp_.size(); ++k) {
    if (lcp_.row(k).normal != i) continue;
    lcp_.set_impulse(k, 0);
    if (lcp_.status[k] == LcpState::free) lcp_.status[k] = LcpState::at_upper;
  }
  return true;
}

// Rate at which a row, whose status has just changed, moves away from that change as the covering grows. `left`: its
// status before.
double LemkePath::opening_rate(int i, Status left) const {
  if (lcp_.status[i] == LcpState::free) return slack_rate(i, left);
  return lcp_.status[i] == LcpState::at_upper ? residual_rates_[i] : -residual_rates_[i];
}

// Follows the path through at most `max_changes` status changes. Returns true if it has reached the given problem;
// otherwise removes the covering vector.
bool LemkePath::follow(int max_changes) {
  start();
  double remaining = 1;
  double sign = -1;
  int last_changed = -1;
  Status last_status = LcpState::free;
  for (; max_changes > 0 && !lcp_.budget.exceeded() && find_direction(); --max_changes) {
    if (last_changed >= 0) sign = opening_rate(last_changed, last_status) > 0 ? 1 : -1;
    const StatusChange next = ratio_test(sign, sign < 0 ? remaining : 1e6);
    if (next.row < 0 && sign > 0) break;
    advance(sign * next.distance);
    remaining += sign * next.distance;
    if (next.row < 0) return pivoting_.solve(kFinalExchanges);
    last_status = lcp_.status[next.row];
    last_changed = apply(next) ? next.row : -1;
  }
  remove_covering(remaining);
  return false;
}

}  // namespace limber::sim::solver
