// Import of valid MJCF: frames, joints, masses, defaults, contacts, actuators, keyframes, includes, the choice of a
// tree.
#include "model/import.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "files.h"
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
using test::try_mjcf;

// one free body with these elements
BodyModel free_body(const std::string& content, const std::string& compiler = "") {
  return mjcf("<mujoco><compiler " + compiler + "/><worldbody><body name='b'><freejoint/>" + content +
              "</body></worldbody></mujoco>");
}

Quat home_rotation(const std::string& orientation, const std::string& compiler = "") {
  return mjcf("<mujoco><compiler " + compiler + "/><worldbody><body name='b' " + orientation +
              "><freejoint/><geom size='1'/></body></worldbody></mujoco>")
      .links.at(0)
      .home.rotation;
}

TEST(Mjcf, ReadsEveryOrientation) {
  const auto expect_same = [](const Quat& a, const Quat& b) { EXPECT_LT(test::angle_between(a, b), 1e-7); };
  const Quat half = quat_axis({0, 0, 1}, kPi / 2);
  expect_same(home_rotation("quat='2 0 0 2'"), half);
  expect_same(home_rotation("axisangle='0 0 3 90'"), half);
  expect_same(home_rotation("axisangle='0 0 1 1.5707963267948966'", "angle='radian'"), half);
  expect_same(home_rotation("xyaxes='0 2 0 -1 5 0'"), half);
  expect_same(home_rotation("zaxis='0 -1 0'"), quat_axis({1, 0, 0}, kPi / 2));
  expect_same(home_rotation("zaxis='0 0 -1'"), quat_axis({1, 0, 0}, kPi));
  const Quat x = quat_axis({1, 0, 0}, 0.1), y = quat_axis({0, 1, 0}, 0.2), z = quat_axis({0, 0, 1}, 0.3);
  expect_same(home_rotation("euler='.1 .2 .3'", "angle='radian'"), x * y * z);
  expect_same(home_rotation("euler='.1 .2 .3'", "angle='radian' eulerseq='XYZ'"), z * y * x);
  expect_same(home_rotation("euler='.3 .2 .1'", "angle='radian' eulerseq='zyx'"), z * y * x);
  expect_same(home_rotation("euler='.1 .2 .3'", "angle='radian' eulerseq='xYz'"), y * x * z);
}

TEST(Mjcf, PlacesAFreeBodyWhereTheFilePlacesIt) {
  const BodyModel m = mjcf(
      "<mujoco model='m'><worldbody><body name='b' pos='1 2 3'><freejoint/><geom "
      "size='1'/></body></worldbody></mujoco>");
  EXPECT_EQ(m.name, "m");
  ASSERT_EQ(m.links.size(), 1u);
  expect_near(m.links[0].start.position, {1, 2, 3}, 0);
  EXPECT_GT(m.links[0].inertial.mass, 0);
}

TEST(Mjcf, ReadsEveryShape) {
  const BodyModel m =
      free_body(R"(<geom size=".1"/><geom type="capsule" size=".1 .2"/><geom type="cylinder" size=".1 .3"/>
<geom type="box" size=".1 .2 .3" pos="1 0 0"/><geom type="ellipsoid" size=".1 .2 .3"/>
<geom type="capsule" fromto="0 0 0 3 0 4" size=".1"/><geom type="box" fromto="0 0 0 0 0 -2" size=".1"/>)");
  ASSERT_EQ(m.links.at(0).collisions.size(), 7u) << all_problems(m);
  const auto& s = m.links[0].collisions;
  EXPECT_EQ(s[0].shape.kind, ShapeKind::sphere);
  EXPECT_EQ(s[0].shape.radius, 0.1);
  EXPECT_EQ(s[1].shape.kind, ShapeKind::capsule);
  EXPECT_EQ(s[1].shape.height, 0.4);
  EXPECT_EQ(s[2].shape.kind, ShapeKind::cylinder);
  EXPECT_EQ(s[2].shape.height, 0.6);
  expect_near(s[3].shape.size, {0.2, 0.4, 0.6}, 1e-15);
  expect_near(s[3].origin.position, {1, 0, 0}, 0);
  EXPECT_EQ(s[4].shape.kind, ShapeKind::ellipsoid);
  expect_near(s[4].shape.size, {0.2, 0.4, 0.6}, 1e-15);
  EXPECT_NEAR(s[5].shape.height, 5, 1e-12);
  expect_near(s[5].origin.position, {1.5, 0, 2}, 1e-12);
  expect_near(s[5].origin.rotation * Vec3(0, 0, 1), {0.6, 0, 0.8}, 1e-12);
  expect_near(s[6].shape.size, {0.2, 0.2, 2}, 1e-12);
  expect_near(s[6].origin.position, {0, 0, -1}, 1e-12);
}

