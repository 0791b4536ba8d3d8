// The effects of the properties of parts, measured in the world.
#include <functional>

#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

constexpr double kG = 9.81;

void mass() {
  const Vec3 size(0.2, 0.4, 0.6);
  for (const double m : {0.5, 1.0, 20.0}) {
    WorldFixture s;
    Part& part = s.add_single_part(box_model(size), 1);
    s.set(part.id(), "mass", {m});
    for (int i = 0; i < 30; i++) {
      part.apply_force({3, 0, 0});
      part.apply_torque({0, 0.01, 0});
      s.ticks(1);
    }
    EXPECT_NEAR(part.linear_velocity().x, 3 / m * 0.5, 1e-5) << m;
    // the inertia scales with it
    EXPECT_NEAR(part.angular_velocity().y, 0.01 / box_inertia(m, size).y * 0.5, 1e-5) << m;
  }
}

void linear_damping() {
  for (const double d : {0.0, 0.3, 0.9}) {
    WorldFixture s;
    Part& part = s.add_single_part(sphere_model(0.1), 1);
    s.set(part.id(), "linear_damping", {d});
    s.set(part.id(), "linear_velocity", {4, 0, 0});
    s.ticks(120);
    EXPECT_NEAR(part.linear_velocity().x, 4 * std::pow(1 - d, 2), 2e-4) << d;
  }
}

void angular_damping() {
  for (const double d : {0.0, 0.3, 0.9}) {
    WorldFixture s;
    Part& part = s.add_single_part(sphere_model(0.1), 1);
    s.set(part.id(), "angular_damping", {d});
    s.set(part.id(), "angular_velocity", {0, 4, 0});
    s.ticks(120);
    EXPECT_NEAR(part.angular_velocity().y, 4 * std::pow(1 - d, 2), 2e-4) << d;
  }
}

// A flat box on a floor with tilted gravity: it slides with g·(sin - mu·cos), or not at all.
void friction() {
  const double slope = 0.4;
  for (const double mu : {0.0, 0.1, 0.3, 0.41, 0.44, 2.0}) {
    WorldFixture s;
    s.floor();
    Part& box = s.add_single_part(box_model({0.4, 0.4, 0.1}), 1, {{0, 0, 0.05}, quat_identity()});
    s.set(box.id(), "friction", {mu});
    s.gravity({kG * std::sin(slope), 0, -kG * std::cos(slope)});
    s.ticks(30);
    const double before = box.linear_velocity().x;
    s.ticks(60);
    const double expected = std::max(0.0, kG * (std::sin(slope) - mu * std::cos(slope)));  // tan 0.4 = 0.4228
    // within 3 % of the friction: the box's four contact points alternate
    EXPECT_NEAR(box.linear_velocity().x - before, expected, 0.03 * mu * kG * std::cos(slope) + 1e-3) << mu;
  }
}

// A rolling ball: the torque mu·m·g against it and I = 2/5·m·r² decelerate it by mu·g/(1.4·r).
void rolling_friction() {
  const double r = 0.2;
  for (const double mu : {0.0, 0.005, 0.02}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -kG});
    Part& ball = s.add_single_part(sphere_model(r), 1, {{0, 0, r}, quat_identity()});
    s.set(ball.id(), "rolling_friction", {mu});
    s.set(ball.id(), "linear_velocity", {2, 0, 0});
    s.set(ball.id(), "angular_velocity", {0, 2 / r, 0});
    s.ticks(30);
    const double before = ball.linear_velocity().x;
    s.ticks(60);
    EXPECT_NEAR(before - ball.linear_velocity().x, mu * kG / (1.4 * r), 0.01) << mu;
  }
}

