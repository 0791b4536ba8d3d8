// Arm: a chain of boxes on a fixed base, with a servo at each joint and joint axes alternating between x and y.
#pragma once

#include <string>

#include "sim/bullet/bullet.h"
#include "sim/stage.h"

namespace limber::sim::test {

struct ArmSpec {
  int links = 5;
  Vec3 base{0, 0, 0};
  bool fixed = true;     ///< false: the base has mass 1 and floats.
  double mirror = 1;     ///< -1: mirrored at the plane y = 0.
  double side_step = 0;  ///< offset (y) of each link from the previous one
};

/// Links `link0` (the base) to `linkN`, joints `joint1` to `jointN`.
inline Body& make_arm(WorldFixture& s, const std::string& name, const ArmSpec& spec = {}) {
  Body& arm = s.body(name);
  const auto shape = [&](const std::string& key, const Vec3& size) -> Shape& {
    Shape* existing = s.world.shapes().find(key);
    return existing != nullptr ? *existing : *s.world.shapes().add(key, box_model(size)).value();
  };
  Shape& box = shape("arm link", {0.1, 0.08, 0.2});
  Part* below =
      arm.add_part("link0", shape("arm base", {0.2, 0.2, 0.1}), spec.fixed ? 0 : 1, {spec.base, quat_identity()})
          .value();
  for (int i = 1; i <= spec.links; i++) {
    const Vec3 at = spec.base + Vec3(0, spec.mirror * spec.side_step * i, 0.25 * i);
    Part* link = arm.add_part("link" + std::to_string(i), box, 0.5, {at, quat_identity()}).value();
    // an axis is a pseudovector: the mirror image at y = 0 keeps y and negates x and z
    const Vec3 axis = i % 2 == 0 ? normalized({1, 0.2, 0}) : Vec3(0, 1, 0);
    const Vec3 mirrored(spec.mirror * axis.x, axis.y, spec.mirror * axis.z);
    Joint* joint = arm.add_joint("joint" + std::to_string(i), *below, *link, model::JointType::revolute,
                                 at - Vec3(0, 0, 0.125), mirrored)
                       .value();
    (void)arm.add_motor(*joint).value();
    below = link;
  }
  return arm;
}

/// Sets all servos to a wave of half a radian.
inline void set_wave_targets(WorldFixture& s, Body& arm, double time) {
  int i = 0;
  for (const auto& motor : arm.motors()) s.set(motor->id(), "target", {0.5 * std::sin(3 * time + 0.7 * i++)});
}

/// Poses and velocities of a body's parts in Bullet, for bitwise comparison.
inline std::vector<float> motion_values(const Body& body) {
  std::vector<float> out;
  for (const auto& part : body.parts()) {
    const btRigidBody& r = part->rigid();
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++) out.push_back(r.getWorldTransform().getBasis()[i][k]);
      out.push_back(r.getWorldTransform().getOrigin()[i]);
      out.push_back(r.getLinearVelocity()[i]);
      out.push_back(r.getAngularVelocity()[i]);
    }
  }
  return out;
}

}  // namespace limber::sim::test
