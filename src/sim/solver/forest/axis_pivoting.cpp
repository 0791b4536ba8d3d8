// AxisActiveSet: the active set of the axes: ordered bounds, warm start, and block principal pivoting (Júdice and Pires
// 1994) with Murty's least-index rule once the number of violations stops decreasing. If that doesn't converge, as in
// long chains with overloaded motors, only the largest violations are exchanged, fewer in each round.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/solver/forest/axis_active_set.h"

namespace limber::sim::solver {
namespace {

/// Tolerance of impulses at bounds, and of rates at a row's velocity, before a state changes.
double tolerance_of(double size, double offset) { return 1e-6 * (offset + std::fabs(size)); }
constexpr double kImpulseOffset = 1e-4;

// Impulse of an active row beyond its nearest bound.
double excess(const AxisRow& row) { return std::fabs(row.impulse - (row.impulse < row.lower ? row.lower : row.upper)); }

// Largest finite bound of a row; 0: it has none, as a limit.
double largest_bound(const AxisRow& row) {
  return std::max(row.lower > -AxisRow::kInfinity ? std::fabs(row.lower) : 0,
                  row.upper < AxisRow::kInfinity ? std::fabs(row.upper) : 0);
}

// True if a bounded soft row must change its status. Such rows are independent of the others of their axis.
bool is_violated(const AxisActiveSet& axes, const AxisRow& row) {
  if (row.hard() || !row.bounded() || row.constant() || row.status == AxisRow::deferred) return false;
  if (row.status == AxisRow::active) {
    return row.impulse < row.lower - tolerance_of(row.lower, kImpulseOffset) ||
           row.impulse > row.upper + tolerance_of(row.upper, kImpulseOffset);
  }
  const double violation = axes.residual(row);
  return row.status == AxisRow::at_lower ? violation > tolerance_of(row.velocity, 1)
                                         : violation < -tolerance_of(row.velocity, 1);
}

// Size of the violation of a soft row, as AxisActiveSet::violation_of().
double soft_violation(const AxisActiveSet& axes, const AxisRow& row) {
  if (row.status != AxisRow::active) return std::fabs(axes.residual(row));
  return excess(row) / std::max(kImpulseOffset, largest_bound(row));
}

// Changes the status of a soft row that is violated.
void exchange_row(AxisRow& row) {
  row.status = row.status != AxisRow::active                 ? AxisRow::active
               : row.impulse < 0.5 * (row.lower + row.upper) ? AxisRow::at_lower
                                                             : AxisRow::at_upper;
}

void defer_row(AxisActiveSet& axes, AxisRow& row) {
  row.status = AxisRow::deferred;
  row.initial_impulse = std::clamp(row.impulse, row.lower, row.upper);
  axes.add_pending(row, row.initial_impulse - row.impulse);
}

// Code of a state in the previous step: one of these plus the kind of a row: the active row; or, if no row is active,
// the row above the boundary (which is below that row), or if there is none, the row below the boundary.
constexpr int kActiveRow = 1;
constexpr int kBoundaryBelow = 6;
constexpr int kBoundaryAbove = 11;
// flag: contacts changed this state
constexpr int kChangedByContacts = 16;

/// Number of rounds in which violations may not decrease, before exchanges are made one at a time.
constexpr int kMaxStalledRounds = 3;
/// exchange_worst() exchanges one in kWorstFraction violations in its first round, and fewer in each later one.
constexpr int kWorstFraction = 4;
/// Rounds of exchange_worst(), at most, per node of a tree. Random arms of 17 to 300 joints converge in half as many;
/// one in 600 would cycle.
constexpr int kWorstRoundsPerNode = 2;

}  // namespace

bool AxisActiveSet::admissible(const BoundedRows& bounded, int state) const {
  if (state < 0 || state > 2 * bounded.count) return false;
  for (int i = 0; i < bounded.count; ++i) {
    if (state == 2 * i + 1) continue;
    const AxisRow& row = row_of(bounded, i);
    if (2 * i + 1 < state ? row.lower <= -AxisRow::kInfinity : row.upper >= AxisRow::kInfinity) return false;
  }
  return true;
}

int AxisActiveSet::previous_state(const BoundedRows& bounded, std::uint8_t code) const {
  if (code == 0) return -1;
  const int base = code >= kBoundaryAbove ? kBoundaryAbove : (code >= kBoundaryBelow ? kBoundaryBelow : kActiveRow);
  for (int i = 0; i < bounded.count; ++i) {
    if (row_of(bounded, i).kind != code - base) continue;
    const int state = base == kActiveRow ? 2 * i + 1 : (base == kBoundaryBelow ? 2 * i : 2 * i + 2);
    return admissible(bounded, state) ? state : -1;
  }
  return -1;
}

// Default state: a motor reaches its speed, friction sticks, limits are inactive.
int AxisActiveSet::default_state(const BoundedRows& bounded) const {
  for (const AxisRow::Kind kind : {AxisRow::motor, AxisRow::friction}) {
    for (int i = 0; i < bounded.count; ++i) {
      if (row_of(bounded, i).kind == kind && admissible(bounded, 2 * i + 1)) return 2 * i + 1;
    }
  }
  for (int state = 0; state <= 2 * bounded.count; state += 2) {
    if (admissible(bounded, state)) return state;
  }
  for (int state = 1; state <= 2 * bounded.count; state += 2) {
    if (admissible(bounded, state)) return state;
  }
  return 0;
}

void AxisActiveSet::build_bounds(int node, int axis, std::uint8_t previous) {
  BoundedRows bounded;
  bounded.node = node;
  bounded.axis = axis;
  bounded.first = bounded_row_indices_.size();
  for (const AxisRow& row : rows(node)) {
    if (row.axis != axis || !row.hard() || !row.bounded() || row.constant()) continue;
    bounded_row_indices_.push_back(index_of(row));
    bounded.count++;
  }
  reconcile_limits(bounded);
  sort_bounds(bounded);
  bounded.state = previous_state(bounded, previous % kChangedByContacts);
  bounded.deferred_before = bounded.state >= 0 && previous >= kChangedByContacts;
  if (bounded.state < 0) bounded.state = default_state(bounded);
  apply_state(bounded);
  for (int i = 0; bounded.deferred_before && i < bounded.count; ++i)
    row_of(bounded, i).initial_status = row_of(bounded, i).status;
  bounded_rows_.push_back(bounded);
}

// Contradicting limits: the lower one is reduced to the upper one.
void AxisActiveSet::reconcile_limits(const BoundedRows& bounded) {
  double min_upper_velocity = AxisRow::kInfinity;
  for (int i = 0; i < bounded.count; ++i) {
    const AxisRow& row = row_of(bounded, i);
    if (row.lower <= -AxisRow::kInfinity) min_upper_velocity = std::min(min_upper_velocity, row.velocity);
  }
  for (int i = 0; i < bounded.count; ++i) {
    AxisRow& row = row_of(bounded, i);
    if (row.upper >= AxisRow::kInfinity) row.velocity = std::min(row.velocity, min_upper_velocity);
  }
}

// Sorts the rows, which are the last of bounded_row_indices_, by velocity; of equals, rows without an upper bound come
// first, those without a lower bound last.
void AxisActiveSet::sort_bounds(const BoundedRows& bounded) {
  const auto rank = [](const AxisRow& row) {
    return row.upper >= AxisRow::kInfinity ? 0 : (row.lower <= -AxisRow::kInfinity ? 2 : 1);
  };
  const auto ordered = [&](const AxisRow& low, const AxisRow& high) {
    return low.velocity < high.velocity || (low.velocity == high.velocity && rank(low) <= rank(high));
  };
  for (int i = bounded.first; i < bounded.first + bounded.count; ++i) {
    for (int k = i; k > bounded.first && !ordered(rows_[bounded_row_indices_[k - 1]], rows_[bounded_row_indices_[k]]);
         --k) {
      std::swap(bounded_row_indices_[k - 1], bounded_row_indices_[k]);
    }
  }
}

// State of a deferred axis after the step, derived from its impulses.
int AxisActiveSet::final_state(const BoundedRows& bounded) const {
  int below = 0;
  for (int i = 0; i < bounded.count; ++i) {
    const AxisRow& row = row_of(bounded, i);
    const double slack = tolerance_of(row.impulse, kImpulseOffset);
    if (row.impulse > row.lower + slack && row.impulse < row.upper - slack) return 2 * i + 1;
    if (row.impulse <= row.lower + slack) below++;
  }
  return 2 * below;
}

ActiveSetWarmStart AxisActiveSet::active_set(int node) const {
  ActiveSetWarmStart out{};
  for (int k = bounded_rows_start_[node]; k < bounded_rows_start_[node + 1]; ++k) {
    const BoundedRows& bounded = bounded_rows_[k];
    const int state = bounded.deferred ? final_state(bounded) : bounded.state;
    const int i = state / 2;
    const bool top = i == bounded.count;
    const int base = (state & 1) != 0 ? kActiveRow : (top ? kBoundaryAbove : kBoundaryBelow);
    const int flag = bounded.deferred && state != bounded.state ? kChangedByContacts : 0;
    out[bounded.axis] = static_cast<std::uint8_t>(flag + base + row_of(bounded, top ? i - 1 : i).kind);
  }
  return out;
}

void AxisActiveSet::apply_state(BoundedRows& bounded) {
  for (int i = 0; i < bounded.count; ++i) {
    row_of(bounded, i).status = bounded.state == 2 * i + 1
                                    ? AxisRow::active
                                    : (2 * i + 1 < bounded.state ? AxisRow::at_lower : AxisRow::at_upper);
  }
}

// Defers the axes that match and are not deferred yet. Returns their number.
template <class F>
int AxisActiveSet::defer_if(int first, int last, F&& matches) {
  int deferred = 0;
  for (BoundedRows& bounded : bounded_rows(first, last)) {
    if (bounded.deferred || !matches(bounded)) continue;
    bounded.deferred = true;
    for (int i = 0; i < bounded.count; ++i) defer_row(*this, row_of(bounded, i));
    deferred++;
  }
  return deferred;
}

// Returns the state that the present impulses and rates require.
int AxisActiveSet::required_state(const BoundedRows& bounded) const {
  const int i = bounded.state / 2;
  if ((bounded.state & 1) != 0) {
    const AxisRow& row = row_of(bounded, i);
    // if the next row has the same velocity, skip the state between them
    const auto same_velocity = [&](int k) {
      return k >= 0 && k < bounded.count &&
             std::fabs(row_of(bounded, k).velocity - row.velocity) <= tolerance_of(row.velocity, 1);
    };
    if (row.impulse < row.lower - tolerance_of(row.lower, kImpulseOffset))
      return bounded.state + (same_velocity(i + 1) ? 2 : 1);
    if (row.impulse > row.upper + tolerance_of(row.upper, kImpulseOffset))
      return bounded.state - (same_velocity(i - 1) ? 2 : 1);
    return bounded.state;
  }
  const double present_rate = rate(bounded.node, bounded.axis);
  if (i > 0) {
    const AxisRow& row = row_of(bounded, i - 1);
    if (present_rate < row.velocity - tolerance_of(row.velocity, 1) && row.lower < row.upper) return 2 * i - 1;
  }
  if (i < bounded.count) {
    const AxisRow& row = row_of(bounded, i);
    if (present_rate > row.velocity + tolerance_of(row.velocity, 1) && row.lower < row.upper) return 2 * i + 1;
  }
  return bounded.state;
}

IndexedSpan<AxisActiveSet::BoundedRows> AxisActiveSet::bounded_rows(int first, int last) {
  const auto begin = bounded_rows_start_[first];
  return IndexedSpan<BoundedRows>(bounded_rows_).subspan(begin, bounded_rows_start_[last] - begin);
}

int AxisActiveSet::find_violations(int first, int last) {
  int violated = 0;
  for (BoundedRows& bounded : bounded_rows(first, last)) {
    bounded.next_state = bounded.deferred ? bounded.state : required_state(bounded);
    if (!admissible(bounded, bounded.next_state)) bounded.next_state = bounded.state;
    if (bounded.next_state != bounded.state) violated++;
  }
  for (int i = first; i < last; ++i) {
    for (const AxisRow& row : rows(i)) violated += is_violated(*this, row) ? 1 : 0;
  }
  return violated;
}

void AxisActiveSet::exchange(int first, int last, bool only_last) {
  const IndexedSpan<BoundedRows> all = bounded_rows(first, last);
  for (int k = all.size(); k-- > 0;) {
    if (all[k].next_state == all[k].state) continue;
    all[k].state = all[k].next_state;
    apply_state(all[k]);
    if (only_last) return;
  }
  for (int i = first; i < last; ++i) {
    for (AxisRow& row : rows(i)) {
      if (!is_violated(*this, row)) continue;
      exchange_row(row);
      if (only_last) return;
    }
  }
}

// Size of the violation of an axis that must change its state: its impulse beyond the bound, relative to the largest
// bound of the axis (of a motor, if it has one), or its rate beyond the row's velocity.
double AxisActiveSet::violation_of(const BoundedRows& bounded) const {
  if ((bounded.state & 1) == 0)
    return std::fabs(rate(bounded.node, bounded.axis) - row_of(bounded, bounded.next_state / 2).velocity);
  double bound = kImpulseOffset;
  for (int i = 0; i < bounded.count; ++i) bound = std::max(bound, largest_bound(row_of(bounded, i)));
  return excess(row_of(bounded, bounded.state / 2)) / bound;
}

// Exchanges the largest of the violations that find_violations() has found: one in `divisor` of them, at least one.
void AxisActiveSet::exchange_worst(int first, int last, int divisor) {
  violations_.clear();
  for (int k = bounded_rows_start_[first]; k < bounded_rows_start_[last]; ++k) {
    const BoundedRows& bounded = bounded_rows_[k];
    if (bounded.next_state != bounded.state) violations_.push_back({violation_of(bounded), k, false});
  }
  for (int i = first; i < last; ++i) {
    for (const AxisRow& row : rows(i)) {
      if (is_violated(*this, row)) violations_.push_back({soft_violation(*this, row), index_of(row), true});
    }
  }
  const int count = std::max(1, violations_.size() / divisor);
  std::partial_sort(violations_.begin(), violations_.begin() + count, violations_.end(),
                    [](const Violation& a, const Violation& b) {
                      return std::tuple(-a.size, a.soft, a.index) < std::tuple(-b.size, b.soft, b.index);
                    });
  for (int i = 0; i < count; ++i) {
    if (violations_[i].soft) {
      exchange_row(rows_[violations_[i].index]);
    } else {
      BoundedRows& bounded = bounded_rows_[violations_[i].index];
      bounded.state = bounded.next_state;
      apply_state(bounded);
    }
  }
}

bool AxisActiveSet::solve(int first, int last, int max_exchanges) {
  if (factored_[first] != 0) {
    solve_once(first, last);
    if (find_violations(first, last) == 0) return true;
    exchange(first, last, false);
  }
  return solve_from_scratch(first, last, max_exchanges);
}

bool AxisActiveSet::solve_from_scratch(int first, int last, int max_exchanges) {
  int min_violated = rows_.size() + 1;
  int stalled_rounds_left = kMaxStalledRounds;
  const int max_rounds = max_exchanges + kWorstRoundsPerNode * (last - first);
  for (int round = 0;; ++round) {
    if (!factor(first, last)) return false;
    solve_once(first, last);
    const int violated = find_violations(first, last);
    if (violated == 0) return true;
    if (round >= max_rounds) break;
    if (round >= max_exchanges) {
      exchange_worst(first, last, kWorstFraction + round - max_exchanges);
      continue;
    }
    bool single = false;
    if (violated < min_violated) {
      min_violated = violated;
      stalled_rounds_left = kMaxStalledRounds;
    } else {
      single = stalled_rounds_left == 0;
      stalled_rounds_left = std::max(stalled_rounds_left - 1, 0);
    }
    exchange(first, last, single);
  }
  defer_violated(first, last);
  return factor_and_solve_once(first, last);
}

int AxisActiveSet::defer_as_before(int first, int last) {
  return defer_if(first, last, [](const BoundedRows& bounded) { return bounded.deferred_before; });
}

int AxisActiveSet::defer_axis(int node, int axis) {
  return defer_if(node, node + 1, [axis](const BoundedRows& bounded) { return bounded.axis == axis; });
}

int AxisActiveSet::defer_all(int first, int last) {
  return defer_if(first, last, [](const BoundedRows&) { return true; });
}

void AxisActiveSet::save() {
  saved_impulses_.resize(rows_.size());
  for (int i = 0; i < rows_.size(); ++i) saved_impulses_[i] = rows_[i].impulse;
  saved_rates_ = rates_;
  saved_changes_ = changes_;
}

void AxisActiveSet::restore() {
  for (int i = 0; i < rows_.size(); ++i) {
    AxisRow& row = rows_[i];
    row.impulse = saved_impulses_[i];
    pending_[i] = row.status == AxisRow::deferred ? std::clamp(row.impulse, row.lower, row.upper) - row.impulse : 0;
  }
  rates_ = saved_rates_;
  changes_ = saved_changes_;
}

bool AxisActiveSet::factor_and_solve_once(int first, int last) {
  for (int i = first; i < last; ++i) forest.node(i).load = {};
  if (!factor(first, last)) return false;
  solve_once(first, last);
  return true;
}

int AxisActiveSet::defer_violated(int first, int last) {
  const int violated = find_violations(first, last);
  if (violated == 0) return 0;
  defer_if(first, last, [](const BoundedRows& bounded) { return bounded.next_state != bounded.state; });
  for (int i = first; i < last; ++i) {
    for (AxisRow& row : rows(i)) {
      if (is_violated(*this, row)) defer_row(*this, row);
    }
  }
  return violated;
}

}  // namespace limber::sim::solver
