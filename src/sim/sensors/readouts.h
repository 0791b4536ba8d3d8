// Readouts of forces and motion: getters of properties of parts, joints, bodies and the world. [sim]
#pragma once

#include "base/vec.h"

namespace limber::sim {

class Body;
class Joint;
class Part;
class World;

// Of a part that reports contacts, in the last tick: number of its contact points; mean normal force (sum of the
// points' sizes), mean friction force (size of the sum), and the mean force of both on the part, world; N.
void read_contact_count(const Part& part, double* out);
void read_contact_normal_force(const Part& part, double* out);
void read_contact_friction_force(const Part& part, double* out);
void read_contact_force(const Part& part, double* out);

// Mean force and torque that the joint's parent exerted on the child in the last tick, at the joint's point on the
// child, along the axes of the joint's frame on the parent: N, N·m.
void read_reaction_force(const Joint& joint, double* out);
void read_reaction_torque(const Joint& joint, double* out);

/// Mass, momentum and energy of parts that can move, in the state that Bullet has: that of the last tick.
struct MotionSum {
  double mass = 0;       ///< kg
  Vec3 moment{0};        ///< Sum of mass · center, kg·m.
  Vec3 momentum{0};      ///< kg·m/s
  Vec3 angular{0};       ///< Angular momentum about the world's origin, kg·m²/s.
  double kinetic = 0;    ///< J
  double potential = 0;  ///< In the gravity field, 0 at the world's origin, J.

  void add(const Part& part);
  Vec3 center() const { return mass > 0 ? moment / mass : Vec3(0); }
};

// Of the movable parts of a body. The angular momentum is that about their center of mass.
void read_body_mass(const Body& body, double* out);
void read_center_of_mass(const Body& body, double* out);
void read_body_momentum(const Body& body, double* out);
void read_body_angular_momentum(const Body& body, double* out);
void read_body_kinetic_energy(const Body& body, double* out);
void read_body_potential_energy(const Body& body, double* out);

// Of all movable parts of the enabled bodies. The angular momentum is that about the world's origin.
void read_world_momentum(const World& world, double* out);
void read_world_angular_momentum(const World& world, double* out);
void read_world_kinetic_energy(const World& world, double* out);
void read_world_potential_energy(const World& world, double* out);

}  // namespace limber::sim
