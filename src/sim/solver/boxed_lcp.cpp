// Block pivoting: exchanges rows between free and bounded and solves for all free rows at once; sweeps improve the
// start if that fails.
#include "sim/solver/boxed_lcp.h"

#include <algorithm>
#include <cmath>

#include "base/capacity.h"
#include "sim/solver/dense_kernels.h"

namespace limber {
namespace {

constexpr int kMaxFirstExchanges = 5;  // from the initial statuses
constexpr int kSweeps = 8;
constexpr int kFinalSweeps = 48;
/// Once the work budget is exceeded.
constexpr int kBriefSweeps = 16;
constexpr int kSweepsPerCheck = 4;
/// After kTrialExchanges, pivoting is aborted if more than this fraction of the rows is still violated: it would rarely
/// converge.
constexpr int kTrialExchanges = 1;
constexpr double kMaxViolatedFraction = 0.2;
constexpr int kPatience = 3;  // exchanges without improvement before they are made one at a time
/// Proximal softness relative to a row's response, for rows that depend on each other (four contact points of a box).
constexpr double kSoftness = 1e-6;

}  // namespace

BoxedLcp::BoxedLcp(WorkBudget& budget) : budget_(budget), free_factor_(budget, kReservedRows) {
  for (std::vector<double>* square : {&response_, &old_response_})
    clear_and_reserve(*square, kReservedRows * kReservedRows);
  clear_and_reserve(lu_, nth(kMaxFree * kMaxFree));
}

void BoxedLcp::reset(int rows) {
  stride_ = (rows + 1) / 2 * 2;
  reserve(response_, nth(rows * stride_));
  rows_.assign(nth(rows), Row{});
  response_.assign(nth(rows * stride_), 0);
  residuals_.assign(nth(stride_), 0);
}

void BoxedLcp::remap(std::span<const int> from) {
  old_response_.swap(response_);
  const int old_stride = stride_;
  reset(static_cast<int>(from.size()));
  for (int i = 0; i < size(); ++i) {
    if (from[nth(i)] < 0) continue;
    const double* line = &old_response_[nth(from[nth(i)] * old_stride)];
    for (int k = 0; k < size(); ++k) {
      if (from[nth(k)] >= 0) response(i, k) = line[from[nth(k)]];
    }
  }
}

void BoxedLcp::add_outer_products(std::span<const double> vectors, int width) {
  for (int i = 0; i < size(); ++i) {
    changed_.clear();
    for (std::size_t first = 0; first < vectors.size(); first += nth(width)) {
      changed_.push_back({&vectors[first], -vectors[first + nth(i)]});
    }
    subtract_scaled(&response(i, 0), changed_, stride_);
  }
  changed_.clear();
}

void BoxedLcp::update_bounds(Row& row) const {
  if (row.normal < 0 || friction_frozen_) return;
  double max_friction = row.friction * std::max(rows_[nth(row.normal)].impulse, 0.0);
  if (row.max_impulse > 0) max_friction = std::min(max_friction, row.max_impulse);
  row.lower = -max_friction;
  row.upper = max_friction;
}

void BoxedLcp::change_impulse(int i, double change) {
  if (change == 0) return;
  row(i).impulse += change;
  apply_changes(residuals_, i, change);
}

void BoxedLcp::apply_changes(std::vector<double>& to, int i, double change) const {
  subtract_scaled(to.data(), &response_[nth(i * stride_)], change, stride_);
}

// Changes an impulse; apply_changes() updates the residuals for all queued changes together.
void BoxedLcp::queue_change(int i, double change) {
  if (change == 0) return;
  row(i).impulse += change;
  changed_.push_back({&response_[nth(i * stride_)], change});
}

void BoxedLcp::apply_changes() {
  budget_.charge(static_cast<double>(changed_.size()), stride_);
  subtract_scaled(residuals_.data(), changed_, stride_);
  changed_.clear();
}

void BoxedLcp::restart() {
  for (int i = 0; i < size(); ++i) {
    row(i).impulse = center_[nth(i)] = start_impulses_[nth(i)];
    residuals_[nth(i)] = row(i).residual;
  }
}

void BoxedLcp::sweep() {
  budget_.charge(size(), stride_);
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    update_bounds(r);
    set_impulse(i, std::clamp(r.impulse + residuals_[nth(i)] * inverse_diagonal_[nth(i)], r.lower, r.upper));
  }
}

