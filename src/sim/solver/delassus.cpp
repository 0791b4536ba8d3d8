// DelassusMatrix: builds the matrix from half responses, and updates it by the axes that have become free.
#include "sim/solver/delassus.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/solver/lcp/dense_kernels.h"

namespace limber::sim::solver {
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

void DelassusMatrix::clear() {
  factor_version_ = 0;
  known_row_ids_.clear();
  known_axes_.clear();
}

void DelassusMatrix::clear_inputs() {
  for (int i = 0; i < trees_.node_count(); ++i) trees_.axes.forest.node(i).input.fill(0);
}

// Appends the half responses of a row, for each tree that it acts on.
void DelassusMatrix::add_half_response(const CoupledRow& row) {
  bodies_.clear();
  rows_.for_each_jacobian(row, [&](const BodyJacobian& body) { bodies_.push_back(&body); });
  double* unit_input = row.axis != nullptr ? &trees_.axes.forest.node(row.a.node).input[row.axis->axis] : nullptr;
  if (unit_input != nullptr) *unit_input = 1;
  for (int i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i] != nullptr) add_tree_response(i);
  }
  if (unit_input != nullptr) *unit_input = 0;
}

// Appends the half response in the tree of a row's body, to the loads on all its bodies there, two at a time.
void DelassusMatrix::add_tree_response(int first_body) {
  const int tree = trees_.tree_of(bodies_[first_body]->node);
  const auto in_tree = [&](const BodyJacobian* body) { return body != nullptr && trees_.tree_of(body->node) == tree; };
  int axes = 0;
  for (int k = first_body; k < bodies_.size(); ++k) {
    if (in_tree(bodies_[k])) axes = std::max(axes, trees_.axes.forest.free_axis_count(bodies_[k]->node));
  }
  half_responses_.push_back({tree, half_values_.size(), axes});
  half_values_.resize(half_values_.size() + axes, 0);
  const IndexedSpan<double> half = IndexedSpan<double>(half_values_).last(axes);
  bool first_pair = true;
  for (int k = first_body; k < bodies_.size();) {
    FixedArray<TreeLoad, 2> loads;
    int loaded = 0;
    for (; k < bodies_.size() && loaded < 2; ++k) {
      if (!in_tree(bodies_[k])) continue;
      loads[loaded++] = {bodies_[k]->node, bodies_[k]->jacobian};
      bodies_[k] = nullptr;
    }
    if (loaded == 0) break;
    if (std::exchange(first_pair, false)) {
      trees_.axes.forest.half_response(loads[0], loads[1], half);
      continue;
    }
    half_scratch_.assign(axes, 0);
    trees_.axes.forest.half_response(loads[0], loads[1], half_scratch_);
    for (int i = 0; i < axes; ++i) half[i] += half_scratch_[i];
  }
}

// Response of one row to a unit impulse of another one.
double DelassusMatrix::product(int a, int b) const {
  double response = 0;
  for (const HalfResponse& first : responses_of(a)) {
    for (const HalfResponse& second : responses_of(b)) {
      if (first.tree != second.tree) continue;
      response += dot_product(half_values_.data() + first.begin, half_values_.data() + second.begin,
                              std::min(first.count, second.count));
    }
  }
  return response;
}

void DelassusMatrix::build(BoxedLcp& lcp, IndexedSpan<const int> rows) {
  const int count = rows.size();
  lcp.reset(count);
  clear_inputs();
  half_values_.clear();
  half_responses_.clear();
  first_response_.clear();
  for (int i = 0; i < count; ++i) {
    first_response_.push_back(half_responses_.size());
    add_half_response(rows_[rows[i]]);
  }
  first_response_.push_back(half_responses_.size());
  const auto elements = static_cast<double>(half_values_.size());
  budget_.charge(elements, kAxisCost);
  budget_.charge(0.5 * count * count, elements / (count + 1));
  for (int i = 0; i < count; ++i) {
    for (int k = i; k < count; ++k) lcp.response(i, k) = lcp.response(k, i) = product(i, k);
  }
}