TEST(Mjcf, ComputesMassesFromGeoms) {
  const BodyModel m = free_body("<geom type='box' size='.5 1 1.5' density='2'/>");
  EXPECT_NEAR(m.file_links[0].mass, 2 * 6, 1e-12);  // 1 x 2 x 3 m
  EXPECT_NEAR(m.file_links[0].tensor[0][0], 12.0 / 12 * (4 + 9), 1e-12);
  EXPECT_NEAR(free_body("<geom size='.1'/>").file_links[0].mass, 1000 * 4.0 / 3 * kPi * 1e-3, 1e-9);
  const BodyModel two = free_body("<geom size='.1' mass='1' pos='1 0 0'/><geom size='.1' mass='3' pos='-1 0 0'/>");
  EXPECT_NEAR(two.file_links[0].mass, 4, 1e-12);
  expect_near(two.file_links[0].center, {-0.5, 0, 0}, 1e-12);
  const double sphere = 0.4 * 0.01;
  EXPECT_NEAR(two.file_links[0].tensor[0][0], 4 * sphere, 1e-12);
  EXPECT_NEAR(two.file_links[0].tensor[1][1], 4 * sphere + 1 * 1.5 * 1.5 + 3 * 0.5 * 0.5, 1e-12);
  // an ellipsoid: m/5·(b² + c²)
  const BodyModel e = free_body("<geom type='ellipsoid' size='1 2 3' mass='5'/>");
  EXPECT_NEAR(e.file_links[0].tensor[0][0], 4 + 9, 1e-9);
  EXPECT_NEAR(e.file_links[0].tensor[2][2], 1 + 4, 1e-9);
}

TEST(Mjcf, ReadsInertials) {
  const char* const inertial = "<inertial pos='0 0 1' quat='1 0 0 1' mass='2' diaginertia='1 2 2.5'/><geom size='.1'/>";
  const BodyModel m = free_body(inertial);
  EXPECT_EQ(m.file_links[0].mass, 2);
  expect_near(m.file_links[0].center, {0, 0, 1}, 0);
  EXPECT_NEAR(m.file_links[0].tensor[0][0], 2, 1e-12);
  EXPECT_NEAR(m.file_links[0].tensor[1][1], 1, 1e-12);
  const BodyModel full = free_body("<inertial mass='2' fullinertia='1 2 2.5 .1 .2 .3'/>");
  EXPECT_EQ(full.file_links[0].tensor[0][1], 0.1);
  EXPECT_EQ(full.file_links[0].tensor[0][2], 0.2);
  EXPECT_EQ(full.file_links[0].tensor[1][2], 0.3);
  EXPECT_NEAR(free_body(inertial, "inertiafromgeom='true'").file_links[0].mass, 1000 * 4.0 / 3 * kPi * 1e-3, 1e-9);
}

