// KinematicBodies: static bodies that move at given velocities during a tick. They push and carry others, and are never
// pushed.
#pragma once

#include <memory>
#include <vector>

#include "sim/bullet/bullet.h"
#include "sim/bullet/sleep.h"

namespace limber::sim::bullet {

/// A motion during one tick: at a constant velocity and angular velocity from the present pose.
struct KinematicMove {
  btRigidBody* body = nullptr;
  Pose from;           ///< Of the center of mass at the start of the tick.
  btTransform to;      ///< At its end.
  Vec3 linear{0};      ///< m/s
  Vec3 axis{0};        ///< Unit.
  double angular = 0;  ///< rad/s about the axis.
};

/// Returns the move from the body's present pose to `to` in `seconds`, by the shorter rotation.
KinematicMove move_to(btRigidBody& body, const btTransform& to, double seconds);
/// Returns the move at these velocities (world axes).
KinematicMove move_at(btRigidBody& body, const Vec3& linear, const Vec3& angular, double seconds);

/// While a body moves, its velocity is that of Bullet's rigid body; solvers see it (surface_motion.h, IslandSolver).
/// [sim]
class KinematicBodies {
 public:
  /// Adds a move of the next tick and sets the body's velocity.
  void add(const KinematicMove& move);

  // For IslandWorld.
  /// Wakes the objects that the bodies touch, in the present substep.
  void wake(SleepTracker& sleep) const;
  /// Moves the bodies by a substep of `h` s; `last`: to their final poses. Reads the joints there again.
  void advance(double h, bool last);
  /// Ends a tick: removes all moves. Bodies keep their velocities.
  void end_tick();

 private:
  // on the heap, since the world itself is in Bullet's memory; its content lives for one tick only
  std::unique_ptr<std::vector<KinematicMove>> moves_ = std::make_unique<std::vector<KinematicMove>>();
  double time_ = 0;  // since the start of the tick, s
};

}  // namespace limber::sim::bullet
