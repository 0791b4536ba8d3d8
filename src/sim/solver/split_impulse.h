// SplitImpulse: corrects penetration by displacements that leave no velocity, as Bullet does, but with the response of
// the trees, so that joints stay closed.
#pragma once

#include "sim/solver/coupled_rows.h"
#include "sim/solver/delassus.h"

namespace limber::sim::solver {

/// Writes push and turn velocities to Bullet's solver bodies. Uses the trees' factor and overwrites their inputs. [sim]
class SplitImpulse {
 public:
  SplitImpulse(const Island& island, SpanningTrees& trees, CoupledRows& rows, DelassusMatrix& delassus,
               WorkBudget& budget)
      : island_(island), trees_(trees), rows_(rows), delassus_(delassus), lcp_(budget) {}

  void apply();

 private:
  bool gather_rows();
  void solve();
  void respond();
  void write() const;

  const Island& island_;
  SpanningTrees& trees_;
  CoupledRows& rows_;
  DelassusMatrix& delassus_;
  BoxedLcp lcp_;
  IndexedArray<int> lcp_rows_;  // normals, and locks that close loops
};

}  // namespace limber::sim::solver