TEST(Mjcf, AppliesTheCompilersMassRules) {
  EXPECT_NEAR(free_body("<geom size='.1'/>", "settotalmass='7'").file_links[0].mass, 7, 1e-12);
  EXPECT_NEAR(free_body("<geom size='.1' mass='.1'/>", "boundmass='1'").file_links[0].mass, 1, 1e-12);
  const Mat3 bound = free_body("<geom size='.1' mass='1'/>", "boundinertia='.5'").file_links[0].tensor;
  EXPECT_NEAR(bound[1][1], 0.5, 1e-12);
  const char* const odd = "<inertial mass='1' diaginertia='1 1 4'/>";
  EXPECT_NEAR(free_body(odd, "balanceinertia='true'").file_links[0].tensor[0][0], 2, 1e-12);
  const BodyModel groups =
      free_body("<geom size='.1' mass='1'/><geom size='.1' mass='2' group='3'/>", "inertiagrouprange='0 2'");
  EXPECT_NEAR(groups.file_links[0].mass, 1, 1e-12);
}

TEST(Mjcf, ReadsJoints) {
  const BodyModel m =
      jointed("<joint name='j' axis='0 2 0' pos='0 0 .5' range='-90 45' damping='.3' frictionloss='.4'/>");
  ASSERT_EQ(m.joints.size(), 1u) << all_problems(m);
  const JointModel& j = m.joints[0];
  EXPECT_EQ(j.type, JointType::revolute);
  EXPECT_TRUE(j.limited);
  EXPECT_NEAR(j.lower, -kPi / 2, 1e-12);
  EXPECT_NEAR(j.upper, kPi / 4, 1e-12);
  EXPECT_EQ(j.damping, 0.3);
  EXPECT_EQ(j.friction, 0.4);
  expect_near(j.frame_in_parent.position, {0, 0, 1.5}, 1e-12);
  expect_near(j.frame_in_child.position, {0, 0, 0.5}, 1e-12);
  expect_near(j.frame_in_child.rotation * Vec3(0, 0, 1), {0, 1, 0}, 1e-12);
  EXPECT_EQ(m.links[0].inertial.mass, 0);  // a base without a joint is fixed
  EXPECT_EQ(jointed("<joint/>").joints[0].type, JointType::continuous);
  EXPECT_EQ(jointed("<joint type='slide' range='-1 2'/>").joints[0].type, JointType::prismatic);
  EXPECT_NEAR(jointed("<joint type='slide' range='-1 2'/>").joints[0].upper, 2, 0);
  EXPECT_EQ(jointed("<joint type='ball'/>").joints[0].type, JointType::spherical);
}

TEST(Mjcf, LimitsApplyAsFlagsAndAutolimitsSay) {
  EXPECT_TRUE(jointed("<joint range='-1 1'/>").joints[0].limited);
  EXPECT_FALSE(jointed("<joint range='-1 1' limited='false'/>").joints[0].limited);
  EXPECT_FALSE(jointed("<joint range='-1 1'/>", "", "autolimits='false'").joints[0].limited);
  EXPECT_TRUE(jointed("<joint range='-1 1' limited='true'/>", "", "autolimits='false'").joints[0].limited);
}

TEST(Mjcf, ShiftsLimitsByTheReference) {
  const BodyModel m = jointed("<joint type='slide' range='0 3' ref='1'/>");
  EXPECT_EQ(m.joints[0].lower, -1);
  EXPECT_EQ(m.joints[0].upper, 2);
  EXPECT_TRUE(has_problem(m, Severity::note, "<joint ref>", 1)) << all_problems(m);
}

TEST(Mjcf, TurnsABodyAboutTheAnchorOfItsJoint) {
  ImportOptions options;
  options.pose["j"] = kPi / 2;
  const BodyModel m = mjcf(R"(<mujoco><worldbody><body name='base'><body name='arm' pos='0 0 1'>
<joint name='j' axis='0 1 0' pos='0 0 1'/><geom size='.1'/></body></body></worldbody></mujoco>)",
                           options);
  // the body's origin is 1 m below the anchor at 2 m, and turns from -z to -x
  expect_near(m.links[1].home.position, {0, 0, 1}, 1e-12);
  expect_near(m.links[1].start.position, {-1, 0, 2}, 1e-12);
}

