// The effects of the properties of motors on each of the six axes, measured in the world.
#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

template <class F>
void on_axes(bool linear, F&& measure) {
  for (int axis = linear ? 0 : 3; axis < (linear ? 3 : 6); axis++) {
    OneAxisFixture a(axis);
    SCOPED_TRACE(axis);
    measure(a);
  }
}

void active(OneAxisFixture& a) {
  a.set_motor("velocity", 1);
  a.ticks(30);
  EXPECT_EQ(a.v(), 0);
  a.set_motor("active", 1);
  a.ticks(30);
  EXPECT_NEAR(a.v(), 1, 1e-4);
  a.set_motor("active", 0);
  a.apply_force(0.6);
  a.ticks(1);
  EXPECT_NEAR(a.v(), 1 + 0.6 / a.inertia() / 60, 1e-3);
}

void velocity(OneAxisFixture& a) {
  a.set_motor("active", 1);
  for (const double v : {0.7, -1.3, 0.0}) {
    a.set_motor("velocity", v);
    a.ticks(30);
    EXPECT_NEAR(a.v(), v, 1e-4);
  }
}

void max_force(OneAxisFixture& a) {
  a.set_motor("active", 1);
  a.set_motor("velocity", 100);
  for (const double force : {0.05, 0.4}) {
    const double before = a.v();
    a.set_motor("max_force", force);
    a.ticks(15);
    EXPECT_NEAR(a.v() - before, force / a.inertia() / 4, 1e-3);
    const Vec3 applied = a.vec(a.motor.id(), a.axis < 3 ? "applied_force" : "applied_torque");
    EXPECT_NEAR(applied[a.axis % 3], force, 1e-3 * force);
  }
}

void servo_active(OneAxisFixture& a) {
  a.set_motor("active", 1);
  a.set_motor("velocity", 2);
  a.set_motor("servo_position", 0.5);
  a.ticks(60);
  EXPECT_NEAR(a.v(), 2, 1e-4);  // a spin ignores the position
  a.set_value(0);
  a.set_motor("servo_active", 1);
  a.ticks(6);
  EXPECT_NEAR(a.x(), 0.2, 0.02);  // moving at its speed
  a.ticks(114);
  EXPECT_NEAR(a.x(), 0.5, 1e-4);
}

void servo_position(OneAxisFixture& a) {
  a.set_motor("active", 1);
  a.set_motor("servo_active", 1);
  for (const double target : {0.6, -1.2, 0.0}) {
    a.set_motor("servo_position", target);
    a.ticks(120);
    EXPECT_NEAR(a.x(), target, 1e-4);
    EXPECT_NEAR(a.v(), 0, 1e-3);
  }
}

// Half a period after its release, a spring is at the opposite end: pi·sqrt(inertia/stiffness).
void spring_active(OneAxisFixture& a) {
  const double k = a.inertia() * kPi * kPi;  // half a period is one second
  a.set_motor("spring_stiffness", k);
  a.set_value(0.2);
  a.ticks(60);
  EXPECT_NEAR(a.x(), 0.2, 1e-5);
  a.set_motor("spring_active", 1);
  a.ticks(60);
  EXPECT_NEAR(a.x(), -0.2, 2e-3);
  a.set_motor("active", 1);  // spring has priority over spin: no change
  a.set_motor("velocity", 5);
  a.ticks(60);
  EXPECT_NEAR(a.x(), 0.2, 4e-3);
}

void spring_rest(OneAxisFixture& a) {
  const double k = a.inertia() * 40;
  a.set_motor("spring_active", 1);
  a.set_motor("spring_stiffness", k);
  a.set_motor("spring_damping", 2 * std::sqrt(k * a.inertia()));  // critical
  for (const double rest : {0.5, -0.3}) {
    a.set_motor("spring_rest_length", rest);
    a.ticks(240);
    EXPECT_NEAR(a.x(), rest, 1e-3);
  }
}

// Static sag: load over stiffness.
void spring_stiffness(OneAxisFixture& a) {
  a.set_motor("spring_active", 1);
  for (const double per_inertia : {50.0, 200.0}) {
    const double k = a.inertia() * per_inertia;
    a.set_motor("spring_stiffness", k);
    a.set_motor("spring_damping", 2 * std::sqrt(k * a.inertia()));
    a.ticks_with_load(240, 0.1 * k);
    EXPECT_NEAR(a.x(), 0.1, 1e-3);
    const double applied =
        a.get(a.motor.id(), a.prefixed("spring_stiffness_applied"))[static_cast<std::size_t>(a.axis % 3)];
    EXPECT_NEAR(applied, k, 1e-5 * k);
  }
}

// Without stiffness, the speed decreases by the factor 1 + c·h/inertia in each substep (implicit Euler).
void spring_damping(OneAxisFixture& a) {
  a.set_motor("spring_active", 1);
  const double c = 3 * a.inertia();
  a.set_motor("spring_damping", c);
  a.set_rate(1);
  a.ticks(30);
  EXPECT_NEAR(a.v(), std::pow(1 / (1 + 3 * a.h()), 120), 1e-3);
  EXPECT_NEAR(a.get(a.motor.id(), a.prefixed("spring_damping_applied"))[static_cast<std::size_t>(a.axis % 3)], c,
              1e-5 * c);
}

