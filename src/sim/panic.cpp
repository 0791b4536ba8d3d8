// What acts while a panic holds.
#include "sim/panic.h"

#include <cmath>

#include "sim/body.h"
#include "sim/world.h"

namespace limber {

void Panic::begin() { turn(true); }
void Panic::end() { turn(false); }

void Panic::turn(bool on) {
  static const Row& told = World::table().at("panicked");
  if (on_ == on) return;
  on_ = on;
  settled_ = false;
  began_ = world_.tick();
  world_.store().tell(world_.id(), told)[0] = on ? 1 : 0;
  world_.bullet().wake_all();
  world_.effect_gravity();
  renew();
}

void Panic::renew() {
  for (const auto& body : world_.bodies()) {
    for (const auto& motor : body->motors()) {
      motor->hold_here();
      motor->effect_axes();
    }
  }
}

Vec3 Panic::weight(const Vec3& gravity) const {
  const double size = glm::length(gravity);
  return on_ && size > kBrake * kSink ? gravity * (kBrake * kSink / size) : gravity;
}

bool Panic::holds_motors() const {
  static const Row& motors = World::table().at("panic_motors");
  return world_.store().values(world_.id(), motors)[0] == 0;
}

AxisDrive Panic::drive(MotorMode mode) const {
  if (!on_) return static_cast<AxisDrive>(mode);
  return mode != MotorMode::off && holds_motors() ? AxisDrive::servo : AxisDrive::off;
}

void Panic::brake(double h) {
  const auto left = static_cast<btScalar>(fixed::exp(-kBrake * h));
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      btRigidBody& rigid = part->rigid();
      if (rigid.isStaticObject()) continue;
      rigid.setLinearVelocity(rigid.getLinearVelocity() * left);
      rigid.setAngularVelocity(rigid.getAngularVelocity() * left);
    }
  }
}

}  // namespace limber
