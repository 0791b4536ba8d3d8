// Delassus matrix of the coupled rows, J M⁻¹ J' of the articulated trees: products of half responses, or, if only few
// axes have been deferred since, a low-rank update of the previous matrix.
#include <algorithm>
#include <cmath>

#include "sim/solver/dense_kernels.h"
#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

/// Cost of a free axis on the path of an impulse to the root, in multiply-adds.
constexpr double kAxisCost = 24;
/// Softness of a contact that joints prevent from moving, relative to the response of its two bodies alone.
constexpr double kBlockedSoftness = 4e-4;
/// The matrix is updated instead of rebuilt if it has at least this many known rows per new column.
constexpr int kMinKnownRowsPerColumn = 6;
/// An update fails if an axis retains less than this fraction of its rate once the axes before it are prescribed.
constexpr double kMinRateRatio = 1e-6;

}  // namespace

// Appends the half responses of a row, for each tree that it acts on, to half_values_.
void DirectSolver::add_half_response(const CoupledRow& row, HalfResponses& responses) {
  responses.fill({});
  std::array<const BodyJacobian*, 4> bodies{};
  int count = 0;
  for_each_jacobian(row, [&](const BodyJacobian& body) { bodies[at(count++)] = &body; });
  double* unit_input = row.axis != nullptr ? &tree_rows_.forest.node(row.a.node).input[row.axis->axis] : nullptr;
  if (unit_input != nullptr) *unit_input = 1;
  for (int i = 0, response_count = 0; i < count; ++i) {
    if (bodies[at(i)] == nullptr) continue;
    // all bodies in the same tree: at most two pairs
    const int tree = tree_at(bodies[at(i)]->node);
    std::array<TreeLoad, 4> loads;
    int loaded = 0;
    int axes = 0;
    for (int k = i; k < count; ++k) {
      const BodyJacobian* const body = bodies[at(k)];
      if (body == nullptr || tree_at(body->node) != tree) continue;
      loads[at(loaded++)] = {body->node, body->jacobian};
      axes = std::max(axes, tree_rows_.forest.free_axis_count(body->node));
      bodies[at(k)] = nullptr;
    }
    responses[at(response_count++)] = {tree, static_cast<int>(half_values_.size()), axes};
    half_values_.resize(half_values_.size() + at(axes), 0);
    const std::span<double> half = std::span(half_values_).last(at(axes));
    tree_rows_.forest.half_response(loads[0], loads[1], half);
    if (loaded <= 2) continue;
    half_scratch_.assign(at(axes), 0);
    tree_rows_.forest.half_response(loads[2], loads[3], half_scratch_);
    for (int k = 0; k < axes; ++k) half[at(k)] += half_scratch_[at(k)];
  }
  if (unit_input != nullptr) *unit_input = 0;
}

// Adds the softness of a row to the diagonal. The less the joints let a contact respond, compared with its two bodies
// alone, the softer it is made (once per step), so that its impulse stays small and doesn't accelerate the rest of the
// tree.
void DirectSolver::add_softness(BoxedLcp& lcp, int i) {
  CoupledRow& row = coupled_[at(lcp_rows_[at(i)])];
  double& response = lcp.response(i, i);
  if (row.contact != nullptr && !row.softened && row.mobility > 0) {
    const double blocked = std::max(0.0, 1 - response / row.mobility);
    row.softness += kBlockedSoftness * row.mobility * blocked * blocked;
    row.softened = true;
  }
  response += row.softness;
}

// Builds the Delassus matrix of these coupled rows.
void DirectSolver::build_delassus(BoxedLcp& lcp, std::span<const int> rows) {
  const int count = static_cast<int>(rows.size());
  lcp.reset(count);
  for (int i = 0; i < tree_rows_.forest.size(); ++i) tree_rows_.forest.node(i).input.fill(0);
  half_values_.clear();
  half_responses_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) add_half_response(coupled_[at(rows[i])], half_responses_[i]);
  const auto elements = static_cast<double>(half_values_.size());
  budget_.charge(elements, kAxisCost);
  budget_.charge(0.5 * count * count, elements / (count + 1));
  const auto product_of = [this](const HalfResponse& a, const HalfResponse& b) {
    if (a.tree != b.tree) return 0.0;
    return dot_product(half_values_.data() + a.begin, half_values_.data() + b.begin, std::min(a.count, b.count));
  };
  for (int i = 0; i < count; ++i) {
    const HalfResponses& responses = half_responses_[at(i)];
    for (int k = i; k < count; ++k) {
      double response = 0;
      for (const HalfResponse& first : responses) {
        if (first.tree < 0) break;
        for (const HalfResponse& second : half_responses_[at(k)]) {
          if (second.tree < 0) break;
          response += product_of(first, second);
        }
      }
      lcp.response(i, k) = lcp.response(k, i) = response;
    }
  }
}

