// Snapshot: an immutable copy of the transient state, published after each tick. Readers may keep it for any time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/output/render_scene.h"
#include "sim/clock/clock_reading.h"
#include "sim/fixtures/dmx.h"
#include "sim/visuals/overlay.h"

namespace limber::engine {

/// A body in a snapshot. Its joints are in stream order (root to tip).
struct BodyEntry {
  std::string name;
  std::uint32_t enabled_offset = 0;  ///< Index of its `enabled` (1 or 0) in Snapshot::transient.
  std::vector<std::string> joint_names;
  std::vector<std::uint32_t> joint_offsets;  ///< Index of each joint's block in Snapshot::transient.
  std::vector<std::uint32_t> part_offsets;   ///< The same for parts.
};

/// The bodies of a snapshot. Rebuilt only when bodies are added, removed or changed; shared by the snapshots in
/// between.
struct BodyList {
  std::vector<BodyEntry> bodies;  ///< In the order in which they were made.
};

/// Offsets of properties in a joint's or part's block of Snapshot::transient, in numbers.
struct TransientOffsets {
  std::uint32_t joint_position = 0;  ///< 3: the joint's point on the parent's side, world, m.
  std::uint32_t joint_rotation = 0;  ///< 4: x y z w of the child's joint frame, world.
  std::uint32_t joint_relrot = 0;    ///< 3: R = Rz·Ry·Rx of the child's joint frame in the parent's, rad, unwrapped.
  std::uint32_t joint_offsets = 0;   ///< 3: the child's shift along the parent's joint axes, m.
  std::uint32_t part_position = 0;   ///< 3: link frame, world, m.
  std::uint32_t part_rotation = 0;   ///< 4: x y z w.
};
const TransientOffsets& transient_offsets();

/// Seconds of a tick, by phase (see src/README.md).
struct PhaseTimes {
  double commands = 0;
  double scripts = 0;
  double behaviors = 0;
  double callbacks = 0;  ///< On-change callbacks.
  double physics = 0;
  double readouts = 0;
  double snapshot = 0;
  double gc = 0;
  /// Without `gc`, which runs after the tick.
  double total() const { return commands + scripts + behaviors + callbacks + physics + readouts + snapshot; }
};

struct Snapshot {
  std::uint64_t tick = 0;
  double time = 0;   ///< Simulated seconds.
  double speed = 1;  ///< Measured speed factor: simulated seconds per real second.
  bool paused = false;
  PhaseTimes times;  ///< Of this tick; `snapshot` and `gc` are of the previous one.
  std::shared_ptr<const BodyList> body_list;
  std::vector<double> transient;  ///< Transient values of every node (states and readouts), in the layout of the store.
  std::shared_ptr<const RenderScene> render_scene;
  std::vector<double> visuals;            ///< For material_of(), camera_of(), appearance_of().
  std::uint64_t visuals_version = 0;      ///< Changes when `visuals` of the same `render_scene` may have changed.
  sim::DmxFrame dmx;                      ///< The values of the lighting fixtures.
  sim::ClockReading clock;                ///< Musical time.
  bool replayed = false;                  ///< Made while a take was replayed.
  std::vector<sim::OverlayMark> overlay;  ///< Empty while the debug overlay is off.
};

/// Returns the world pose of a part, given by the index of its block (BodyEntry::part_offsets). [any]
Pose part_pose(const Snapshot& snapshot, std::uint32_t part_offset);

}  // namespace limber::engine