// Adds the softness of a row to the diagonal. The less the joints let a contact respond, compared with its two bodies
// alone, the softer it is made (once per step), so that its impulse stays small and doesn't accelerate the rest of the
// tree.
void DelassusMatrix::add_softness(BoxedLcp& lcp, int i, CoupledRow& row) {
  double& response = lcp.response(i, i);
  if (row.contact != nullptr && !row.softened && row.mobility > 0) {
    const double blocked = std::max(0.0, 1 - response / row.mobility);
    row.softness += kBlockedSoftness * row.mobility * blocked * blocked;
    row.softened = true;
  }
  response += row.softness;
}

// Identifies a row in all rounds of a step; increases with the index of the row.
int DelassusMatrix::row_id(int coupled_row) const {
  const AxisRow* axis = rows_[coupled_row].axis;
  return axis == nullptr ? coupled_row : rows_.fixed_count() + trees_.axes.index_of(*axis);
}

bool DelassusMatrix::update(BoxedLcp& lcp, IndexedSpan<const int> rows) {
  row_ids_.clear();
  for (const int i : rows) row_ids_.push_back(row_id(i));
  if (factor_version_ == trees_.axes.factor_version() && row_ids_ == known_row_ids_) return true;
  if (!extend(lcp, rows)) {
    build(lcp, rows);
    for (int i = 0; i < lcp.size(); ++i) add_softness(lcp, i, rows_[rows[i]]);
  }
  factor_version_ = trees_.axes.factor_version();
  known_row_ids_ = row_ids_;
  known_axes_.clear();
  for (int i = 0; i < trees_.node_count(); ++i) {
    const TreeNode& node = trees_.axes.forest.node(i);
    known_axes_.push_back({node.prescribed, node.damping});
  }
  for (int i = 0; i < lcp.size(); ++i) {
    if (!std::isfinite(lcp.response(i, i))) return false;
  }
  return true;
}

// Finds the axes that were prescribed when the matrix was built, and are free now. Returns false if other axes changed.
bool DelassusMatrix::find_released_axes() {
  released_.clear();
  if (known_axes_.size() != trees_.node_count()) return false;
  for (int i = 0; i < trees_.node_count(); ++i) {
    const TreeNode& node = trees_.axes.forest.node(i);
    const KnownAxes& before = known_axes_[i];
    if ((node.prescribed & ~before.prescribed) != 0 || node.damping != before.damping) return false;
    for (int k = 0; k < 6; ++k) {
      if (((before.prescribed & ~node.prescribed) >> k & 1U) != 0) released_.push_back({{i, {}}, {}, k, -1});
    }
  }
  return true;
}

// Updates the matrix if only few axes have been released (deferred, so that they are free now) or rows added since;
// returns false if it must be rebuilt. A released axis adds the outer product of the rates that a unit impulse about it
// gives the rows, divided by the rate of the axis itself (Schur complement).
bool DelassusMatrix::extend(BoxedLcp& lcp, IndexedSpan<const int> rows) {
  if (!std::includes(row_ids_.begin(), row_ids_.end(), known_row_ids_.begin(), known_row_ids_.end())) return false;
  if (!find_released_axes()) return false;
  const int known_count = known_row_ids_.size();
  const int count = rows.size();
  const int released = released_.size();
  if ((released + count - known_count) * kMinKnownRowsPerColumn > known_count) return false;
  clear_inputs();
  const int width = (count + 1) / 2 * 2 + (released + 1) / 2 * 2;
  if (!factor_released_axes(rows, width)) return false;
  previous_index_.clear();
  for (int i = 0, next = 0; i < count; ++i) {
    const bool existed = next < known_count && known_row_ids_[next] == row_ids_[i];
    previous_index_.push_back(existed ? next++ : -1);
  }
  lcp.remap(previous_index_);
  lcp.add_outer_products(updates_, width);
  add_new_rows(lcp, rows);
  budget_.charge((released + count - known_count) * (trees_.node_count() + count), kAxisCost);
  budget_.charge(count * (1 + released), count);
  return true;
}

