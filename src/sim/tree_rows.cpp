// Planning a node's rows, one exact solve, and what it does to them.
#include "sim/tree_rows.h"

#include <algorithm>
#include <cmath>

namespace limber {

void TreeRows::clear(int room) {
  trees.clear(room);
  rows_.clear();
  pending_.clear();
  row_start_.assign(1, 0);
  stairs_.clear();
  stair_start_.assign(1, 0);
  stair_rows_.clear();
  rates_.clear();
  others_.clear();
  changes_.clear();
  factored_.clear();
  exchanges_ = 0;
}

TreeRow& TreeRows::add(int axis, double velocity, double softness, double lower, double upper, TreeRow::Mark mark) {
  TreeRow& row = rows_.emplace_back();
  row.velocity = velocity;
  row.softness = softness;
  row.lower = lower;
  row.upper = upper;
  row.node = trees.size() - 1;
  row.axis = static_cast<std::uint8_t>(axis);
  row.mark = mark;
  return row;
}

void TreeRows::end_node(const std::array<double, 6>& rates, const TreeMemory& before) {
  const int node = trees.size() - 1;
  row_start_.push_back(static_cast<int>(rows_.size()));
  pending_.resize(rows_.size(), 0);
  rates_.push_back(rates);
  others_.push_back({});
  changes_.push_back({});
  factored_.push_back(0);
  unsigned stairs = 0;
  for (TreeRow& row : rows(node)) {
    if (!row.bounded()) continue;
    if (row.constant()) {
      row.status = TreeRow::at_lower;
    } else if (row.hard()) {
      stairs |= 1u << row.axis;
    } else {
      // a soft stop begins at rest: the bound nearest to no impulse
      row.status = std::fabs(row.lower) <= std::fabs(row.upper) ? TreeRow::at_lower : TreeRow::at_upper;
    }
  }
  for (int axis = 0; axis < 6; ++axis) {
    if ((stairs >> axis & 1) != 0) build_stair(node, axis, before[at(axis)]);
  }
  stair_start_.push_back(static_cast<int>(stairs_.size()));
}

std::span<TreeRow> TreeRows::rows(int node) {
  const auto first = at(row_start_[at(node)]);
  return std::span(rows_).subspan(first, at(row_start_[at(node) + 1]) - first);
}

bool TreeRows::factor(int first, int last) {
  for (int i = first; i < last; ++i) {
    TreeNode& n = trees.node(i);
    n.held = 0;
    n.conductance.fill(0);
    for (const TreeRow& row : rows(i)) {
      if (row.status != TreeRow::active) continue;
      if (row.hard()) {
        n.held |= 1u << row.axis;
      } else {
        n.conductance[row.axis] += 1 / row.softness;
      }
    }
  }
  effort_.lines(kNodeLines * (last - first), 6);
  factored_[at(first)] = 1;
  factors_++;
  return trees.factor(first, last);
}

void TreeRows::plan_node(int i) {
  TreeNode& n = trees.node(i);
  const std::array<double, 6>& rate = rates_[at(i)];
  std::array<double, 6>& others = others_[at(i)];
  n.ask.fill(0);
  others.fill(0);
  const std::span<TreeRow> all = rows(i);
  for (const TreeRow& row : all) {
    if (row.status == TreeRow::active && row.hard()) n.ask[row.axis] = row.velocity - rate[row.axis];
  }
  for (TreeRow& row : all) {
    const bool held = (n.held >> row.axis & 1) != 0;
    double change = 0;
    if (row.status == TreeRow::active) {
      if (row.hard()) continue;
      const double after = rate[row.axis] + (held ? n.ask[row.axis] : 0);
      change = (row.velocity - after) / row.softness - row.impulse;
    } else if (row.status == TreeRow::outer) {
      double& pending = pending_[at(static_cast<int>(&row - rows_.data()))];
      change = pending;
      pending = 0;
      row.impulse += change;
    } else {
      const double bound = row.status == TreeRow::at_lower ? row.lower : row.upper;
      change = bound - row.impulse;
      row.impulse = bound;
    }
    (held ? others : n.ask)[row.axis] += change;
  }
}

void TreeRows::take_node(int i) {
  TreeNode& n = trees.node(i);
  std::array<double, 6>& rate = rates_[at(i)];
  for (std::size_t k = 0; k < 6; ++k) rate[k] += n.rate[k];
  for (TreeRow& row : rows(i)) {
    if (row.status != TreeRow::active) continue;
    if (row.hard()) {
      row.impulse += n.impulse[row.axis] - others_[at(i)][row.axis];
    } else {
      row.impulse = (row.velocity - rate[row.axis]) / row.softness;
    }
  }
  changes_[at(i)] += n.change;
  n.load = {};
}

void TreeRows::correct(int first, int last) {
  effort_.lines(kNodeLines * (last - first), 6);
  for (int i = first; i < last; ++i) plan_node(i);
  trees.solve(first, last);
  for (int i = first; i < last; ++i) take_node(i);
}

}  // namespace limber
