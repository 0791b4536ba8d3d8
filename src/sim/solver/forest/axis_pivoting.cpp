// AxisActiveSet: the active set of the axes: ordered bounds, warm start, and block principal pivoting (Júdice and Pires
// 1994) with Murty's least-index rule once the number of violations stops decreasing.
#include <algorithm>
#include <cmath>

#include "sim/solver/forest/axis_active_set.h"

namespace limber {
namespace {

/// Tolerance of impulses at bounds, and of rates at a row's velocity, before a state changes.
double tolerance_of(double size, double offset) { return 1e-6 * (offset + std::fabs(size)); }
constexpr double kImpulseOffset = 1e-4;

// Code of a remembered state: one of these plus the kind of a row: the active row; or, if no row is active, the row
// above the boundary (which is below that row), or if there is none, the row below the boundary.
constexpr int kActiveRow = 1;
constexpr int kBoundaryBelow = 6;
constexpr int kBoundaryAbove = 11;
// flag: contacts changed this state
constexpr int kChangedByContacts = 16;

/// Number of rounds in which violations may not decrease, before exchanges are made one at a time.
constexpr int kMaxStalledRounds = 3;

}  // namespace

bool AxisActiveSet::admissible(const OrderedBounds& s, int state) const {
  if (state < 0 || state > 2 * s.count) return false;
  for (int i = 0; i < s.count; ++i) {
    if (state == 2 * i + 1) continue;
    const AxisRow& row = row_of(s, i);
    if (2 * i + 1 < state ? row.lower <= -AxisRow::kInfinity : row.upper >= AxisRow::kInfinity) return false;
  }
  return true;
}

int AxisActiveSet::remembered_state(const OrderedBounds& s, std::uint8_t code) const {
  if (code == 0) return -1;
  const int base = code >= kBoundaryAbove ? kBoundaryAbove : (code >= kBoundaryBelow ? kBoundaryBelow : kActiveRow);
  for (int i = 0; i < s.count; ++i) {
    if (row_of(s, i).kind != code - base) continue;
    const int state = base == kActiveRow ? 2 * i + 1 : (base == kBoundaryBelow ? 2 * i : 2 * i + 2);
    return admissible(s, state) ? state : -1;
  }
  return -1;
}

// Default state: a motor reaches its speed, friction sticks, limits are inactive.
int AxisActiveSet::default_state(const OrderedBounds& s) const {
  for (const AxisRow::Kind kind : {AxisRow::motor, AxisRow::friction}) {
    for (int i = 0; i < s.count; ++i) {
      if (row_of(s, i).kind == kind && admissible(s, 2 * i + 1)) return 2 * i + 1;
    }
  }
  for (int state = 0; state <= 2 * s.count; state += 2) {
    if (admissible(s, state)) return state;
  }
  for (int state = 1; state <= 2 * s.count; state += 2) {
    if (admissible(s, state)) return state;
  }
  return 0;
}

void AxisActiveSet::build_bounds(int node, int axis, std::uint8_t remembered) {
  OrderedBounds s;
  s.node = node;
  s.axis = axis;
  s.first = bound_rows_.size();
  for (const AxisRow& row : rows(node)) {
    if (row.axis != axis || !row.hard() || !row.bounded() || row.constant()) continue;
    bound_rows_.push_back(index_of(row));
    s.count++;
  }
  reconcile_limits(s);
  sort_bounds(s);
  s.state = remembered_state(s, remembered % kChangedByContacts);
  s.deferred_before = s.state >= 0 && remembered >= kChangedByContacts;
  if (s.state < 0) s.state = default_state(s);
  apply_state(s);
  for (int i = 0; s.deferred_before && i < s.count; ++i) row_of(s, i).initial_status = row_of(s, i).status;
  ordered_bounds_.push_back(s);
}

// Contradicting limits: the lower one is reduced to the upper one.
void AxisActiveSet::reconcile_limits(const OrderedBounds& s) {
  double min_upper_velocity = AxisRow::kInfinity;
  for (int i = 0; i < s.count; ++i) {
    const AxisRow& row = row_of(s, i);
    if (row.lower <= -AxisRow::kInfinity) min_upper_velocity = std::min(min_upper_velocity, row.velocity);
  }
  for (int i = 0; i < s.count; ++i) {
    AxisRow& row = row_of(s, i);
    if (row.upper >= AxisRow::kInfinity) row.velocity = std::min(row.velocity, min_upper_velocity);
  }
}

// Sorts the rows, which are the last of bound_rows_, by velocity; of equals, rows without an upper bound come first,
// those without a lower bound last.
void AxisActiveSet::sort_bounds(const OrderedBounds& s) {
  const auto rank = [](const AxisRow& row) {
    return row.upper >= AxisRow::kInfinity ? 0 : (row.lower <= -AxisRow::kInfinity ? 2 : 1);
  };
  const auto ordered = [&](const AxisRow& low, const AxisRow& high) {
    return low.velocity < high.velocity || (low.velocity == high.velocity && rank(low) <= rank(high));
  };
  for (int i = s.first; i < s.first + s.count; ++i) {
    for (int k = i; k > s.first && !ordered(rows_[bound_rows_[k - 1]], rows_[bound_rows_[k]]); --k) {
      std::swap(bound_rows_[k - 1], bound_rows_[k]);
    }
  }
}

// State of a deferred axis after the step, derived from its impulses.
int AxisActiveSet::final_state(const OrderedBounds& s) const {
  int below = 0;
  for (int i = 0; i < s.count; ++i) {
    const AxisRow& row = row_of(s, i);
    const double slack = tolerance_of(row.impulse, kImpulseOffset);
    if (row.impulse > row.lower + slack && row.impulse < row.upper - slack) return 2 * i + 1;
    if (row.impulse <= row.lower + slack) below++;
  }
  return 2 * below;
}

ActiveSetMemory AxisActiveSet::active_set(int node) const {
  ActiveSetMemory out{};
  for (int k = bounds_start_[node]; k < bounds_start_[node + 1]; ++k) {
    const OrderedBounds& s = ordered_bounds_[k];
    const int state = s.deferred ? final_state(s) : s.state;
    const int i = state / 2;
    const bool top = i == s.count;
    const int base = (state & 1) != 0 ? kActiveRow : (top ? kBoundaryAbove : kBoundaryBelow);
    const int flag = s.deferred && state != s.state ? kChangedByContacts : 0;
    out[s.axis] = static_cast<std::uint8_t>(flag + base + row_of(s, top ? i - 1 : i).kind);
  }
  return out;
}

void AxisActiveSet::apply_state(OrderedBounds& s) {
  for (int i = 0; i < s.count; ++i) {
    row_of(s, i).status =
        s.state == 2 * i + 1 ? AxisRow::active : (2 * i + 1 < s.state ? AxisRow::at_lower : AxisRow::at_upper);
  }
}

// Defers the axes that match and are not deferred yet. Returns their number.
template <class F>
int AxisActiveSet::defer_if(int first, int last, F&& matches) {
  int deferred = 0;
  for (OrderedBounds& s : ordered_bounds(first, last)) {
    if (s.deferred || !matches(s)) continue;
    s.deferred = true;
    for (int i = 0; i < s.count; ++i) defer_row(row_of(s, i));
    deferred++;
  }
  return deferred;
}

void AxisActiveSet::defer_row(AxisRow& row) {
  row.status = AxisRow::deferred;
  row.initial_impulse = std::clamp(row.impulse, row.lower, row.upper);
  add_pending(row, row.initial_impulse - row.impulse);
}

// Returns the state that the present impulses and rates require.
int AxisActiveSet::required_state(const OrderedBounds& s) const {
  const int i = s.state / 2;
  if ((s.state & 1) != 0) {
    const AxisRow& row = row_of(s, i);
    // if the next row has the same velocity, skip the state between them
    const auto same_velocity = [&](int k) {
      return k >= 0 && k < s.count && std::fabs(row_of(s, k).velocity - row.velocity) <= tolerance_of(row.velocity, 1);
    };
    if (row.impulse < row.lower - tolerance_of(row.lower, kImpulseOffset))
      return s.state + (same_velocity(i + 1) ? 2 : 1);
    if (row.impulse > row.upper + tolerance_of(row.upper, kImpulseOffset))
      return s.state - (same_velocity(i - 1) ? 2 : 1);
    return s.state;
  }
  const double present_rate = rate(s.node, s.axis);
  if (i > 0) {
    const AxisRow& row = row_of(s, i - 1);
    if (present_rate < row.velocity - tolerance_of(row.velocity, 1) && row.lower < row.upper) return 2 * i - 1;
  }
  if (i < s.count) {
    const AxisRow& row = row_of(s, i);
    if (present_rate > row.velocity + tolerance_of(row.velocity, 1) && row.lower < row.upper) return 2 * i + 1;
  }
  return s.state;
}

// True if a bounded soft row must change its status. Such rows are independent of the others of their axis.
bool AxisActiveSet::is_violated(const AxisRow& row) const {
  if (row.hard() || !row.bounded() || row.constant() || row.status == AxisRow::deferred) return false;
  if (row.status == AxisRow::active) {
    return row.impulse < row.lower - tolerance_of(row.lower, kImpulseOffset) ||
           row.impulse > row.upper + tolerance_of(row.upper, kImpulseOffset);
  }
  const double violation = residual(row);
  return row.status == AxisRow::at_lower ? violation > tolerance_of(row.velocity, 1)
                                         : violation < -tolerance_of(row.velocity, 1);
}

IndexedSpan<AxisActiveSet::OrderedBounds> AxisActiveSet::ordered_bounds(int first, int last) {
  const auto begin = bounds_start_[first];
  return IndexedSpan<OrderedBounds>(ordered_bounds_).subspan(begin, bounds_start_[last] - begin);
}

int AxisActiveSet::find_violations(int first, int last) {
  int violated = 0;
  for (OrderedBounds& s : ordered_bounds(first, last)) {
    s.next_state = s.deferred ? s.state : required_state(s);
    if (!admissible(s, s.next_state)) s.next_state = s.state;
    if (s.next_state != s.state) violated++;
  }
  for (int i = first; i < last; ++i) {
    for (const AxisRow& row : rows(i)) violated += is_violated(row) ? 1 : 0;
  }
  return violated;
}

void AxisActiveSet::exchange(int first, int last, bool only_last) {
  const IndexedSpan<OrderedBounds> all = ordered_bounds(first, last);
  for (int k = all.size(); k-- > 0;) {
    if (all[k].next_state == all[k].state) continue;
    all[k].state = all[k].next_state;
    apply_state(all[k]);
    if (only_last) return;
  }
  for (int i = first; i < last; ++i) {
    for (AxisRow& row : rows(i)) {
      if (!is_violated(row)) continue;
      row.status = row.status != AxisRow::active                 ? AxisRow::active
                   : row.impulse < 0.5 * (row.lower + row.upper) ? AxisRow::at_lower
                                                                 : AxisRow::at_upper;
      if (only_last) return;
    }
  }
}

bool AxisActiveSet::solve(int first, int last, int max_exchanges) {
  if (factored_[first] != 0) {
    correct(first, last);
    if (find_violations(first, last) == 0) return true;
    exchange(first, last, false);
  }
  return pivot(first, last, max_exchanges);
}

bool AxisActiveSet::pivot(int first, int last, int max_exchanges) {
  int min_violated = rows_.size() + 1;
  int stalled_rounds_left = kMaxStalledRounds;
  for (int round = 0;; ++round) {
    if (!factor(first, last)) return false;
    correct(first, last);
    const int violated = find_violations(first, last);
    if (violated == 0) return true;
    if (round >= max_exchanges) break;
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
  return factor_and_correct(first, last);
}

int AxisActiveSet::defer_remembered(int first, int last) {
  return defer_if(first, last, [](const OrderedBounds& s) { return s.deferred_before; });
}

int AxisActiveSet::defer_axis(int node, int axis) {
  return defer_if(node, node + 1, [axis](const OrderedBounds& s) { return s.axis == axis; });
}

int AxisActiveSet::defer_all(int first, int last) {
  return defer_if(first, last, [](const OrderedBounds&) { return true; });
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

bool AxisActiveSet::factor_and_correct(int first, int last) {
  for (int i = first; i < last; ++i) forest.node(i).load = {};
  if (!factor(first, last)) return false;
  correct(first, last);
  return true;
}

int AxisActiveSet::defer_violated(int first, int last) {
  const int violated = find_violations(first, last);
  if (violated == 0) return 0;
  defer_if(first, last, [](const OrderedBounds& s) { return s.next_state != s.state; });
  for (int i = first; i < last; ++i) {
    for (AxisRow& row : rows(i)) {
      if (is_violated(row)) defer_row(row);
    }
  }
  return violated;
}

}  // namespace limber
