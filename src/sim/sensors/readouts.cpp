// Readouts of contacts, joint reactions, momentum and energy, calculated when they are read.
#include "sim/sensors/readouts.h"

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

/// Impulses on a part in the last tick.
struct ContactSum {
  int count = 0;         // points in use
  double normal = 0;     // sum of the sizes of the normal impulses, N·s
  Vec3 normal_sum{0};    // N·s
  Vec3 friction_sum{0};  // N·s
  double seconds = 1;
};

ContactSum contacts_of(const Part& part) {
  const ContactPoints& points = part.body().world().sensing().contacts().points();
  ContactSum sum;
  sum.seconds = points.seconds();
  for (const PartContact& contact : points.of(part.id())) {
    const ContactPoint& point = points.list()[contact.point];
    const double sign = point.a == part.id() ? 1 : -1;
    if (point.in_use != 0) sum.count++;
    sum.normal += point.impulse;
    sum.normal_sum += sign * point.impulse * point.normal;
    sum.friction_sum += sign * point.friction;
  }
  return sum;
}

MotionSum motion_of(const Body& body) {
  MotionSum motion;
  for (const auto& part : body.parts()) motion.add(*part);
  return motion;
}

MotionSum motion_of(const World& world) {
  MotionSum motion;
  for (const auto& body : world.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) motion.add(*part);
  }
  return motion;
}

}  // namespace

void read_contact_count(const Part& part, double* out) { out[0] = contacts_of(part).count; }

void read_contact_normal_force(const Part& part, double* out) {
  const ContactSum sum = contacts_of(part);
  out[0] = sum.normal / sum.seconds;
}

void read_contact_friction_force(const Part& part, double* out) {
  const ContactSum sum = contacts_of(part);
  out[0] = glm::length(sum.friction_sum) / sum.seconds;
}

void read_contact_force(const Part& part, double* out) {
  const ContactSum sum = contacts_of(part);
  put(out, (sum.normal_sum + sum.friction_sum) / sum.seconds);
}

void read_reaction_force(const Joint& joint, double* out) {
  put(out, joint.in_world() ? joint.constraint().reaction().force() : Vec3(0));
}

void read_reaction_torque(const Joint& joint, double* out) {
  put(out, joint.in_world() ? joint.constraint().reaction().torque() : Vec3(0));
}

void MotionSum::add(const Part& part) {
  if (part.is_static()) return;
  const btRigidBody& rigid = part.rigid();
  const double m = 1 / static_cast<double>(rigid.getInvMass());
  const Vec3 center = bullet::from_bt(rigid.getCenterOfMassPosition());
  const Vec3 velocity = bullet::from_bt(rigid.getLinearVelocity());
  const btMatrix3x3& axes = rigid.getCenterOfMassTransform().getBasis();
  const Vec3 spin = bullet::from_bt(rigid.getAngularVelocity() * axes);  // along the principal axes
  const Vec3 own_angular = part.geometry()->unit_inertia * m * spin;
  const Vec3 gravity =
      bullet::from_bt(rigid.isInWorld() ? rigid.getGravity() : part.body().world().bullet().getGravity());
  mass += m;
  moment += m * center;
  momentum += m * velocity;
  angular += glm::cross(center, m * velocity) + bullet::from_bt(axes * bullet::to_bt(own_angular));
  kinetic += 0.5 * (m * glm::dot(velocity, velocity) + glm::dot(spin, own_angular));
  potential -= m * glm::dot(gravity, center);
}

void read_body_mass(const Body& body, double* out) { out[0] = motion_of(body).mass; }
void read_center_of_mass(const Body& body, double* out) { put(out, motion_of(body).center()); }
void read_body_momentum(const Body& body, double* out) { put(out, motion_of(body).momentum); }
void read_body_angular_momentum(const Body& body, double* out) {
  const MotionSum motion = motion_of(body);
  put(out, motion.angular - glm::cross(motion.center(), motion.momentum));
}
void read_body_kinetic_energy(const Body& body, double* out) { out[0] = motion_of(body).kinetic; }
void read_body_potential_energy(const Body& body, double* out) { out[0] = motion_of(body).potential; }

void read_world_momentum(const World& world, double* out) { put(out, motion_of(world).momentum); }
void read_world_angular_momentum(const World& world, double* out) { put(out, motion_of(world).angular); }
void read_world_kinetic_energy(const World& world, double* out) { out[0] = motion_of(world).kinetic; }
void read_world_potential_energy(const World& world, double* out) { out[0] = motion_of(world).potential; }

}  // namespace limber::sim
