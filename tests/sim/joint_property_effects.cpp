// The effects of the properties of joints on each of the six axes, measured in the world.
#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

// A limit stops a motion towards it, the lower one from below, and follows its property.
void limit(bool linear, bool upper) {
  for (int axis = linear ? 0 : 3; axis < (linear ? 3 : 6); axis++) {
    for (const double at : {-0.4, 0.3}) {
      OneAxisFixture a(axis);
      upper ? a.limits(-0.8, at) : a.limits(at, 0.8);
      a.ticks_with_load(120, upper ? 2.0 : -2.0);
      EXPECT_NEAR(a.x(), at, 1e-3) << axis;
      EXPECT_NEAR(a.v(), 0, 1e-3) << axis;
    }
    // equal: locked there; crossed: free
    OneAxisFixture locked(axis);
    locked.limits(0.2, 0.2);
    locked.ticks_with_load(120, 2);
    EXPECT_NEAR(locked.x(), 0.2, 1e-3) << axis;
    OneAxisFixture free(axis);
    free.limits(0.5, -0.5);
    free.ticks_with_load(30, 0.3);
    EXPECT_NEAR(free.v(), 0.3 / free.inertia() * 0.5, 1e-3) << axis;
  }
}

// A lock's error decreases by the share erp in each substep.
void stop_erp(bool linear) {
  for (int axis = linear ? 0 : 3; axis < (linear ? 3 : 6); axis++) {
    for (const double erp : {0.05, 0.2, 0.6}) {
      OneAxisFixture a(axis);
      a.limits(0, 0);
      a.set_joint("stop_erp", erp);
      a.set_value(0.01);
      a.ticks(1);
      EXPECT_NEAR(a.x(), 0.01 * std::pow(1 - erp, 4), 1e-5) << axis << " " << erp;
    }
  }
}

// A loaded lock or limit yields by cfm·load.
void stop_cfm(bool linear) {
  for (int axis = linear ? 0 : 3; axis < (linear ? 3 : 6); axis++) {
    for (const double cfm : {0.0, 0.002, 0.01}) {
      OneAxisFixture lock(axis);
      lock.limits(0, 0);
      lock.set_joint("stop_cfm", cfm);
      lock.ticks_with_load(600, 5);
      EXPECT_NEAR(lock.x(), 5 * cfm, 5 * cfm * 0.01 + 1e-5) << axis << " " << cfm;
      OneAxisFixture stop(axis);
      stop.limits(-0.5, 0.1);
      stop.set_joint("stop_cfm", cfm);
      stop.ticks_with_load(600, 5);
      EXPECT_NEAR(stop.x(), 0.1 + 5 * cfm, 5 * cfm * 0.01 + 1e-3) << axis << " " << cfm;
    }
  }
}

// A torque accelerates the own axis by torque / (inertia + armature).
void armature() {
  for (const double armature : {0.0, 0.05, 3.0}) {
    OneAxisFixture a(5);
    a.set(a.joint.id(), "armature", {armature});
    a.ticks_with_load(30, 0.4);
    EXPECT_NEAR(a.v(), 0.4 / (a.inertia() + armature) * 0.5, 1e-5) << armature;
  }
}

// A box on a ball joint with a vertical axis, which a torque turns.
struct TurnedBall : WorldFixture {
  TurnedBall()
      : robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        child(part(robot, box_model({0.4, 0.6, 0.5}), 2)),
        joint(*robot.add_joint("joint", base, child, model::JointType::spherical, Vec3(0), Vec3(0, 0, 1)).value()) {}
  // Sets a limit, and returns a readout after two seconds of a torque.
  double after_torque(const char* property, double value, const Vec3& torque, const char* readout) {
    set(joint.id(), property, {value});
    for (int i = 0; i < 120; i++) {
      child.apply_torque(torque);
      world.step();
    }
    return number(joint.id(), readout);
  }
  Body& robot;
  Part& base;
  Part& child;
  Joint& joint;
};

// A torque across the axis swings the box to its cone.
void cone_limit() {
  for (const double cone : {0.2, 1.3})
    EXPECT_NEAR(TurnedBall().after_torque("cone_limit", cone, {1, 0, 0}, "swing"), cone, 1e-3);
  EXPECT_GT(TurnedBall().after_torque("cone_limit", kPi, {0.1, 0, 0}, "swing"), 1.5);
}

// A torque about the axis twists the box to its limit.
void twist(bool upper) {
  for (const double limit : {-0.4, 0.7}) {
    TurnedBall ball;
    ball.set(ball.joint.id(), upper ? "twist_lower" : "twist_upper", {upper ? -1.0 : 1.0});
    const Vec3 torque(0, 0, upper ? 1 : -1);
    EXPECT_NEAR(ball.after_torque(upper ? "twist_upper" : "twist_lower", limit, torque, "twist"), limit, 1e-3);
  }
}

// A torque about any axis turns the box up to the limit.
void rotation_limit() {
  for (const double limit : {0.5, 2.0}) {
    EXPECT_NEAR(TurnedBall().after_torque("rotation_limit", limit, {1, 0, 0}, "swing"), limit, 1e-3);
    EXPECT_NEAR(TurnedBall().after_torque("rotation_limit", limit, {0, 0, 1}, "twist"), limit, 1e-3);
  }
}

}  // namespace

void add_joint_effects(PropertyEffects& effects) {
  for (const bool linear : {true, false}) {
    const std::string side = linear ? "linear_" : "angular_";
    effects[{"Joint", side + "lower_limit"}] = [=] { limit(linear, false); };
    effects[{"Joint", side + "upper_limit"}] = [=] { limit(linear, true); };
    effects[{"Joint", side + "stop_erp"}] = [=] { stop_erp(linear); };
    effects[{"Joint", side + "stop_cfm"}] = [=] { stop_cfm(linear); };
  }
  effects[{"Joint", "armature"}] = armature;
  effects[{"Joint", "cone_limit"}] = cone_limit;
  effects[{"Joint", "twist_lower"}] = [] { twist(false); };
  effects[{"Joint", "twist_upper"}] = [] { twist(true); };
  effects[{"Joint", "rotation_limit"}] = rotation_limit;
}

}  // namespace limber::sim::test
