// Rotation of a body within one internal step: a spin about an axis of its own, which is integrated exactly however far
// it turns, and the rest, which is clamped beyond a quarter of pi. docs/solver.md. [any]
#pragma once

#include "sim/bullet.h"

namespace limber {

/// Rotation per internal step, rad, beyond which rotation that is no spin is clamped (to less than pi, as Bullet does
/// it): the body's pivots would move along straight lines where they should go round, and joints would part.
inline constexpr double kTurnClamp = kPi / 4;
/// Below this rotation per internal step, rad, a constant angular velocity is accurate enough.
inline constexpr double kSlowTurn = 0.05;

/// Angular velocity of a body, split. All vectors are in world axes.
struct Turn {
  Vec3 rest{0};     ///< Angular velocity without the spin, perpendicular to the axis; rad/s.
  Vec3 axis{0};     ///< Unit; zero where the whole angular velocity is the rest.
  double spin = 0;  ///< rad/s about the axis.
  Vec3 own{0};      ///< The same axis as it lies in the body; a hinge's axis differs by the error of its locks. Unit.
  const btRigidBody* owner = nullptr;  ///< The other part, when the axis belongs to that.
  Vec3 lever{0};  ///< From the axis to the centre of mass, m: zero unless a motor drives an unbalanced part.

  /// Rotation in a step of `h` s: R(after) = rotation · R(before).
  Quat rotation(double h) const;
  /// The axis after that step, as the present velocity of its part moves it.
  Vec3 next_axis(double h) const;
  /// Shift of the centre of mass in that step, given its velocity.
  Vec3 shift(const Vec3& velocity, double h) const;
  /// Rotation per step, in rad, by which the rest is clamped; 0: no clamp.
  double clamped(double h) const;
};

/// Splits the angular velocity `w` of a body for a step of `h` s. A spin is a rotation about
/// - the axis of a driven hinge of the body, when the centre of mass and all other pivots of the body lie on it, or
/// when
///   the body has no other joint and turns faster than the other part of that hinge;
/// - a principal axis of inertia on which all pivots of the body lie.
/// Slow rotations (kSlowTurn), and bodies without joints, have none: the latter are moved by free_motion().
Turn split_turn(const btRigidBody& body, const Vec3& w, double h);

/// True for a body without joints that turns fast enough to be moved by free_motion().
bool moves_freely(const btRigidBody& body, double h);
/// Rotates a body without joints for `h` s as Euler's equations say, in as many parts as it needs: energy and angular
/// momentum are conserved whatever the speed.
void free_motion(const Vec3& inertia, Quat& rotation, Vec3& w, double h);

/// Change of the angular velocity of a body in a step of `h` s by its own rotation, as if it had no joints; world axes.
/// A body that moves freely has its change in free_motion().
Vec3 gyroscopic_change(const btRigidBody& body, double h);
/// The gyroscopic torque on a body at an angular velocity `w`, N·m, world axes: it does no work on w.
Vec3 gyroscopic_torque(const btRigidBody& body, const Vec3& w, double h);

/// Moves a body by its velocities for `h` s. Returns the clamped rotation, rad.
double move_body(btRigidBody& body, double h);

/// The part of the angular velocity that counts as tumbling: without spin about a driven joint's axis or a principal
/// axis; world axes.
Vec3 tumbling(const btRigidBody& body, double h);

/// The largest angular velocity, rad/s, by which a body's rotation was clamped since the tick began; 0: none. Kept in
/// the body.
void begin_clamps(btRigidBody& body);
void note_clamp(btRigidBody& body, double by);
double clamped_by(const btRigidBody& body);

}  // namespace limber
