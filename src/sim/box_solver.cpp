// Exchanges of rows at their bounds, all free rows solved for at once; sweeps guess where that begins badly.
#include "sim/box_solver.h"

#include <algorithm>
#include <cmath>

#include "base/room.h"
#include "sim/dense.h"

namespace limber {
namespace {

constexpr int kFirstExchanges = 5;  // from where the rows stand
constexpr int kSweeps = 8;
constexpr int kLastSweeps = 48;
/// Where there is no time for more.
constexpr int kBriefSweeps = 16;
constexpr int kSweepsBetweenLooks = 4;
/// After so many exchanges, a larger part of the rows that is still broken means that few more will not mend them.
constexpr int kTrials = 1;
constexpr double kHopeless = 0.2;
constexpr int kPatience = 3;  // exchanges that may bring nothing before they are made one by one
/// Rows that depend on each other (four contact points of a box) get this much softness, as part of their response.
constexpr double kSoftness = 1e-6;

}  // namespace

BoxSolver::BoxSolver(Effort& effort) : effort_(effort), steady_(effort, kUsualRows) {
  for (std::vector<double>* square : {&response_, &old_response_}) take_room(*square, kUsualRows * kUsualRows);
  take_room(factor_, nth(kMostFree * kMostFree));
}

void BoxSolver::start(int rows) {
  stride_ = (rows + 1) / 2 * 2;
  make_room(response_, nth(rows * stride_));
  rows_.assign(nth(rows), Row{});
  response_.assign(nth(rows * stride_), 0);
  left_.assign(nth(stride_), 0);
}

void BoxSolver::grow(std::span<const int> from) {
  old_response_.swap(response_);
  const int old_stride = stride_;
  start(static_cast<int>(from.size()));
  for (int i = 0; i < size(); ++i) {
    if (from[nth(i)] < 0) continue;
    const double* line = &old_response_[nth(from[nth(i)] * old_stride)];
    for (int k = 0; k < size(); ++k) {
      if (from[nth(k)] >= 0) response(i, k) = line[from[nth(k)]];
    }
  }
}

void BoxSolver::add_squares(std::span<const double> lines, int width) {
  for (int i = 0; i < size(); ++i) {
    changed_.clear();
    for (std::size_t first = 0; first < lines.size(); first += nth(width)) {
      changed_.push_back({&lines[first], -lines[first + nth(i)]});
    }
    subtract_scaled(&response(i, 0), changed_, stride_);
  }
  changed_.clear();
}

void BoxSolver::bound(Row& row) const {
  if (row.normal < 0 || frozen_) return;
  double reach = row.friction * std::max(rows_[nth(row.normal)].impulse, 0.0);
  if (row.most > 0) reach = std::min(reach, row.most);
  row.lower = -reach;
  row.upper = reach;
}

void BoxSolver::apply(int i, double change) {
  if (change == 0) return;
  row(i).impulse += change;
  respond(left_, i, change);
}

void BoxSolver::respond(std::vector<double>& to, int i, double change) const {
  subtract_scaled(to.data(), &response_[nth(i * stride_)], change, stride_);
}

// Changes of impulses that others need not hear of at once: respond() tells all rows together.
void BoxSolver::change(int i, double by) {
  if (by == 0) return;
  row(i).impulse += by;
  changed_.push_back({&response_[nth(i * stride_)], by});
}

void BoxSolver::respond() {
  effort_.lines(static_cast<double>(changed_.size()), stride_);
  subtract_scaled(left_.data(), changed_, stride_);
  changed_.clear();
}

void BoxSolver::restart() {
  for (int i = 0; i < size(); ++i) {
    row(i).impulse = center_[nth(i)] = start_[nth(i)];
    left_[nth(i)] = row(i).left;
  }
}

void BoxSolver::sweep() {
  effort_.lines(size(), stride_);
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    bound(r);
    put(i, std::clamp(r.impulse + left_[nth(i)] * eases_[nth(i)], r.lower, r.upper));
  }
}

// Until no row misses its law by more than it may.
void BoxSolver::sweep(int most) {
  double miss = 1e300;
  for (int i = 0; i < most && miss > tolerance(); i += kSweepsBetweenLooks) {
    for (int k = 0; k < kSweepsBetweenLooks; ++k) sweep();
    miss = missed();
  }
}

double BoxSolver::missed() {
  effort_.lines(size(), 0);
  double most = 0;
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    const double own = response(i, i);
    if (!(own > 0)) continue;
    bound(r);
    const double miss = std::fabs(std::clamp(left_[nth(i)], (r.lower - r.impulse) * own, (r.upper - r.impulse) * own));
    if (!(miss <= most)) most = miss;
  }
  return most;
}

double BoxSolver::take_missed() {
  recenter();
  const double miss = missed();
  if (miss < least_missed_) least_missed_ = miss;
  return miss;
}

