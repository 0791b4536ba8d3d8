// sim:load_urdf: options, poses, merged links, loading in callbacks, errors.
#include <gtest/gtest.h>

#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

// a base, a link 0.5 m above it that turns about x within ±1, and a gripper fixed 0.25 m above the link's end
constexpr const char* kUrdf = R"(<?xml version="1.0"?>
<robot name="crane">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="jib">
    <inertial><origin xyz="0 0 0.5"/><mass value="2"/>
      <inertia ixx="0.2" iyy="0.2" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision>
  </link>
  <link name="hand">
    <inertial><mass value="0.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="lift" type="revolute"><parent link="base"/><child link="jib"/><origin xyz="0 0 0.5"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="30" velocity="2"/></joint>
  <joint name="grip" type="fixed"><parent link="jib"/><child link="hand"/><origin xyz="0 0 1.25"/></joint>
</robot>
)";

struct Crane : testing::Test {
  Crane() { fixture.write("urdf/crane.urdf", kUrdf); }
  std::string value(const std::string& options, const std::string& expression) {
    const std::string fault =
        fixture.run("local crane = sim:load_urdf('urdf/crane.urdf'" + options + ")\nprint(" + expression + ")");
    return fault.empty() ? fixture.host.printed.back() : first_line(fault);
  }
  ScriptFixture fixture;
};

TEST_F(Crane, IsFoundAboveTheSceneAndNamedAsTheRobot) {
  EXPECT_EQ(value("", "crane, #crane.parts, #crane.joints, #crane.motors, crane.root.mass"),
            "body 'crane'\t2\t1\t1\t0");
}
TEST_F(Crane, HasServosOrNone) { EXPECT_EQ(value(", { motors = 'off' }", "crane.motors[1].mode"), "off"); }
TEST_F(Crane, ServosHoldWithTheFilesEffortAndVelocity) {
  EXPECT_EQ(value("", "crane.motors[1].mode, crane:motor('lift').max_angular_force.z, crane:motor(1).speed"),
            "servo\t30\t2");
}
TEST_F(Crane, AcceptsANameAndAPosition) {
  EXPECT_EQ(value(", { name = 'c1', position = { 1, 2, 3 } }", "crane, crane.position, crane:part('jib').position"),
            "body 'c1'\tvec3(1, 2, 3)\tvec3(1, 2, 3.5)");
}
TEST_F(Crane, IsRotated) {
  // half a turn about y: the upright link hangs down
  EXPECT_EQ(value(", { rotation = quat(0, 1, 0, 0) }",
                  "string.format('%.6f %.6f', crane:part('jib').position.z, crane:part('jib').position.x + 1)"),
            "-0.500000 1.000000");
}
TEST_F(Crane, MergedLinksKeepTheirFrame) {
  EXPECT_EQ(value("", "crane:link('hand').position, crane:link('hand'), crane:link('hand') == crane:link('hand')"),
            "vec3(0, 0, 1.75)\tlink 'crane/hand'\ttrue");
}
TEST_F(Crane, KeepsFixedJointsWhenAsked) {
  EXPECT_EQ(value(", { keep_fixed = true }", "#crane.parts, crane:joint('grip').type, #crane.motors"), "3\tfixed\t1");
}
TEST_F(Crane, FloatsWhenAsked) {
  // the base's volume of 0.008 m³ at 1000 kg/m³
  EXPECT_EQ(value(", { fixed_base = false }", "string.format('%.6f', crane.root.mass)"), "8.000000");
}
TEST_F(Crane, StartsInAPose) {
  EXPECT_EQ(value(", { pose = { lift = 0.5 } }",
                  "string.format('%.4f %.4f', crane:joint('lift').value, crane:motor('lift').target)"),
            "0.5000 0.5000");
}
TEST_F(Crane, TwoLoadsGiveTwoBodies) {
  ASSERT_EQ(fixture.run(R"(
local a = sim:load_urdf("urdf/crane.urdf", { name = "a" })
local b = sim:load_urdf("urdf/crane.urdf", { name = "b", position = { 3, 0, 0 } })
a:part("jib").friction = 0.9
print(a:part("jib").friction, b:part("jib").friction, a:part("jib") == b:part("jib"))
)"),
            "");
  EXPECT_EQ(fixture.host.printed, Lines{"0.9\t0.5\tfalse"});
  EXPECT_EQ(fixture.world.find_body("a")->model(), fixture.world.find_body("b")->model());
}

TEST_F(Crane, CallbacksLoadFilesOfTheRun) {
  fixture.write("urdf/other.urdf", kUrdf);
  ASSERT_EQ(fixture.play(R"(
sim:load_urdf("urdf/crane.urdf")
sim:on_start(function()
  print(sim:load_urdf("urdf/crane.urdf", { name = "again" }))
  sim:load_urdf("urdf/other.urdf", { name = "other" })
end)
)"),
            "");
  EXPECT_EQ(fixture.host.printed, Lines{"body 'again'"});
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_EQ(first_line(fixture.host.faults[0].text),
            "scripts/scene.lua:5: 'urdf/other.urdf' was not loaded with these options when the scene ran; callbacks "
            "can't read files, so load it once at the top level");
}

TEST_F(Crane, ReportsMistakes) {
  const std::string at = "scripts/scene.lua:1: ";
  const auto crane_fault = [](const std::string& options) {
    ScriptFixture own;
    own.write("urdf/crane.urdf", kUrdf);
    return first_line(own.run("sim:load_urdf('urdf/crane.urdf', " + options + ")"));
  };
  EXPECT_EQ(crane_fault("{ motors = 'on' }"), at + "load_urdf: motors is 'servo' or 'off', not 'on'");
  EXPECT_EQ(crane_fault("{ fixed_base = 1 }"), at + "load_urdf: fixed_base is true or false, not 1");
  EXPECT_EQ(crane_fault("{ fixed_bas = true }"), at + "load_urdf: opts has no 'fixed_bas'; did you mean 'fixed_base'?");
  const std::string pose_fault = crane_fault("{ pose = { lfit = 1, lift = 1 } }");
  EXPECT_NE(pose_fault.find("pose: 'crane' has no movable joint 'lfit'; did you mean 'lift'?"), std::string::npos)
      << pose_fault;
  EXPECT_EQ(crane_fault("{ pose = { lift = 'up' } }"), at + "load_urdf: pose, lift takes a number, not 'up'");
  EXPECT_EQ(crane_fault("5"), at + "load_urdf: opts is a table, not 5");
  ScriptFixture broken;
  broken.write("urdf/broken.urdf", "<robot name='x'>");
  const std::string fault = broken.run("sim:load_urdf('urdf/broken.urdf')");
  EXPECT_NE(fault.find("broken.urdf:"), std::string::npos) << fault;
}

}  // namespace
}  // namespace limber::script