TEST(Mjcf, BodiesDoNotCollideWithMovingParents) {
  const BodyModel m = mjcf(R"(<mujoco><worldbody><body name='base'><freejoint/><geom size='.1'/>
<body name='arm' pos='0 0 1'><joint name='x' axis='1 0 0'/><joint name='y' axis='0 1 0'/><geom size='.1'/></body></body>
</worldbody></mujoco>)");
  ASSERT_EQ(m.links.size(), 3u);
  ASSERT_EQ(m.exclusions.size(), 1u);
  EXPECT_EQ(m.exclusions[0], std::pair(0, 2));
}

TEST(Mjcf, ChainsSeveralJointsOfABody) {
  const BodyModel m = jointed(
      "<joint name='x' axis='1 0 0'/><joint name='y' axis='0 1 0' pos='0 0 .1'/><joint name='s' type='slide'/>");
  ASSERT_EQ(m.links.size(), 4u);
  ASSERT_EQ(m.joints.size(), 3u);
  EXPECT_EQ(m.joints[0].name, "x");
  EXPECT_EQ(m.joints[2].name, "s");
  EXPECT_EQ(m.links[1].name, "arm_x");
  EXPECT_EQ(m.links[3].name, "arm");
  const double mass = 1000 * 0.2 * 0.4 * 0.6;
  EXPECT_NEAR(m.links[3].inertial.mass, mass, 1e-9);
  EXPECT_NEAR(m.links[1].inertial.mass, mass * 1e-5, 1e-9);
  EXPECT_TRUE(m.exclusions.empty()) << "in MuJoCo, bodies collide with static parents";
  for (const Problem& p : m.problems) EXPECT_EQ(p.severity, Severity::note) << p.text;
  // both turn: first about x, then about the turned y
  ImportOptions options;
  options.pose = {{"x", 0.3}, {"y", 0.4}};
  const BodyModel turned = mjcf(R"(<mujoco><worldbody><body name='base'><body name='arm'><joint name='x' axis='1 0 0'/>
<joint name='y' axis='0 1 0'/><geom size='.1'/></body></body></worldbody></mujoco>)",
                                options);
  EXPECT_LT(test::angle_between(turned.links[2].start.rotation, quat_axis({1, 0, 0}, 0.3) * quat_axis({0, 1, 0}, 0.4)),
            1e-7);
}

TEST(Mjcf, ResolvesDefaultClasses) {
  const BodyModel m = mjcf(R"(<mujoco><default><geom rgba="1 0 0 1" size=".1"/><joint damping="1"/>
<default class="leg"><geom type="capsule" size=".2 .3"/><joint axis="1 0 0"/><default class="foot"><geom size=".5"/></default></default></default>
<worldbody><body name="a"><freejoint/><geom/><body name="b" childclass="leg"><joint/><geom/><geom class="foot" type="sphere"/>
<geom class="main"/></body></body></worldbody></mujoco>)");
  ASSERT_EQ(m.links.size(), 2u) << all_problems(m);
  EXPECT_EQ(m.links[0].collisions[0].shape.radius, 0.1);
  EXPECT_EQ(m.links[0].visuals[0].color, Vec3(1, 0, 0));
  const auto& leg = m.links[1].collisions;
  EXPECT_EQ(leg[0].shape.kind, ShapeKind::capsule);
  EXPECT_EQ(leg[0].shape.height, 0.6);
  EXPECT_EQ(leg[1].shape.radius, 0.5);
  EXPECT_EQ(leg[2].shape.kind, ShapeKind::sphere);
  EXPECT_EQ(m.joints[0].damping, 1);
  expect_near(m.file_joints[0].axis, {1, 0, 0}, 0);
}

