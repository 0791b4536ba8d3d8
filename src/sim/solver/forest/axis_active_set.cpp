// AxisActiveSet: the choice of prescribed and free axes, one exact solve, and the update of impulses and rates.
#include "sim/solver/forest/axis_active_set.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {

void AxisActiveSet::clear(int capacity) {
  forest.clear(capacity);
  rows_.clear();
  pending_.clear();
  row_start_.assign(1, 0);
  bounded_rows_.clear();
  bounded_rows_start_.assign(1, 0);
  bounded_row_indices_.clear();
  violations_.clear_and_reserve(capacity);
  rates_.clear();
  known_impulses_.clear();
  changes_.clear();
  factored_.clear();
}

AxisRow& AxisActiveSet::add(int axis, double velocity, double softness, double lower, double upper,
                            AxisRow::Kind kind) {
  AxisRow& row = rows_.emplace_back();
  row.velocity = velocity;
  row.softness = softness;
  row.lower = lower;
  row.upper = upper;
  row.node = forest.size() - 1;
  row.axis = static_cast<std::uint8_t>(axis);
  row.kind = kind;
  return row;
}

void AxisActiveSet::end_node(const FixedArray<double, 6>& rates, const ActiveSetWarmStart& previous) {
  const int node = forest.size() - 1;
  row_start_.push_back(rows_.size());
  pending_.resize(rows_.size(), 0);
  rates_.push_back(rates);
  known_impulses_.push_back({});
  changes_.push_back({});
  factored_.push_back(0);
  unsigned bounded_axes = 0;
  for (AxisRow& row : rows(node)) {
    if (!row.bounded()) continue;
    if (row.constant()) {
      row.status = AxisRow::at_lower;
    } else if (row.hard()) {
      bounded_axes |= 1u << row.axis;
    } else {
      // a soft limit starts inactive: at the bound that is nearest to zero
      row.status = std::fabs(row.lower) <= std::fabs(row.upper) ? AxisRow::at_lower : AxisRow::at_upper;
    }
  }
  for (int axis = 0; axis < 6; ++axis) {
    if ((bounded_axes >> axis & 1) != 0) build_bounds(node, axis, previous[axis]);
  }
  bounded_rows_start_.push_back(bounded_rows_.size());
}

IndexedSpan<AxisRow> AxisActiveSet::rows(int node) {
  return IndexedSpan<AxisRow>(rows_).subspan(row_start_[node], row_start_[node + 1] - row_start_[node]);
}

bool AxisActiveSet::factor(int first, int last) {
  for (int i = first; i < last; ++i) {
    TreeNode& n = forest.node(i);
    n.prescribed = 0;
    n.damping.fill(0);
    for (const AxisRow& row : rows(i)) {
      if (row.status != AxisRow::active) continue;
      if (row.hard()) {
        n.prescribed |= 1u << row.axis;
      } else {
        n.damping[row.axis] += 1 / row.softness;
      }
    }
  }
  budget_.charge(kNodeVectors * (last - first), 6);
  factored_[first] = 1;
  factor_version_++;
  return forest.factor(first, last);
}

void AxisActiveSet::prepare_node(int i) {
  TreeNode& n = forest.node(i);
  const FixedArray<double, 6>& rate = rates_[i];
  FixedArray<double, 6>& known_impulses = known_impulses_[i];
  n.input.fill(0);
  known_impulses.fill(0);
  const IndexedSpan<AxisRow> all = rows(i);
  for (const AxisRow& row : all) {
    if (row.status == AxisRow::active && row.hard()) n.input[row.axis] = row.velocity - rate[row.axis];
  }
  for (AxisRow& row : all) {
    const bool prescribed = (n.prescribed >> row.axis & 1) != 0;
    double change = 0;
    if (row.status == AxisRow::active) {
      if (row.hard()) continue;
      const double after = rate[row.axis] + (prescribed ? n.input[row.axis] : 0);
      change = (row.velocity - after) / row.softness - row.impulse;
    } else if (row.status == AxisRow::deferred) {
      double& pending = pending_[index_of(row)];
      change = pending;
      pending = 0;
      row.impulse += change;
    } else {
      const double bound = row.status == AxisRow::at_lower ? row.lower : row.upper;
      change = bound - row.impulse;
      row.impulse = bound;
    }
    (prescribed ? known_impulses : n.input)[row.axis] += change;
  }
}

void AxisActiveSet::accumulate_node(int i) {
  TreeNode& n = forest.node(i);
  FixedArray<double, 6>& rate = rates_[i];
  for (int k = 0; k < 6; ++k) rate[k] += n.rate[k];
  for (AxisRow& row : rows(i)) {
    if (row.status != AxisRow::active) continue;
    if (row.hard()) {
      row.impulse += n.impulse[row.axis] - known_impulses_[i][row.axis];
    } else {
      row.impulse = (row.velocity - rate[row.axis]) / row.softness;
    }
  }
  changes_[i] += n.velocity_change;
  n.load = {};
}

void AxisActiveSet::solve_once(int first, int last) {
  budget_.charge(kNodeVectors * (last - first), 6);
  for (int i = first; i < last; ++i) prepare_node(i);
  forest.solve(first, last);
  for (int i = first; i < last; ++i) accumulate_node(i);
}

}  // namespace limber::sim::solver