// Computes one vector per released axis, with the axes before it prescribed; its outer product with itself is added to
// the matrix. Elements of the axes follow those of the rows. Returns false if an axis (nearly) depends on others.
bool DelassusMatrix::factor_released_axes(IndexedSpan<const int> rows, int width) {
  const int count = rows.size();
  const int released = released_.size();
  const int axes = (count + 1) / 2 * 2;
  updates_.assign(released * width, 0);
  columns_.resize((released + 1) * count);
  for (int n = 0; n < released; ++n) {
    double* line = &updates_[n * width];
    compute_column(released_[n], rows, column(n), {line + axes, released});
    std::copy_n(column(n).data(), count, line);
    const double initial_rate = line[axes + n];
    for (int m = 0; m < n; ++m) {
      const double* before = &updates_[m * width];
      subtract_scaled(line, before, before[axes + n], width);
    }
    if (!(line[axes + n] > kMinRateRatio * initial_rate)) return false;
    const double scale = 1 / std::sqrt(line[axes + n]);
    for (int i = 0; i < width; ++i) line[i] *= scale;
  }
  return true;
}

// Computes the responses of the rows that the matrix didn't have. A released axis has its column already.
void DelassusMatrix::add_new_rows(BoxedLcp& lcp, IndexedSpan<const int> rows) {
  const int released = released_.size();
  for (int i = 0; i < rows.size(); ++i) {
    if (previous_index_[i] >= 0) continue;
    CoupledRow& row = rows_[rows[i]];
    const int released_axis = released_index(row);
    if (released_axis == released) compute_column(impulse_site(row), rows, column(released), {});
    for (int k = 0; k < rows.size(); ++k) lcp.response(i, k) = lcp.response(k, i) = column(released_axis)[k];
    add_softness(lcp, i, row);
  }
}

// Index of the released axis that the row belongs to; released_.size() if none.
int DelassusMatrix::released_index(const CoupledRow& row) const {
  const auto matches = [&row](const ImpulseSite& of) {
    return row.axis != nullptr && of.a.node == row.axis->node && of.axis == row.axis->axis;
  };
  return static_cast<int>(std::find_if(released_.begin(), released_.end(), matches) - released_.begin());
}

DelassusMatrix::ImpulseSite DelassusMatrix::impulse_site(const CoupledRow& row) {
  return {row.a, row.b, row.axis != nullptr ? static_cast<int>(row.axis->axis) : -1, row.coupling};
}

// Column of the Delassus matrix: rates that a unit impulse gives the rows and the first released axes.
void DelassusMatrix::compute_column(const ImpulseSite& site, IndexedSpan<const int> rows, IndexedSpan<double> rates,
                                    IndexedSpan<double> axes) {
  Forest& forest = trees_.axes.forest;
  touched_.clear();
  const auto touches = [&](int tree) { return std::find(touched_.begin(), touched_.end(), tree) != touched_.end(); };
  rows_.for_each_jacobian(site, [&](const BodyJacobian& body) {
    const int tree = trees_.tree_of(body.node);
    if (!touches(tree)) touched_.push_back(tree);
    if (site.axis < 0) forest.node(body.node).load += body.jacobian;
  });
  if (site.axis >= 0) forest.node(site.a.node).input[site.axis] = 1;
  for (const int tree : touched_) forest.respond(trees_[tree].first, trees_[tree].last);
  if (site.axis >= 0) forest.node(site.a.node).input[site.axis] = 0;
  rows_.for_each_jacobian(site, [&](const BodyJacobian& body) { forest.node(body.node).load = {}; });
  const auto rate = [&](const ImpulseSite& of) {
    double sum = 0;
    rows_.for_each_jacobian(of, [&](const BodyJacobian& body) {
      if (!touches(trees_.tree_of(body.node))) return;
      const TreeNode& n = forest.node(body.node);
      if (of.axis < 0) sum += dot(body.jacobian, n.velocity_change);
      if (of.axis >= 0 && (n.prescribed >> of.axis & 1U) == 0) sum += n.rate[of.axis];
    });
    return sum;
  };
  for (int i = 0; i < rows.size(); ++i) rates[i] = rate(impulse_site(rows_[rows[i]]));
  for (int n = 0; n < axes.size(); ++n) axes[n] = rate(released_[n]);
}

}  // namespace limber::sim::solver
