// How the rows around the trees answer to each other's impulses: by halves of responses, or, where a few axes have been
// given up since, from what the answers were before.
#include <algorithm>
#include <cmath>

#include "sim/dense.h"
#include "sim/island_direct.h"

namespace limber {
namespace {

/// What a free axis costs on the way of an impulse to the root, in numbers.
constexpr double kAxisNumbers = 24;
/// Softness of a contact that joints hold still, as part of the response of its two bodies alone.
constexpr double kHeldSoftness = 4e-4;
/// For so many rows that were known one new column is worth it.
constexpr int kRowsForColumn = 6;
/// An axis that, with those before it held still, keeps less than this part of its rate is left to the whole way.
constexpr double kLeastRate = 1e-6;

}  // namespace

// What an impulse of the row lets the free axes of its trees feel, behind all that is in felt_.
void IslandDirect::feel(const OuterRow& row, Reaches& reaches) {
  reaches.fill({});
  std::array<const Side*, 4> sides{};
  int count = 0;
  for_each_side(row, [&](const Side& side) { sides[at(count++)] = &side; });
  double* ask = row.axis != nullptr ? &system_.trees.node(row.a.node).ask[row.axis->axis] : nullptr;
  if (ask != nullptr) *ask = 1;
  for (int i = 0, reached = 0; i < count; ++i) {
    if (sides[at(i)] == nullptr) continue;
    // the bodies that are in the same tree: at most two pairs
    const int tree = tree_at(sides[at(i)]->node);
    std::array<TreeLoad, 4> loads;
    int loaded = 0;
    int axes = 0;
    for (int k = i; k < count; ++k) {
      const Side* const side = sides[at(k)];
      if (side == nullptr || tree_at(side->node) != tree) continue;
      loads[at(loaded++)] = {side->node, side->pull};
      axes = std::max(axes, system_.trees.free_axes(side->node));
      sides[at(k)] = nullptr;
    }
    reaches[at(reached++)] = {tree, static_cast<int>(felt_.size()), axes};
    felt_.resize(felt_.size() + at(axes), 0);
    const std::span<double> felt = std::span(felt_).last(at(axes));
    system_.trees.feel(loads[0], loads[1], felt);
    if (loaded <= 2) continue;
    felt_more_.assign(at(axes), 0);
    system_.trees.feel(loads[2], loads[3], felt_more_);
    for (int k = 0; k < axes; ++k) felt[at(k)] += felt_more_[at(k)];
  }
  if (ask != nullptr) *ask = 0;
}

// Adds the softness of a row to its response. A contact is made softer, once per step, the less the joints let it
// respond compared with its two bodies alone: its impulse stays small instead of throwing the rest of the tree.
void IslandDirect::soften(BoxSolver& box, int i) {
  OuterRow& row = outer_[at(boxed_[at(i)])];
  double& response = box.response(i, i);
  if (row.contact != nullptr && !row.softened && row.eases > 0) {
    const double held = std::max(0.0, 1 - response / row.eases);
    row.softness += kHeldSoftness * row.eases * held * held;
    row.softened = true;
  }
  response += row.softness;
}

// The trees' response between these outer rows.
void IslandDirect::respond(BoxSolver& box, std::span<const int> rows) {
  const int count = static_cast<int>(rows.size());
  box.start(count);
  for (int i = 0; i < system_.trees.size(); ++i) system_.trees.node(i).ask.fill(0);
  felt_.clear();
  reaches_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) feel(outer_[at(rows[i])], reaches_[i]);
  const auto felt = static_cast<double>(felt_.size());
  effort_.lines(felt, kAxisNumbers);
  effort_.lines(0.5 * count * count, felt / (count + 1));
  const auto together = [this](const Reach& a, const Reach& b) {
    if (a.tree != b.tree) return 0.0;
    return product(felt_.data() + a.begin, felt_.data() + b.begin, std::min(a.count, b.count));
  };
  for (int i = 0; i < count; ++i) {
    const Reaches& mine = reaches_[at(i)];
    for (int k = i; k < count; ++k) {
      double response = 0;
      for (const Reach& one : mine) {
        if (one.tree < 0) break;
        for (const Reach& other : reaches_[at(k)]) {
          if (other.tree < 0) break;
          response += together(one, other);
        }
      }
      box.response(i, k) = box.response(k, i) = response;
    }
  }
}

// Those that are solved for, in the order of outer_.
void IslandDirect::gather_rows() {
  place_.resize(outer_.size());
  boxed_.clear();
  for (std::size_t i = 0; i < outer_.size(); ++i) {
    place_[i] = outer_[i].aside ? -1 : static_cast<int>(boxed_.size());
    if (!outer_[i].aside) boxed_.push_back(static_cast<int>(i));
  }
}

// The same for a row in every round of a step, and growing as boxed_ does.
int IslandDirect::name_of(int outer) const {
  const TreeRow* axis = outer_[at(outer)].axis;
  return axis == nullptr ? outer : static_cast<int>(fixed_outer_) + system_.index_of(*axis);
}

// False: not a number.
bool IslandDirect::build_responses() {
  gather_rows();
  names_.clear();
  for (const int i : boxed_) names_.push_back(name_of(i));
  if (box_factors_ == system_.factors() && names_ == known_names_) return true;
  if (!extend_responses()) {
    respond(box_, boxed_);
    for (int i = 0; i < box_.size(); ++i) soften(box_, i);
  }
  box_factors_ = system_.factors();
  known_names_ = names_;
  known_axes_.clear();
  for (int i = 0; i < system_.trees.size(); ++i) {
    known_axes_.push_back({system_.trees.node(i).held, system_.trees.node(i).conductance});
  }
  for (int i = 0; i < box_.size(); ++i) {
    if (!std::isfinite(box_.response(i, i))) return false;
  }
  return true;
}

