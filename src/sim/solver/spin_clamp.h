// SpinClamp: keeps bodies from rotating too far in one step.
#pragma once

#include <utility>

#include "sim/solver/forest/spanning_trees.h"

namespace limber::sim::solver {

/// If a body rotates by more than kMaxRotationPerStep in a step, Bullet rotates it by less than its angular velocity
/// implies. In a tree with such a body (spins, see rotation_step.h, excluded) the motion relative to the tree's rigid
/// motion is scaled down. Momentum and every homogeneous constraint on the rates are unaffected. [sim]
class SpinClamp {
 public:
  SpinClamp(const Island& island, SpanningTrees& trees) : island_(island), trees_(trees) {}

  /// Forgets the previous step.
  void begin() { before_.clear(); }
  /// Clamps the velocities before the solve, or those after it. Returns true if something changed; the trees must then
  /// be built again, starting from the changed velocities.
  bool clamp_before() { return clamp(Stage::before); }
  bool clamp_after() { return clamp(Stage::after); }
  /// Restores the velocity changes for the iterative solver.
  void undo() const;
  /// Scales down the target rates of motors and limits in trees where a body would rotate too far in one step, spins
  /// excluded. Returns true if something changed.
  bool limit_target_rates();

 private:
  enum class Stage : std::uint8_t { before, after };
  struct RigidMotion {  // motion of a tree as one rigid piece
    Vec3 center{0};
    Spatial velocity;  // of the center of mass
  };

  bool clamp(Stage stage);
  double fastest_rotation(const Tree& tree, Stage stage) const;
  double fastest_relative_rotation(const Tree& tree, Stage stage, const RigidMotion& rigid) const;
  Spatial velocity(int node, Stage stage) const;
  Spatial velocity_without_spin(int node, Stage stage) const;
  RigidMotion rigid_motion(const Tree& tree, Stage stage) const;
  void scale_motion(int node, Stage stage, const RigidMotion& rigid, double scale_change);
  double fastest_tumbling(const Tree& tree) const;
  bool drives_spin(int index, int axis) const;

  const Island& island_;
  SpanningTrees& trees_;
  IndexedArray<std::pair<btVector3, btVector3>>
      before_;  // by body: velocity changes before the clamp; empty: unchanged
};

}  // namespace limber::sim::solver
