// Measures the effect of each property of sensors.
#include "sim/property_effects.h"
#include "sim/sensors/sensor.h"
#include "sim/stage.h"

namespace limber::sim::test {

namespace {

// A static ball with a sensor at the origin, and a static box whose faces are at x = 2 and 3.
struct SensorScene : WorldFixture {
  explicit SensorScene(SensorKind kind)
      : robot(body("robot")),
        head(part(robot, sphere_model(0.1), 0)),
        sensor(*robot.sensors().add("sensor", kind, head).value()) {
    add_single_part(box_model(Vec3(1)), 0, {{2.5, 0, 0}, quat_identity()});
  }
  void set_sensor(const char* property, std::vector<double> values) {
    set(sensor.id(), property, std::move(values));
    ticks(1);
  }
  double read(const char* property) const { return number(sensor.id(), property); }
  Body& robot;
  Part& head;
  Sensor& sensor;
};

void imu_position() {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  Sensor& imu = *ball.body().sensors().add("imu", SensorKind::imu, ball).value();
  s.set(ball.id(), "angular_velocity", {0, 0, 3});
  for (const double x : {0.0, 0.5, -1.0}) {
    s.set(imu.id(), "position", {x, 0, 0});
    s.ticks(1);
    EXPECT_NEAR(s.vec(imu.id(), "specific_force").x, -9 * x, 1e-3);
  }
}

void imu_rotation() {
  SensorScene s(SensorKind::imu);
  s.gravity({0, 0, -9.81});
  s.set_sensor("rotation", {0, 0, 0, 1});
  EXPECT_NEAR(s.vec(s.sensor.id(), "specific_force").z, 9.81, 1e-5);
  s.set_sensor("rotation", {1, 0, 0, 0});
  EXPECT_NEAR(s.vec(s.sensor.id(), "specific_force").z, -9.81, 1e-5);
}

void range_position() {
  SensorScene s(SensorKind::range_finder);
  for (const double x : {0.0, 0.5, -1.0}) {
    s.set_sensor("position", {x, 0.2, 0});
    EXPECT_NEAR(s.read("distance"), 2 - x, 1e-6);
    EXPECT_NEAR(s.vec(s.sensor.id(), "hit_position").y, 0.2, 1e-6);
    EXPECT_NEAR(s.vec(s.sensor.id(), "hit_normal").x, -1, 1e-6);
  }
}

void range_direction() {
  SensorScene s(SensorKind::range_finder);
  s.set_sensor("direction", {1, 0.2, 0});
  EXPECT_NEAR(s.read("distance"), 2 * std::sqrt(1.04), 1e-6);
  s.set_sensor("direction", {-1, 0, 0});
  EXPECT_EQ(s.read("hit"), 0);
  EXPECT_EQ(s.read("distance"), 10);
  EXPECT_FALSE(s.store.set(s.sensor.id(), "direction", std::vector<double>{0, 0, 0}));
}

void range_range() {
  SensorScene s(SensorKind::range_finder);
  for (const double range : {1.0, 1.999, 2.001}) {
    s.set_sensor("range", {range});
    EXPECT_EQ(s.read("hit"), range > 2 ? 1 : 0);
    EXPECT_NEAR(s.read("distance"), std::min(range, 2.0), 1e-6);
  }
}

void range_sees_own_body() {
  SensorScene s(SensorKind::range_finder);
  s.part(s.robot, sphere_model(0.25), 0, {{1, 0, 0}, quat_identity()});
  s.set_sensor("sees_own_body", {0});
  EXPECT_NEAR(s.read("distance"), 2, 1e-6);
  s.set_sensor("sees_own_body", {1});
  EXPECT_NEAR(s.read("distance"), 0.75, 1e-6);
}

struct ZoneScene : SensorScene {
  ZoneScene() : SensorScene(SensorKind::zone) {
    add_single_part(sphere_model(0.1), 1, {{0, 0.7, 0}, quat_identity()});
    part(robot, sphere_model(0.1), 1, {{0, 0, 0.8}, quat_identity()});
  }
};

void zone_position() {
  ZoneScene s;
  for (const double y : {0.0, 0.5, 0.7}) {
    s.set_sensor("position", {0, y, 0});
    EXPECT_NEAR(s.read("distance"), std::max(0.6 - y, 0.0), 1e-6);
  }
}

void zone_radius() {
  ZoneScene s;
  for (const double radius : {0.5, 0.599, 0.601}) {
    s.set_sensor("radius", {radius});
    EXPECT_EQ(s.read("count"), radius > 0.6 ? 1 : 0);
    EXPECT_NEAR(s.read("distance"), std::min(radius, 0.6), 1e-6);
  }
}

void zone_sees_own_body() {
  ZoneScene s;
  for (const double on : {0.0, 1.0}) {
    s.set_sensor("sees_own_body", {on});
    EXPECT_EQ(s.read("count"), 1 + on);
  }
}

void zone_sees_static() {
  ZoneScene s;
  s.set_sensor("radius", {2.1});
  for (const double on : {0.0, 1.0}) {
    s.set_sensor("sees_static", {on});
    EXPECT_EQ(s.read("count"), 1 + on);
  }
}

// A static board with boxes of 2 and 3 kg at its ends.
struct TouchScene : WorldFixture {
  TouchScene() : board(add_single_part(box_model({2, 1, 0.1}), 0)) {
    gravity({0, 0, -9.81});
    for (const double x : {-0.8, 0.8}) {
      add_single_part(box_model(Vec3(0.2)), x < 0 ? 2 : 3, {{x, 0, 0.15}, quat_identity()});
    }
    touch = board.body().sensors().add("touch", SensorKind::touch, board).value();
  }
  double force(const char* property, std::vector<double> values) {
    set(touch->id(), property, std::move(values));
    ticks(60);
    return number(touch->id(), "force");
  }
  Part& board;
  Sensor* touch = nullptr;
};

void touch_radius() {
  TouchScene s;
  s.set(s.touch->id(), "position", {-0.8, 0, 0});
  EXPECT_NEAR(s.force("radius", {0}), 5 * 9.81, 0.01);
  EXPECT_NEAR(s.force("radius", {0.5}), 2 * 9.81, 0.01);
  EXPECT_NEAR(s.force("radius", {0.05}), 0, 1e-9);
}

void touch_position() {
  TouchScene s;
  s.set(s.touch->id(), "radius", {0.5});
  EXPECT_NEAR(s.force("position", {-0.8, 0, 0}), 2 * 9.81, 0.01);
  EXPECT_NEAR(s.force("position", {0.8, 0, 0}), 3 * 9.81, 0.01);
}

void stream_contacts() {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.1}, quat_identity()});
  s.set(ball.id(), "report_contacts", {1});
  for (const double on : {0.0, 1.0}) {
    s.set(ball.id(), "stream_contacts", {on});
    s.ticks(10);
    EXPECT_EQ(s.world.sensing().contacts().points().streamed().size(), on != 0 ? 1u : 0u);
  }
}

}  // namespace

void add_sensor_effects(PropertyEffects& effects) {
  effects[{"Part", "stream_contacts"}] = stream_contacts;
  effects[{"Imu", "position"}] = imu_position;
  effects[{"Imu", "rotation"}] = imu_rotation;
  effects[{"RangeFinder", "position"}] = range_position;
  effects[{"RangeFinder", "direction"}] = range_direction;
  effects[{"RangeFinder", "range"}] = range_range;
  effects[{"RangeFinder", "sees_own_body"}] = range_sees_own_body;
  effects[{"Zone", "position"}] = zone_position;
  effects[{"Zone", "radius"}] = zone_radius;
  effects[{"Zone", "sees_own_body"}] = zone_sees_own_body;
  effects[{"Zone", "sees_static"}] = zone_sees_static;
  effects[{"Touch", "position"}] = touch_position;
  effects[{"Touch", "radius"}] = touch_radius;
}

}  // namespace limber::sim::test
