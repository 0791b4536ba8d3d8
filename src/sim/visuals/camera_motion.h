// CameraMoves: animations of the camera: a glide from one view to another, and following an object. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/id.h"
#include "base/memory/archive.h"
#include "base/vec.h"

namespace limber::sim {

class World;

class CameraMoves {
 public:
  explicit CameraMoves(World& world) : world_(world) {}

  /// Moves the camera from its present view to the given one within `seconds` of simulation time (> 0), with ease-in
  /// and ease-out, on an arc around the target. Replaces an earlier animation. Setting the camera's pose ends it.
  void glide(const Vec3& eye, const Vec3& target, double seconds);
  /// Looks at the given part, or root of the given body, and moves with it. Distance and direction are kept and may
  /// be changed. Replaces a glide; the null id ends the following, as does the removal of the object.
  void follow(NodeId object);
  bool is_active() const { return state_.glide || !state_.followed.null(); }
  /// Ends all animations.
  void stop() { state_ = {}; }
  /// Updates the camera; call after each tick.
  void step();
  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }

 private:
  using View = std::array<double, 7>;  // the camera's pose: position, rotation, distance
  struct Glide {
    Vec3 from_eye, from_target, eye, target;
    double start_time = 0, seconds = 0;
    View last_view{};  // the pose as set in the last step
  };
  // what persists from tick to tick, besides the camera's properties
  struct State {
    std::optional<Glide> glide;
    NodeId followed;
    Vec3 last_position{};  // last position of the followed object
  };

  void save_for_rollback();
  View view() const;
  std::optional<Vec3> position_of(NodeId object) const;
  void step_glide();
  void step_follow();

  World& world_;
  State state_;
  std::uint64_t saved_in_call_ = 0;  // the last guarded call that saved its state
};

}  // namespace limber::sim
