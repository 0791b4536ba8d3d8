// Sensors, contacts, rays and zones in scripts: lists, errors that name the argument.
#include <gtest/gtest.h>

#include <algorithm>

#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kSensorScene = R"(
sim.gravity = vec3(0, 0, -10)
local ball = sim:add_sphere_shape("ball", 0.5)
local body = sim:add_body("body")
local first = body:add_part("first", ball, { position = vec3(0, 0, 0) })
local second = body:add_part("second", ball, { position = vec3(3, 0, 0) })
)";

std::string sensor_value_of(const std::string& lines, const std::string& expression) {
  ScriptFixture fixture;
  const std::string fault = fixture.run(std::string(kSensorScene) + lines + "\nprint(" + expression + ")");
  return fault.empty() ? fixture.host.printed.back() : first_line(fault);
}

TEST(SensorScripts, HavePartsListsAndSettings) {
  EXPECT_EQ(sensor_value_of("local imu = first:add_imu('imu', { position = vec3(1, 2, 3) })\n"
                            "local eye = second:add_range_finder('eye', { range = 4 })\n"
                            "first:add_zone('zone') second:add_touch('skin')",
                            "imu, imu.part == first, imu.body == body, imu.position.y, eye.range, eye.other, "
                            "#body.sensors, body.sensors[2] == eye, body:sensor('skin'), second.report_contacts"),
            "imu 'body/imu'\ttrue\ttrue\t2\t4\tnil\t4\ttrue\ttouch 'body/skin'\ttrue");
  EXPECT_EQ(sensor_value_of("first:add_imu('a') first:add_zone('ab') first:add_imu('c') local n = {}\n"
                            "for s in body:sensors('a*') do n[#n + 1] = s.name end",
                            "table.concat(n, ' ')"),
            "a ab");
}

TEST(SensorScripts, AreCopiedWithTheirBody) {
  EXPECT_EQ(sensor_value_of("first:add_range_finder('eye', { range = 4, direction = vec3(0, 0, 1) })\n"
                            "local twin = body:copy('twin')",
                            "twin:sensor('eye').range, twin:sensor('eye').direction.z, twin:sensor('eye').part.body"),
            "4\t1\tbody 'twin'");
}

TEST(SensorScripts, RaysSeePosesThatWereJustSet) {
  EXPECT_EQ(sensor_value_of("local a = sim:ray(vec3(-5, 0, 0), vec3(5, 0, 0))\n"
                            "first.position = vec3(0, 5, 0)\n"
                            "local b = sim:ray(vec3(-5, 0, 0), vec3(5, 0, 0))\n"
                            "body.position = vec3(0, 9, 0)\n"
                            "local c = sim:ray(vec3(-5, 0, 0), vec3(5, 0, 0))",
                            "a.part.name, a.distance, b.part.name, b.distance, c"),
            "first\t4.5\tsecond\t7.5\tnil");
}

TEST(SensorScripts, ErrorsNameTheArgument) {
  const auto error_of = [](const char* line) {
    const std::string text = sensor_value_of(line, "1");
    const std::string place = "scripts/scene.lua:7: ";
    EXPECT_TRUE(text.starts_with(place)) << text;
    return text.substr(std::min(place.size(), text.size()));
  };
  EXPECT_EQ(error_of("sim:ray(vec3(0, 0, 0 / 0), vec3())"), "sim:ray: from takes a finite number, not nan");
  EXPECT_EQ(error_of("sim:ray(vec3(), 3)"), "sim:ray: to takes a vec3, not 3");
  EXPECT_EQ(error_of("sim:ray(vec3(), vec3(), { ignores = body })"),
            "sim:ray: opts has no 'ignores'; did you mean 'ignore'?");
  EXPECT_EQ(error_of("sim:ray(vec3(), vec3(), { ignore = 'body' })"),
            "sim:ray: ignore is a body or a part, not 'body'");
  EXPECT_EQ(error_of("sim:rays(vec3(), { vec3(1, 1, 1), vec3(1 / 0, 0, 0) })"),
            "sim:rays: target 2 takes a finite number, not inf");
  EXPECT_EQ(error_of("sim:overlap_sphere(vec3(), 0 / 0)"), "sim:overlap_sphere: radius takes a finite number, not nan");
  EXPECT_EQ(error_of("first:add_imu('a') first:add_zone('a')"), "there is a sensor 'a' already; names are unique");
  EXPECT_EQ(error_of("first:add_imu('a', { range = 3 })"),
            "add_imu: opts has no 'range'; there are: position, rotation");
  EXPECT_EQ(error_of("first:add_zone('a').count = 3"), "zone 'body/a': 'count' is a readout: it can be read, not set");
  EXPECT_EQ(error_of("body:sensor('eye')"), "body 'body' has no sensor 'eye'; none exist");
}

TEST(SensorScripts, OfAFailedCallAreRemoved) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kSensorScene) + R"(
sim:on_start(function()
  first:add_imu("imu")
  second:add_zone("zone")
  error("no")
end)
sim:at(0.05, function()
  print(#body.sensors)
  first:add_imu("imu")
  print(#body.sensors, body:sensor("imu").part.name)
end)
)",
                         10),
            "");
  ASSERT_EQ(fixture.host.printed.size(), 2u);
  EXPECT_EQ(fixture.host.printed[0], "0");
  EXPECT_EQ(fixture.host.printed[1], "1\tfirst");
}

// A fixed joint of a URDF file has a reading if it is kept; a merged one is no joint.
TEST(SensorScripts, FixedJointsOfAFileReportIfTheyAreKept) {
  for (const bool keep : {false, true}) {
    ScriptFixture fixture;
    fixture.write("urdf/shelf.urdf", R"(<robot name="shelf">
<link name="wall"/>
<link name="board"><inertial><origin xyz="0.5 0 0"/><mass value="10"/>
  <inertia ixx="0.1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="cup"><inertial><mass value="2"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="wall"/><child link="board"/><axis xyz="0 1 0"/>
  <limit lower="-1" upper="1" effort="1000" velocity="10"/></joint>
<joint name="glue" type="fixed"><parent link="board"/><child link="cup"/><origin xyz="0.8 0 0.1"/></joint>
</robot>)");
    const std::string option = keep ? "true" : "false";
    ASSERT_EQ(fixture.play("sim.gravity = vec3(0, 0, -10)\nshelf = sim:load_urdf('urdf/shelf.urdf', { keep_fixed = " +
                               option + " })\n" + R"(
sim:after(1, function()
  local force = shelf:joint("hinge").reaction_force
  print(#shelf.joints, string.format("%.1f", force:length()))
  if #shelf.joints == 2 then print(string.format("%.2f", shelf:joint("glue").reaction_force.z)) end
end))",
                           70),
              "");
    ASSERT_FALSE(fixture.host.printed.empty());
    EXPECT_EQ(fixture.host.printed[0], keep ? "2\t120.0" : "1\t120.0");
    if (keep) {
      EXPECT_EQ(fixture.host.printed.at(1), "20.00");
    }
  }
}

}  // namespace
}  // namespace limber::script
