// MotionSource: what a writer of motion is told of an engine that is driven offline: who came with which links, and
// where all are at a time between two ticks.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/motion_surfaces.h"
#include "engine/snapshot.h"
#include "motion/motion.h"
#include "sim/world.h"

namespace limber {

class MotionSource {
 public:
  /// `patterns`: names of bodies, or OSC's patterns of them; none: all bodies.
  explicit MotionSource(std::vector<std::string> patterns) : patterns_(std::move(patterns)) {}

  /// After each tick, and before the first: who is there now. A body that comes back with the same parts and joints
  /// under the same name, as after a reset, is the same. [sim]
  void learn(const World& world, const Snapshot& now);
  /// Where they are between the two snapshots: `mix` 0 .. 1. Places along a line, rotations along the shortest turn.
  /// Who comes or goes with `now` does so at 1, and nothing is between a moment and a reset.
  Result<void> add_frame(double time, const Snapshot& before, const Snapshot& now, double mix, MotionWriter& writer);

  /// Bodies that were in a frame.
  std::size_t bodies() const { return samples_.size(); }
  /// All that were seen, chosen or not.
  const std::vector<std::string>& names() const { return names_; }

 private:
  // a number of a joint's block
  struct Value {
    std::size_t joint = 0;
    std::uint32_t row = 0;
    bool turns = false;  // an angle between -pi and pi
  };
  struct Track {
    MotionBody body;
    std::uint64_t content = 0;  // of its model
    std::vector<Value> values;
    std::optional<std::size_t> number;  // the writer's
  };
  // which track each body of a roster is, and which body each track; -1: none
  struct Seen {
    std::shared_ptr<const Roster> roster;
    std::vector<int> track_of;
    std::vector<int> body_of;
  };

  int find_track(const Body& body, const RosterBody& entry, const Snapshot& now);
  Track make_track(const Body& body, const RosterBody& entry, const Snapshot& now);
  bool chosen(const std::string& name) const;
  const Seen& seen(const Roster* roster) const;

  std::vector<std::string> patterns_;
  std::vector<std::string> names_;
  std::vector<Track> tracks_;
  std::array<Seen, 2> seen_;  // the newest first
  MotionSurfaces surfaces_;
  std::vector<MotionSample> samples_;  // by the writer's numbers
};

}  // namespace limber
