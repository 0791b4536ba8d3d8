// GyroscopicCorrection: evaluates the gyroscopic torques of fast bodies with joints at the middle of the step, with the
// velocities found: a fixed point, accelerated by Anderson mixing (Anderson, Iterative procedures for nonlinear
// integral equations, 1965).
#pragma once

#include "sim/solver/forest/spanning_trees.h"

namespace limber::sim::solver {

/// begin() after the first solve, then correct() and another solve until nothing changes. [sim]
class GyroscopicCorrection {
 public:
  GyroscopicCorrection(const Island& island, SpanningTrees& trees) : island_(island), trees_(trees) {}

  /// Collects bodies that rotate so fast that their gyroscopic torque depends on the joints' reactions.
  void begin();
  /// True if there are none.
  bool empty() const { return impulses_.empty(); }
  /// Returns true if loads have changed and everything must be solved again.
  bool correct();

 private:
  struct Impulse {  // the gyroscopic impulse on a body, N·m·s
    int node;
    double scale;                         // mean moment of inertia, kg·m²
    Vec3 applied;                         // so far
    Vec3 residual;                        // fixed-point residual: by the velocities found, minus `applied`
    FixedArray<Vec3, 2> applied_changes;  // of the last passes, newest first
    FixedArray<Vec3, 2> residual_changes;
  };

  bool update_residuals();
  FixedArray<double, 2> mixing_weights(int history) const;

  const Island& island_;
  SpanningTrees& trees_;
  IndexedArray<Impulse> impulses_;
  int passes_ = 0;
};

}  // namespace limber::sim::solver
