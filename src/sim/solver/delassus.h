// DelassusMatrix: the response of coupled rows to unit impulses, J M⁻¹ J', of articulated trees (Delassus 1917;
// Brogliato, Nonsmooth Mechanics, 2016, section 5.1.3).
#pragma once

#include <cstdint>

#include "sim/solver/coupled_rows.h"

namespace limber::sim::solver {

/// Computes the matrix of a BoxedLcp as products of half responses, or, if only few axes have been deferred since, as a
/// low-rank update of the previous matrix. [sim]
class DelassusMatrix {
 public:
  DelassusMatrix(SpanningTrees& trees, CoupledRows& rows, WorkBudget& budget)
      : trees_(trees), rows_(rows), budget_(budget) {}

  /// Forgets the matrix of update(); call after the trees were built.
  void clear();
  /// Builds the matrix of the coupled rows `rows`, without softness.
  void build(BoxedLcp& lcp, IndexedSpan<const int> rows);
  /// Updates the matrix for the rows (of increasing index) and the present factor, with softness. Call always with the
  /// same LCP. Returns false if a response is not finite.
  bool update(BoxedLcp& lcp, IndexedSpan<const int> rows);

 private:
  struct ImpulseSite {  // the bodies that a unit impulse acts on, or an axis of the first
    BodyJacobian a, b;
    int axis = -1;
    int coupling = -1;  // gear or tendon: more bodies
  };
  struct KnownAxes {  // state of a node's axes when the matrix was built
    unsigned prescribed;
    FixedArray<double, 6> damping;
  };
  struct HalfResponse {  // half response of a row in one tree
    int tree = -1;
    int begin = 0;  // in half_values_
    int count = 0;
  };

  void clear_inputs();
  void add_half_response(const CoupledRow& row);
  void add_tree_response(int first_body);
  IndexedSpan<const HalfResponse> responses_of(int row) const {
    const int first = first_response_[row];
    return IndexedSpan<const HalfResponse>(half_responses_).subspan(first, first_response_[row + 1] - first);
  }
  double product(int a, int b) const;
  void add_softness(BoxedLcp& lcp, int i, CoupledRow& row);
  int row_id(int coupled_row) const;
  bool extend(BoxedLcp& lcp, IndexedSpan<const int> rows);
  bool find_released_axes();
  bool factor_released_axes(IndexedSpan<const int> rows, int width);
  void add_new_rows(BoxedLcp& lcp, IndexedSpan<const int> rows);
  int released_index(const CoupledRow& row) const;
  static ImpulseSite impulse_site(const CoupledRow& row);
  void compute_column(const ImpulseSite& site, IndexedSpan<const int> rows, IndexedSpan<double> rates,
                      IndexedSpan<double> axes);
  IndexedSpan<double> column(int n) {
    return IndexedSpan<double>(columns_).subspan(n * row_ids_.size(), row_ids_.size());
  }

  SpanningTrees& trees_;
  CoupledRows& rows_;
  WorkBudget& budget_;
  // of build()
  IndexedArray<double> half_values_;           // half responses of the rows
  IndexedArray<double> half_scratch_;          // of a third and further bodies in one tree
  IndexedArray<HalfResponse> half_responses_;  // of the rows, by tree that a row acts on
  IndexedArray<int> first_response_;           // by row: its first one in half_responses_; one more at the end
  IndexedArray<const BodyJacobian*> bodies_;   // of a row; null: done
  // of update()
  std::uint64_t factor_version_ = 0;  // the matrix was built with; 0: none
  IndexedArray<int> row_ids_;
  IndexedArray<int> known_row_ids_;     // of the rows that the matrix has
  IndexedArray<KnownAxes> known_axes_;  // by node
  IndexedArray<ImpulseSite> released_;  // axes that have become free since then
  IndexedArray<int> previous_index_;    // by row: its index before
  IndexedArray<double> updates_;        // vectors whose outer products are added
  IndexedArray<double> columns_;        // of the released axes, and of one new row
  IndexedArray<int> touched_;           // trees that an impulse acts on
};

}  // namespace limber::sim::solver