void BoxSolver::read_statuses() {
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    bound(r);
    const double slack = 1e-9 * (1e-6 + std::fabs(r.impulse));
    status_[nth(i)] = r.impulse <= r.lower + slack ? at_lower : r.impulse >= r.upper - slack ? at_upper : free;
    // at no impulse a friction row slides where it would be pushed back
    if (r.normal >= 0 && r.lower == r.upper) status_[nth(i)] = left_[nth(i)] > 0 ? at_upper : at_lower;
  }
}

// The free row whose impulse sets that of row i, at its bound; -1: none.
int BoxSolver::slides_with(int i) const {
  if (frozen_) return -1;
  const Row& r = rows_[nth(i)];
  const int tie = ties_[nth(i)];
  const bool capped = tie >= 0 && r.most > 0 && r.friction * rows_[nth(r.normal)].impulse > r.most;
  return capped ? -1 : tie;
}

// The system of the free rows; a sliding row's impulse is a part of its normal's.
void BoxSolver::assemble() {
  free_.clear();
  place_.resize(rows_.size());
  ties_.resize(rows_.size());
  for (int i = 0; i < size(); ++i) {
    const int normal = row(i).normal;
    const bool bounded = status_[nth(i)] != free;
    place_[nth(i)] = -1;
    ties_[nth(i)] = bounded && normal >= 0 ? place_[nth(normal)] : -1;
    if (bounded || !(response(i, i) > 0)) continue;
    place_[nth(i)] = static_cast<int>(free_.size());
    free_.push_back(i);
  }
  const int n = static_cast<int>(free_.size());
  effort_.lines(n + size(), n);
  width_ = (n + 1) / 2 * 2;
  factor_.assign(nth(n * width_), 0);
  for (int i = 0; i < n; ++i) {
    const double* from = &response(free_[nth(i)], 0);
    double* to = &factor_[nth(i * width_)];
    for (int k = 0; k < n; ++k) to[k] = from[free_[nth(k)]];
  }
  for (int k = 0; k < size(); ++k) {
    const int with = slides_with(k);
    if (with < 0) continue;
    const double part = status_[nth(k)] == at_upper ? row(k).friction : -row(k).friction;
    for (int i = 0; i < n; ++i) factor_[nth(i * width_ + with)] += part * response(free_[nth(i)], k);
  }
}

// Into a lower and an upper triangle, lines exchanged. False where there are none.
bool BoxSolver::decompose() {
  const int n = static_cast<int>(free_.size());
  effort_.lines(0.5 * n * n, 0.7 * n);
  exchanged_.resize(nth(n));
  for (int c = 0; c < n; ++c) {
    int top = c;
    for (int r = c + 1; r < n; ++r) {
      if (std::fabs(factor_[nth(r * width_ + c)]) > std::fabs(factor_[nth(top * width_ + c)])) top = r;
    }
    double* line = &factor_[nth(c * width_)];
    exchanged_[nth(c)] = top;
    if (top != c) std::swap_ranges(line, line + width_, &factor_[nth(top * width_)]);
    if (!(std::fabs(line[c]) > 0) || !std::isfinite(line[c])) return false;
    const double inverse = 1 / line[c];
    for (int r = c + 1; r < n; ++r) {
      double* other = &factor_[nth(r * width_)];
      const double part = other[c] * inverse;
      other[c] = part;
      if (part == 0) continue;
      int from = c + 1;
      if (from % 2 != 0) {
        other[from] -= part * line[from];
        from++;
      }
      subtract_scaled(other + from, line + from, part, width_ - from);
    }
  }
  return true;
}

// With the factor at hand: impulses of the free rows that answer what step_ holds.
void BoxSolver::solve_step() {
  const int n = static_cast<int>(free_.size());
  effort_.lines(2 * n, 0.5 * n);
  for (int c = 0; c < n; ++c) std::swap(step_[nth(c)], step_[nth(exchanged_[nth(c)])]);
  for (int r = 0; r < n; ++r) step_[nth(r)] -= product(&factor_[nth(r * width_)], step_.data(), r);
  for (int r = n; r-- > 0;) {
    const double* line = &factor_[nth(r * width_)];
    step_[nth(r)] = (step_[nth(r)] - product(line + r + 1, step_.data() + r + 1, n - r - 1)) / line[r];
  }
}

// What free rows still miss is given to them, with what slides along.
void BoxSolver::correct_free() {
  const int n = static_cast<int>(free_.size());
  step_.resize(nth(n));
  for (int i = 0; i < n; ++i) step_[nth(i)] = left_[nth(free_[nth(i)])];
  solve_step();
  for (int i = 0; i < n; ++i) change(free_[nth(i)], step_[nth(i)]);
  follow_normals();
}

void BoxSolver::follow_normals() {
  effort_.lines(size(), 0);
  for (int i = 0; i < size(); ++i) {
    if (status_[nth(i)] == free) continue;
    Row& r = row(i);
    if (slides_with(i) >= 0) {
      // tied also where the normal pulls, which the next exchange sees
      change_to(i, (status_[nth(i)] == at_upper ? r.friction : -r.friction) * row(r.normal).impulse);
    } else {
      bound(r);
      change_to(i, status_[nth(i)] == at_upper ? r.upper : r.lower);
    }
  }
  respond();
}

