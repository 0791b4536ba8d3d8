// Rotation of a body within one substep: split into a spin about a body axis, which is integrated exactly at any
// speed, and the rest, which is clamped beyond a quarter of pi. docs/understand/solver.md. [any]
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

/// Rotation per substep, rad, beyond which rotation other than spin is clamped (to less than pi, as in Bullet):
/// pivots would move along straight lines instead of arcs, and joints would drift apart.
inline constexpr double kMaxRotationPerStep = kPi / 4;
/// Below this rotation per substep, rad, a constant angular velocity is accurate enough.
inline constexpr double kSlowRotation = 0.05;

/// Angular velocity of a body, split into spin and rest. All vectors are in world axes.
struct RotationStep {
  Vec3 tumble{0};   ///< Angular velocity without the spin, perpendicular to the axis; rad/s.
  Vec3 axis{0};     ///< Unit; zero if there is no spin.
  double spin = 0;  ///< rad/s about the axis.
  /// The same axis, as fixed in the body; a hinge's axis differs from it by the error of its locks. Unit.
  Vec3 body_axis{0};
  const btRigidBody* owner = nullptr;  ///< The other part of the hinge, if the axis is fixed to that; else null.
  Vec3 lever{0};  ///< From the axis to the center of mass, m: zero unless a motor drives an unbalanced part.

  /// Rotation in a step of `h` s: R(after) = rotation · R(before).
  Quat rotation(double h) const;
  /// The axis after that step, as the present velocity of its part moves it.
  Vec3 next_axis(double h) const;
  /// Translation of the center of mass in that step, given its velocity.
  Vec3 translation(const Vec3& velocity, double h) const;
  /// Rotation per step, rad, that the clamp removes from the rest; 0: no clamp.
  double clamped(double h) const;
};

/// Splits the angular velocity `w` of a body for a step of `h` s. A spin is a rotation
/// - about the axis of a driven hinge of the body, if the center of mass and all other pivots of the body lie on it, or
/// the body has no other joint and turns faster than the other part of that hinge;
/// - about a principal axis of inertia on which all pivots of the body lie.
/// Slow rotations (kSlowRotation) and bodies without joints have none: the latter are moved by
/// integrate_free_rotation().
RotationStep split_rotation(const btRigidBody& body, const Vec3& w, double h);

/// True if a body without joints rotates fast enough to be moved by integrate_free_rotation().
bool moves_freely(const btRigidBody& body, double h);
/// Rotates a torque-free body without joints for `h` s by Euler's equations, in as many smaller steps as it needs:
/// energy and angular momentum are conserved at any speed.
void integrate_free_rotation(const Vec3& inertia, Quat& rotation, Vec3& w, double h);

/// Change of the angular velocity of a body in a step of `h` s by its own rotation, as if it had no joints; world axes.
/// Zero for a body that moves freely, since integrate_free_rotation() includes it.
Vec3 gyroscopic_change(const btRigidBody& body, double h);
/// Gyroscopic torque on a body at an angular velocity `w`, N·m, world axes; it does no work on w.
Vec3 gyroscopic_torque(const btRigidBody& body, const Vec3& w, double h);

/// Moves a body by its velocities for `h` s. Returns the rotation removed by the clamp, rad.
double move_body(btRigidBody& body, double h);

/// Angular velocity without spin about a driven joint's axis or a principal axis; world axes.
Vec3 tumbling_velocity(const btRigidBody& body, double h);

/// clamped_speed() returns the largest angular velocity, rad/s, that the clamp has removed since reset_clamp(), which
/// is called at the start of a tick; 0: none. It is stored in the body.
void reset_clamp(btRigidBody& body);
void record_clamp(btRigidBody& body, double amount);
double clamped_speed(const btRigidBody& body);

}  // namespace limber::sim::bullet