TEST(Mjcf, ReadsColorsAndMaterials) {
  const BodyModel m = mjcf(R"(<mujoco><asset><material name="red" rgba="1 0 0 .5"/></asset><worldbody><body><freejoint/>
<geom size=".1" material="red"/><geom size=".1" material="red" rgba="0 1 0 1"/><geom size=".1" rgba="0 0 0 0"/>
<geom size=".1" material="blue"/></body></worldbody></mujoco>)");
  ASSERT_EQ(m.links[0].visuals.size(), 3u);  // the third is invisible
  EXPECT_EQ(m.links[0].collisions.size(), 4u);
  EXPECT_EQ(m.links[0].visuals[0].color, Vec3(1, 0, 0));
  EXPECT_EQ(m.links[0].visuals[0].alpha, 0.5);
  EXPECT_EQ(m.links[0].visuals[1].color, Vec3(0, 1, 0));
  EXPECT_TRUE(has_problem(m, Severity::warning, "material 'blue' is not defined", 3)) << all_problems(m);
}

TEST(Mjcf, SeparatesVisualAndCollisionGeoms) {
  const BodyModel m = free_body("<geom size='.1' contype='0' conaffinity='0'/><geom size='.2' group='3'/>");
  ASSERT_EQ(m.links[0].visuals.size(), 1u);
  EXPECT_EQ(m.links[0].visuals[0].shape.radius, 0.1);
  ASSERT_EQ(m.links[0].collisions.size(), 1u);
  EXPECT_EQ(m.links[0].collisions[0].shape.radius, 0.2);
}

TEST(Mjcf, ContactMasksExcludePairs) {
  const auto three = [](const char* a, const char* b, const char* c) {
    const auto body = [](const char* name, const char* masks) {
      return std::string("<body name='") + name + "'><joint/><geom size='.1' " + masks + "/></body>";
    };
    return mjcf("<mujoco><worldbody><body name='r'><geom size='.01' mass='1' contype='0' conaffinity='0'/>" +
                body("a", a) + body("b", b) + body("c", c) + "</body></worldbody></mujoco>");
  };
  // none collides with another of the body
  const BodyModel none = three("conaffinity='0'", "conaffinity='0'", "conaffinity='0'");
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(none.links[static_cast<std::size_t>(i)].self_collision) << i;
  EXPECT_TRUE(none.exclusions.empty());
  // a and b share no bit, c collides with both
  const BodyModel some =
      three("contype='1' conaffinity='1'", "contype='2' conaffinity='2'", "contype='3' conaffinity='3'");
  ASSERT_EQ(some.exclusions.size(), 1u);
  EXPECT_EQ(some.exclusions[0], std::pair(1, 2));
}

TEST(Mjcf, ReadsExclusions) {
  const BodyModel m =
      mjcf(R"(<mujoco><worldbody><body name="r"><geom size=".1"/><body name="a"><joint/><geom size=".1"/></body>
<body name="b"><joint/><geom size=".1"/></body></body></worldbody>
<contact><exclude body1="b" body2="a"/><exclude body1="b" body2="none"/></contact></mujoco>)");
  ASSERT_EQ(m.exclusions.size(), 1u);
  EXPECT_EQ(m.exclusions[0], std::pair(1, 2));
  EXPECT_TRUE(m.overlaps.empty());  // they overlap, but are excluded already
  EXPECT_TRUE(has_problem(m, Severity::error, "body 'none' does not exist", 3)) << all_problems(m);
}