// A ball that spins in place: torque mu·m·g against I = 2/5·m·r².
void spinning_friction() {
  const double r = 0.2;
  for (const double mu : {0.0, 0.005, 0.01}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -kG});
    Part& ball = s.add_single_part(sphere_model(r), 1, {{0, 0, r}, quat_identity()});
    s.set(ball.id(), "friction", {1});
    s.set(ball.id(), "spinning_friction", {mu});
    s.set(ball.id(), "angular_velocity", {0, 0, 20});
    s.ticks(60);
    EXPECT_NEAR(ball.angular_velocity().z, 20 - mu * kG / (0.4 * r * r), 0.1) << mu;
  }
}

// Friction of a box sliding along x, with the friction in this direction scaled by the factor.
double speed_lost(const Vec3& direction, double factor) {
  WorldFixture s;
  s.floor();
  s.gravity({0, 0, -kG});
  Part& box = s.add_single_part(box_model({0.4, 0.4, 0.1}), 1, {{0, 0, 0.05}, quat_identity()});
  s.set(box.id(), "friction", {0.4});
  s.set(box.id(), "friction_direction", {direction.x, direction.y, direction.z});
  s.set(box.id(), "friction_factor", {factor});
  s.set(box.id(), "linear_velocity", {6, 0, 0});
  s.ticks(30);
  return 6 - box.linear_velocity().x;
}

void friction_direction() {
  EXPECT_NEAR(speed_lost({0, 0, 0}, 0.25), 0.2 * kG, 0.02);
  EXPECT_NEAR(speed_lost({1, 0, 0}, 0.25), 0.05 * kG, 0.02);
  EXPECT_NEAR(speed_lost({0, 1, 0}, 0.25), 0.2 * kG, 0.02);
  EXPECT_NEAR(speed_lost({0, 0, 1}, 0.25), 0.2 * kG, 0.02);
}

void friction_factor() {
  for (const double factor : {0.0, 0.5, 1.0, 2.0}) {
    EXPECT_NEAR(speed_lost({0.5, 0, 0}, factor), 0.2 * factor * kG, 0.02) << factor;
  }
}

double height_after_bounce(double restitution, double drop) {
  WorldFixture s;
  s.floor();
  s.substeps(16);
  s.gravity({0, 0, -kG});
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.1 + drop}, quat_identity()});
  s.set(ball.id(), "restitution", {restitution});
  double highest = 0;
  bool rising = false;
  for (int i = 0; i < 150; i++) {
    s.ticks(1);
    if (!rising && ball.linear_velocity().z > 0) rising = true;
    if (rising) highest = std::max(highest, ball.pose().position.z - 0.1);
    if (rising && ball.linear_velocity().z < 0) break;
  }
  return highest;
}

void restitution() {
  for (const double e : {0.3, 0.5, 0.8}) EXPECT_NEAR(height_after_bounce(e, 2), e * e * 2, 0.03 * e * e * 2) << e;
  EXPECT_LT(height_after_bounce(0, 2), 0.002);
}

void report_contacts() {
  for (const bool on : {false, true}) {
    WorldFixture s;
    s.floor();
    s.gravity({0, 0, -kG});
    Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.3}, quat_identity()});
    s.set(ball.id(), "report_contacts", {on ? 1. : 0.});
    std::size_t events = 0;
    for (int i = 0; i < 60; i++) {
      s.ticks(1);
      events += s.world.sensing().contacts().events().size();
    }
    EXPECT_EQ(events, on ? 1u : 0u);
  }
}

void position() {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.1), 1);
  s.set(part.id(), "linear_velocity", {1, 0, 0});
  s.ticks(6);
  s.set(part.id(), "position", {5, -6, 7});
  s.ticks(6);
  EXPECT_NEAR(part.pose().position.x, 5.1, 1e-5);
  EXPECT_NEAR(part.pose().position.y, -6, 1e-5);
  EXPECT_NEAR(part.pose().position.z, 7, 1e-5);
}

