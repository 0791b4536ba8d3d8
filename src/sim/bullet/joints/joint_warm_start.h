// JointWarmStart: impulses and solver state that a joint keeps from one substep for the next.
#pragma once

#include <array>
#include <cstdint>

#include "sim/bullet/joints/joint_rows.h"

namespace limber::sim::bullet {

class JointWarmStart {
 public:
  /// Forgets everything but the impulses of the present block.
  void reset();
  /// Stores the impulse of a row once the step is solved.
  void store(const JointRow& row, btScalar impulse) {
    if (row.kind == JointRow::Kind::motor || row.kind == JointRow::Kind::lock) last_impulse_[row.axis] = impulse;
  }
  /// Computes the impulses with which the solvers start a step from those of the previous step.
  void begin_step(const JointRows& rows);

  /// Impulses of the rows of the block (JointRows::first_of_block).
  const float* block_impulses() const { return block_impulses_.data(); }
  void clear_block_impulses() { block_impulses_.fill(0); }
  /// Filtered impulse of the linear locks on the child in a substep along the parent-side axes, N·s. It follows
  /// decreases at once, and increases or changes of direction within about ten steps.
  const std::array<float, 3>& lock_impulse() const { return lock_impulse_; }
  /// Active set of the last step, for AxisActiveSet.
  solver::FixedArray<std::uint8_t, 6>& active_set() { return active_set_; }
  /// Energy that the locks of a tree have absorbed and may return, J, >= 0; stored in the tree's first joint.
  double& lock_energy() { return lock_energy_; }

 private:
  std::array<float, 6> last_impulse_{};  // of locks and motors, by axis
  std::array<float, 7> block_impulses_{};
  std::array<float, 3> lock_impulse_{};
  solver::FixedArray<std::uint8_t, 6> active_set_{};
  double lock_energy_ = 0;
};

}  // namespace limber::sim::bullet