TEST(Mjcf, ActuatorsLimitTheirJoint) {
  const auto joint = [](const std::string& actuator) {
    return jointed("<joint name='j'/>", "<actuator>" + actuator + "</actuator>").joints.at(0);
  };
  EXPECT_EQ(joint("<motor joint='j' ctrlrange='-2 1' gear='10'/>").effort, 20);
  EXPECT_TRUE(joint("<motor joint='j'/>").driven);
  EXPECT_EQ(joint("<motor joint='j'/>").effort, 10000);
  EXPECT_EQ(joint("<position joint='j' kp='50' ctrlrange='-1 1' forcerange='-7 7'/>").effort, 7);
  EXPECT_EQ(joint("<position joint='j' forcerange='-7 7' forcelimited='false'/>").effort, 10000);
  EXPECT_EQ(joint("<velocity joint='j' ctrlrange='-3 3' forcerange='-7 7' gear='2'/>").velocity, 1.5);
  EXPECT_EQ(joint("<general joint='j' ctrlrange='-1 1' gainprm='30'/>").effort, 30);
  EXPECT_EQ(
      joint("<general joint='j' ctrlrange='-1 1' gainprm='30' biastype='affine' biasprm='0 -30 -1' forcerange='-9 9'/>")
          .effort,
      9);
  EXPECT_EQ(joint("<motor joint='j' ctrlrange='-1 1' gear='4'/><motor joint='j' ctrlrange='-1 1' gear='3'/>").effort,
            7);
  const auto limited = [](const std::string& gear) {
    return jointed("<joint name='j' actuatorfrcrange='-5 5'/>",
                   "<actuator><motor joint='j' ctrlrange='-1 1' gear='" + gear + "'/></actuator>")
        .joints.at(0)
        .effort;
  };
  EXPECT_EQ(limited("4"), 4);
  EXPECT_EQ(limited("40"), 5);
  EXPECT_FALSE(joint("").driven);
  const BodyModel passive = jointed("<joint name='j'/>");
  EXPECT_TRUE(has_problem(passive, Severity::note, "1 joint has no actuator and moves freely, first 'j'", 1))
      << all_problems(passive);
}

TEST(Mjcf, ReadsTheGainsOfPositionActuators) {
  const auto gains = [](const std::string& actuator) {
    return jointed("<joint name='j' ref='90'/>", "<actuator>" + actuator + "</actuator>").joints[0].spring;
  };
  const SpringModel position = gains("<position joint='j' kp='5' kv='.5' gear='2'/>");
  EXPECT_EQ(position.stiffness, 20);
  EXPECT_EQ(position.damping, 2);
  EXPECT_NEAR(position.rest, -kPi / 2, 1e-12);
  const SpringModel general = gains("<general joint='j' gainprm='5' biastype='affine' biasprm='0 -5 -.5'/>");
  EXPECT_EQ(general.stiffness, 5);
  EXPECT_EQ(general.damping, 0.5);
  EXPECT_EQ(gains("<motor joint='j'/>").stiffness, 0);
  EXPECT_EQ(gains("<general joint='j' biasprm='0 -5 -.5'/>").stiffness, 0) << "without bias";
}

TEST(Mjcf, ReadsArmatures) {
  EXPECT_EQ(jointed("<joint armature='.2'/>").joints[0].armature, 0.2);
  EXPECT_EQ(jointed("<joint armature='-1'/>").joints[0].armature, 0);
  EXPECT_TRUE(has_problem(jointed("<joint type='ball' armature='1'/>"), Severity::note, "armature of a ball joint", 1));
}

TEST(Mjcf, SuggestsNamesOfMisspelledElements) {
  const auto suggests = [](const std::string& text, const std::string& name) {
    const BodyModel m =
        mjcf("<mujoco><worldbody><body name='b'><joint/><geom size='.1'/></body></worldbody>" + text + "</mujoco>");
    EXPECT_NE(all_problems(m).find("Did you mean <" + name + ">?"), std::string::npos) << all_problems(m);
  };
  suggests("<actuator><moter joint='j'/></actuator>", "motor");
  suggests("<contact><exclud body1='b' body2='b'/></contact>", "exclude");
  suggests("<tendon><fixd/></tendon>", "fixed");
  suggests("<equality><conect/></equality>", "connect");
  suggests("<asset><materiel name='m'/></asset>", "material");
  suggests("<default><goem/></default>", "geom");
  suggests("<actuators/>", "actuator");
}