// A rotated box responds to a torque about a world axis with the inertia about that axis.
void rotation() {
  const Vec3 size(0.1, 0.4, 0.8);
  WorldFixture s;
  Part& part = s.add_single_part(box_model(size), 2);
  const double half = std::sqrt(0.5);
  s.set(part.id(), "rotation", {0, half, 0, half});  // +90 degrees about y: the box's x points to -z
  part.apply_torque({0, 0, 0.06});
  s.ticks(1);
  EXPECT_NEAR(part.angular_velocity().z, 0.06 / box_inertia(2, size).x / 60, 1e-6);
  EXPECT_NEAR(part.pose().rotation.y, half, 1e-3);
}

void linear_velocity() {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.1), 1);
  s.set(part.id(), "linear_velocity", {1, -2, 3});
  s.ticks(60);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(part.pose().position[i], Vec3(1, -2, 3)[i], 1e-5);
}

void angular_velocity() {
  for (int axis = 0; axis < 3; axis++) {
    WorldFixture s;
    Part& part = s.add_single_part(box_model(Vec3(0.2)), 1);
    Vec3 omega(0);
    omega[axis] = 0.8;
    s.set(part.id(), "angular_velocity", {omega.x, omega.y, omega.z});
    s.ticks(60);
    const Quat expected = quat_axis(omega / 0.8, 0.8);
    for (const Vec3& v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      EXPECT_LT(glm::length(part.pose().rotation * v - expected * v), 1e-4) << axis;
    }
  }
}

// Drops a ball on another ball. Returns true if they don't collide, as set up by `prepare`.
bool falls_through(bool one_body, const std::function<void(WorldFixture&, Part& ball, Part& below)>& prepare) {
  WorldFixture s;
  s.gravity({0, 0, -10});
  Body& body = s.body("two");
  Part& below = s.part(body, sphere_model(0.1), 0);
  Part& ball = one_body ? s.part(body, sphere_model(0.1), 1, {{0, 0, 0.3}, quat_identity()})
                        : s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.3}, quat_identity()});
  prepare(s, ball, below);
  s.ticks(30);
  // half a second: 1.25 m of free fall
  if (ball.pose().position.z > 0) return false;
  EXPECT_NEAR(ball.pose().position.z, 0.3 - 1.25, 0.02);
  return true;
}

void part_self_collision() {
  const auto none = [](WorldFixture& s, Part& ball, Part&) { s.set(ball.id(), "self_collision", {0}); };
  EXPECT_TRUE(falls_through(true, none));
  EXPECT_FALSE(falls_through(false, none));
  EXPECT_TRUE(
      falls_through(true, [](WorldFixture& s, Part&, Part& below) { s.set(below.id(), "self_collision", {0}); }));
  EXPECT_FALSE(falls_through(true, [](WorldFixture&, Part&, Part&) {}));
}

void collision_group() {
  EXPECT_TRUE(falls_through(false, [](WorldFixture& s, Part& ball, Part& below) {
    s.set(ball.id(), "collision_group", {4});
    s.set(below.id(), "collision_mask", {1 + 2 + 8});
  }));
  EXPECT_FALSE(falls_through(false, [](WorldFixture& s, Part& ball, Part& below) {
    s.set(ball.id(), "collision_group", {4});
    s.set(below.id(), "collision_mask", {4});
  }));
}

// A change while the ball rests on the other one takes effect in the next step.
void collision_mask() {
  EXPECT_TRUE(
      falls_through(false, [](WorldFixture& s, Part& ball, Part&) { s.set(ball.id(), "collision_mask", {0}); }));
  WorldFixture s;
  s.gravity({0, 0, -10});
  s.floor();
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.1}, quat_identity()});
  s.ticks(20);
  EXPECT_NEAR(ball.pose().position.z, 0.1, 0.002);
  const double rest = ball.pose().position.z;
  s.set(ball.id(), "collision_mask", {65534});
  s.ticks(6);
  EXPECT_NEAR(ball.pose().position.z, rest - 10.0 / 240 / 240 * 24 * 25 / 2, 1e-5);
}

