// Which rows are in force: staircases, their states from step to step, and block principal pivoting (Júdice and Pires)
// with Murty's least index when it stops getting better.
#include <algorithm>
#include <cmath>

#include "sim/tree_rows.h"

namespace limber {
namespace {

/// How far an impulse may pass its bound, and a rate its row's velocity, before the row's state changes.
double slack_of(double size, double least) { return 1e-6 * (least + std::fabs(size)); }
constexpr double kLeastImpulse = 1e-4;

// what a state is remembered as: a row in force, or the row above the gap, or the one below it when it is the last
constexpr int kActive = 1;
constexpr int kBelow = 6;
constexpr int kAbove = 11;
// and that contacts made it so
constexpr int kByContacts = 16;

/// Rounds that may pass without fewer broken laws before single exchanges.
constexpr int kPatience = 3;

}  // namespace

bool TreeRows::admissible(const Stair& s, int state) const {
  if (state < 0 || state > 2 * s.count) return false;
  for (int i = 0; i < s.count; ++i) {
    if (state == 2 * i + 1) continue;
    const TreeRow& row = row_of(s, i);
    if (2 * i + 1 < state ? row.lower <= -kTreeInfinity : row.upper >= kTreeInfinity) return false;
  }
  return true;
}

int TreeRows::remembered(const Stair& s, std::uint8_t code) const {
  if (code == 0) return -1;
  const int base = code >= kAbove ? kAbove : (code >= kBelow ? kBelow : kActive);
  for (int i = 0; i < s.count; ++i) {
    if (row_of(s, i).mark != code - base) continue;
    const int state = base == kActive ? 2 * i + 1 : (base == kBelow ? 2 * i : 2 * i + 2);
    return admissible(s, state) ? state : -1;
  }
  return -1;
}

// A motor reaches its speed, friction holds, limits are far.
int TreeRows::guess(const Stair& s) const {
  for (const TreeRow::Mark mark : {TreeRow::motor, TreeRow::friction}) {
    for (int i = 0; i < s.count; ++i) {
      if (row_of(s, i).mark == mark && admissible(s, 2 * i + 1)) return 2 * i + 1;
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

void TreeRows::build_stair(int node, int axis, std::uint8_t before) {
  Stair s;
  s.node = node;
  s.axis = axis;
  s.first = static_cast<int>(stair_rows_.size());
  for (const TreeRow& row : rows(node)) {
    if (row.axis != axis || !row.hard() || !row.bounded() || row.constant()) continue;
    stair_rows_.push_back(static_cast<int>(&row - rows_.data()));
    s.count++;
  }
  // limits that contradict each other: the lower one asks for no more than the upper one allows
  double most = kTreeInfinity;
  for (int i = 0; i < s.count; ++i) {
    if (row_of(s, i).lower <= -kTreeInfinity) most = std::min(most, row_of(s, i).velocity);
  }
  for (int i = 0; i < s.count; ++i) {
    TreeRow& row = row_of(s, i);
    if (row.upper >= kTreeInfinity) row.velocity = std::min(row.velocity, most);
  }
  // by velocity; of equals, those without an upper bound come first, those without a lower one last
  const auto rank = [](const TreeRow& row) {
    return row.upper >= kTreeInfinity ? 0 : (row.lower <= -kTreeInfinity ? 2 : 1);
  };
  const auto begin = stair_rows_.begin() + s.first;
  for (auto i = begin; i != stair_rows_.end(); ++i) {
    for (auto k = i; k != begin; --k) {
      const TreeRow& low = rows_[at(*(k - 1))];
      const TreeRow& high = rows_[at(*k)];
      if (low.velocity < high.velocity || (low.velocity == high.velocity && rank(low) <= rank(high))) break;
      std::iter_swap(k - 1, k);
    }
  }
  s.state = remembered(s, before % kByContacts);
  s.before = s.state >= 0 && before >= kByContacts;
  if (s.state < 0) s.state = guess(s);
  take_state(s);
  for (int i = 0; s.before && i < s.count; ++i) row_of(s, i).guess = row_of(s, i).status;
  stairs_.push_back(s);
}

// Where a staircase that was given up came to stand.
int TreeRows::reached(const Stair& s) const {
  int below = 0;
  for (int i = 0; i < s.count; ++i) {
    const TreeRow& row = row_of(s, i);
    const double slack = slack_of(row.impulse, kLeastImpulse);
    if (row.impulse > row.lower + slack && row.impulse < row.upper - slack) return 2 * i + 1;
    if (row.impulse <= row.lower + slack) below++;
  }
  return 2 * below;
}

TreeMemory TreeRows::memory(int node) const {
  TreeMemory out{};
  for (int k = stair_start_[at(node)]; k < stair_start_[at(node) + 1]; ++k) {
    const Stair& s = stairs_[at(k)];
    const int state = s.outer ? reached(s) : s.state;
    const int i = state / 2;
    const bool top = i == s.count;
    const int base = (state & 1) != 0 ? kActive : (top ? kAbove : kBelow);
    const int by = s.outer && state != s.state ? kByContacts : 0;
    out[at(s.axis)] = static_cast<std::uint8_t>(by + base + row_of(s, top ? i - 1 : i).mark);
  }
  return out;
}

void TreeRows::take_state(Stair& s) {
  for (int i = 0; i < s.count; ++i) {
    row_of(s, i).status =
        s.state == 2 * i + 1 ? TreeRow::active : (2 * i + 1 < s.state ? TreeRow::at_lower : TreeRow::at_upper);
  }
}

void TreeRows::give_up(Stair& s) {
  s.outer = true;
  for (int i = 0; i < s.count; ++i) hand_over(row_of(s, i));
}

void TreeRows::hand_over(TreeRow& row) {
  row.status = TreeRow::outer;
  row.likely = std::clamp(row.impulse, row.lower, row.upper);
  push(row, row.likely - row.impulse);
}

// The state that a staircase's impulses and rates ask for.
int TreeRows::wanted(const Stair& s) const {
  const int i = s.state / 2;
  if ((s.state & 1) != 0) {
    const TreeRow& row = row_of(s, i);
    // a step of no width is skipped
    const auto same = [&](int k) {
      return k >= 0 && k < s.count && std::fabs(row_of(s, k).velocity - row.velocity) <= slack_of(row.velocity, 1);
    };
    if (row.impulse < row.lower - slack_of(row.lower, kLeastImpulse)) return s.state + (same(i + 1) ? 2 : 1);
    if (row.impulse > row.upper + slack_of(row.upper, kLeastImpulse)) return s.state - (same(i - 1) ? 2 : 1);
    return s.state;
  }
  const double now = rate(s.node, s.axis);
  if (i > 0) {
    const TreeRow& row = row_of(s, i - 1);
    if (now < row.velocity - slack_of(row.velocity, 1) && row.lower < row.upper) return 2 * i - 1;
  }
  if (i < s.count) {
    const TreeRow& row = row_of(s, i);
    if (now > row.velocity + slack_of(row.velocity, 1) && row.lower < row.upper) return 2 * i + 1;
  }
  return s.state;
}

// A soft bounded row stands alone: does its law want another status?
bool TreeRows::breaks(const TreeRow& row) const {
  if (row.hard() || !row.bounded() || row.constant() || row.status == TreeRow::outer) return false;
  if (row.status == TreeRow::active) {
    return row.impulse < row.lower - slack_of(row.lower, kLeastImpulse) ||
           row.impulse > row.upper + slack_of(row.upper, kLeastImpulse);
  }
  const double left = residual(row);
  return row.status == TreeRow::at_lower ? left > slack_of(row.velocity, 1) : left < -slack_of(row.velocity, 1);
}

std::span<TreeRows::Stair> TreeRows::stairs(int first, int last) {
  const auto begin = at(stair_start_[at(first)]);
  return std::span(stairs_).subspan(begin, at(stair_start_[at(last)]) - begin);
}

int TreeRows::look(int first, int last) {
  int broken = 0;
  for (Stair& s : stairs(first, last)) {
    s.want = s.outer ? s.state : wanted(s);
    if (!admissible(s, s.want)) s.want = s.state;
    if (s.want != s.state) broken++;
  }
  for (int i = first; i < last; ++i) {
    for (const TreeRow& row : rows(i)) broken += breaks(row) ? 1 : 0;
  }
  return broken;
}

void TreeRows::move(int first, int last, bool only_last) {
  exchanges_++;
  const std::span<Stair> all = stairs(first, last);
  for (std::size_t k = all.size(); k-- > 0;) {
    if (all[k].want == all[k].state) continue;
    all[k].state = all[k].want;
    take_state(all[k]);
    if (only_last) return;
  }
  for (int i = first; i < last; ++i) {
    for (TreeRow& row : rows(i)) {
      if (!breaks(row)) continue;
      row.status = row.status != TreeRow::active                 ? TreeRow::active
                   : row.impulse < 0.5 * (row.lower + row.upper) ? TreeRow::at_lower
                                                                 : TreeRow::at_upper;
      if (only_last) return;
    }
  }
}

bool TreeRows::settle(int first, int last, int budget) {
  if (factored_[at(first)] != 0) {
    correct(first, last);
    if (look(first, last) == 0) return true;
    move(first, last, false);
  }
  return pivot(first, last, budget);
}

bool TreeRows::pivot(int first, int last, int budget) {
  int fewest = static_cast<int>(rows_.size()) + 1;
  int patience = kPatience;
  for (int round = 0;; ++round) {
    if (!factor(first, last)) return false;
    correct(first, last);
    const int broken = look(first, last);
    if (broken == 0) return true;
    if (round >= budget) break;
    bool single = false;
    if (broken < fewest) {
      fewest = broken;
      patience = kPatience;
    } else {
      single = patience == 0;
      patience = std::max(patience - 1, 0);
    }
    move(first, last, single);
  }
  give_up_broken(first, last);
  return refresh(first, last);
}

int TreeRows::give_up_remembered(int first, int last) {
  int given_up = 0;
  for (Stair& s : stairs(first, last)) {
    if (!s.before || s.outer) continue;
    give_up(s);
    given_up++;
  }
  return given_up;
}

int TreeRows::give_up_axis(int node, int axis) {
  int given_up = 0;
  for (Stair& s : stairs(node, node + 1)) {
    if (s.axis != axis || s.outer) continue;
    give_up(s);
    given_up++;
  }
  return given_up;
}

int TreeRows::give_up_all(int first, int last) {
  int given_up = 0;
  for (Stair& s : stairs(first, last)) {
    if (s.outer) continue;
    give_up(s);
    given_up++;
  }
  return given_up;
}

void TreeRows::keep() {
  kept_impulses_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) kept_impulses_[i] = rows_[i].impulse;
  kept_rates_ = rates_;
  kept_changes_ = changes_;
}

void TreeRows::go_back() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    TreeRow& row = rows_[i];
    row.impulse = kept_impulses_[i];
    pending_[i] = row.status == TreeRow::outer ? std::clamp(row.impulse, row.lower, row.upper) - row.impulse : 0;
  }
  rates_ = kept_rates_;
  changes_ = kept_changes_;
}

bool TreeRows::refresh(int first, int last) {
  for (int i = first; i < last; ++i) trees.node(i).load = {};
  if (!factor(first, last)) return false;
  correct(first, last);
  return true;
}

int TreeRows::give_up_broken(int first, int last) {
  const int broken = look(first, last);
  if (broken == 0) return 0;
  for (Stair& s : stairs(first, last)) {
    if (s.want != s.state) give_up(s);
  }
  for (int i = first; i < last; ++i) {
    for (TreeRow& row : rows(i)) {
      if (breaks(row)) hand_over(row);
    }
  }
  return broken;
}

}  // namespace limber
