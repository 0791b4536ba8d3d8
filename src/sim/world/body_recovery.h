// BodyRecovery: the poses that a body can return to: its start pose, and the last good one, which the stability check
// restores. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Body;
class Joint;
class Part;

class BodyRecovery {
 public:
  explicit BodyRecovery(Body& body) : body_(body) {}

  /// Makes the present pose the start pose of a body that was created since the last step.
  void save_new_start_pose();
  /// Makes the pose of `other`, a body of the same structure, the start pose.
  void save_start_pose(const Body& other);
  /// Returns to the start pose, at rest and enabled; other values don't change.
  void reset();

  /// Ends the publication of the body's readouts: saves the pose as good unless the body was restored in this tick, or
  /// `separated`, a joint that came apart, is not null. [any, one thread per body]
  void save_good_pose(Joint* separated);
  /// Returns the joint that came apart in this tick, once, or null. Null also if the body was restored in this tick.
  const Joint* consume_separated_joint();
  /// Restores the last good pose, at rest, because a part is unstable; the second time since the last reset it also
  /// disables the body. Logs this, once per tick; returns true if it did.
  bool restore_good_pose(const Part& part, const std::string& instability);
  /// After the last substep: discards forces that a restored body got for further steps.
  void finish_restore();

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  Body& body_;
  // what persists from tick to tick
  struct State {
    bool is_new = true;  // created since the last step: the next step saves its start pose
    bool restored_this_tick = false;
    bool restored_once = false;
    std::size_t good_pose_count = 0;  // number of valid elements of good_poses
    std::vector<Pose> good_poses;     // of the parts after the last good tick
  } state_;
  std::uint64_t saved_in_call_ = 0;   // the last guarded call that saved this object
  Joint* separated_joint_ = nullptr;  // a joint that came apart in this tick
};

}  // namespace limber::sim
