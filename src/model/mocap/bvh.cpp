// BvhClip: its poses. The reader is in bvh_reader.cpp.
#include "model/mocap/bvh.h"

#include <algorithm>

namespace limber::model {

Pose BvhClip::local_pose(std::size_t joint, std::size_t frame) const {
  const BvhJoint& of = joints[joint];
  const float* const row = values.data() + frame * channels + of.first_channel;
  Pose pose{of.offset, quat_identity()};
  for (std::size_t i = 0; i < of.channel_count; i++) {
    const double value = static_cast<double>(row[i]);
    const auto channel = static_cast<int>(of.channels[i]);
    if (channel < 3) {
      pose.position[channel] = value;
    } else {
      Vec3 axis(0);
      axis[channel - 3] = 1;
      pose.rotation = pose.rotation * quat_axis(axis, value * (kPi / 180));
    }
  }
  return pose;
}

Pose BvhClip::local_pose_at(std::size_t joint, double time) const {
  const double at = std::clamp(time, 0.0, duration()) / frame_time;
  const std::size_t frame = std::min(static_cast<std::size_t>(at), frames - 1);
  const Pose from = local_pose(joint, frame);
  const double amount = at - static_cast<double>(frame);
  if (amount <= 0 || frame + 1 >= frames) return from;
  const Pose to = local_pose(joint, frame + 1);
  return {from.position + (to.position - from.position) * amount, slerp(from.rotation, to.rotation, amount)};
}

}  // namespace limber::model