// Collects the rows of the LCP (those not inactive) in the order of coupled_.
void DirectSolver::gather_lcp_rows() {
  lcp_index_.resize(coupled_.size());
  lcp_rows_.clear();
  for (std::size_t i = 0; i < coupled_.size(); ++i) {
    lcp_index_[i] = coupled_[i].inactive ? -1 : static_cast<int>(lcp_rows_.size());
    if (!coupled_[i].inactive) lcp_rows_.push_back(static_cast<int>(i));
  }
}

// Identifies a row in all rounds of a step; ascending over lcp_rows_.
int DirectSolver::row_id(int coupled_row) const {
  const TreeRow* axis = coupled_[at(coupled_row)].axis;
  return axis == nullptr ? coupled_row : static_cast<int>(fixed_coupled_) + tree_rows_.index_of(*axis);
}

// Updates the Delassus matrix for the present rows and factor. Returns false if a response is not finite.
bool DirectSolver::update_delassus() {
  gather_lcp_rows();
  row_ids_.clear();
  for (const int i : lcp_rows_) row_ids_.push_back(row_id(i));
  if (lcp_factor_version_ == tree_rows_.factor_version() && row_ids_ == known_row_ids_) return true;
  if (!extend_delassus()) {
    build_delassus(lcp_, lcp_rows_);
    for (int i = 0; i < lcp_.size(); ++i) add_softness(lcp_, i);
  }
  lcp_factor_version_ = tree_rows_.factor_version();
  known_row_ids_ = row_ids_;
  known_axes_.clear();
  for (int i = 0; i < tree_rows_.forest.size(); ++i) {
    known_axes_.push_back({tree_rows_.forest.node(i).prescribed, tree_rows_.forest.node(i).conductance});
  }
  for (int i = 0; i < lcp_.size(); ++i) {
    if (!std::isfinite(lcp_.response(i, i))) return false;
  }
  return true;
}

