// Rig: a world with bare parts and joints between them, for tests that compare single joints with formulas.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/joint_constraint.h"

namespace limber::sim {

inline constexpr double kRigStep = 1.0 / 240.0;

/// Parts don't collide. Gravity is zero by default.
struct Rig {
  Rig() { world.setGravity(btVector3(0, 0, 0)); }
  ~Rig() {
    for (auto& joint : joints) world.removeConstraint(joint.get());
    for (auto& part : parts) world.removeRigidBody(part.get());
  }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Mass 0: static. `inertia` is the principal tensor, kg·m².
  btRigidBody& part(double mass, const Vec3& inertia, const Pose& pose = {}) {
    btRigidBody::btRigidBodyConstructionInfo info(bullet::to_scalar(mass), nullptr, &ball, bullet::to_bt(inertia));
    info.m_startWorldTransform = bullet::to_bt(pose);
    parts.push_back(std::make_unique<btRigidBody>(info));
    parts.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(parts.back().get(), 0, 0);
    return *parts.back();
  }
  btRigidBody& ground() { return part(0, Vec3(0)); }

  /// Frames relative to the parts' centers of mass. Every axis is locked at 0.
  bullet::JointConstraint& joint(btRigidBody& parent, btRigidBody& child, const Pose& in_parent = {},
                                 const Pose& in_child = {}) {
    joints.push_back(
        std::make_unique<bullet::JointConstraint>(parent, child, bullet::to_bt(in_parent), bullet::to_bt(in_child)));
    world.addConstraint(joints.back().get());
    return *joints.back();
  }

  void steps(int count, double h = kRigStep) { world.step(h, count); }

  btSphereShape ball{0.05f};
  std::deque<std::unique_ptr<btRigidBody>> parts;
  std::deque<std::unique_ptr<bullet::JointConstraint>> joints;
  bullet::IslandWorld world{WorldSetup{}};
};

inline bullet::AxisSettings free_axis() {
  bullet::AxisSettings s;
  s.lower = 1;
  s.upper = -1;
  return s;
}
inline bullet::AxisSettings limited_axis(double lower, double upper) {
  bullet::AxisSettings s;
  s.lower = static_cast<float>(lower);
  s.upper = static_cast<float>(upper);
  return s;
}
inline bullet::AxisSettings servo_axis(bullet::AxisSettings s, double target, double speed, double force) {
  s.drive = bullet::AxisDrive::servo;
  s.target = target;
  s.velocity = static_cast<float>(speed);
  s.max_force = static_cast<float>(force);
  return s;
}
inline bullet::AxisSettings spin_axis(bullet::AxisSettings s, double speed, double force) {
  s.drive = bullet::AxisDrive::spin;
  s.velocity = static_cast<float>(speed);
  s.max_force = static_cast<float>(force);
  return s;
}
inline bullet::AxisSettings spring_axis(bullet::AxisSettings s, double rest, double stiffness, double damping = 0) {
  s.drive = bullet::AxisDrive::spring;
  s.rest = rest;
  s.stiffness = static_cast<float>(stiffness);
  s.spring_damping = static_cast<float>(damping);
  return s;
}

/// Unit vector of an axis 0..2 or 3..5.
inline Vec3 unit(int axis) { return {axis % 3 == 0 ? 1.0 : 0.0, axis % 3 == 1 ? 1.0 : 0.0, axis % 3 == 2 ? 1.0 : 0.0}; }

/// Sets the velocity of a joint's child so that one axis has this rate; the parent must be at rest.
inline void set_axis_rate(btRigidBody& child, int axis, double rate) {
  if (axis < 3) {
    child.setLinearVelocity(bullet::to_bt(unit(axis) * rate));
  } else {
    child.setAngularVelocity(bullet::to_bt(unit(axis) * rate));
  }
}

}  // namespace limber::sim
