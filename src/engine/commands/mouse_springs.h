// MouseSprings: the springs of the mouse in the view and of /physics/part/hold. A damped spring, strong enough for the
// whole body, pulls a point of a part to a target. It is removed if it is not renewed for half a second. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/world.h"

namespace limber::engine {

class MouseSprings {
 public:
  static constexpr double kTimeout = 0.5;          ///< Simulated seconds until a spring that is not renewed is removed.
  static constexpr double kOmega = 10;             ///< 1/s: natural frequency with a free body, critically damped.
  static constexpr std::size_t kMaxSprings = 256;  ///< Maximum number of springs.

  /// Attaches a spring to `point` (in the part's frame), or moves the part's existing spring. `target` is in the world.
  /// Returns false if there are too many.
  bool attach(sim::World& world, NodeId part, const Vec3& point, const Vec3& target);
  void release(NodeId part);
  void clear() { springs_.clear(); }
  /// Removes expired springs and applies the forces of the others. Call it before each step.
  void apply_forces(sim::World& world);
  std::size_t size() const { return springs_.size(); }

 private:
  struct Spring {
    NodeId part;
    Vec3 point{0};
    Vec3 target{0};
    double until = 0;  // s
  };
  std::vector<Spring> springs_;
};

}  // namespace limber::engine
