// Friction and its normals: rounds of a convex problem in which friction's bounds stay, and the tied one from there.
#include <algorithm>
#include <cmath>

#include "sim/box_solver.h"

namespace limber {
namespace {

constexpr int kTiedExchanges = 4;
constexpr int kDescents = 60;
constexpr int kBriefDescents = 10;  // where there is no time for more
constexpr int kBlockReleases = 30;
constexpr int kRecenterings = 5;
constexpr int kFrictionRounds = 12;
/// Changes of a status, for each row, before a path is given up.
constexpr int kMostChanges = 4;
constexpr int kFullRounds = 3;  // after them friction's bounds follow by halves

}  // namespace

// Bounds that stay make it a convex problem: from the least within the free rows to that of the next set of them, cut
// off at bounds where that still leads down. Each step makes the dual energy less.
bool BoxSolver::descend() {
  before_.resize(rows_.size());
  follow_normals();
  int settled = 0;
  for (int round = 0; round < (effort_.over() ? kBriefDescents : kDescents); ++round) {
    if (!choose_free()) return false;
    step_free();
    if (!step_within_bounds()) continue;
    if (release(round > kBlockReleases) > 0) continue;
    recenter();
    least_missed_ = missed();
    if (least_missed_ <= tolerance() || ++settled == kRecenterings) return true;
  }
  recenter();
  least_missed_ = missed();
  return effort_.over();  // then that has to do
}

bool BoxSolver::choose_free() {
  marks_.resize(rows_.size());
  for (int i = 0; i < size(); ++i) marks_[nth(i)] = status_[nth(i)] == free && response(i, i) > 0 ? 1 : 0;
  return steady_.choose(marks_, kMostFree);
}

// What free rows miss is given to them.
void BoxSolver::step_free() {
  const std::span<const int> rows = steady_.rows();
  left_before_ = left_;
  step_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    before_[nth(rows[k])] = row(rows[k]).impulse;
    step_[k] = left_[nth(rows[k])];
  }
  steady_.solve(step_);
  for (std::size_t k = 0; k < rows.size(); ++k) change(rows[k], step_[k]);
  respond();
}

// From before_ to where the free rows want to be, or as far as that may be gone. True: all of it.
bool BoxSolver::step_within_bounds() {
  effort_.lines(2 * size(), 0);
  const std::span<const int> rows = steady_.rows();
  double reach = 1;
  for (const int i : rows) {
    const Row& r = row(i);
    const double from = before_[nth(i)];
    if (r.impulse > r.upper) reach = std::min(reach, (r.upper - from) / (r.impulse - from));
    if (r.impulse < r.lower) reach = std::min(reach, (r.lower - from) / (r.impulse - from));
  }
  if (reach == 1) return true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    step_[k] = row(i).impulse - before_[nth(i)];
    change_to(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
  }
  respond();
  double gained = 0;
  for (const int i : rows) gained += (row(i).impulse - before_[nth(i)]) * (left_before_[nth(i)] + left_[nth(i)]);
  const bool down = gained > 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int i = rows[k];
    Row& r = row(i);
    const double from = before_[nth(i)];
    const double to = from + step_[k];
    const bool over = to > r.upper;
    if (!over && to >= r.lower) {
      if (!down) change_to(i, from + reach * step_[k]);
      continue;
    }
    const double bound = over ? r.upper : r.lower;
    if (down || std::fabs(bound - from) <= reach * std::fabs(step_[k]) * (1 + 1e-12)) {
      change_to(i, bound);
      status_[nth(i)] = over ? at_upper : at_lower;
    } else {
      change_to(i, from + reach * step_[k]);
    }
  }
  respond();
  return false;
}

// Rows at their bounds that would leave them become free: all, or the one that wants it most.
int BoxSolver::release(bool only_one) {
  effort_.lines(size(), 0);
  const double least = 0.5 * tolerance();
  int released = 0;
  int most = -1;
  double wish = 0;
  for (int i = 0; i < size(); ++i) {
    const Row& r = row(i);
    if (status_[nth(i)] == free || !(response(i, i) > 0) || !(r.lower < r.upper)) continue;
    const double wants = status_[nth(i)] == at_lower ? left_[nth(i)] : -left_[nth(i)];
    if (!(wants > least)) continue;
    released++;
    if (!only_one) status_[nth(i)] = free;
    if (wants > wish) {
      wish = wants;
      most = i;
    }
  }
  if (only_one && most >= 0) status_[nth(most)] = free;
  return released;
}

// Bounds of friction go that part of the way to what the normals of the moment say, and stay there.
void BoxSolver::hold_friction(double part) {
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (r.normal < 0) continue;
    const double before = held_[nth(i)];
    frozen_ = false;
    bound(r);
    const double reach = part == 1 ? r.upper : before + part * (r.upper - before);
    held_[nth(i)] = r.upper = reach;
    r.lower = -reach;
  }
  frozen_ = true;
}

// Friction bounded by the normals of the round before: a problem that always has a solution, and one that the tied one
// is near.
bool BoxSolver::settle_friction() {
  steady_.start(response_, stride_);
  for (int round = 0; round < kFrictionRounds; ++round) {
    hold_friction(round < kFullRounds ? 1 : 0.5);
    for (int i = 0; i < size(); ++i) change_to(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
    respond();
    if (round == 0) read_statuses();
    if (!descend()) return false;
    if (round + 1 == kFrictionRounds || effort_.over()) break;
    frozen_ = false;
    least_missed_ = missed();
    if (least_missed_ <= tolerance()) return true;
    for (int i = 0; i < size(); ++i) settled_[nth(i)] = row(i).impulse;
    settled_status_ = status_;
    const double settled_missed = least_missed_;
    least_missed_ = 1e300;
    if (pivot(kTiedExchanges)) return true;
    least_missed_ = settled_missed;
    for (int i = 0; i < size(); ++i) change_to(i, settled_[nth(i)]);
    respond();
    recenter();
    status_ = settled_status_;
  }
  return true;
}

// Where no round agreed with its normals, a solution may be found on the path from the last one, or that stays.
void BoxSolver::agree_at_last() {
  for (int i = 0; i < size(); ++i) settled_[nth(i)] = row(i).impulse;
  const double settled_missed = least_missed_;
  frozen_ = false;
  least_missed_ = 1e300;
  const int changes = kMostChanges * (size() + 8);
  if (follow_path(changes)) return;
  for (int i = 0; i < size(); ++i) change_to(i, std::clamp(0.0, row(i).lower, row(i).upper));
  respond();
  if (follow_path(changes)) return;
  for (int i = 0; i < size(); ++i) change_to(i, settled_[nth(i)]);
  respond();
  least_missed_ = settled_missed;
}

}  // namespace limber
