// MocapJoint: a joint of a source of motion capture: its node, its last sample, and its motion on stage, which follows
// the samples within the limits of the source. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/vec.h"
#include "properties/store.h"
#include "sim/mocap/mocap_messages.h"

namespace limber::sim {

class MocapSource;

/// Settings of a source for the motion of its joints in a tick.
struct MocapMotion {
  double dt = 0;  ///< s
  Pose stage;     ///< Where the source's origin is.
  double scale = 1;
  double max_step = 0;  ///< Largest motion in the tick, m.
  double max_turn = 0;  ///< rad
};

class MocapJoint {
 public:
  static const PropertyTable& table();

  /// What persists from tick to tick, besides its readouts. Lengths in m, Z up; `raw` without the source's offset.
  struct State {
    Pose raw;        ///< Of the last sample, in the source's frame.
    Pose raw_local;  ///< The same in its parent's frame.
    Pose pose;       ///< On stage.
    Quat local_rotation = quat_identity();
    Vec3 velocity{0};
    Vec3 acceleration{0};
    double sampled_at = -1;  ///< Time of the last sample, s; negative: none yet.
    double interval = 0;     ///< Mean time between samples, s.
    double remaining = 0;    ///< Time in which it reaches the last sample, s.
    double confidence = 1;   ///< As received.
    bool has_local_position = false;
    bool has_local_rotation = false;
    bool is_local = false;  ///< Its place is given relative to its parent.
    bool placed = false;    ///< It has a pose on stage.
  };

  /// `index`: in the list of its source.
  MocapJoint(MocapSource& source, NodeId group, std::string name, std::size_t index);
  ~MocapJoint();
  MocapJoint(const MocapJoint&) = delete;
  MocapJoint& operator=(const MocapJoint&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  std::size_t index() const { return index_; }
  MocapSource& source() const { return source_; }
  /// Number in the list of the source; -1: none.
  int parent() const { return parent_; }
  void set_parent(int parent) { parent_ = parent; }

  /// Records a sample at a time. `axes`: those of the source.
  void accept(const MocapSample& sample, const MocapAxes& axes, double time);
  /// Sets the pose in its parent's frame, m, Z up, which the joint reaches in the next tick: that of a player.
  void set_local(const Pose& pose, double time);
  bool seen() const { return state_.sampled_at >= 0; }
  double sampled_at() const { return state_.sampled_at; }
  bool placed() const { return state_.placed; }
  const Pose& pose() const { return state_.pose; }
  const Vec3& velocity() const { return state_.velocity; }
  const Vec3& acceleration() const { return state_.acceleration; }
  const Quat& local_rotation() const { return state_.local_rotation; }
  double confidence() const { return confidence_; }
  bool on_floor() const { return on_floor_; }

  /// Its sample in the source's frame; `parent`: that of its nearest ancestor with a sample, or null.
  Pose raw_pose(const Pose* parent) const;
  /// Moves it towards a pose in the source's frame. `parent`: its nearest ancestor with a pose on stage, or null.
  void move(const Pose& raw, const MocapJoint* parent, const MocapMotion& motion);
  /// Stops it where it is.
  void stop() { state_.velocity = state_.acceleration = Vec3(0); }
  /// Publishes its readouts. `trust`: factor on its confidence.
  void publish(double time, double trust, bool on_floor);

  State& state() { return state_; }

  // Callback of a property.
  void read_number(double* out) const { *out = static_cast<double>(index_ + 1); }

 private:
  void count_sample(double time);

  MocapSource& source_;
  NodeId id_;
  std::size_t index_;
  int parent_ = -1;
  double confidence_ = 0;  // as published, like the next field
  bool on_floor_ = false;
  State state_;
};

}  // namespace limber::sim
