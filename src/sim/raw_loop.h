// RawLoop: the arms of the benchmarks in a plain Bullet world, written as anybody would with stock parts: what a tick
// of ours is compared with.
#pragma once

#include <memory>
#include <vector>

#include "sim/bullet.h"

namespace limber {

/// Arms of boxes on fixed bases, standing on a floor; a limited, servo-driven joint between each two boxes.
struct ArmScene {
  int arms = 1;
  int parts = 17;      ///< That move, of each arm; as many joints.
  double spacing = 4;  ///< Between arms, m.
  Vec3 size{0.1, 0.1, 0.2};
  double mass = 1;       ///< Of a part, kg.
  double limit = 1.4;    ///< Of each joint, both ways, rad.
  double speed = 10;     ///< Of each servo, rad/s.
  double force = 10000;  ///< Of each servo, N·m.
  int solver_iterations = 10;
  double step = 1.0 / 240;  ///< Internal step, s.
  int substeps = 4;         ///< Internal steps of a tick.

  bool hanging = false;  ///< From bases above the floor, instead of standing on it.
  bool direct = false;   ///< Ours: with the direct solver.

  /// A part's centre when the arm is straight; part -1 is the base, which does not move.
  Vec3 center(int arm, int part) const;
  /// From a part's centre to the joint that it hangs on.
  Vec3 to_joint() const { return {0, 0, (hanging ? 0.5 : -0.5) * size.z}; }
  /// A joint turns about x or y in turn: 0 or 1. It bears the part of its number.
  static int axis(int joint) { return joint & 1; }
  /// Where the servo of a joint goes at a time: ±0.3 rad at 0.5 Hz, a wave along the arm.
  static double target(int joint, double time);
};

/// Stock Bullet on the scene: discrete dynamics world, sequential impulses, six-dof spring joints. [sim]
class RawLoop {
 public:
  explicit RawLoop(const ArmScene& scene);
  ~RawLoop();
  RawLoop(const RawLoop&) = delete;
  RawLoop& operator=(const RawLoop&) = delete;

  /// Targets of all servos for this time.
  void drive(double time);
  /// One tick: the scene's internal steps.
  void tick();

  /// Largest distance between the two sides of a joint, m.
  double joint_gap() const;
  /// Largest distance of a joint from its servo's target at this time, rad.
  double servo_error(double time) const;
  int contact_pairs() const;

 private:
  btRigidBody& add_box(const Vec3& center, double mass);
  void add_floor();
  void add_arm(int arm);

  ArmScene scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape box_;
  btStaticPlaneShape plane_{btVector3(0, 0, 1), 0};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btGeneric6DofSpring2Constraint>> joints_;  // arm by arm, from the base up
};

}  // namespace limber