TEST(Mjcf, JointsWithoutAnActuatorKeepTheirSpring) {
  const std::string joint = "<joint name='j' stiffness='3' springref='90' ref='45'/>";
  const BodyModel passive = jointed(joint);
  EXPECT_EQ(passive.joints[0].spring.stiffness, 3);
  EXPECT_NEAR(passive.joints[0].spring.rest, kPi / 4, 1e-12);
  const BodyModel driven = jointed(joint, "<actuator><motor joint='j'/></actuator>");
  EXPECT_EQ(driven.joints[0].spring.stiffness, 0);
  EXPECT_TRUE(has_problem(driven, Severity::warning, "1 joint has an actuator and a spring, first 'j'", 1))
      << all_problems(driven);
  EXPECT_TRUE(has_problem(jointed("<joint type='ball' stiffness='3'/>"), Severity::warning,
                          "stiffness of a ball joint ignored", 1));
}

TEST(Mjcf, KeyframeHomeSetsTheStart) {
  const BodyModel m = mjcf(R"(<mujoco><worldbody><body name="t" pos="0 0 1"><freejoint/><geom size=".1"/>
<body name="b"><joint name="j" type="slide" ref=".5"/><geom size=".1"/></body></body></worldbody>
<keyframe><key name="other" qpos="9 9 9 1 0 0 0 9"/><key name="home" qpos="1 2 3 0 0 0 1 .75"/></keyframe></mujoco>)");
  expect_near(m.links[0].home.position, {0, 0, 1}, 0);
  expect_near(m.links[0].start.position, {1, 2, 3}, 0);
  EXPECT_LT(test::angle_between(m.links[0].start.rotation, quat_axis({0, 0, 1}, kPi)), 1e-7);
  EXPECT_EQ(m.joints[0].start, 0.25);
}

TEST(Mjcf, JointEqualitiesFollow) {
  const BodyModel m = mjcf(
      R"(<mujoco><worldbody><body name="t"><geom size=".1"/><body name="a"><joint name="j" type="slide"/><geom size=".1"/></body>
<body name="b"><joint name="k" type="slide"/><geom size=".1"/></body></body></worldbody>
<equality><joint joint1="k" joint2="j" polycoef=".1 -2 0 0 0"/></equality></mujoco>)");
  EXPECT_EQ(m.joints[1].mimic, 0);
  EXPECT_EQ(m.joints[1].mimic_multiplier, -2);
  EXPECT_EQ(m.joints[1].mimic_offset, 0.1);
}

TEST(Mjcf, ChoosesATree) {
  const std::string text =
      R"(<mujoco><worldbody><geom type="plane" size="1 1 1"/><body name="table"><geom size=".1"/></body>
<body name="robot" pos="0 0 1"><freejoint/><geom size=".1"/></body><body name="cart"><joint name="s" type="slide"/><geom size=".1"/></body></worldbody></mujoco>)";
  const BodyModel first = mjcf(text);
  ASSERT_EQ(first.links.size(), 1u);
  EXPECT_EQ(first.links[0].name, "robot");
  EXPECT_TRUE(
      has_problem(first, Severity::note, "the body is the tree of 'robot'; 2 other top-level bodies (table, cart)", 1))
      << all_problems(first);
  ImportOptions options;
  options.root = "cart";
  const BodyModel cart = mjcf(text, options);
  ASSERT_EQ(cart.links.size(), 2u);
  EXPECT_EQ(cart.links[0].name, "world");
  EXPECT_EQ(cart.links[0].inertial.mass, 0);
  options.root = "world";
  const BodyModel all = mjcf(text, options);
  ASSERT_EQ(all.links.size(), 3u) << all_problems(all);  // the table is merged into the world
  EXPECT_EQ(all.links[0].collisions.size(), 2u);
  EXPECT_EQ(all.joints[0].type, JointType::floating);
  expect_near(all.links[1].home.position, {0, 0, 1}, 0);
  options.root = "robt";
  const auto none = try_mjcf(text, options);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().find("model.xml:1: there is no top-level body 'robt'; did you mean 'robot'?"),
            std::string::npos)
      << none.error();
}

TEST(Mjcf, KeepsSitesAsFrames) {
  const BodyModel m = jointed("<joint/><site name='tip' pos='0 0 .5'/>");
  ASSERT_EQ(m.merged.size(), 1u);
  EXPECT_EQ(m.merged[0].name, "tip");
  EXPECT_TRUE(m.merged[0].site);
  EXPECT_EQ(m.merged[0].link, 1);
  expect_near(m.merged[0].offset.position, {0, 0, 0.5}, 0);
}

