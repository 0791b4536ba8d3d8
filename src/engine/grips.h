// Grips: what hands hold in the picture. A spring pulls a point of a part to where the hand is, strong enough for its
// whole body and damped; a hand that says nothing more lets go. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world.h"

namespace limber {

class Grips {
 public:
  static constexpr double kLasts = 0.5;      ///< Simulated seconds that a grip lasts without another word.
  static constexpr double kOmega = 10;       ///< 1/s: how fast a free body comes, without swinging over.
  static constexpr std::size_t kMost = 256;  ///< Parts that are held at once.

  /// `point` in the part's frame, `target` in the world. One that is held already is led on. False: too many.
  bool hold(World& world, NodeId part, const Vec3& point, const Vec3& target);
  void let_go(NodeId part);
  void clear() { grips_.clear(); }
  /// The forces of this tick; before the step.
  void pull(World& world);
  std::size_t size() const { return grips_.size(); }

 private:
  struct Grip {
    NodeId part;
    Vec3 point{0};
    Vec3 target{0};
    double until = 0;  // s
  };
  std::vector<Grip> grips_;
};

}  // namespace limber
