// Sensors that an MJCF file declares: their places and readings, copies, undo of the body.
#include <gtest/gtest.h>

#include <string>

#include "../model/files.h"
#include "model/import.h"
#include "sim/sensors/sensor_list.h"
#include "stage.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kWeight = 2 * 9.81;  // N

// A box of 2 kg, 0.2 m high, on the floor, with a range finder that looks up to a plate, and an IMU that lies on its
// side.
constexpr const char* kSensorBox = R"(<mujoco><worldbody><body name="box" pos="0 0 .1"><freejoint/>
<geom type="box" size=".2 .2 .1" mass="2"/><site name="imu" euler="90 0 0" pos=".1 0 0"/>
<site name="eye" pos="0 0 .1"/><site name="sole" pos="0 0 -.1" size=".5"/></body></worldbody>
<sensor><accelerometer site="imu"/><gyro site="imu"/><rangefinder name="above" site="eye" cutoff="4"/>
<touch name="ground" site="sole"/></sensor></mujoco>)";

struct ModelSensorsFixture : WorldFixture {
  ModelSensorsFixture() {
    gravity({0, 0, -9.81});
    floor();
    add_single_part(box_model({1, 1, 0.1}), 0, {{0, 0, 1.55}, quat_identity()});
  }
  Body& box() {
    const model::test::Files files;
    const auto imported = model::import_model(files.write("box.xml", kSensorBox));
    EXPECT_TRUE(imported);
    return *world.add_body(*imported, "box", BuildOptions{}).value();
  }
  void expect_readings(const Body& body) {
    const SensorList& sensors = body.sensors();
    ASSERT_EQ(sensors.list().size(), 3u);
    const Vec3 force = vec(sensors.find("imu")->id(), "specific_force");
    EXPECT_NEAR(force.y, 9.81, 0.01);  // the site's y axis points up
    EXPECT_NEAR(force.z, 0, 0.01);
    EXPECT_EQ(number(sensors.find("above")->id(), "range"), 4);
    EXPECT_NEAR(number(sensors.find("above")->id(), "distance"), 1.3, 1e-3);
    EXPECT_NEAR(number(sensors.find("ground")->id(), "force"), kWeight, 0.01 * kWeight);
  }
};

TEST(ModelSensors, MeasureAtTheirSites) {
  ModelSensorsFixture s;
  const Body& box = s.box();
  s.ticks(60);
  s.expect_readings(box);
}

TEST(ModelSensors, CopiesHaveThem) {
  ModelSensorsFixture s;
  Body& box = s.box();
  const Body& copy = *s.world.copy_body(box, "copy").value();
  s.world.remove_body(box);
  s.ticks(60);
  s.expect_readings(copy);
}

}  // namespace
}  // namespace limber::sim
