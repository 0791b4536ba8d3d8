// LcpState: the matrix, sweeps, and the proximal point.
#include "sim/solver/lcp/lcp_state.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Up to this number of rows nothing is allocated.
constexpr int kReservedRows = 160;
constexpr int kSweepsPerCheck = 4;
/// Proximal softness relative to a row's response, for rows that depend on each other (four contact points of a box).
constexpr double kSoftness = 1e-6;

}  // namespace

LcpState::LcpState(WorkBudget& work_budget) : budget(work_budget) {
  matrix.clear_and_reserve(kReservedRows * kReservedRows);
  old_matrix_.clear_and_reserve(kReservedRows * kReservedRows);
}

void LcpState::reset(int count) {
  stride = (count + 1) / 2 * 2;
  matrix.reserve_ahead(count * stride);
  rows.assign(count, Row{});
  matrix.assign(count * stride, 0);
  residuals.assign(stride, 0);
}

void LcpState::remap(IndexedSpan<const int> from) {
  old_matrix_.swap(matrix);
  const int old_stride = stride;
  reset(from.size());
  for (int i = 0; i < size(); ++i) {
    if (from[i] < 0) continue;
    const double* line = &old_matrix_[from[i] * old_stride];
    for (int k = 0; k < size(); ++k) {
      if (from[k] >= 0) response(i, k) = line[from[k]];
    }
  }
}

void LcpState::add_outer_products(IndexedSpan<const double> vectors, int width) {
  for (int i = 0; i < size(); ++i) {
    changed_.clear();
    for (int first = 0; first < vectors.size(); first += width) {
      changed_.push_back({&vectors[first], -vectors[first + i]});
    }
    subtract_scaled(&response(i, 0), changed_, stride);
  }
  changed_.clear();
}

void LcpState::begin() {
  start_impulses_.resize(size());
  center_.resize(size());
  status.resize(size());
  inverse_diagonal.resize(size());
  friction_frozen = false;
  violation = 1e300;
  for (int i = 0; i < size(); ++i) {
    start_impulses_[i] = row(i).impulse;
    response(i, i) *= 1 + kSoftness;
    inverse_diagonal[i] = 1 / response(i, i);
  }
  restart();
}

void LcpState::end() {
  for (int i = 0; i < size(); ++i) response(i, i) /= 1 + kSoftness;
}

void LcpState::restart() {
  for (int i = 0; i < size(); ++i) {
    row(i).impulse = center_[i] = start_impulses_[i];
    residuals[i] = row(i).residual;
  }
}

void LcpState::restart_from_guess() {
  restart();
  for (int i = 0; i < size(); ++i) queue_change(i, row(i).initial_change);
  flush_changes();
}

void LcpState::update_bounds(Row& row) const {
  if (row.normal < 0 || friction_frozen) return;
  const double max_friction = row.friction * std::max(rows[row.normal].impulse, 0.0);
  row.lower = -max_friction;
  row.upper = max_friction;
}

void LcpState::classify_rows() {
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    update_bounds(r);
    const double slack = 1e-9 * (1e-6 + std::fabs(r.impulse));
    status[i] = r.impulse <= r.lower + slack ? at_lower : r.impulse >= r.upper - slack ? at_upper : free;
    // at zero impulse a friction row slides against its residual
    if (r.normal >= 0 && r.lower == r.upper) status[i] = residuals[i] > 0 ? at_upper : at_lower;
  }
}

void LcpState::set_impulse(int i, double impulse) {
  const double change = impulse - row(i).impulse;
  if (change == 0) return;
  row(i).impulse += change;
  subtract_response(residuals, i, change);
}

void LcpState::queue_change(int i, double change) {
  if (change == 0) return;
  row(i).impulse += change;
  changed_.push_back({&matrix[i * stride], change});
}

void LcpState::flush_changes() {
  budget.charge(static_cast<double>(changed_.size()), stride);
  subtract_scaled(residuals.data(), changed_, stride);
  changed_.clear();
}

void LcpState::subtract_response(IndexedArray<double>& rates, int i, double impulse) const {
  subtract_scaled(rates.data(), &matrix[i * stride], impulse, stride);
}

void LcpState::sweep() {
  budget.charge(size(), stride);
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    update_bounds(r);
    set_impulse(i, std::clamp(r.impulse + residuals[i] * inverse_diagonal[i], r.lower, r.upper));
  }
}

void LcpState::sweep(int max_sweeps) {
  double present = 1e300;
  for (int i = 0; i < max_sweeps && present > tolerance(); i += kSweepsPerCheck) {
    for (int k = 0; k < kSweepsPerCheck; ++k) sweep();
    present = max_violation();
  }
}

double LcpState::max_violation() {
  budget.charge(size(), 0);
  double largest = 0;
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    const double diagonal = response(i, i);
    if (!(diagonal > 0)) continue;
    update_bounds(r);
    const double present =
        std::fabs(std::clamp(residuals[i], (r.lower - r.impulse) * diagonal, (r.upper - r.impulse) * diagonal));
    if (!(present <= largest)) largest = present;
  }
  return largest;
}

double LcpState::record_violation() {
  recenter();
  const double present = max_violation();
  if (present < violation) violation = present;
  return present;
}

void LcpState::recenter() {
  for (int i = 0; i < size(); ++i) {
    residuals[i] += kSoftness / (1 + kSoftness) * response(i, i) * (row(i).impulse - center_[i]);
    center_[i] = row(i).impulse;
  }
}

void LcpState::save_impulses(IndexedArray<double>& saved) const {
  saved.resize(size());
  for (int i = 0; i < size(); ++i) saved[i] = rows[i].impulse;
}

void LcpState::restore_impulses(const IndexedArray<double>& saved) {
  for (int i = 0; i < size(); ++i) queue_impulse(i, saved[i]);
  flush_changes();
}

}  // namespace limber::sim::solver
