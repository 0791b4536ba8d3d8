// TreeRows: the laws of a forest's axes (locks, motors, servos, limits, friction, springs), solved exactly with the
// trees by pivoting. docs/solver.md. No Bullet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/effort.h"
#include "sim/tree_solver.h"

namespace limber {

/// rate + softness·impulse = velocity, its impulse kept within [lower, upper]; at a bound the rate is what it will.
struct TreeRow {
  enum Mark : std::uint8_t { motor, friction, lower_limit, upper_limit, other };
  enum Status : std::uint8_t { active, at_lower, at_upper, outer };

  double velocity = 0;
  double softness = 0;  ///< >= 0; 0: a hard row.
  double lower = 0;     ///< kTreeInfinity and beyond: no bound.
  double upper = 0;
  double impulse = 0;
  int node = 0;
  std::uint8_t axis = 0;
  Mark mark = other;  ///< Tells the rows of an axis apart, from step to step; at most one of each hard kind.
  Status status = active;
  Status guess = outer;  ///< Of a row given up: where it may come to stand; outer: as its impulse says.
  double likely = 0;     ///< Of a row given up: an impulse to search from.

  bool hard() const { return softness == 0; }
  bool bounded() const;
  bool constant() const { return lower == upper; }
};
inline constexpr double kTreeInfinity = 1e15;
inline bool TreeRow::bounded() const { return lower > -kTreeInfinity || upper < kTreeInfinity; }

/// Which row of each axis was in force, and whether contacts made it so: what the next step starts from. 0: unknown.
using TreeMemory = std::array<std::uint8_t, 6>;

/// [sim]
class TreeRows {
 public:
  explicit TreeRows(Effort& effort) : effort_(effort) {}

  TreeSolver trees;

  /// No nodes; memory for so many is at hand.
  void clear(int room = 0);
  /// Rows of the node last added to `trees`, between two calls of end_node.
  TreeRow& add(int axis, double velocity, double softness, double lower, double upper, TreeRow::Mark mark);
  /// `rates`: of the node's axes, as they are before the step's impulses; `before`: the state of the last step.
  void end_node(const std::array<double, 6>& rates, const TreeMemory& before);
  TreeMemory memory(int node) const;

  std::span<TreeRow> rows(int node);
  int index_of(const TreeRow& row) const { return static_cast<int>(&row - rows_.data()); }
  std::span<const TreeRow> rows(int node) const {
    const auto first = at(row_start_[at(node)]);
    return std::span(rows_).subspan(first, at(row_start_[at(node) + 1]) - first);
  }
  std::span<TreeRow> rows() { return rows_; }
  double rate(int node, int axis) const { return rates_[at(node)][at(axis)]; }
  /// Change of a node's velocity by all that was solved so far.
  const Spatial& change(int node) const { return changes_[at(node)]; }
  /// Counts what was already done to a body from outside: velocities and rates are as if it had been solved.
  void set_change(int node, const Spatial& change) { changes_[at(node)] = change; }

  /// Solves whole trees, first .. last - 1, until every row obeys its law; at most `budget` exchanges. Rows of axes
  /// that did not settle are given up: their status is `outer`. False: an axis that moves no mass.
  bool pivot(int first, int last, int budget);
  /// The same where a factor is there already, and may still hold.
  bool settle(int first, int last, int budget);
  /// One exact solve with the loads of the nodes and the pending impulses of outer rows; loads are then cleared.
  void correct(int first, int last);
  /// Rows whose law is now broken are given up (`outer`); how many axes that were. factor() is due when not 0.
  int give_up_broken(int first, int last);
  /// Those that contacts brought elsewhere in the step before: likely they will again.
  int give_up_remembered(int first, int last);
  /// The bounded hard rows of one axis; 0 when it has none, or they were given up before.
  int give_up_axis(int node, int axis);
  /// All bounded rows that are in force, whether their law is broken or not.
  int give_up_all(int first, int last);
  /// Remembers impulses, rates and changes; goes back to them, rows that were given up since stay so.
  void keep();
  void go_back();
  /// After that: a new factor, and one solve.
  bool refresh(int first, int last);
  bool factor(int first, int last);
  /// An impulse of an outer row, to be applied by the next correct().
  void push(TreeRow& row, double impulse) { pending_[static_cast<std::size_t>(&row - rows_.data())] += impulse; }
  double residual(const TreeRow& row) const {
    return row.velocity - row.softness * row.impulse - rate(row.node, row.axis);
  }

  int exchanges() const { return exchanges_; }
  /// Tells one set of factors from the next.
  std::uint64_t factors() const { return factors_; }

 private:
  // The hard bounded rows of one axis, sorted by velocity: together a staircase. State 2i + 1: row i is active, those
  // before it at their lower bounds, those after it at their upper ones. State 2i: none is active between i - 1 and i.
  struct Stair {
    int node = 0;
    int axis = 0;
    int first = 0;  // in stair_rows_
    int count = 0;
    int state = 0;
    int want = 0;
    bool outer = false;
    bool before = false;  // was brought elsewhere by contacts in the step before
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  TreeRow& row_of(const Stair& s, int i) { return rows_[at(stair_rows_[at(s.first + i)])]; }
  const TreeRow& row_of(const Stair& s, int i) const { return rows_[at(stair_rows_[at(s.first + i)])]; }
  void build_stair(int node, int axis, std::uint8_t before);
  bool admissible(const Stair& s, int state) const;
  int remembered(const Stair& s, std::uint8_t code) const;
  int guess(const Stair& s) const;
  int reached(const Stair& s) const;
  void take_state(Stair& s);
  void give_up(Stair& s);
  void hand_over(TreeRow& row);
  int wanted(const Stair& s) const;
  int look(int first, int last);
  bool breaks(const TreeRow& row) const;
  void move(int first, int last, bool only_last);
  void plan_node(int i);
  void take_node(int i);
  std::span<Stair> stairs(int first, int last);

  /// What a factor, and what a solve costs, for each node: about so many lines of six.
  static constexpr int kNodeLines = 28;

  Effort& effort_;
  std::vector<TreeRow> rows_;
  std::vector<double> pending_;
  std::vector<int> row_start_;  // of each node
  std::vector<Stair> stairs_;
  std::vector<int> stair_start_;  // of each node
  std::vector<int> stair_rows_;
  std::vector<std::array<double, 6>> rates_;
  std::vector<std::array<double, 6>> others_;  // impulse changes on held axes that are known beforehand
  std::vector<Spatial> changes_;
  std::vector<double> kept_impulses_;
  std::vector<std::array<double, 6>> kept_rates_;
  std::vector<Spatial> kept_changes_;
  std::vector<unsigned char> factored_;  // node: whether its tree's factor is that of the present states
  int exchanges_ = 0;
  std::uint64_t factors_ = 0;
};

}  // namespace limber
