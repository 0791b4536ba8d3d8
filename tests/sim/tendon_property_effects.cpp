// Measures the effect of each property of tendons.
#include "sim/property_effects.h"
#include "sim/stage.h"
#include "sim/tendons/tendon_list.h"

namespace limber::sim::test {

namespace {

// A ball of 2 kg one meter above a static one, and a tendon between their centers. No gravity.
struct TetheredBall : WorldFixture {
  TetheredBall()
      : robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        ball(part(robot, sphere_model(0.1), 2, {{0, 0, 1}, quat_identity()})),
        tendon(world.tendons().add(robot, "tendon", {{&base, {}}, {&ball, {}}}).value()->id()) {
    set(tendon, "damping", {0});
  }
  // force during one tick, by the change of the ball's speed
  double pull() {
    const double before = ball.linear_velocity().z;
    ticks(1);
    return -2 * (ball.linear_velocity().z - before) * 60;
  }
  Body& robot;
  Part& base;
  Part& ball;
  NodeId tendon;
};

void measure_tendon_stiffness() {
  for (const double stiffness : {1.0, 50.0}) {
    TetheredBall t;
    t.set(t.tendon, "stiffness", {stiffness});
    t.set(t.tendon, "rest_length", {0.9});
    EXPECT_NEAR(t.pull(), 0.1 * stiffness, 0.02 * stiffness);
  }
}

void measure_tendon_damping() {
  TetheredBall t;
  t.set(t.tendon, "stiffness", {0});
  t.set(t.tendon, "damping", {3});
  t.set(t.tendon, "rest_length", {0.5});
  t.ball.set_velocity({0, 0, 0.4}, {0, 0, 0});
  EXPECT_NEAR(t.pull(), 3 * 0.4, 0.05);
  t.ball.set_velocity({0, 0, -0.4}, {0, 0, 0});
  EXPECT_NEAR(t.pull(), 0, 1e-6) << "it doesn't push";
}

void measure_tendon_rest_length() {
  TetheredBall t;
  t.set(t.tendon, "stiffness", {10});
  t.set(t.tendon, "rest_length", {0.7});
  EXPECT_NEAR(t.pull(), 3, 0.01);
  t.set(t.tendon, "rest_length", {1.2});
  EXPECT_NEAR(t.pull(), 0, 1e-6);
}

void measure_tendon_tension() {
  TetheredBall t;
  t.set(t.tendon, "rest_length", {2});
  t.set(t.tendon, "tension", {5});
  EXPECT_NEAR(t.pull(), 5, 1e-4);
  EXPECT_NEAR(t.number(t.tendon, "force"), 5, 1e-4);
}

void measure_tendon_max_tension() {
  TetheredBall t;
  t.set(t.tendon, "tension", {5});
  t.set(t.tendon, "rest_length", {0.5});
  t.set(t.tendon, "max_tension", {8});
  EXPECT_NEAR(t.pull(), 8, 1e-4);
  t.set(t.tendon, "max_tension", {2});
  EXPECT_NEAR(t.pull(), 2, 1e-4);
}

void measure_tendon_pushes() {
  TetheredBall t;
  t.set(t.tendon, "stiffness", {10});
  t.set(t.tendon, "rest_length", {1.2});
  EXPECT_NEAR(t.pull(), 0, 1e-6);
  t.set(t.tendon, "pushes", {1});
  EXPECT_NEAR(t.pull(), -2, 0.02);
}

void measure_tendon_enabled() {
  TetheredBall t;
  t.set(t.tendon, "tension", {5});
  t.set(t.tendon, "enabled", {0});
  EXPECT_EQ(t.pull(), 0);
  t.set(t.tendon, "enabled", {1});
  EXPECT_NEAR(t.pull(), 5, 0.1);
}

// A drawn size; the view's own tests measure it.
void measure_tendon_radius() {
  TetheredBall t;
  t.set(t.tendon, "radius", {0.5});
  EXPECT_EQ(t.pull(), 0);
}

}  // namespace

void add_tendon_effects(PropertyEffects& effects) {
  effects[{"Tendon", "stiffness"}] = measure_tendon_stiffness;
  effects[{"Tendon", "damping"}] = measure_tendon_damping;
  effects[{"Tendon", "rest_length"}] = measure_tendon_rest_length;
  effects[{"Tendon", "tension"}] = measure_tendon_tension;
  effects[{"Tendon", "max_tension"}] = measure_tendon_max_tension;
  effects[{"Tendon", "pushes"}] = measure_tendon_pushes;
  effects[{"Tendon", "enabled"}] = measure_tendon_enabled;
  effects[{"Tendon", "radius"}] = measure_tendon_radius;
}

}  // namespace limber::sim::test
