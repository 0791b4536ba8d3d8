// PositionCorrection: where joints would have a position error at the step's end (a rotation is clamped, or the drift
// correction has not converged), bodies are moved by the least displacement in the norm of the mass matrix, without a
// change of velocity. Newton's method; each iteration is one solve of the trees at the predicted poses.
#pragma once

#include "sim/solver/forest/spanning_trees.h"

namespace limber::sim::solver {

/// Adds to the push and turn velocities of Bullet's solver bodies. Islands with loops are not corrected. [sim]
class PositionCorrection {
 public:
  PositionCorrection(const Island& island, const SpanningTrees& trees, WorkBudget& budget)
      : island_(island), trees_(trees), axes_(budget) {}

  /// Reserves memory for islands of `bodies` bodies.
  void reserve(int bodies) { axes_.clear(bodies); }
  /// Call after the results of the step were written.
  void apply();

 private:
  void predict_poses();
  void set_goals();
  void set_poses();
  void restore_poses();
  double position_error() const;
  bool solve_displacements();
  bool add_node(int node);
  void add_rows(int index);
  void move_bodies();
  void set_push_velocities() const;

  const Island& island_;
  const SpanningTrees& trees_;
  AxisActiveSet axes_;                         // the trees at the predicted poses
  IndexedArray<Pose> end_poses_;               // by node: at the step's end
  IndexedArray<FixedArray<double, 6>> goals_;  // by joint: positions of its locked axes at the step's end
};

}  // namespace limber::sim::solver
