// LockEnergy: limits the energy that the drift correction adds to trees without motors, in which ideal locks do no
// work.
#pragma once

#include "sim/solver/drift_correction.h"

namespace limber::sim::solver {

/// begin() after the solve without drift correction. The energy that the locks of a tree may return is stored in its
/// first joint from step to step. Trees that loops connect exchange energy: those of an island with loops count as one
/// tree. [sim]
class LockEnergy {
 public:
  LockEnergy(const Island& island, SpanningTrees& trees, const CoupledRows& rows, DriftCorrection& drift)
      : island_(island), trees_(trees), rows_(rows), drift_(drift) {}

  void begin();
  /// Scales down drift corrections of passive trees whose locks would add energy. Returns true if something changed.
  bool limit();
  /// Adds the energy that the locks have taken to that which they may return.
  void store();

 private:
  double work_of_locks(const Tree& tree) const;
  double work_of_loops() const;
  int first_joint(const Tree& tree) const;
  double& stored_energy(const Tree& tree) const;
  bool is_passive(const Tree& tree) const;

  const Island& island_;
  SpanningTrees& trees_;
  const CoupledRows& rows_;
  DriftCorrection& drift_;
  IndexedArray<Tree> groups_;              // the trees, or all of them as one
  IndexedArray<double> uncorrected_work_;  // by group: of its locks without drift correction, J
};

}  // namespace limber::sim::solver
