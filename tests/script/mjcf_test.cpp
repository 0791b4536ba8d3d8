// sim:load_urdf with MJCF files: motors, the choice of a tree, sites, and the motion of a body with several joints.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "stage.h"

namespace limber::script {
namespace {

// a free ball, and a fixed post with an arm on two hinges, of which the first is driven
constexpr const char* kMjcf = R"(<mujoco model="scene"><worldbody>
<body name="post" pos="0 0 1"><geom type="box" size=".1 .1 .03"/>
  <body name="arm" pos="0 0 .5"><joint name="x" axis="1 0 0"/><joint name="y" axis="0 1 0"/>
    <geom type="capsule" fromto="0 0 0 .4 0 0" size=".05"/><site name="tip" pos=".4 0 0"/></body></body>
<body name="ball" pos="1 2 3"><freejoint/><geom size=".1"/></body></worldbody>
<actuator><motor joint="x" gear="30" ctrlrange="-1 1"/></actuator></mujoco>)";

struct MjcfScene : testing::Test {
  MjcfScene() { fixture.write("scene.xml", kMjcf); }
  std::string value(const std::string& options, const std::string& expression) {
    const std::string fault =
        fixture.run("local body = sim:load_urdf('scene.xml'" + options + ")\nprint(" + expression + ")");
    return fault.empty() ? fixture.host.printed.back() : fault;
  }
  ScriptFixture fixture;
};

TEST_F(MjcfScene, LoadsTheFirstTreeThatMoves) {
  EXPECT_EQ(value("", "body, #body.parts, #body.joints, body.position"), "body 'scene'\t3\t2\tvec3(0, 0, 1)");
}
TEST_F(MjcfScene, LoadsAnotherTree) {
  EXPECT_EQ(value(", { root = 'ball' }", "#body.parts, #body.joints, body.position"), "1\t0\tvec3(1, 2, 3)");
}
TEST_F(MjcfScene, LoadsAllTreesInOneBody) {
  EXPECT_EQ(value(", { root = 'world' }", "#body.parts, body:part('ball').position"), "4\tvec3(1, 2, 3)");
}
TEST_F(MjcfScene, DrivesJointsWithAnActuator) {
  EXPECT_EQ(value("", "body:motor('x').mode, body:motor('x').max_angular_force.z, body:motor('y').mode"),
            "servo\t30\toff");
}
TEST_F(MjcfScene, DrivesAllJointsOnRequest) {
  EXPECT_EQ(value(", { motors = 'servo' }", "body:motor('x').mode, body:motor('y').mode"), "servo\tservo");
}
TEST_F(MjcfScene, DrivesNoJointOnRequest) {
  EXPECT_EQ(value(", { motors = 'off' }", "body:motor('x').mode, body:motor('y').mode"), "off\toff");
}
TEST_F(MjcfScene, SpringsOfPassiveJointsAct) {
  fixture.write("scene.xml", R"(<mujoco model="scene"><worldbody><body name="post"><body name="arm">
<joint name="y" axis="0 1 0" stiffness="3" springref="90"/><geom size=".1"/></body></body></worldbody></mujoco>)");
  EXPECT_EQ(value("",
                  "body:motor('y').mode, body:motor('y').angular_spring_stiffness.z, "
                  "string.format('%.4f', body:motor('y').target)"),
            "spring\t3\t1.5708");
}
TEST_F(MjcfScene, FindsSites) { EXPECT_EQ(value("", "body:link('tip').position"), "vec3(0.4, 0, 1.5)"); }
TEST_F(MjcfScene, RejectsUnknownTrees) {
  EXPECT_NE(value(", { root = 'bal' }", "1").find("there is no top-level body 'bal'; did you mean 'ball'?"),
            std::string::npos);
}
TEST_F(MjcfScene, RejectsARootThatIsNoText) {
  const std::string fault = value(", { root = 1 }", "1");
  EXPECT_NE(fault.find("load_urdf: root takes text, not 1"), std::string::npos) << fault;
}

// The arm falls about y alone: a physical pendulum, so its energy stays.
TEST_F(MjcfScene, SwingsAsAPendulum) {
  const std::string fault = fixture.play(
      "sim.gravity, sim.timestep, sim.substeps = vec3(0, 0, -9.81), 1 / 240, 4\n"
      "body = sim:load_urdf('scene.xml')\n",
      0);
  ASSERT_EQ(fault, "");
  sim::Body* const body = fixture.world.find_body("scene");
  ASSERT_NE(body, nullptr);
  const sim::Joint* const y = body->find_joint("y");
  ASSERT_NE(y, nullptr);
  // from horizontal to the lowest point: I·w²/2 = m·g·l, with a capsule of radius r and length h
  const double r = 0.05, h = 0.4, density = 1000;
  const double cylinder = density * kPi * r * r * h, caps = density * 4 / 3 * kPi * r * r * r;
  const double inertia = cylinder * (3 * r * r + h * h) / 12 + caps * (2 * r * r / 5 + h * h / 4 + 3 * h * r / 8) +
                         (cylinder + caps) * 0.04;
  const double expected = std::sqrt(2 * (cylinder + caps) * 9.81 * 0.2 / inertia);
  double fastest = 0;
  for (int i = 0; i < 240; ++i) {
    fixture.tick(1);
    fastest = std::max(fastest, std::abs(fixture.store.values(y->id(), sim::Joint::table().at("speed"))[0]));
    EXPECT_LT(y->gap(), 1e-4);
  }
  EXPECT_NEAR(fastest, expected, 0.01 * expected);
}

}  // namespace
}  // namespace limber::script
