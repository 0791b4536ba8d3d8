// LockEnergy: limits the energy that the drift correction adds to trees without motors, in which ideal locks do no
// work.
#pragma once

#include "sim/solver/drift_correction.h"

namespace limber::sim::solver {

/// begin() after the solve without drift correction. The energy that the locks of a tree may return is stored in its
/// first joint from step to step. [sim]
class LockEnergy {
 public:
  LockEnergy(const Island& island, SpanningTrees& trees, DriftCorrection& drift)
      : island_(island), trees_(trees), drift_(drift) {}

  void begin();
  /// Scales down drift corrections of passive trees whose locks would add energy. Returns true if something changed.
  bool limit();
  /// Adds the energy that the locks have taken to that which they may return.
  void store();

 private:
  double work_of_locks(const Tree& tree) const;
  double& stored_energy(const Tree& tree) const;
  bool is_passive(const Tree& tree) const;

  const Island& island_;
  SpanningTrees& trees_;
  DriftCorrection& drift_;
  IndexedArray<double> uncorrected_work_;  // by tree: of its locks without drift correction, J
};

}  // namespace limber::sim::solver