// Sweeps until no row violates its condition by more than the tolerance.
void BoxedLcp::sweep(int max_sweeps) {
  double violation = 1e300;
  for (int i = 0; i < max_sweeps && violation > tolerance(); i += kSweepsPerCheck) {
    for (int k = 0; k < kSweepsPerCheck; ++k) sweep();
    violation = max_violation();
  }
}

double BoxedLcp::max_violation() {
  budget_.charge(size(), 0);
  double largest = 0;
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    const double diagonal = response(i, i);
    if (!(diagonal > 0)) continue;
    update_bounds(r);
    const double violation =
        std::fabs(std::clamp(residuals_[nth(i)], (r.lower - r.impulse) * diagonal, (r.upper - r.impulse) * diagonal));
    if (!(violation <= largest)) largest = violation;
  }
  return largest;
}

double BoxedLcp::record_violation() {
  recenter();
  const double violation = max_violation();
  if (violation < violation_) violation_ = violation;
  return violation;
}

void BoxedLcp::classify_rows() {
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    update_bounds(r);
    const double slack = 1e-9 * (1e-6 + std::fabs(r.impulse));
    status_[nth(i)] = r.impulse <= r.lower + slack ? at_lower : r.impulse >= r.upper - slack ? at_upper : free;
    // at zero impulse a friction row slides against its residual
    if (r.normal >= 0 && r.lower == r.upper) status_[nth(i)] = residuals_[nth(i)] > 0 ? at_upper : at_lower;
  }
}

// If row i slides: index in free_ of the normal whose impulse determines the row's; -1: none.
int BoxedLcp::tied_normal(int i) const {
  if (friction_frozen_) return -1;
  const Row& r = rows_[nth(i)];
  const int normal_index = tied_normals_[nth(i)];
  const bool capped =
      normal_index >= 0 && r.max_impulse > 0 && r.friction * rows_[nth(r.normal)].impulse > r.max_impulse;
  return capped ? -1 : normal_index;
}

// Assembles the matrix of the free rows. Sliding rows are eliminated: their impulse is a multiple of their normal's.
void BoxedLcp::assemble() {
  free_.clear();
  free_index_.resize(rows_.size());
  tied_normals_.resize(rows_.size());
  for (int i = 0; i < size(); ++i) {
    const int normal = row(i).normal;
    const bool bounded = status_[nth(i)] != free;
    free_index_[nth(i)] = -1;
    tied_normals_[nth(i)] = bounded && normal >= 0 ? free_index_[nth(normal)] : -1;
    if (bounded || !(response(i, i) > 0)) continue;
    free_index_[nth(i)] = static_cast<int>(free_.size());
    free_.push_back(i);
  }
  const int n = static_cast<int>(free_.size());
  budget_.charge(n + size(), n);
  width_ = (n + 1) / 2 * 2;
  lu_.assign(nth(n * width_), 0);
  for (int i = 0; i < n; ++i) {
    const double* from = &response(free_[nth(i)], 0);
    double* to = &lu_[nth(i * width_)];
    for (int k = 0; k < n; ++k) to[k] = from[free_[nth(k)]];
  }
  for (int k = 0; k < size(); ++k) {
    const int normal_index = tied_normal(k);
    if (normal_index < 0) continue;
    const double factor = status_[nth(k)] == at_upper ? row(k).friction : -row(k).friction;
    for (int i = 0; i < n; ++i) lu_[nth(i * width_ + normal_index)] += factor * response(free_[nth(i)], k);
  }
}

