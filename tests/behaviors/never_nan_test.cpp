// Behaviors never produce NaN, at the ends of all parameter ranges, for parts that coincide, rest, move fast or are far
// away.
#include <cmath>

#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

// Two bodies of four balls each, with joints and motors, at critical positions.
struct CriticalScene : Rig {
  std::vector<Part*> parts;
  CriticalScene() {
    for (const char* name : {"one", "two"}) {
      Body& b = body(name);
      for (int i = 0; i < 4; i++) {
        Part& part = ball(b, {0.3 * i, 0, 0}, 0.001);
        if (i > 0) {
          Joint& joint = **b.add_joint("joint" + std::to_string(i), *parts.back(), part, model::JointType::spherical,
                                       part.pose().position, Vec3(0, 0, 1));
          Motor& motor = **b.add_motor(joint);
          set(motor.id(), "angular_active", {1, 1, 1});
          set(motor.id(), "angular_servo_active", {1, 0, 1});
          set(motor.id(), "angular_spring_active", {0, 1, 0});
        }
        parts.push_back(&part);
      }
    }
  }
  void place(int arrangement) {
    const Vec3 positions[] = {{0, 0, 0}, {1e6, -1e6, 1e6}, {1e-30, 0, 0}, {0, 0, 1e-3}};
    const Vec3 velocities[] = {{0, 0, 0}, {1e4, 1e4, -1e4}, {1e-300, 0, 0}, {0, 1e-5, 0}};
    for (std::size_t i = 0; i < parts.size(); i++) {
      const std::size_t k = (i * static_cast<std::size_t>(arrangement)) % 4;
      parts[i]->set_pose({positions[k], quat_identity()});
      parts[i]->set_velocity(velocities[k], velocities[(k + 1) % 4]);
    }
  }
  void expect_numbers(const std::string& label) {
    for (Part* part : parts) {
      const Vec3 f = force(*part);
      const Vec3 t = torque(*part);
      EXPECT_TRUE(is_finite(f) && is_finite(t)) << label << " force " << f.x << " " << f.y << " " << f.z;
      clear(*part);
    }
    for (const auto& b : world.bodies()) {
      for (const auto& motor : b->motors()) {
        EXPECT_TRUE(is_finite(vec(motor->id(), "angular_servo_position"))) << label;
        EXPECT_TRUE(is_finite(vec(motor->id(), "angular_spring_rest_length"))) << label;
      }
    }
  }
};

double extreme(const Property& property, int which) {
  if (property.type == PropertyType::boolean) return 1;
  switch (which) {
    case 0:
      return property.min;
    case 1:
      return property.max;
    case 2:
      return 0;
    case 3:
      return 1e-300;
    default:
      return 1;
  }
}

TEST(NeverNan, HoldsAtTheEndsOfAllRanges) {
  CriticalScene s;
  std::mt19937 generator(3);
  for (const auto& type : s.world.behaviors().types().all()) {
    Body& body = *s.world.find_body("one");
    NodeId id;
    Behavior* single = nullptr;
    BehaviorGroup* group = nullptr;
    if (type->is_group) {
      group = &s.add_group(type->name);
      id = group->id();
    } else {
      single = &s.add(body, type->name);
      id = single->id();
    }
    const PropertyTable& table = s.store.table(id);
    for (int round = 0; round < 400; round++) {
      std::string label = type->name;
      for (const Property& property : table.properties()) {
        if (property.kind != PropertyKind::setting) continue;
        std::vector<double> values;
        for (std::uint32_t i = 0; i < property.width; i++)
          values.push_back(extreme(property, static_cast<int>(generator() % 5)));
        s.set(id, property.name, values);
        label += " " + property.name + " " + std::to_string(values[0]);
      }
      s.place(static_cast<int>(generator() % 4));
      s.step_behaviors();
      s.expect_numbers(label);
    }
    if (single != nullptr) s.world.behaviors().remove(*single);
    if (group != nullptr) s.world.behaviors().remove(*group);
  }
}

}  // namespace
}  // namespace limber::sim
