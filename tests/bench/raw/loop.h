// RawLoop: the measured arms in a stock Bullet world, programmed in the usual way, as the baseline for our tick.
#pragma once

#include <memory>
#include <vector>

#include "sim/bullet/bullet.h"

namespace limber {

/// Arms of boxes on fixed bases, standing on a floor, with limited, servo-driven joints.
struct ArmScene {
  int arms = 1;
  int parts = 17;      ///< moving parts per arm; also the number of joints
  double spacing = 4;  ///< between arms, m
  Vec3 size{0.1, 0.1, 0.2};
  double mass = 1;       ///< per part, kg
  double limit = 1.4;    ///< of each joint in both directions, rad
  double speed = 10;     ///< of each servo, rad/s
  double force = 10000;  ///< of each servo, N·m
  int solver_iterations = 10;
  double step = 1.0 / 240;  ///< substep, s
  int substeps = 4;         ///< substeps per tick

  bool hanging = false;  ///< from bases above the floor, instead of standing on it
  bool direct = false;   ///< our world: use the direct solver

  /// Center of a part while the arm is straight; part -1 is the base, which is fixed.
  Vec3 center(int arm, int part) const;
  /// Vector from a part's center to the joint that connects it to its parent.
  Vec3 to_joint() const { return {0, 0, (hanging ? 0.5 : -0.5) * size.z}; }
  /// Axis of a joint, alternating: 0 for x or 1 for y. The joint's child is the part of the same index.
  static int axis(int joint) { return joint & 1; }
  /// Servo target of a joint at a time: ±0.3 rad at 0.5 Hz, as a wave along the arm.
  static double target(int joint, double time);
};

/// Stock Bullet simulating the scene: discrete dynamics world, sequential impulses, six-dof spring joints. [sim]
class RawLoop {
 public:
  explicit RawLoop(const ArmScene& scene);
  ~RawLoop();
  RawLoop(const RawLoop&) = delete;
  RawLoop& operator=(const RawLoop&) = delete;

  /// Sets the targets of all servos for a time.
  void drive(double time);
  /// Advances by one tick.
  void tick();

  /// Largest distance between the two sides of a joint, m.
  double joint_gap() const;
  /// Largest distance of a joint from its servo's target at a time, rad.
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
  std::vector<std::unique_ptr<btGeneric6DofSpring2Constraint>> joints_;  // arm by arm, from the base to the tip
};

}  // namespace limber