// Static: it stays. Kinematic: it moves at the velocity that is set, whatever pushes it. Dynamic: it falls.
void motion() {
  WorldFixture s;
  s.gravity({0, 0, -kG});
  Part& part = s.add_single_part(sphere_model(0.1), 1);
  s.set(part.id(), "motion", {2});
  s.ticks(30);
  EXPECT_EQ(part.pose().position.z, 0);
  s.set(part.id(), "motion", {1});
  s.set(part.id(), "linear_velocity", {0, 0, 2});
  part.apply_force({0, 0, 1000});
  s.ticks(30);
  EXPECT_NEAR(part.pose().position.z, 1, 1e-5);
  s.set(part.id(), "motion", {0});
  s.ticks(60);
  EXPECT_NEAR(part.linear_velocity().z, 2 - kG, 1e-4);
}

// Friction accelerates a box on a belt until it has the belt's velocity.
void surface_velocity() {
  WorldFixture s;
  s.gravity({0, 0, -kG});
  Part& belt = s.add_single_part(box_model({20, 20, 0.2}), 0, {{0, 0, -0.1}, quat_identity()});
  Part& box = s.add_single_part(box_model({0.4, 0.4, 0.1}), 1, {{0, 0, 0.05}, quat_identity()});
  for (const Vec3 v : {Vec3(0.5, 0, 0), Vec3(0, -0.3, 0), Vec3(0)}) {
    s.set(belt.id(), "surface_velocity", {v.x, v.y, v.z});
    s.ticks(120);
    EXPECT_NEAR(glm::length(box.linear_velocity() - v), 0, 1e-3);
  }
}

// A property of the picture alone: two equal scenes move alike, whatever its value.
void check_no_motion(const char* property, const std::vector<double>& value) {
  WorldFixture plain, changed;
  std::array<Part*, 2> balls{};
  for (std::size_t i = 0; i < 2; i++) {
    WorldFixture& s = i == 0 ? plain : changed;
    s.gravity({0, 0, -10});
    s.floor();
    balls[i] = &s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.5}, quat_identity()});
    balls[i]->set_velocity({1, 0, 0}, {0, 2, 0});
  }
  changed.set(balls[1]->id(), property, value);
  plain.ticks(60);
  changed.ticks(60);
  EXPECT_EQ(balls[0]->pose().position, balls[1]->pose().position);
  EXPECT_EQ(balls[0]->pose().rotation, balls[1]->pose().rotation);
  const double* const read = changed.store.values(balls[1]->id(), Part::table().at(property));
  for (std::size_t i = 0; i < value.size(); i++) EXPECT_EQ(read[i], value[i]);
}

// their effect on the picture is measured in tests/render
void tint() { check_no_motion("tint", {0.25, 0.5, 0.75}); }
void transparency() { check_no_motion("transparency", {0.5}); }

}  // namespace

void add_part_effects(PropertyEffects& effects) {
  effects[{"Part", "mass"}] = mass;
  effects[{"Part", "motion"}] = motion;
  effects[{"Part", "surface_velocity"}] = surface_velocity;
  effects[{"Part", "linear_damping"}] = linear_damping;
  effects[{"Part", "angular_damping"}] = angular_damping;
  effects[{"Part", "friction"}] = friction;
  effects[{"Part", "rolling_friction"}] = rolling_friction;
  effects[{"Part", "spinning_friction"}] = spinning_friction;
  effects[{"Part", "friction_direction"}] = friction_direction;
  effects[{"Part", "friction_factor"}] = friction_factor;
  effects[{"Part", "restitution"}] = restitution;
  effects[{"Part", "self_collision"}] = part_self_collision;
  effects[{"Part", "collision_group"}] = collision_group;
  effects[{"Part", "collision_mask"}] = collision_mask;
  effects[{"Part", "report_contacts"}] = report_contacts;
  effects[{"Part", "tint"}] = tint;
  effects[{"Part", "transparency"}] = transparency;
  effects[{"Part", "position"}] = position;
  effects[{"Part", "rotation"}] = rotation;
  effects[{"Part", "linear_velocity"}] = linear_velocity;
  effects[{"Part", "angular_velocity"}] = angular_velocity;
}

}  // namespace limber::sim::test