// Where axes have been given up since, or rows came, and not many. An axis that lets go adds to the response between
// two rows the product of the rates that a unit impulse about it gives them, over the rate that it gives the axis
// itself.
bool IslandDirect::extend_responses() {
  if (known_axes_.size() != at(system_.trees.size())) return false;
  if (!std::includes(names_.begin(), names_.end(), known_names_.begin(), known_names_.end())) return false;
  released_.clear();
  for (int i = 0; i < system_.trees.size(); ++i) {
    const TreeNode& node = system_.trees.node(i);
    const KnownAxes& before = known_axes_[at(i)];
    if ((node.held & ~before.held) != 0 || node.conductance != before.conductance) return false;
    for (int k = 0; k < 6; ++k) {
      if (((before.held & ~node.held) >> k & 1U) != 0) released_.push_back({{i, {}}, {}, k, -1});
    }
  }
  const auto known = static_cast<int>(known_names_.size());
  const int count = static_cast<int>(boxed_.size());
  const int freed = static_cast<int>(released_.size());
  if ((freed + count - known) * kRowsForColumn > known) return false;
  for (int i = 0; i < system_.trees.size(); ++i) system_.trees.node(i).ask.fill(0);

  // a line for each axis that lets go, as if those before it were held still: what it adds is the square of the line
  const int axes = (count + 1) / 2 * 2;  // behind the rows
  const int width = axes + (freed + 1) / 2 * 2;
  lines_.assign(at(freed * width), 0);
  answers_.resize(at((freed + 1) * count));
  const auto answers = [&](int n) { return std::span(answers_).subspan(at(n * count), at(count)); };
  for (int n = 0; n < freed; ++n) {
    double* line = &lines_[at(n * width)];
    answer(released_[at(n)], answers(n), std::span(line + axes, at(freed)));
    std::copy_n(answers(n).data(), count, line);
    const double alone = line[axes + n];
    for (int m = 0; m < n; ++m) {
      const double* before = &lines_[at(m * width)];
      subtract_scaled(line, before, before[axes + n], width);
    }
    if (!(line[axes + n] > kLeastRate * alone)) return false;
    const double scale = 1 / std::sqrt(line[axes + n]);
    for (int i = 0; i < width; ++i) line[i] *= scale;
  }
  from_.clear();
  for (int i = 0, next = 0; i < count; ++i) {
    const bool was = next < known && known_names_[at(next)] == names_[at(i)];
    from_.push_back(was ? next++ : -1);
  }
  box_.grow(from_);
  box_.add_squares(lines_, width);
  for (int i = 0; i < count; ++i) {
    if (from_[at(i)] >= 0) continue;
    const OuterRow& row = outer_[at(boxed_[at(i)])];
    const int known_as = released_with(row);
    if (known_as == freed) answer(pull_on(row), answers(freed), {});
    for (int k = 0; k < count; ++k) box_.response(i, k) = box_.response(k, i) = answers(known_as)[at(k)];
    soften(box_, i);
  }
  effort_.lines((freed + count - known) * (system_.trees.size() + count), kAxisNumbers);
  effort_.lines(count * (1 + freed), count);
  return true;
}

// The axis that let go and that the row is of; behind them all where it is of none.
int IslandDirect::released_with(const OuterRow& row) const {
  const auto same = [&row](const Pull& of) {
    return row.axis != nullptr && of.a.node == row.axis->node && of.axis == row.axis->axis;
  };
  return static_cast<int>(std::find_if(released_.begin(), released_.end(), same) - released_.begin());
}

IslandDirect::Pull IslandDirect::pull_on(const OuterRow& row) {
  return {row.a, row.b, row.axis != nullptr ? static_cast<int>(row.axis->axis) : -1, row.gear};
}

// Rates that a unit impulse gives the rows that are solved for, and the first of the axes that let go.
void IslandDirect::answer(const Pull& to, std::span<double> rows, std::span<double> axes) {
  TreeSolver& trees = system_.trees;
  std::array<int, 4> touched{-1, -1, -1, -1};
  const auto touches = [&](int tree) { return std::find(touched.begin(), touched.end(), tree) != touched.end(); };
  int count = 0;
  for_each_side(to, [&](const Side& side) {
    const int tree = tree_at(side.node);
    if (!touches(tree)) touched[at(count++)] = tree;
    if (to.axis < 0) trees.node(side.node).load += side.pull;
  });
  if (to.axis >= 0) trees.node(to.a.node).ask[at(to.axis)] = 1;
  for (int i = 0; i < count; ++i) trees.respond(trees_[at(touched[at(i)])].first, trees_[at(touched[at(i)])].last);
  if (to.axis >= 0) trees.node(to.a.node).ask[at(to.axis)] = 0;
  for_each_side(to, [&](const Side& side) { trees.node(side.node).load = {}; });
  const auto rate = [&](const Pull& of) {
    double sum = 0;
    for_each_side(of, [&](const Side& side) {
      if (!touches(tree_at(side.node))) return;
      const TreeNode& n = trees.node(side.node);
      if (of.axis < 0) sum += dot(side.pull, n.change);
      if (of.axis >= 0 && (n.held >> of.axis & 1U) == 0) sum += n.rate[at(of.axis)];
    });
    return sum;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = rate(pull_on(outer_[at(boxed_[i])]));
  for (std::size_t n = 0; n < axes.size(); ++n) axes[n] = rate(released_[n]);
}

}  // namespace limber