// Updates the matrix if only few axes have been released (deferred, so that they are free now) or rows added since;
// returns false if it must be rebuilt. A released axis adds the outer product of the rates that a unit impulse about it
// gives the rows, divided by the rate of the axis itself (Schur complement).
bool DirectSolver::extend_delassus() {
  if (known_axes_.size() != at(tree_rows_.forest.size())) return false;
  if (!std::includes(row_ids_.begin(), row_ids_.end(), known_row_ids_.begin(), known_row_ids_.end())) return false;
  released_.clear();
  for (int i = 0; i < tree_rows_.forest.size(); ++i) {
    const TreeNode& node = tree_rows_.forest.node(i);
    const KnownAxes& before = known_axes_[at(i)];
    if ((node.prescribed & ~before.prescribed) != 0 || node.conductance != before.conductance) return false;
    for (int k = 0; k < 6; ++k) {
      if (((before.prescribed & ~node.prescribed) >> k & 1U) != 0) released_.push_back({{i, {}}, {}, k, -1});
    }
  }
  const auto known_count = static_cast<int>(known_row_ids_.size());
  const int count = static_cast<int>(lcp_rows_.size());
  const int released = static_cast<int>(released_.size());
  if ((released + count - known_count) * kMinKnownRowsPerColumn > known_count) return false;
  for (int i = 0; i < tree_rows_.forest.size(); ++i) tree_rows_.forest.node(i).input.fill(0);

  // one vector per released axis, with the axes before it prescribed; its outer product with itself is added
  const int axes = (count + 1) / 2 * 2;  // columns behind the rows
  const int width = axes + (released + 1) / 2 * 2;
  updates_.assign(at(released * width), 0);
  columns_.resize(at((released + 1) * count));
  const auto column = [&](int n) { return std::span(columns_).subspan(at(n * count), at(count)); };
  for (int n = 0; n < released; ++n) {
    double* line = &updates_[at(n * width)];
    delassus_column(released_[at(n)], column(n), std::span(line + axes, at(released)));
    std::copy_n(column(n).data(), count, line);
    const double initial_rate = line[axes + n];
    for (int m = 0; m < n; ++m) {
      const double* before = &updates_[at(m * width)];
      subtract_scaled(line, before, before[axes + n], width);
    }
    if (!(line[axes + n] > kMinRateRatio * initial_rate)) return false;
    const double scale = 1 / std::sqrt(line[axes + n]);
    for (int i = 0; i < width; ++i) line[i] *= scale;
  }
  previous_index_.clear();
  for (int i = 0, next = 0; i < count; ++i) {
    const bool existed = next < known_count && known_row_ids_[at(next)] == row_ids_[at(i)];
    previous_index_.push_back(existed ? next++ : -1);
  }
  lcp_.remap(previous_index_);
  lcp_.add_outer_products(updates_, width);
  for (int i = 0; i < count; ++i) {
    if (previous_index_[at(i)] >= 0) continue;
    const CoupledRow& row = coupled_[at(lcp_rows_[at(i)])];
    const int released_axis = released_index(row);
    if (released_axis == released) delassus_column(impulse_site(row), column(released), {});
    for (int k = 0; k < count; ++k) lcp_.response(i, k) = lcp_.response(k, i) = column(released_axis)[at(k)];
    add_softness(lcp_, i);
  }
  budget_.charge((released + count - known_count) * (tree_rows_.forest.size() + count), kAxisCost);
  budget_.charge(count * (1 + released), count);
  return true;
}

// Index of the released axis that the row belongs to; released_.size() if none.
int DirectSolver::released_index(const CoupledRow& row) const {
  const auto matches = [&row](const ImpulseSite& of) {
    return row.axis != nullptr && of.a.node == row.axis->node && of.axis == row.axis->axis;
  };
  return static_cast<int>(std::find_if(released_.begin(), released_.end(), matches) - released_.begin());
}

DirectSolver::ImpulseSite DirectSolver::impulse_site(const CoupledRow& row) {
  return {row.a, row.b, row.axis != nullptr ? static_cast<int>(row.axis->axis) : -1, row.gear};
}

// Column of the Delassus matrix: rates that a unit impulse gives the rows of the LCP and the first released axes.
void DirectSolver::delassus_column(const ImpulseSite& site, std::span<double> rows, std::span<double> axes) {
  Forest& trees = tree_rows_.forest;
  std::array<int, 4> touched{-1, -1, -1, -1};
  const auto touches = [&](int tree) { return std::find(touched.begin(), touched.end(), tree) != touched.end(); };
  int count = 0;
  for_each_jacobian(site, [&](const BodyJacobian& body) {
    const int tree = tree_at(body.node);
    if (!touches(tree)) touched[at(count++)] = tree;
    if (site.axis < 0) trees.node(body.node).load += body.jacobian;
  });
  if (site.axis >= 0) trees.node(site.a.node).input[at(site.axis)] = 1;
  for (int i = 0; i < count; ++i) trees.respond(trees_[at(touched[at(i)])].first, trees_[at(touched[at(i)])].last);
  if (site.axis >= 0) trees.node(site.a.node).input[at(site.axis)] = 0;
  for_each_jacobian(site, [&](const BodyJacobian& body) { trees.node(body.node).load = {}; });
  const auto rate = [&](const ImpulseSite& of) {
    double sum = 0;
    for_each_jacobian(of, [&](const BodyJacobian& body) {
      if (!touches(tree_at(body.node))) return;
      const TreeNode& n = trees.node(body.node);
      if (of.axis < 0) sum += dot(body.jacobian, n.velocity_change);
      if (of.axis >= 0 && (n.prescribed >> of.axis & 1U) == 0) sum += n.rate[at(of.axis)];
    });
    return sum;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = rate(impulse_site(coupled_[at(lcp_rows_[i])]));
  for (std::size_t n = 0; n < axes.size(); ++n) axes[n] = rate(released_[n]);
}

}  // namespace limber
