// Panic: replaces gravity, motor drives and velocities while it is on.
#include "sim/world/panic.h"

#include <cmath>

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/motion/part_motion.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

void Panic::begin() { set_on(true); }
void Panic::end() { set_on(false); }

void Panic::set_on(bool on) {
  static const Property& panicked = World::table().at("panicked");
  if (state_.on == on) return;
  state_ = {.on = on, .first_second_over = false, .start_tick = world_.tick()};
  world_.store().mutable_values(world_.id(), panicked)[0] = on ? 1 : 0;
  world_.bullet().wake_all();
  apply_gravity();
  update_motors();
}

void Panic::update_motors() {
  for (const auto& body : world_.bodies()) {
    for (const auto& motor : body->motors()) {
      motor->save_held_position();
      motor->apply_axes();
    }
  }
}

void Panic::apply_gravity() {
  static const Property& property = World::table().at("gravity");
  const Vec3 gravity = vec3_at(world_.store().values(world_.id(), property));
  const double size = glm::length(gravity);
  const bool limited = state_.on && size > kDamping * kTerminalSpeed;
  world_.bullet().setGravity(bullet::to_bt(limited ? gravity * (kDamping * kTerminalSpeed / size) : gravity));
  for (const auto& body : world_.bodies()) {
    if (gravity_factor(*body) != 1) apply_gravity_factor(*body);
  }
}

bool Panic::holds_motors() const {
  static const Property& motors = World::table().at("panic_motors");
  return world_.store().values(world_.id(), motors)[0] == 0;
}

bullet::AxisDrive Panic::drive(MotorMode mode) const {
  if (!state_.on) return static_cast<bullet::AxisDrive>(mode);
  return mode != MotorMode::off && holds_motors() ? bullet::AxisDrive::servo : bullet::AxisDrive::off;
}

void Panic::damp(double h) {
  const auto factor = static_cast<btScalar>(fixed::exp(-kDamping * h));
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      btRigidBody& rigid = part->rigid();
      if (rigid.isStaticObject()) continue;
      rigid.setLinearVelocity(rigid.getLinearVelocity() * factor);
      rigid.setAngularVelocity(rigid.getAngularVelocity() * factor);
    }
  }
}

}  // namespace limber::sim