TEST(Mjcf, FramesMoveTheirContent) {
  const BodyModel m = free_body(
      "<frame pos='1 0 0' euler='0 0 90'><geom size='.1' pos='1 0 0'/><body name='c' pos='0 1 0'><joint/><geom "
      "size='.1'/></body></frame>");
  expect_near(m.links[0].collisions[0].origin.position, {1, 1, 0}, 1e-12);
  expect_near(m.links[1].home.position, {0, 0, 0}, 1e-12);
}

TEST(Mjcf, ReadsMeshesWithScaleAndReference) {
  const test::Files files;
  files.write("meshes/box.stl", test::binary_stl(test::box({0.2, 0.4, 0.6})));
  const std::string path = files.write(
      "model.xml", R"(<mujoco><compiler meshdir="meshes"/><asset><mesh file="box.stl" scale="2 2 2" refpos=".1 0 0"/>
<mesh name="tetra" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody><body name="b"><freejoint/>
<geom type="mesh" mesh="box" pos="0 0 1" density="100"/><geom type="mesh" mesh="tetra" mass="1"/></body></worldbody></mujoco>)");
  const auto model = import_model(path);
  ASSERT_TRUE(model) << model.error();
  const LinkModel& link = (*model)->links[0];
  ASSERT_EQ(link.collisions.size(), 2u) << all_problems(**model);
  expect_near(link.collisions[0].origin * Vec3(0), {-0.2, 0, 1}, 1e-6);
  EXPECT_NEAR((*model)->file_links[0].mass, 100 * 0.4 * 0.8 * 1.2 + 1, 1e-5);
  EXPECT_EQ((*model)->files.size(), 2u);
}

TEST(Mjcf, ReportsWhatItDoesNotSupportOncePerKind) {
  const BodyModel m = mjcf(
      R"(<mujoco><option timestep=".01"/><visual/><worldbody><light/><light/><body name="b"><joint name="j" stiffness="3"/>
<geom size=".1" friction="1"/><geom type="hfield" hfield="h"/><composite/></body></worldbody>
<tendon><fixed stiffness="1"><joint joint="j" coef="1"/></fixed><spatial/></tendon><sensor><magnetometer/><magnetometer/></sensor><actuator><muscle tendon="t"/></actuator></mujoco>)");
  EXPECT_TRUE(has_problem(m, Severity::note, "<option> ignored", 1)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "<light> ignored: the scene sets the view (2 places)", 1))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "<geom>: friction has no effect", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "hfield 'h' does not exist", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "<composite> inside <body> ignored", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "stiffness, damping, friction and limits of <fixed>", 3))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "<spatial> in <tendon> ignored: it pulls at nothing", 3))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "<magnetometer> in <sensor> ignored: nothing is measured (2 places)", 3))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "<muscle> that drives no joint ignored", 3)) << all_problems(m);
}

TEST(Mjcf, NamesUnnamedAndRepeatedElements) {
  const BodyModel m = mjcf(R"(<mujoco><worldbody><body><geom size=".1"/><body><joint/><geom size=".1"/></body>
<body name="body"><joint name="x"/><geom size=".1"/></body><body name="c"><joint name="x"/><geom size=".1"/></body></body></worldbody></mujoco>)");
  ASSERT_EQ(m.links.size(), 4u);
  EXPECT_EQ(m.links[0].name, "body_2");
  EXPECT_EQ(m.links[1].name, "body_3");
  EXPECT_EQ(m.links[2].name, "body");
  EXPECT_EQ(m.joints[0].name, "body_3");
  EXPECT_EQ(m.joints[2].name, "x_2");
  EXPECT_TRUE(has_problem(m, Severity::error, "joint 'x' is declared twice; the second is called 'x_2'", 2))
      << all_problems(m);
}

}  // namespace
}  // namespace limber::model