// The same law as for a spring's damping, for every axis that isn't locked, in any mode.
void damping() {
  for (int axis = 0; axis < 6; axis++) {
    OneAxisFixture a(axis);
    SCOPED_TRACE(axis);
    a.set(a.motor.id(), "damping", {3 * a.inertia()});
    a.set_rate(1);
    a.ticks(30);
    EXPECT_NEAR(a.v(), std::pow(1 / (1 + 3 * a.h()), 120), 1e-3);
    // in addition to a spring's own damping
    OneAxisFixture both(axis);
    both.set_motor("spring_active", 1);
    both.set_motor("spring_damping", both.inertia());
    both.set(both.motor.id(), "damping", {2 * both.inertia()});
    both.set_rate(1);
    both.ticks(30);
    EXPECT_NEAR(both.v(), std::pow(1 / (1 + 3 * both.h()), 120), 2e-3);
    // a spin against it is limited to v = force/damping
    OneAxisFixture spin(axis);
    spin.set_motor("active", 1);
    spin.set_motor("velocity", 100);
    spin.set_motor("max_force", 6 * spin.inertia());
    spin.set(spin.motor.id(), "damping", {3 * spin.inertia()});
    spin.ticks(300);
    EXPECT_NEAR(spin.v(), 2, 0.01);
  }
}

void bounce() {
  for (int axis = 0; axis < 6; axis++) {
    for (const double e : {0.0, 0.4, 1.0}) {
      for (const double way : {1.0, -1.0}) {
        OneAxisFixture a(axis);
        a.limits(-0.1, 0.1);
        a.set(a.motor.id(), "bounce", {e});
        a.set_rate(way);
        a.ticks(9);
        EXPECT_NEAR(a.v(), -e * way, 0.02) << axis << " " << e;
      }
    }
  }
}

// The own axis of a revolute and of a prismatic joint.
struct OwnAxis : WorldFixture {
  explicit OwnAxis(model::JointType type)
      : joint(*robot.add_joint("joint", base, child, type, Vec3(0), {0, 0, 1}).value()) {}
  double x() const { return joint.value(); }
  double v() const { return number(joint.id(), "speed"); }
  Body& robot = body("robot");
  Part& base = part(robot, sphere_model(0.05), 0);
  Part& child = part(robot, box_model({0.2, 0.3, 0.4}), 1);
  Joint& joint;
  Motor& motor = *robot.add_motor(joint).value();
};

void mode() {
  for (const model::JointType type : {model::JointType::revolute, model::JointType::prismatic}) {
    OwnAxis o(type);
    EXPECT_EQ(o.number(o.motor.id(), "mode"), 2);  // created as a servo that holds
    o.set(o.motor.id(), "target", {0.4});
    o.ticks(60);
    EXPECT_NEAR(o.x(), 0.4, 1e-4);
    o.set(o.motor.id(), "speed", {3});
    o.set(o.motor.id(), "mode", {1});
    o.ticks(30);
    EXPECT_NEAR(o.v(), 3, 1e-3);
    o.set(o.motor.id(), "mode", {0});
    o.set(o.motor.id(), "speed", {-3});
    o.ticks(30);
    EXPECT_NEAR(o.v(), 3, 1e-3);  // off: it coasts
    const char* stiffness = type == model::JointType::revolute ? "angular_spring_stiffness" : "linear_spring_stiffness";
    o.set_one(o.motor.id(), stiffness, 2, 0.5);
    const double before = o.x();
    o.set(o.motor.id(), "target", {before});
    o.set(o.motor.id(), "mode", {3});
    o.ticks(1);
    EXPECT_LT(o.v(), 3);  // the spring pulls back
    for (const double m : {0., 1., 4., 2., 4., 3.}) {
      o.set(o.motor.id(), "mode", {m});
      EXPECT_EQ(o.number(o.motor.id(), "mode"), m);
    }
  }
}

void target() {
  for (const model::JointType type : {model::JointType::revolute, model::JointType::prismatic}) {
    const std::string side = type == model::JointType::revolute ? "angular_" : "linear_";
    OwnAxis o(type);
    o.set(o.motor.id(), "target", {0.7});
    EXPECT_EQ(o.get(o.motor.id(), side + "servo_position")[2], 0.7);
    EXPECT_EQ(o.get(o.motor.id(), side + "spring_rest_length")[2], 0.7);
    o.ticks(60);
    EXPECT_NEAR(o.x(), 0.7, 1e-4);
  }
}

void speed() {
  for (const model::JointType type : {model::JointType::revolute, model::JointType::prismatic}) {
    OwnAxis o(type);
    o.set(o.motor.id(), "speed", {0.5});
    o.set(o.motor.id(), "target", {2});
    o.ticks(60);
    EXPECT_NEAR(o.x(), 0.5, 0.01);  // at its maximal speed: half a radian per second
    EXPECT_NEAR(o.v(), 0.5, 1e-3);
    o.set(o.motor.id(), "mode", {1});
    o.set(o.motor.id(), "speed", {-2});
    o.ticks(30);
    EXPECT_NEAR(o.v(), -2, 1e-3);
  }
}

