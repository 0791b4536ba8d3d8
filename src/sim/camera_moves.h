// CameraMoves: what moves the camera by itself: a glide from one view to another, a thing that it goes with. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/id.h"
#include "base/vec.h"

namespace limber {

class World;

class CameraMoves {
 public:
  explicit CameraMoves(World& world) : world_(world) {}

  /// From the view that it has to this one in so many seconds of simulation time (> 0), slow at both ends, around the
  /// target rather than through it. Ends what moved it before; a hand on the camera ends it.
  void glide(const Vec3& eye, const Vec3& target, double seconds);
  /// Looks at this part, or at the root of this body, from now on and goes with it; distance and direction stay, a hand
  /// may change them. Ends a glide; the null id: goes with nothing. A thing that is gone ends it.
  void follow(NodeId thing);
  bool moving() const { return state_.glide || !state_.followed.null(); }
  /// Stands still from now on.
  void stop() { state_ = {}; }
  /// After each tick: the camera is where it is due.
  void step();

 private:
  friend class WorldUndo;
  friend class WorldKey;

  using View = std::array<double, 7>;  // the rows that say where it is: position, rotation, distance
  struct Glide {
    Vec3 from_eye, from_target, eye, target;
    double begin = 0, seconds = 0;
    View left{};  // how the last step left the rows
  };
  struct State {
    std::optional<Glide> glide;
    NodeId followed;
    Vec3 at{};  // where the followed thing was
  };

  View view() const;
  std::optional<Vec3> place_of(NodeId thing) const;
  void step_glide();
  void step_follow();

  World& world_;
  State state_;
  std::uint64_t kept_in_ = 0;  // the call that its undo has kept it for
};

}  // namespace limber
