// Import of MJCF: ranges and starts of ball joints, and sensors.
#include <string>

#include <gtest/gtest.h>

#include "import_text.h"
#include "mjcf_text.h"
#include "solids.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::expect_near;
using test::has_problem;
using test::jointed;
using test::mjcf;

TEST(Mjcf, KeyframeHomeTurnsBallJoints) {
  const BodyModel m = mjcf(R"(<mujoco><worldbody><body name="t"><geom size=".1"/>
<body name="b" pos="0 0 1"><joint name="j" type="ball" pos="0 0 .5"/><geom size=".1"/></body></body></worldbody>
<keyframe><key name="home" qpos="0 2 0 0"/></keyframe></mujoco>)");
  expect_near(m.links[1].home.position, {0, 0, 1}, 1e-12);
  expect_near(m.links[1].start.position, {0, 0, 2}, 1e-12);  // half a turn about the anchor
  EXPECT_LT(test::angle_between(m.links[1].start.rotation, quat_axis({1, 0, 0}, kPi)), 1e-7);
}

// The larger number is the largest angle of the whole rotation.
TEST(Mjcf, RangesOfBallJointsLimitTheirRotation) {
  EXPECT_EQ(jointed("<joint type='ball'/>").joints[0].ball.angle, kPi);
  EXPECT_NEAR(jointed("<joint type='ball' range='0 60'/>").joints[0].ball.angle, kPi / 3, 1e-12);
  EXPECT_NEAR(jointed("<joint type='ball' range='0 .7'/>", "", "angle='radian'").joints[0].ball.angle, 0.7, 1e-12);
  EXPECT_EQ(jointed("<joint type='ball' range='0 60' limited='false'/>").joints[0].ball.angle, kPi);
  EXPECT_EQ(jointed("<joint type='ball' range='0 400'/>").joints[0].ball.angle, kPi);
  const BodyModel none = jointed("<joint type='ball' range='0 0'/>");
  EXPECT_EQ(none.joints[0].ball.angle, kPi);
  EXPECT_TRUE(has_problem(none, Severity::error, "range 0 0 can't be a limit; the joint is free", 1));
  const BodyModel narrow = jointed("<joint type='ball' range='0 .1'/>");
  EXPECT_EQ(narrow.joints[0].ball.angle, 0.01);
  EXPECT_TRUE(has_problem(narrow, Severity::warning, "the largest angle is 0.00175 rad; using 0.01 rad", 1))
      << all_problems(narrow);
}

// Sensors on sites become sensors of the part that has the site, at its place there.
TEST(Mjcf, SensorsOnSitesAreSensorsOfTheBody) {
  const BodyModel m = mjcf(R"(<mujoco><compiler angle="radian"/><worldbody><body name="t"><freejoint/><geom size=".1"/>
<body name="b" pos="0 0 1"><geom size=".1"/><site name="imu" pos=".1 0 0"/>
<site name="eye" pos="0 0 .2" euler="0 1.5707963267948966 0"/></body>
<body name="c"><joint type="ball"/><geom size=".1"/><site name="sole" size=".04 .02"/></body></body></worldbody>
<sensor><accelerometer name="a" site="imu"/><gyro name="g" site="imu"/><rangefinder name="range" site="eye" cutoff="3"/>
<touch site="sole"/><jointpos joint="j"/><torque site="imu"/><gyro/><touch site="sool"/><rangefinder name="range" site="imu"/>
</sensor></mujoco>)");
  ASSERT_EQ(m.sensors.size(), 3u) << all_problems(m);
  EXPECT_EQ(m.sensors[0].name, "imu");
  EXPECT_EQ(m.sensors[0].kind, SensorModel::Kind::imu);
  EXPECT_EQ(m.sensors[0].link, 0);  // its body is fixed to the root
  expect_near(m.sensors[0].pose.position, {0.1, 0, 1}, 1e-12);
  EXPECT_EQ(m.sensors[1].name, "range");
  EXPECT_EQ(m.sensors[1].range, 3);
  expect_near(m.sensors[1].pose * Vec3(0, 0, 1), {1, 0, 1.2}, 1e-12);
  EXPECT_EQ(m.sensors[2].name, "sole");
  EXPECT_EQ(m.sensors[2].link, 1);
  EXPECT_EQ(m.sensors[2].radius, 0.04);
  const std::string problems = all_problems(m);
  EXPECT_EQ(problems.find("jointpos"), std::string::npos);
  EXPECT_TRUE(has_problem(m, Severity::note, "<torque> in <sensor> ignored: nothing is measured", 6)) << problems;
  EXPECT_TRUE(has_problem(m, Severity::warning, "<gyro> without a site ignored", 6)) << problems;
  EXPECT_TRUE(has_problem(m, Severity::error, "site 'sool' does not exist", 6)) << problems;
  EXPECT_TRUE(has_problem(m, Severity::error, "there is a sensor 'range' already", 6)) << problems;
}

}  // namespace
}  // namespace limber::model