// LU decomposition with partial pivoting. Returns false if the matrix is singular.
bool BoxedLcp::factor_lu() {
  const int n = static_cast<int>(free_.size());
  budget_.charge(0.5 * n * n, 0.7 * n);
  pivots_.resize(nth(n));
  for (int c = 0; c < n; ++c) {
    int pivot_row = c;
    for (int r = c + 1; r < n; ++r) {
      if (std::fabs(lu_[nth(r * width_ + c)]) > std::fabs(lu_[nth(pivot_row * width_ + c)])) pivot_row = r;
    }
    double* line = &lu_[nth(c * width_)];
    pivots_[nth(c)] = pivot_row;
    if (pivot_row != c) std::swap_ranges(line, line + width_, &lu_[nth(pivot_row * width_)]);
    if (!(std::fabs(line[c]) > 0) || !std::isfinite(line[c])) return false;
    const double inverse = 1 / line[c];
    for (int r = c + 1; r < n; ++r) {
      double* other = &lu_[nth(r * width_)];
      const double factor = other[c] * inverse;
      other[c] = factor;
      if (factor == 0) continue;
      int from = c + 1;
      if (from % 2 != 0) {
        other[from] -= factor * line[from];
        from++;
      }
      subtract_scaled(other + from, line + from, factor, width_ - from);
    }
  }
  return true;
}

// Solves for step_ in place with the LU factor.
void BoxedLcp::solve_lu() {
  const int n = static_cast<int>(free_.size());
  budget_.charge(2 * n, 0.5 * n);
  for (int c = 0; c < n; ++c) std::swap(step_[nth(c)], step_[nth(pivots_[nth(c)])]);
  for (int r = 0; r < n; ++r) step_[nth(r)] -= dot_product(&lu_[nth(r * width_)], step_.data(), r);
  for (int r = n; r-- > 0;) {
    const double* line = &lu_[nth(r * width_)];
    step_[nth(r)] = (step_[nth(r)] - dot_product(line + r + 1, step_.data() + r + 1, n - r - 1)) / line[r];
  }
}

// Applies the impulses that make the residuals of the free rows zero, and updates sliding rows.
void BoxedLcp::correct_free() {
  const int n = static_cast<int>(free_.size());
  step_.resize(nth(n));
  for (int i = 0; i < n; ++i) step_[nth(i)] = residuals_[nth(free_[nth(i)])];
  solve_lu();
  for (int i = 0; i < n; ++i) queue_change(free_[nth(i)], step_[nth(i)]);
  update_bounded_rows();
}

void BoxedLcp::update_bounded_rows() {
  budget_.charge(size(), 0);
  for (int i = 0; i < size(); ++i) {
    if (status_[nth(i)] == free) continue;
    Row& r = row(i);
    if (tied_normal(i) >= 0) {
      // tied even if the normal pulls; the next exchange corrects that
      queue_impulse(i, (status_[nth(i)] == at_upper ? r.friction : -r.friction) * row(r.normal).impulse);
    } else {
      update_bounds(r);
      queue_impulse(i, status_[nth(i)] == at_upper ? r.upper : r.lower);
    }
  }
  apply_changes();
}

bool BoxedLcp::solve_free() {
  if (!lu_valid_) {
    assemble();
    if (static_cast<int>(free_.size()) > kMaxFree || !factor_lu()) return false;
    lu_valid_ = true;
  }
  update_bounded_rows();
  correct_free();
  return true;
}

// Proximal point: moves the center of the softness to the present impulses, so that it vanishes at convergence.
void BoxedLcp::recenter() {
  for (int i = 0; i < size(); ++i) {
    residuals_[nth(i)] += kSoftness / (1 + kSoftness) * response(i, i) * (row(i).impulse - center_[nth(i)]);
    center_[nth(i)] = row(i).impulse;
  }
}

// Exchanges the status of rows that violate their condition (`only_last`: of the last one). Returns the number of
// violations.
int BoxedLcp::exchange(bool only_last) {
  budget_.charge(size(), 0);
  const double threshold = tolerance();
  int violated = 0;
  for (int i = size(); i-- > 0;) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    update_bounds(r);
    Status& status = status_[nth(i)];
    Status new_status = status;
    const double residual = residuals_[nth(i)];
    if (status == free) {
      const double slack = 0.1 * threshold * inverse_diagonal_[nth(i)];
      if (r.impulse < r.lower - slack) new_status = at_lower;
      if (r.impulse > r.upper + slack) new_status = at_upper;
    } else if (r.lower < r.upper && (status == at_lower ? residual > threshold : residual < -threshold)) {
      new_status = free;
    }
    if (new_status == status) continue;
    violated++;
    if (!only_last || violated == 1) status = new_status;
  }
  return violated;
}

