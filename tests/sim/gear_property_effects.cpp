// Measures the effect of each property of gears.
#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

constexpr double kGearMass = 2;
constexpr Vec3 kGearSize{0.4, 0.6, 0.5};

// Two equal boxes on hinges, a with a servo, b without a motor, and a gear between them.
struct GearedBoxes : WorldFixture {
  GearedBoxes() : robot(body("robot")), base(part(robot, sphere_model(0.05), 0)), a(hinge("a", -1)), b(hinge("b", 1)) {
    set(b.motor()->id(), "mode", {0});
    gear = world.gears().add("gear", a, b, 1).value();
  }
  Joint& hinge(const std::string& name, double x) {
    const Vec3 at(x, 0, 0);
    Part& box = part(robot, box_model(kGearSize), kGearMass, {at, quat_identity()});
    Joint& joint = *robot.add_joint(name, base, box, model::JointType::revolute, at, {0, 0, 1}).value();
    (void)robot.add_motor(joint).value();
    return joint;
  }
  void ticks_with_torque(int n, double torque) {
    for (int i = 0; i < n; i++) {
      b.child().apply_torque({0, 0, torque});
      world.step();
    }
  }
  Body& robot;
  Part& base;
  Joint& a;
  Joint& b;
  Gear* gear = nullptr;
};

void measure_gear_ratio() {
  for (const double ratio : {0.5, -2.0}) {
    GearedBoxes g;
    g.set(g.gear->id(), "ratio", {ratio});
    g.set(g.a.motor()->id(), "target", {0.3});
    g.ticks(60);
    EXPECT_NEAR(g.b.value(), 0.3 * ratio, 1e-3);
  }
}

void measure_gear_offset() {
  GearedBoxes g;
  g.set(g.gear->id(), "offset", {0.25});
  g.ticks(60);
  EXPECT_NEAR(g.b.value(), 0.25, 1e-3);
}

void measure_gear_enabled() {
  GearedBoxes g;
  g.set(g.gear->id(), "enabled", {0});
  g.ticks_with_torque(30, 0.3);
  EXPECT_NEAR(g.number(g.b.id(), "speed"), 0.3 * 0.5 / box_inertia(kGearMass, kGearSize).z, 1e-3);
  g.set(g.gear->id(), "enabled", {1});
  g.ticks(60);
  EXPECT_NEAR(g.b.value(), g.a.value(), 1e-4);
}

// Beyond the limit the remaining load accelerates b.
void measure_gear_max_force() {
  GearedBoxes g;
  g.set(g.gear->id(), "max_force", {0.2});
  g.ticks_with_torque(30, 0.5);
  EXPECT_NEAR(g.number(g.b.id(), "speed"), (0.5 - 0.2) * 0.5 / box_inertia(kGearMass, kGearSize).z, 1e-3);
  EXPECT_NEAR(g.number(g.gear->id(), "force"), -0.2, 1e-6);
  EXPECT_NEAR(g.number(g.gear->id(), "error"), -g.b.value(), 1e-3);
}

}  // namespace

void add_gear_effects(PropertyEffects& effects) {
  effects[{"Gear", "ratio"}] = measure_gear_ratio;
  effects[{"Gear", "offset"}] = measure_gear_offset;
  effects[{"Gear", "enabled"}] = measure_gear_enabled;
  effects[{"Gear", "max_force"}] = measure_gear_max_force;
}

}  // namespace limber::sim::test