// A ramp of targets results in the same ramp, delayed by 1.5 times the smoothing plus three ticks.
void target_smoothing() {
  for (const model::JointType type : {model::JointType::revolute, model::JointType::prismatic}) {
    OwnAxis o(type);
    o.set(o.motor.id(), "target_smoothing", {0.1});
    for (int i = 1; i <= 120; i++) {
      o.set(o.motor.id(), "target", {0.5 * i / 60});
      o.ticks(1);
    }
    EXPECT_NEAR(o.x(), 1 - 0.5 * (0.15 + 3.0 / 60), 2e-3);
    EXPECT_NEAR(o.v(), 0.5, 2e-3);
  }
}

// A given load accelerates by load/inertia, up to the maximal force.
void given_load(OneAxisFixture& a) {
  const std::string load = a.axis < 3 ? "force" : "torque";
  a.set_motor(load, 0.3);
  a.ticks(30);
  EXPECT_EQ(a.v(), 0);  // not active
  a.set_motor(load + "_active", 1);
  a.ticks(30);
  EXPECT_NEAR(a.v(), 0.3 / a.inertia() * 0.5, 1e-4);
  const Vec3 applied = a.vec(a.motor.id(), a.axis < 3 ? "applied_force" : "applied_torque");
  EXPECT_NEAR(applied[a.axis % 3], 0.3, 1e-6);
  a.set_motor("max_force", 0.1);
  a.set_motor(load, -0.3);
  const double before = a.v();
  a.ticks(30);
  EXPECT_NEAR(a.v() - before, -0.1 / a.inertia() * 0.5, 1e-4);
}

void target_torque() {
  for (const model::JointType type : {model::JointType::revolute, model::JointType::prismatic}) {
    OwnAxis o(type);
    o.set(o.motor.id(), "mode", {4});
    o.set(o.motor.id(), "target_torque", {0.02});
    EXPECT_EQ(o.number(o.motor.id(), "target_torque"), 0.02);
    EXPECT_EQ(o.number(o.motor.id(), "mode"), 4);
    o.ticks(60);
    const double inertia = type == model::JointType::revolute ? box_inertia(1, {0.2, 0.3, 0.4}).z : 1;
    EXPECT_NEAR(o.v(), 0.02 / inertia, 1e-4);
    o.set(o.motor.id(), "mode", {2});
    EXPECT_EQ(o.number(o.motor.id(), "mode"), 2);
  }
}

// With the torque max·(1 - w/w0) the speed approaches w0 as 1 - exp(-t·max/(I·w0)), with a spin and with a torque.
void no_load_speed() {
  for (const double mode : {1.0, 4.0}) {
    OwnAxis o(model::JointType::revolute);
    o.set(o.world.id(), "substeps", {40});
    const double inertia = box_inertia(1, {0.2, 0.3, 0.4}).z;
    const double w0 = 5;
    const double max = inertia * w0 / 0.4;  // time constant 0.4 s
    o.set(o.motor.id(), "mode", {mode});
    o.set(o.motor.id(), "speed", {100});
    o.set(o.motor.id(), "target_torque", {1000});
    o.set(o.motor.id(), "max_angular_force", {0, 0, max});
    o.set(o.motor.id(), "no_load_speed", {w0});
    for (const double t : {0.5, 1.0}) {
      o.ticks(30);
      EXPECT_NEAR(o.v(), w0 * (1 - std::exp(-t / 0.4)), 2e-3 * w0) << mode << " " << t;
    }
  }
}

}  // namespace

void add_motor_effects(PropertyEffects& effects) {
  for (const bool linear : {true, false}) {
    const std::string side = linear ? "linear_" : "angular_";
    const auto add = [&](const std::string& property, void (*measure)(OneAxisFixture&)) {
      effects[{"Motor", property}] = [=] { on_axes(linear, measure); };
    };
    add(side + "active", active);
    add(side + "velocity", velocity);
    add("max_" + side + "force", max_force);
    add(side + "servo_active", servo_active);
    add(side + "servo_position", servo_position);
    add(side + "spring_active", spring_active);
    add(side + "spring_rest_length", spring_rest);
    add(side + "spring_stiffness", spring_stiffness);
    add(side + "spring_damping", spring_damping);
    add(linear ? "linear_force" : "angular_torque", given_load);
    add(linear ? "linear_force_active" : "angular_torque_active", given_load);
  }
  effects[{"Motor", "mode"}] = mode;
  effects[{"Motor", "target"}] = target;
  effects[{"Motor", "speed"}] = speed;
  effects[{"Motor", "bounce"}] = bounce;
  effects[{"Motor", "target_torque"}] = target_torque;
  effects[{"Motor", "no_load_speed"}] = no_load_speed;
  effects[{"Motor", "damping"}] = damping;
  effects[{"Motor", "target_smoothing"}] = target_smoothing;
}

}  // namespace limber::sim::test
