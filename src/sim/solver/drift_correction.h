// DriftCorrection: predicts the position error that the rotation of bodies will cause at locked axes in a step, and
// changes the target velocities of these axes so that the error doesn't arise. The idea of SHAKE (Ryckaert, Ciccotti
// and Berendsen, Numerical integration of the cartesian equations of motion of a system with constraints, 1977), in
// velocities.
#pragma once

#include "sim/solver/coupled_rows.h"

namespace limber::sim::solver {

/// begin() after the first solve without corrections, then update() and another solve until nothing changes. [sim]
class DriftCorrection {
 public:
  DriftCorrection(const Island& island, SpanningTrees& trees, CoupledRows& rows)
      : island_(island), trees_(trees), rows_(rows) {}

  void begin();
  /// Updates the correction of all joints: locks prescribe rates at the start of the step, but pivots move along arcs.
  /// If it grows instead of converging, all corrections are removed. `min_drift`: smaller changes are ignored, m.
  void update(double min_drift);
  /// False once an update has changed nothing.
  bool pending() const { return pending_; }
  bool diverged() const { return diverged_; }
  /// True if joints may have a position error at the step's end: the correction has not converged, or a joint was not
  /// corrected because the rotation of one of its bodies is clamped.
  bool leaves_errors() const { return pending_ || diverged_ || skipped_clamped_; }
  /// Scales down the correction of a joint. Returns true if it had one.
  bool scale(int index, double fraction);

  static constexpr double kMinDrift = 1e-4;      ///< Smaller changes are ignored, m.
  static constexpr double kMinFastDrift = 1e-6;  ///< The same if bodies rotate fast: a spinning top would lose energy.
  static constexpr double kMinLoopDrift = 1e-5;  ///< The same if joints close loops: no position correction follows.

 private:
  struct BodyMotion {  // motion of a body in the step, with the velocity found
    Spatial velocity;
    Vec3 translation;
    Quat rotation;
    bool clamped;  // Bullet clamps its rotation
  };

  void apply(int index, const Vec3& drift);
  void predict_motions();
  BodyMotion predict_motion(int body) const;
  Vec3 predict_drift(int index);

  const Island& island_;
  SpanningTrees& trees_;
  CoupledRows& rows_;
  IndexedArray<Vec3> applied_;        // by joint: correction of its locked linear axes that is applied, m
  IndexedArray<Vec3> predicted_;      // by joint: correction that was predicted last, m
  IndexedArray<BodyMotion> motions_;  // by node
  double smallest_change_ = 0;        // of all updates, m
  bool pending_ = false;
  bool diverged_ = false;
  bool skipped_clamped_ = false;
};

}  // namespace limber::sim::solver
