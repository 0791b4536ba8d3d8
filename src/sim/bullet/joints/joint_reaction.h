// JointReaction: mean force and torque that a joint exerts on its child in a tick, from the impulses of all of its
// rows.
#pragma once

#include <array>

#include "sim/bullet/joints/joint_pose.h"

namespace limber::sim::bullet {

/// In each substep: add() for each row, then end_substep(). [sim]
class JointReaction {
 public:
  void reset() { *this = {}; }
  /// Adds the impulse of a row about or along an axis, 0..5.
  void add(int axis, btScalar impulse) { substep_[at(axis)] += impulse; }
  /// Adds an angular impulse, world.
  void add_angular(const btVector3& impulse) { substep_angular_ += impulse; }
  /// Adds the impulses of a substep of `h` s. Those about the dual axes, which depend on the pose, are converted to the
  /// axes of the joint's frame on the parent.
  void end_substep(const JointPose& pose, btScalar h) {
    btVector3 angular = pose.dual_axis(0) * substep_[3] + substep_angular_;
    for (int i = 1; i < 3; ++i) angular += pose.dual_axis(i) * substep_[at(3 + i)];
    for (int i = 0; i < 3; ++i) {
      sum_[at(i)] += substep_[at(i)];
      sum_[at(3 + i)] += pose.linear_axis(i).dot(angular);
    }
    substep_.fill(0);
    substep_angular_.setZero();
    time_ += h;
  }
  /// Ends a tick: averages the impulses.
  void end_tick() {
    const float per_time = time_ > 0 ? 1 / time_ : 0;
    for (std::size_t i = 0; i < 6; ++i) mean_[i] = sum_[i] * per_time;
    sum_.fill(0);
    time_ = 0;
  }

  /// On the child, at its pivot, along the axes of the joint's frame on the parent: N and N·m.
  Vec3 force() const { return {mean_[0], mean_[1], mean_[2]}; }
  Vec3 torque() const { return {mean_[3], mean_[4], mean_[5]}; }

 private:
  std::array<float, 6> substep_{};
  btVector3 substep_angular_{0, 0, 0};
  std::array<float, 6> sum_{};  // over the current tick, N·s and N·m·s
  std::array<float, 6> mean_{};
  float time_ = 0;
};

}  // namespace limber::sim::bullet