// Block principal pivoting. Returns true if no row violates its condition.
bool BoxedLcp::pivot(int max_exchanges) {
  int fewest_violations = size() + 1;
  int patience = kPatience;
  lu_valid_ = false;
  double last_violation = 1e300;
  for (int round = 0; round < max_exchanges; ++round) {
    if (!solve_free()) return false;
    const int violated = exchange(patience == 0);
    if (violated == 0) {
      const double violation = record_violation();
      if (violation_ <= tolerance()) return true;
      if (violation > 0.7 * last_violation) return false;
      last_violation = violation;
      continue;
    }
    lu_valid_ = false;
    if (round >= kTrialExchanges && violated > kMaxViolatedFraction * size()) return false;
    if (violated < fewest_violations) {
      fewest_violations = violated;
      patience = kPatience;
    } else {
      patience = std::max(patience - 1, 0);
    }
  }
  return false;
}

void BoxedLcp::begin() {
  const std::size_t n = rows_.size();
  start_impulses_.resize(n);
  center_.resize(n);
  status_.resize(n);
  saved_impulses_.resize(n);
  friction_bounds_.resize(n);
  friction_frozen_ = false;
  violation_ = 1e300;
  for (std::size_t i = 0; i < n; ++i) start_impulses_[i] = rows_[i].impulse;
  inverse_diagonal_.resize(n);
  for (int i = 0; i < size(); ++i) {
    response(i, i) *= 1 + kSoftness;
    inverse_diagonal_[nth(i)] = 1 / response(i, i);
  }
  restart();
}

void BoxedLcp::end() {
  for (int i = 0; i < size(); ++i) response(i, i) /= 1 + kSoftness;
}

double BoxedLcp::solve(double tolerance) {
  requested_tolerance_ = tolerance;
  begin();
  if (budget_.exceeded()) {
    solve_approximately();
  } else {
    solve_fully();
  }
  end();
  return violation_;
}

double BoxedLcp::refine_friction() {
  begin();
  const double initial_violation = max_violation();
  if (initial_violation > tolerance()) sweep(kBriefSweeps);
  record_violation();
  if (!(violation_ < initial_violation)) {
    restart();
    violation_ = initial_violation;
  }
  classify_rows();
  end();
  return violation_;
}

void BoxedLcp::restart_from_guess() {
  restart();
  for (int i = 0; i < size(); ++i) queue_change(i, row(i).initial_change);
  apply_changes();
}

// Budget exceeded: sweeps from the initial guess, then one convex problem with frozen friction bounds.
void BoxedLcp::solve_approximately() {
  restart_from_guess();
  sweep(kBriefSweeps);
  classify_rows();
  record_violation();
  if (violation_ > tolerance() && !solve_staggered()) final_sweeps();
}

void BoxedLcp::final_sweeps() {
  for (int i = 0; i < kFinalSweeps; ++i) sweep();
  recenter();
  violation_ = max_violation();
}

void BoxedLcp::solve_fully() {
  classify_rows();
  for (int i = 0; i < size(); ++i) {
    const Row& r = row(i);
    if (r.initial_status != unknown) {
      status_[nth(i)] = r.initial_status;
    } else if (r.normal >= 0 && r.lower < r.upper) {
      // friction: status that the row would have if it were solved alone
      const double uncoupled_impulse = r.impulse + residuals_[nth(i)] * inverse_diagonal_[nth(i)];
      status_[nth(i)] = uncoupled_impulse < r.lower ? at_lower : uncoupled_impulse > r.upper ? at_upper : free;
    }
  }
  if (pivot(kMaxFirstExchanges)) return;
  restart_from_guess();
  for (int i = 0; i < kSweeps; ++i) sweep();
  record_violation();
  if (violation_ <= tolerance()) return;
  if (!solve_staggered()) {
    final_sweeps();
  } else if (friction_frozen_ && !budget_.exceeded()) {
    solve_by_path();
  }
}

}  // namespace limber
