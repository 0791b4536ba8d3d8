// MotionSource: passes the bodies of an offline engine, their links and their poses at times between two ticks to a
// MotionWriter.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/motion/motion_surfaces.h"
#include "engine/output/snapshot.h"
#include "export/motion.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::app {

/// Further values of bodies, for tables.
struct MotionExtras {
  bool velocities = false;  ///< Velocities of parts, speeds of joints.
  bool torques = false;     ///< Forces and torques that motors apply.
  bool contacts = false;    ///< Normal forces at the contacts of parts, and the total force of these.
};

/// Tracks the bodies of a running engine.
class MotionSource {
 public:
  /// `patterns`: names or OSC patterns of bodies; empty: all bodies.
  explicit MotionSource(std::vector<std::string> patterns, const MotionExtras& extras = {})
      : patterns_(std::move(patterns)), extras_(extras) {}

  /// Updates the list of bodies; called before the first tick and after each. A body that is created again with the
  /// same name, parts and joints (after a reset, for example) continues the same track. [sim]
  void update(const sim::World& world, const engine::Snapshot& current);
  /// Adds a frame that is interpolated between the two snapshots by `mix`, 0 .. 1: positions linearly, rotations along
  /// the shortest arc. A body that is only in one of the snapshots appears or disappears at `mix` 1. There is no
  /// interpolation across a reset.
  Result<void> add_frame(double time, const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                         exporter::MotionWriter& writer);

  /// Number of bodies that were in a frame.
  std::size_t bodies() const { return samples_.size(); }
  /// Names of all bodies seen so far, whether they match the patterns or not.
  const std::vector<std::string>& names() const { return names_; }

 private:
  // a value in the transient block of a joint
  struct Value {
    std::size_t joint = 0;
    std::uint32_t offset = 0;
    bool wraps = false;  // an angle between -pi and pi
  };
  // the motion of one body
  struct Track {
    exporter::MotionBody body;
    std::uint64_t content = 0;  // hash of the body's model
    std::vector<Value> values;
    std::vector<double> extras_before, extras_now;  // after the last two ticks; empty: the body did not exist
    std::optional<std::size_t> writer_number;       // the writer's number of the body
  };
  // maps the bodies of a body list to tracks and back; -1: none
  struct BodyListTracks {
    std::shared_ptr<const engine::BodyList> body_list;
    std::vector<int> track_of;
    std::vector<int> body_of;
  };

  // a body in a snapshot
  struct BodyAt {
    const engine::Snapshot& snapshot;
    const engine::BodyEntry& body;
  };
  void fill_sample(const Track& track, const BodyAt& from, const BodyAt& to, double mix);

  void update_body_list(const sim::World& world, const engine::Snapshot& current);
  void read_extras(const sim::World& world);
  void fill_extras(const Track& track, double mix, exporter::MotionSample& sample) const;
  int find_or_add_track(const sim::Body& body, const engine::BodyEntry& entry, const engine::Snapshot& current);
  Track make_track(const sim::Body& body, const engine::BodyEntry& entry, const engine::Snapshot& current);
  bool is_selected(const std::string& name) const;
  const BodyListTracks& tracks_of(const engine::BodyList* body_list) const;

  std::vector<std::string> patterns_;
  MotionExtras extras_;
  std::vector<std::string> names_;
  std::vector<Track> tracks_;
  std::array<BodyListTracks, 2> recent_;  // the latest first
  MotionSurfaces surfaces_;
  std::vector<exporter::MotionSample> samples_;  // indexed by the writer's number
};

}  // namespace limber::app
