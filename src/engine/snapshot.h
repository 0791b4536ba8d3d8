// Snapshot: a finished copy of everything that moves, published after each tick. Readers hold it as long as they like.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/drawing.h"
#include "sim/overlay.h"

namespace limber {

/// A body in a snapshot. Its joints stand in stream order.
struct RosterBody {
  std::string name;
  std::uint32_t enabled_at = 0;  ///< Where its `enabled` (1 or 0) stands in Snapshot::live.
  std::vector<std::string> joint_names;
  std::vector<std::uint32_t> joints;  ///< Where each joint's block begins in Snapshot::live.
  std::vector<std::uint32_t> parts;   ///< The same for parts.
};

/// Who is there. Made anew only when bodies come, go or change; shared by all snapshots in between.
struct Roster {
  std::vector<RosterBody> bodies;  ///< In the order in which they were made.
};

/// Offsets in a joint's or part's block of Snapshot::live, in numbers (from the classes' tables).
struct LiveOffsets {
  std::uint32_t joint_position = 0;  ///< 3: the joint's point on the parent's side, world, m.
  std::uint32_t joint_rotation = 0;  ///< 4: x y z w of the child's joint frame, world.
  std::uint32_t joint_relrot = 0;    ///< 3: R = Rz·Ry·Rx of the child's joint frame in the parent's, rad, unwrapped.
  std::uint32_t joint_offsets = 0;   ///< 3: the child's shift along the parent's joint axes, m.
  std::uint32_t part_position = 0;   ///< 3: link frame, world, m.
  std::uint32_t part_rotation = 0;   ///< 4: x y z w.
};
const LiveOffsets& live_offsets();

/// Seconds of a tick, by phase (architecture.md, the tick).
struct PhaseTimes {
  double commands = 0;
  double scripts = 0;
  double behaviors = 0;
  double effects = 0;
  double physics = 0;
  double readouts = 0;
  double snapshot = 0;
  double collector = 0;
  double total() const { return commands + scripts + behaviors + effects + physics + readouts + snapshot; }
};

struct Snapshot {
  std::uint64_t tick = 0;
  double time = 0;   ///< Simulated seconds.
  double speed = 1;  ///< Simulated seconds per real second, reached.
  bool paused = false;
  PhaseTimes times;  ///< What this tick took; of `snapshot` and `collector`, what the one before did.
  std::shared_ptr<const Roster> roster;
  std::vector<double> live;  ///< States and readouts of every node, as the store has them.
  std::shared_ptr<const Drawing> drawing;
  std::vector<double> visuals;        ///< For material_of(), camera_of(), look_of().
  std::uint64_t visuals_version = 0;  ///< Of one drawing: another when `visuals` may be.
  std::vector<OverlayMark> overlay;   ///< Empty while the debug picture is off.
};

}  // namespace limber
