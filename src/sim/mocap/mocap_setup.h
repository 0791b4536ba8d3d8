// MocapSetup: how a source of motion capture was declared: where its frames come from, their axes and units, and the
// joints that the scene expects. Constant while the source exists.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec.h"
#include "model/mocap/bvh.h"

namespace limber::sim {

/// Axes and units of a source's numbers. Results are in meters, right-handed, Z up.
struct MocapAxes {
  enum class Up : std::uint8_t { x, y, z };
  Up up = Up::z;
  bool left_handed = false;
  double unit = 1;  ///< m

  Vec3 direction(const Vec3& v) const;
  Vec3 position(const Vec3& v) const { return direction(v) * unit; }
  Quat rotation(const Quat& q) const;
  bool operator==(const MocapAxes&) const = default;
};

/// An address and the words that describe its arguments; see mocap_messages.h.
struct MocapMapping {
  std::string address;
  std::string words;
  bool operator==(const MocapMapping&) const = default;
};

/// A joint and its parent.
struct MocapBone {
  static constexpr double kDefaultLength = 0.25;  ///< m

  std::string parent;
  std::string child;
  double length = kDefaultLength;  ///< m; for drawing.
  bool operator==(const MocapBone&) const = default;
};

struct MocapSetup {
  MocapAxes axes;
  std::vector<MocapMapping> messages;  ///< None: a player.
  std::vector<std::string> joints;     ///< Expected ones, in the order of messages without names.
  std::vector<MocapBone> bones;
  std::shared_ptr<const model::BvhClip> clip;  ///< Of a player.
  bool is_vmc = false;                         ///< Ignores other messages of that protocol.

  bool operator==(const MocapSetup& other) const;
};

/// The messages of a dialect: "osc" (/mocap/joint/…, or /mocap/<dancer>/joint/… if `dancer` is not empty), "psn" (those
/// that net/osc makes of PosiStageNet) or "vmc", whose bones are in the setup, too. `w_first`: order of the quaternions
/// of "osc".
Result<void> set_mocap_dialect(MocapSetup& setup, const std::string& dialect, const std::string& dancer, bool w_first);

}  // namespace limber::sim
