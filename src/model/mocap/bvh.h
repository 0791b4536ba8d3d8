// BVH: reads motion capture files (Biovision hierarchy): a tree of joints and one row of channel values per frame.
// [any]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber::model {

enum class BvhChannel : std::uint8_t { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

struct BvhJoint {
  std::string name;
  int parent = -1;  ///< Index of a joint before this one; -1: a root.
  Vec3 offset{0};   ///< From its parent, in the rest pose, in units of the file.
  std::array<BvhChannel, 6> channels{};
  std::size_t channel_count = 0;
  std::size_t first_channel = 0;  ///< Index of its first channel in a frame.
};

/// A motion. Lengths are in units of the file, along its axes; angles in degrees.
struct BvhClip {
  static constexpr std::size_t kMaxBytes = 256u << 20;
  static constexpr std::size_t kMaxJoints = 256;
  static constexpr std::size_t kMaxFrames = 10'000'000;
  static constexpr double kMaxValue = 1e6;  ///< Of an offset or a channel.

  std::string file;  ///< For messages.
  std::uint64_t content_hash = 0;
  std::vector<BvhJoint> joints;  ///< Each after its parent.
  double frame_time = 0;         ///< s
  std::size_t frames = 0;
  std::size_t channels = 0;   ///< Per frame.
  std::vector<float> values;  ///< Of all frames, one after the other.

  /// Time of the last frame, s.
  double duration() const { return static_cast<double>(frames - 1) * frame_time; }
  /// Pose of a joint in its parent's frame. Position channels replace the offset; the rotations are applied in the
  /// order of the channels, the last one first.
  Pose local_pose(std::size_t joint, std::size_t frame) const;
  /// The same between two frames: linear and along the shorter arc. `time`: s, clamped to 0 .. duration().
  Pose local_pose_at(std::size_t joint, double time) const;
};

/// Reads a BVH file's text. Errors name the file, the line and the problem.
Result<std::shared_ptr<const BvhClip>> parse_bvh(std::string_view text, std::string file);

}  // namespace limber::model
