// The motion of a part.
#include "sim/motion/part_motion.h"

#include <fmt/format.h>

#include "sim/bullet/island_world.h"
#include "sim/bullet/surface_motion.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {
namespace {

// The velocity moves the part from the next tick on.
void apply_static_velocity(Part& part) {
  const bool moves = part.linear_velocity() != Vec3(0) || part.angular_velocity() != Vec3(0);
  if (is_plane(part)) {
    if (moves) part.body().warnings().warn_static_velocity(fmt::format("part '{}' is a plane and", part.name()));
    return;
  }
  Kinematics& kinematics = part.body().world().kinematics();
  if (part.motion() == PartMotion::fixed && !kinematics.static_parts_move()) return;
  part.kinematic().linear = part.linear_velocity();
  part.kinematic().angular = part.angular_velocity();
  if (moves || bullet::is_moving_static(part.rigid())) kinematics.add(part);
}

void set_bullet_velocity(Part& part, const Vec3& linear, const Vec3& angular) {
  part.rigid().setLinearVelocity(bullet::to_bt(linear));
  part.rigid().setAngularVelocity(bullet::to_bt(angular));
}

}  // namespace

bool is_plane(const Part& part) { return part.geometry()->shape->getShapeType() == STATIC_PLANE_PROXYTYPE; }

Result<void> validate_motion(const Part& part, const double* in) {
  const auto motion = static_cast<PartMotion>(static_cast<int>(in[0]));
  if (is_plane(part) && motion != PartMotion::fixed) return Error{"a plane is static"};
  if (part.mass() == 0 && motion == PartMotion::dynamic)
    return Error{"the part was created with mass 0; create it with a mass instead"};
  return {};
}

void apply_part_motion(Part& part) {
  static const Property& property = Part::table().at("motion");
  static const Property& restitution = Part::table().at("restitution");
  const auto motion = static_cast<PartMotion>(static_cast<int>(part.body().store().values(part.id(), property)[0]));
  btRigidBody& rigid = part.rigid();
  part.kinematic().motion = motion;
  // compared with Bullet's flag, since the rollback of a guarded call restores the other fields
  if (rigid.isStaticObject() == part.is_static()) return;
  Kinematics& kinematics = part.body().world().kinematics();
  kinematics.remove(part);
  const bool in_world = rigid.isInWorld();
  part.remove_from_world();
  rigid.clearForces();
  part.kinematic() = {.motion = motion};
  if (part.is_static()) {
    rigid.setMassProps(0, btVector3(0, 0, 0));
    rigid.updateInertiaTensor();
    set_bullet_velocity(part, Vec3(0), Vec3(0));
  } else {
    apply_part_mass(part);
    set_bullet_velocity(part, part.linear_velocity(), part.angular_velocity());
  }
  // contacts of static parts are predicted even if they bounce
  part.body().store().mark_dirty(part.id(), restitution);
  if (in_world) part.add_to_world();
  for (const auto& joint : part.body().joints()) {
    if (&joint->parent() == &part || &joint->child() == &part) joint->wake();
  }
  kinematics.count_motion_change();
}

void apply_part_mass(Part& part) {
  if (part.is_static()) return;
  btRigidBody& rigid = part.rigid();
  const btScalar before = rigid.getInvMass();
  rigid.setMassProps(static_cast<btScalar>(part.mass()), bullet::to_bt(part.geometry()->unit_inertia * part.mass()));
  rigid.updateInertiaTensor();
  // Bullet stores gravity as a force, which was computed with the old mass
  apply_part_gravity(part);
  if (rigid.getInvMass() != before) part.wake();
}

void apply_part_pose(Part& part) {
  Kinematics& kinematics = part.body().world().kinematics();
  KinematicState& state = part.kinematic();
  if (kinematics.moves_to_pose(part)) {
    state.has_target = true;
    return kinematics.add(part);
  }
  state.teleports = false;
  if (part.is_static()) state.pose_tick = part.body().world().tick() + 1;
  place_part(part);
}

void place_part(Part& part) {
  btRigidBody& rigid = part.rigid();
  const btTransform t = bullet::to_bt(part.pose() * part.geometry()->frame);
  if (!part.is_static() || !(t == rigid.getWorldTransform())) part.wake();
  rigid.setWorldTransform(t);
  rigid.setInterpolationWorldTransform(t);
  rigid.updateInertiaTensor();
  part.body().mark_joints_dirty();
}

void teleport_part(Part& part, const Pose& pose) {
  save_kinematic_state(part);
  part.kinematic().teleports = true;
  part.set_pose(pose);
}

void save_kinematic_state(Part& part) { part.body().world().transaction().save_fields(part.kinematic()); }

void apply_part_velocity(Part& part) {
  if (part.is_static()) return apply_static_velocity(part);
  const bool changes = bullet::to_bt(part.linear_velocity()) != part.rigid().getLinearVelocity() ||
                       bullet::to_bt(part.angular_velocity()) != part.rigid().getAngularVelocity();
  if (changes) part.wake();
  set_bullet_velocity(part, part.linear_velocity(), part.angular_velocity());
}

void apply_part_gravity(Part& part) {
  btRigidBody& rigid = part.rigid();
  const double factor = gravity_factor(part.body());
  const btVector3 world_gravity = part.body().world().bullet().getGravity();
  const int flags = rigid.getFlags() & ~BT_DISABLE_WORLD_GRAVITY;
  // Bullet sets the gravity of all other bodies whenever it changes
  rigid.setFlags(factor == 1 ? flags : flags | BT_DISABLE_WORLD_GRAVITY);
  rigid.setGravity(factor == 1 ? world_gravity : world_gravity * static_cast<btScalar>(factor));
}

double gravity_factor(const Body& body) {
  static const Property& property = Body::table().at("gravity_factor");
  return body.store().values(body.id(), property)[0];
}

void apply_gravity_factor(Body& body) {
  for (const auto& part : body.parts()) {
    const btVector3 before = part->rigid().getGravity();
    apply_part_gravity(*part);
    if (part->rigid().getGravity() != before) part->wake();
  }
}

// All of it is in Bullet's memory, so that a rewind restores it.
void apply_surface_velocity(Part& part) {
  static const Property& property = Part::table().at("surface_velocity");
  const Vec3 in_link = vec3_at(part.body().store().values(part.id(), property));
  const btVector3 local = bullet::to_bt(glm::inverse(part.geometry()->frame.rotation) * in_link);
  const bullet::SurfaceVelocity* const before = bullet::surface_velocity(part.rigid());
  if (before == nullptr ? in_link == Vec3(0) : before->local == local) return;
  const bullet::BulletMemory::Scope scope(&part.body().world().bullet_memory());
  delete before;
  part.rigid().internalSetExtensionPointer(in_link == Vec3(0) ? nullptr : new bullet::SurfaceVelocity{local});
  part.wake();
}

}  // namespace limber::sim