bool BoxSolver::solve_free() {
  if (!factored_) {
    assemble();
    if (static_cast<int>(free_.size()) > kMostFree || !decompose()) return false;
    factored_ = true;
  }
  follow_normals();
  correct_free();
  return true;
}

// Softness pulls towards the impulses of the moment, so that it is worth nothing where they are right.
void BoxSolver::recenter() {
  for (int i = 0; i < size(); ++i) {
    left_[nth(i)] += kSoftness / (1 + kSoftness) * response(i, i) * (row(i).impulse - center_[nth(i)]);
    center_[nth(i)] = row(i).impulse;
  }
}

// Rows whose status their law does not allow change it; returns how many there were.
int BoxSolver::exchange(bool only_last) {
  effort_.lines(size(), 0);
  const double most = tolerance();
  int broken = 0;
  for (int i = size(); i-- > 0;) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    bound(r);
    Status& status = status_[nth(i)];
    Status to = status;
    const double left = left_[nth(i)];
    if (status == free) {
      const double slack = 0.1 * most * eases_[nth(i)];
      if (r.impulse < r.lower - slack) to = at_lower;
      if (r.impulse > r.upper + slack) to = at_upper;
    } else if (r.lower < r.upper && (status == at_lower ? left > most : left < -most)) {
      to = free;
    }
    if (to == status) continue;
    broken++;
    if (!only_last || broken == 1) status = to;
  }
  return broken;
}

bool BoxSolver::pivot(int exchanges) {
  int fewest = size() + 1;
  int patience = kPatience;
  factored_ = false;
  double before = 1e300;
  for (int round = 0; round < exchanges; ++round) {
    if (!solve_free()) return false;
    const int broken = exchange(patience == 0);
    if (broken == 0) {
      const double miss = take_missed();
      if (least_missed_ <= tolerance()) return true;
      if (miss > 0.7 * before) return false;
      before = miss;
      continue;
    }
    factored_ = false;
    if (round >= kTrials && broken > kHopeless * size()) return false;
    if (broken < fewest) {
      fewest = broken;
      patience = kPatience;
    } else {
      patience = std::max(patience - 1, 0);
    }
  }
  return false;
}

void BoxSolver::begin() {
  const std::size_t n = rows_.size();
  start_.resize(n);
  center_.resize(n);
  status_.resize(n);
  settled_.resize(n);
  held_.resize(n);
  frozen_ = false;
  least_missed_ = 1e300;
  for (std::size_t i = 0; i < n; ++i) start_[i] = rows_[i].impulse;
  eases_.resize(n);
  for (int i = 0; i < size(); ++i) {
    response(i, i) *= 1 + kSoftness;
    eases_[nth(i)] = 1 / response(i, i);
  }
  restart();
}

void BoxSolver::end() {
  for (int i = 0; i < size(); ++i) response(i, i) /= 1 + kSoftness;
}

double BoxSolver::solve(double tolerance) {
  asked_ = tolerance;
  begin();
  if (effort_.over()) {
    search_briefly();
  } else {
    search();
  }
  end();
  return least_missed_;
}

double BoxSolver::polish() {
  begin();
  const double before = missed();
  if (before > tolerance()) sweep(kBriefSweeps);
  take_missed();
  if (!(least_missed_ < before)) {
    restart();
    least_missed_ = before;
  }
  read_statuses();
  end();
  return least_missed_;
}

void BoxSolver::start_ahead() {
  restart();
  for (int i = 0; i < size(); ++i) change(i, row(i).ahead);
  respond();
}

// From where the rows may stand: sweeps, and where they do not do, friction held to the normals that they found.
void BoxSolver::search_briefly() {
  start_ahead();
  sweep(kBriefSweeps);
  read_statuses();
  take_missed();
  if (least_missed_ > tolerance() && !settle_friction()) sweep_last();
}

void BoxSolver::sweep_last() {
  for (int i = 0; i < kLastSweeps; ++i) sweep();
  recenter();
  least_missed_ = missed();
}

void BoxSolver::search() {
  read_statuses();
  for (int i = 0; i < size(); ++i) {
    const Row& r = row(i);
    if (r.guess != unknown) {
      status_[nth(i)] = r.guess;
    } else if (r.normal >= 0 && r.lower < r.upper) {
      // friction, by where it would go if it stood alone
      const double alone = r.impulse + left_[nth(i)] * eases_[nth(i)];
      status_[nth(i)] = alone < r.lower ? at_lower : alone > r.upper ? at_upper : free;
    }
  }
  if (pivot(kFirstExchanges)) return;
  start_ahead();
  for (int i = 0; i < kSweeps; ++i) sweep();
  take_missed();
  if (least_missed_ <= tolerance()) return;
  if (!settle_friction()) {
    sweep_last();
  } else if (frozen_ && !effort_.over()) {
    agree_at_last();
  }
}

}  // namespace limber
