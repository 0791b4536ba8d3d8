// Lemke's method for bounded rows: follows the solution along a path from a problem that the present impulses solve to
// the given one, from one change of a row's status to the next.
#include <algorithm>
#include <cmath>

#include "sim/solver/boxed_lcp.h"

namespace limber {
namespace {

/// Exchanges that make the end of the path exact.
constexpr int kFinalExchanges = 8;
/// Rates below this fraction of the largest one count as zero.
constexpr double kMinRelativeRate = 1e-12;

}  // namespace

// Adds the covering vector to the residuals, so that the present impulses solve the problem. Its spread makes rows
// leave their bounds one at a time as it is removed.
void BoxedLcp::add_covering() {
  covering_.assign(nth(stride_), 0);
  double largest = 0;
  const auto bound_sign = [this](int i) { return status_[nth(i)] == free ? 0 : status_[nth(i)] == at_upper ? 1 : -1; };
  for (int i = 0; i < size(); ++i) {
    if (response(i, i) > 0 && row(i).lower < row(i).upper)
      largest = std::max(largest, -bound_sign(i) * residuals_[nth(i)]);
  }
  for (int i = 0; i < size(); ++i) {
    if (!(response(i, i) > 0)) continue;
    const double residual = residuals_[nth(i)];
    if (status_[nth(i)] == free) {
      covering_[nth(i)] = -residual;
    } else if (row(i).lower < row(i).upper) {
      const double spread = 0.1 + std::fmod(0.6180339887498949 * (i + 1), 1.0);
      covering_[nth(i)] = bound_sign(i) * (std::max(-bound_sign(i) * residual, 0.0) + largest * spread);
    }
  }
  remove_covering(-1);
}

void BoxedLcp::remove_covering(double fraction) {
  for (std::size_t i = 0; i < covering_.size(); ++i) residuals_[i] -= fraction * covering_[i];
}

// Finds the path's direction: rates of impulses and residuals per unit of the covering, at the present statuses.
// Returns false if the matrix is singular or too large.
bool BoxedLcp::find_direction() {
  assemble();
  if (static_cast<int>(free_.size()) > kMaxFree || !factor_lu()) return false;
  step_.resize(free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i) step_[i] = covering_[nth(free_[i])];
  solve_lu();
  impulse_rates_.assign(nth(stride_), 0);
  for (std::size_t i = 0; i < free_.size(); ++i) impulse_rates_[nth(free_[i])] = step_[i];
  for (int i = 0; i < size(); ++i) {
    if (tied_normal(i) >= 0) impulse_rates_[nth(i)] = (status_[nth(i)] == at_upper ? 1 : -1) * slack_rate(i, free);
  }
  residual_rates_ = covering_;
  budget_.charge(size(), static_cast<double>(free_.size()));
  for (int i = 0; i < size(); ++i) {
    if (impulse_rates_[nth(i)] != 0) apply_changes(residual_rates_, i, impulse_rates_[nth(i)]);
  }
  return true;
}

// Rate of the distance between a row's impulse and one of its bounds; for `free`: rate of its upper bound.
double BoxedLcp::slack_rate(int i, Status side) const {
  const Row& r = rows_[nth(i)];
  const double bound_rate =
      r.normal >= 0 && status_[nth(r.normal)] == free ? r.friction * impulse_rates_[nth(r.normal)] : 0;
  return side == free ? bound_rate
                      : (side == at_upper ? bound_rate - impulse_rates_[nth(i)] : bound_rate + impulse_rates_[nth(i)]);
}

void BoxedLcp::update_ratio_test(StatusChange& next, int i, double slack, double rate, Status to) const {
  if (!(rate < 0)) return;
  const double distance = std::max(slack, 0.0) / -rate;
  if (distance < next.distance) next = {i, distance, to};
}

// Ratio test: finds the first status change within `max_distance`, where the covering grows (sign 1) or shrinks (-1).
BoxedLcp::StatusChange BoxedLcp::ratio_test(double sign, double max_distance) {
  StatusChange next{-1, max_distance, free};
  double fastest = 0;
  double fastest_residual = 0;
  for (int i = 0; i < size(); ++i) {
    fastest = std::max(fastest, std::fabs(impulse_rates_[nth(i)]));
    fastest_residual = std::max(fastest_residual, std::fabs(residual_rates_[nth(i)]));
  }
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    update_bounds(r);
    if (status_[nth(i)] == free) {
      for (const Status side : {at_lower, at_upper}) {
        const double slack = side == at_upper ? r.upper - r.impulse : r.impulse - r.lower;
        const double rate = sign * slack_rate(i, side);
        if (rate < -kMinRelativeRate * fastest) update_ratio_test(next, i, slack, rate, side);
      }
    } else if (r.normal >= 0 || r.lower < r.upper) {
      const double side = status_[nth(i)] == at_upper ? 1 : -1;
      const double rate = side * sign * residual_rates_[nth(i)];
      if (rate < -kMinRelativeRate * fastest_residual)
        update_ratio_test(next, i, side * residuals_[nth(i)], rate, free);
    }
  }
  return next;
}

void BoxedLcp::advance(double distance) {
  for (int i = 0; i < size(); ++i) {
    row(i).impulse += distance * impulse_rates_[nth(i)];
    residuals_[nth(i)] += distance * residual_rates_[nth(i)];
  }
}

// Applies a status change. Returns false if the path's direction doesn't change: friction without a normal impulse may
// be at either bound.
bool BoxedLcp::apply_status_change(const StatusChange& change) {
  const int i = change.row;
  Row& r = row(i);
  if (change.to == free && r.normal >= 0 && status_[nth(r.normal)] != free) {
    status_[nth(i)] = status_[nth(i)] == at_upper ? at_lower : at_upper;
    return false;
  }
  status_[nth(i)] = change.to;
  if (change.to == free) return true;
  update_bounds(r);
  set_impulse(i, change.to == at_upper ? r.upper : r.lower);
  for (int k = 0; k < size(); ++k) {
    if (row(k).normal != i) continue;
    set_impulse(k, 0);
    if (status_[nth(k)] == free) status_[nth(k)] = at_upper;
  }
  return true;
}

// Follows the path through at most `max_changes` status changes. Returns true if it has reached the given problem;
// otherwise removes the covering vector.
bool BoxedLcp::follow_path(int max_changes) {
  if (std::any_of(rows_.begin(), rows_.end(), [](const Row& r) { return r.max_impulse > 0; })) return false;
  for (int i = 0; i < size(); ++i) {
    update_bounds(row(i));
    set_impulse(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
  }
  classify_rows();
  add_covering();
  double remaining = 1;
  double sign = -1;
  int last_changed = -1;
  Status last_status = free;
  for (; max_changes > 0 && !budget_.exceeded() && find_direction(); --max_changes) {
    if (last_changed >= 0) {
      const Status now = status_[nth(last_changed)];
      const double opening_rate =
          now == free ? slack_rate(last_changed, last_status)
                      : (now == at_upper ? residual_rates_[nth(last_changed)] : -residual_rates_[nth(last_changed)]);
      sign = opening_rate > 0 ? 1 : -1;
    }
    const StatusChange next = ratio_test(sign, sign < 0 ? remaining : 1e6);
    if (next.row < 0 && sign > 0) break;
    advance(sign * next.distance);
    remaining += sign * next.distance;
    if (next.row < 0) return pivot(kFinalExchanges);
    last_status = status_[nth(next.row)];
    last_changed = apply_status_change(next) ? next.row : -1;
  }
  remove_covering(remaining);
  return false;
}

}  // namespace limber
