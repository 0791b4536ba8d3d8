// What the importer makes of good files: order, frames, limits, merging, masses, mimics, start poses.
#include "model/urdf_import.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"

namespace limber {
namespace {

using test::import_text;
using test::says;
using test::try_import;

constexpr double kHalf = kPi / 2;

// an upright arm: hinge about z at 1 m, hinge about -y at 2 m, slide along a slanted axis
constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="lower"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="0 -1 0"/>
    <limit lower="0.5" upper="2" effort="3" velocity="4"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 2"/><limit effort="5" velocity="6"/></joint>
  <joint name="slide" type="prismatic"><parent link="lower"/><child link="tip"/>
    <origin xyz="1 0 0"/><axis xyz="1 1 0"/><limit lower="-0.1" upper="0.2" effort="7" velocity="8"/>
    <dynamics damping="0.3" friction="0.4"/></joint>
</robot>)";

TEST(UrdfImport, LinksAndJointsComeDepthFirstFromTheRoot) {
  const BodyModel m = import_text(kArm);
  ASSERT_EQ(m.links.size(), 4u);
  EXPECT_EQ(m.links[0].name, "base");
  EXPECT_EQ(m.links[1].name, "upper");
  EXPECT_EQ(m.links[2].name, "lower");
  EXPECT_EQ(m.links[3].name, "tip");
  ASSERT_EQ(m.joints.size(), 3u);
  EXPECT_EQ(m.joints[0].name, "shoulder");
  EXPECT_EQ(m.joints[1].name, "elbow");
  EXPECT_EQ(m.joints[2].name, "slide");
  for (const JointModel& j : m.joints) EXPECT_LT(j.parent, j.child);
}

TEST(UrdfImport, JointsInFileOrderAtABranch) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="x"/><link name="y"/><link name="x2"/>
    <joint name="to_y" type="continuous"><parent link="a"/><child link="y"/><axis xyz="0 0 1"/></joint>
    <joint name="to_x" type="continuous"><parent link="a"/><child link="x"/><axis xyz="0 0 1"/></joint>
    <joint name="to_x2" type="continuous"><parent link="x"/><child link="x2"/><axis xyz="0 0 1"/></joint></robot>)");
  ASSERT_EQ(m.links.size(), 4u);
  EXPECT_EQ(m.links[1].name, "y");
  EXPECT_EQ(m.links[2].name, "x");
  EXPECT_EQ(m.links[3].name, "x2");
}

TEST(UrdfImport, HomePoseIsForwardKinematicsAtZero) {
  const BodyModel m = import_text(kArm);
  // the elbow's origin turns by 90 degrees about z, so the slide's 1 m along x lies along world y
  test::expect_near(m.links[1].home.position, {0, 0, 1}, 1e-12);
  test::expect_near(m.links[2].home.position, {0, 0, 2}, 1e-12);
  test::expect_near(m.links[3].home.position, {0, 1, 2}, 1e-12);
  EXPECT_NEAR(test::angle_between(m.links[3].home.rotation, quat_axis({0, 0, 1}, kHalf)), 0, 1e-12);
}

TEST(UrdfImport, StartsAtTheNearestAllowedAngle) {
  const BodyModel m = import_text(kArm);
  // elbow 0 is below 0.5: it starts at 0.5 about -y of its frame, whose x is world y
  EXPECT_DOUBLE_EQ(m.joints[1].start, 0.5);
  test::expect_near(m.links[3].start.position, {0, std::cos(0.5), 2 + std::sin(0.5)}, 1e-12);
  EXPECT_TRUE(says(m, Severity::note, "starts at 0.5", 7)) << test::all_problems(m);
}

TEST(UrdfImport, AskedPoseIsClampedAndPlaced) {
  ImportOptions options;
  options.pose = {{"shoulder", kHalf}, {"slide", 9.0}};
  const BodyModel m = import_text(kArm, options);
  EXPECT_DOUBLE_EQ(m.joints[0].start, kHalf);
  EXPECT_DOUBLE_EQ(m.joints[2].start, 0.2);
  // shoulder turns y to -x; the slide moves 0.2 m along (1,1,0)/sqrt(2) of the lower link
  const double s = 0.2 / std::sqrt(2.0);
  const double along = 1 + s;
  test::expect_near(m.links[3].start.position, {-along * std::cos(0.5), -s, 2 + along * std::sin(0.5)}, 1e-12);
}

TEST(UrdfImport, PoseOfAnUnknownJointIsRefusedWithNearName) {
  ImportOptions options;
  options.pose = {{"elbov", 1.0}};
  const auto refused = try_import(kArm, options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("elbow"), std::string::npos) << refused.error();
}

TEST(UrdfImport, AxesAreUnitAndFramesHaveThemAsZ) {
  const BodyModel m = import_text(kArm);
  test::expect_near(m.file_joints[0].axis, {0, 0, 1}, 1e-15);
  test::expect_near(m.file_joints[2].axis, Vec3(1, 1, 0) / std::sqrt(2.0), 1e-15);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 z = m.joints[i].frame_in_child.rotation * Vec3(0, 0, 1);
    test::expect_near(z, m.file_joints[i].axis, 1e-12, m.joints[i].name);
    // at home both halves of a joint's frame are one place
    const Pose a = m.links[static_cast<std::size_t>(m.joints[i].parent)].home * m.joints[i].frame_in_parent;
    const Pose b = m.links[static_cast<std::size_t>(m.joints[i].child)].home * m.joints[i].frame_in_child;
    test::expect_near(a.position, b.position, 1e-12);
    EXPECT_NEAR(test::angle_between(a.rotation, b.rotation), 0, 1e-7);
  }
}

TEST(UrdfImport, PlusZKeepsTheFrameAndMinusZTurnsAboutX) {
  const char* text = R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="up" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
    <joint name="down" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 -1"/></joint></robot>)";
  const BodyModel m = import_text(text);
  EXPECT_EQ(m.joints[0].frame_in_child.rotation, quat_identity());
  EXPECT_EQ(m.joints[1].frame_in_child.rotation, quat_xyzw(1, 0, 0, 0));
}

TEST(UrdfImport, LimitsByPresence) {
  const auto joint = [](const char* type, const char* limit) {
    return import_text(std::string(R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type=")") + type +
                       R"("><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>)" + limit + "</joint></robot>")
        .joints.at(0);
  };
  struct Case {
    const char* type;
    const char* limit;
    bool limited;
    double lower, upper;
  };
  const Case cases[] = {
      {"revolute", R"(<limit effort="1" velocity="1"/>)", false, 0, 0},
      {"revolute", R"(<limit effort="1" velocity="1" lower="0" upper="0"/>)", true, 0, 0},
      {"revolute", R"(<limit effort="1" velocity="1" lower="-7" upper="7"/>)", true, -7, 7},
      {"revolute", R"(<limit effort="1" velocity="1" lower="1" upper="-1"/>)", false, 0, 0},
      {"revolute", R"(<limit effort="1" velocity="1" upper="1"/>)", true, 0, 1},
      {"revolute", "", false, 0, 0},
      {"revolute", R"(<limit effort="1" velocity="1" lower="-1e16" upper="1e16"/>)", false, 0, 0},
      {"revolute", R"(<limit effort="1" velocity="1" lower="x" upper="1"/>)", false, 0, 0},
      {"continuous", R"(<limit effort="1" velocity="1" lower="0" upper="0"/>)", false, 0, 0},
      {"prismatic", R"(<limit effort="1" velocity="1" lower="0.05" upper="0.4"/>)", true, 0.05, 0.4},
      {"prismatic", "", false, 0, 0},
  };
  for (const Case& c : cases) {
    const JointModel j = joint(c.type, c.limit);
    EXPECT_EQ(j.limited, c.limited) << c.type << c.limit;
    EXPECT_DOUBLE_EQ(j.lower, c.lower) << c.limit;
    EXPECT_DOUBLE_EQ(j.upper, c.upper) << c.limit;
  }
}

TEST(UrdfImport, EffortZeroOrAbsentIsTenThousandAndSaid) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
<limit effort="0" velocity="2" lower="-1" upper="1"/></joint></robot>)");
  EXPECT_DOUBLE_EQ(m.joints[0].effort, 10000);
  EXPECT_DOUBLE_EQ(m.file_joints[0].effort, 0);
  EXPECT_DOUBLE_EQ(m.joints[0].velocity, 2);
  EXPECT_TRUE(says(m, Severity::note, "effort", 2)) << test::all_problems(m);
}

TEST(UrdfImport, DynamicsAreKept) {
  const BodyModel m = import_text(kArm);
  EXPECT_DOUBLE_EQ(m.joints[2].damping, 0.3);
  EXPECT_DOUBLE_EQ(m.joints[2].friction, 0.4);
}

TEST(UrdfImport, AllTypesAreRead) {
  std::string text = R"(<robot name="r"><link name="l0"/>)";
  const char* types[] = {"revolute", "continuous", "prismatic", "planar", "floating"};
  const JointType expected[] = {JointType::revolute, JointType::continuous, JointType::prismatic, JointType::planar,
                                JointType::floating};
  for (int i = 0; i < 5; ++i) {
    text += fmt::format(R"(<link name="l{1}"/><joint name="j{1}" type="{2}"><parent link="l{0}"/><child link="l{1}"/>
      <axis xyz="0 1 0"/></joint>)",
                        i, i + 1, types[i]);
  }
  const BodyModel m = import_text(text + "</robot>");
  ASSERT_EQ(m.joints.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(m.joints[i].type, expected[i]);
}

// a plate of 1 kg with a second one of 3 kg fixed 0.4 m beside it, turned by a quarter about z
constexpr const char* kFixed = R"(<robot name="r"><link name="base"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<link name="b"><inertial><origin xyz="0.1 0 0"/><mass value="3"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
  <collision><origin xyz="0.1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="mark"/>
<joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="weld" type="fixed"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0" rpy="0 0 1.5707963267948966"/></joint>
<joint name="mark_weld" type="fixed"><parent link="b"/><child link="mark"/><origin xyz="0 0 1"/></joint></robot>)";

TEST(UrdfImport, FixedChildrenAreMergedWithTheirInertia) {
  const BodyModel m = import_text(kFixed);
  ASSERT_EQ(m.links.size(), 2u);
  ASSERT_EQ(m.joints.size(), 1u);
  const Inertial& i = m.links[1].inertial;
  EXPECT_DOUBLE_EQ(i.mass, 4);
  // b's centre lies at (0.4, 0.1, 0); the sum's at 3/4 of it
  test::expect_near(i.center, {0.3, 0.075, 0}, 1e-12);
  // Steiner with the reduced mass 0.75 kg and d² = 0.17 m²; the turn exchanges b's x and y
  EXPECT_NEAR(i.tensor[0][0], 0.1 + 0.2 + 0.75 * 0.01, 1e-12);
  EXPECT_NEAR(i.tensor[1][1], 0.2 + 0.1 + 0.75 * 0.16, 1e-12);
  EXPECT_NEAR(i.tensor[2][2], 0.25 + 0.25 + 0.75 * 0.17, 1e-12);
  EXPECT_NEAR(i.tensor[0][1], -0.75 * 0.04, 1e-12);
  ASSERT_EQ(m.links[1].collisions.size(), 2u);
  test::expect_near(m.links[1].collisions[1].origin.position, {0.4, 0.1, 0}, 1e-12);
  ASSERT_EQ(m.merged.size(), 2u);
  EXPECT_EQ(m.merged[1].name, "mark");
  EXPECT_EQ(m.merged[1].link, 1);
  test::expect_near(m.merged[1].offset.position, {0.4, 0, 1}, 1e-12);
  EXPECT_EQ(m.file_links.size(), 4u);
  EXPECT_EQ(m.file_joints.size(), 3u);
}

TEST(UrdfImport, FixedJointsAreKeptWhenAsked) {
  ImportOptions options;
  options.keep_fixed = true;
  const BodyModel m = import_text(kFixed, options);
  // the frame without mass is merged all the same: it would be nailed to the world
  ASSERT_EQ(m.links.size(), 3u);
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[1].type, JointType::fixed);
  EXPECT_DOUBLE_EQ(m.links[2].inertial.mass, 3);
  ASSERT_EQ(m.merged.size(), 1u);
  EXPECT_EQ(m.merged[0].name, "mark");
}

TEST(UrdfImport, RootWithoutMassIsStaticUnlessLetGo) {
  const char* text =
      R"(<robot name="r"><link name="a"><collision><geometry><box size="0.1 0.2 0.5"/></geometry></collision></link></robot>)";
  EXPECT_DOUBLE_EQ(import_text(text).links[0].inertial.mass, 0);
  ImportOptions options;
  options.fixed_base = false;
  const Inertial free = import_text(text, options).links[0].inertial;
  EXPECT_NEAR(free.mass, 10, 1e-12);
  EXPECT_NEAR(free.tensor[0][0], 10.0 / 12 * (0.04 + 0.25), 1e-12);
}

TEST(UrdfImport, RootWithMassFloatsUnlessFixed) {
  const char* text = R"(<robot name="r"><link name="a"><inertial><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>)";
  EXPECT_DOUBLE_EQ(import_text(text).links[0].inertial.mass, 2);
  ImportOptions options;
  options.fixed_base = true;
  const BodyModel fixed = import_text(text, options);
  EXPECT_DOUBLE_EQ(fixed.links[0].inertial.mass, 0);
  EXPECT_DOUBLE_EQ(fixed.file_links[0].mass, 2);
}

TEST(UrdfImport, MovingLinksWithoutMassGetTheirShapes) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/>
<link name="ball"><collision><origin xyz="0 0 0.2"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="dot"/>
<joint name="j" type="continuous"><parent link="a"/><child link="ball"/><axis xyz="0 0 1"/></joint>
<joint name="k" type="continuous"><parent link="ball"/><child link="dot"/><axis xyz="0 0 1"/></joint></robot>)");
  const double mass = 1000 * 4.0 / 3 * kPi * 0.001;
  EXPECT_NEAR(m.links[1].inertial.mass, mass, 1e-12);
  test::expect_near(m.links[1].inertial.center, {0, 0, 0.2}, 1e-15);
  EXPECT_NEAR(m.links[1].inertial.tensor[1][1], 0.4 * mass * 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(m.links[2].inertial.mass, 0.001);
  EXPECT_TRUE(says(m, Severity::warning, "no mass", 2)) << test::all_problems(m);
  EXPECT_TRUE(says(m, Severity::warning, "no mass", 3));
}

TEST(UrdfImport, ImpossibleTensorsAreReplacedByTheShapes) {
  const auto box = [](const char* inertia) {
    return import_text(std::string(R"(<robot name="r"><link name="a"><inertial><mass value="6"/>)") + inertia +
                       R"(</inertial><collision><geometry><box size="1 2 3"/></geometry></collision></link></robot>)");
  };
  const char* bad[] = {R"(<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>)",
                       R"(<inertia ixx="-1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>)",
                       R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="3"/>)", ""};
  for (const char* inertia : bad) {
    const BodyModel m = box(inertia);
    EXPECT_NEAR(m.links[0].inertial.tensor[0][0], 6.0 / 12 * (4 + 9), 1e-12) << inertia;
    EXPECT_NEAR(m.links[0].inertial.tensor[2][2], 6.0 / 12 * (1 + 4), 1e-12) << inertia;
    EXPECT_TRUE(says(m, Severity::warning, "shape's", 1)) << inertia << test::all_problems(m);
  }
  const BodyModel good = box(R"(<inertia ixx="1" ixy="0.1" ixz="0" iyy="1" iyz="0" izz="1.5"/>)");
  EXPECT_DOUBLE_EQ(good.links[0].inertial.tensor[0][1], 0.1);
}

TEST(UrdfImport, InertialOriginTurnsTheTensor) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><inertial>
    <origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial></link></robot>)");
  test::expect_near(m.links[0].inertial.center, {0.1, 0.2, 0.3}, 1e-15);
  EXPECT_NEAR(m.links[0].inertial.tensor[0][0], 2, 1e-12);
  EXPECT_NEAR(m.links[0].inertial.tensor[1][1], 1, 1e-12);
}

TEST(UrdfImport, TinyMomentsAreRaisedForTheSolver) {
  // a rod: about its own axis a thousandth of the large moments at least
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="1e-9"/></inertial></link></robot>)");
  EXPECT_NEAR(m.links[0].inertial.tensor[2][2], 1e-4, 1e-15);
  EXPECT_NEAR(m.links[0].inertial.tensor[0][0], 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(m.file_links[0].tensor[2][2], 1e-9);
}

std::string finger(const char* mimic1, const char* mimic2) {
  return fmt::format(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="i" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0.2" upper="1" effort="1" velocity="1"/></joint>
<joint name="j" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>{}</joint>
<joint name="k" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>{}</joint>
</robot>)",
                     mimic1, mimic2);
}

TEST(UrdfImport, MimicChainsAreResolvedToTheirLeader) {
  const BodyModel m = import_text(finger(R"(<mimic joint="i" multiplier="2" offset="0.1"/>)",
                                         R"(<mimic joint="j" multiplier="-0.5" offset="0.3"/>)"));
  EXPECT_EQ(m.joints[1].mimic, 0);
  EXPECT_EQ(m.joints[2].mimic, 0);
  // k = -0.5 (2 i + 0.1) + 0.3
  EXPECT_DOUBLE_EQ(m.joints[2].mimic_multiplier, -1);
  EXPECT_DOUBLE_EQ(m.joints[2].mimic_offset, 0.25);
  // i starts at its lower limit 0.2
  EXPECT_DOUBLE_EQ(m.joints[1].start, 0.5);
  EXPECT_DOUBLE_EQ(m.joints[2].start, 0.05);
}

TEST(UrdfImport, MimicsThatCannotBeAreDropped) {
  struct Case {
    const char *first, *second, *text;
  };
  const Case cases[] = {{R"(<mimic joint="nope"/>)", "", "'nope'"},
                        {R"(<mimic joint="j"/>)", "", "itself"},
                        {R"(<mimic joint="k"/>)", R"(<mimic joint="j"/>)", "circle"},
                        {R"(<mimic/>)", "", "names no joint"}};
  for (const Case& c : cases) {
    const BodyModel m = import_text(finger(c.first, c.second));
    ASSERT_EQ(m.joints.size(), 3u);
    EXPECT_EQ(m.joints[1].mimic, -1) << c.text;
    EXPECT_EQ(m.joints[2].mimic, -1) << c.text;
    EXPECT_TRUE(says(m, Severity::error, c.text, 3)) << test::all_problems(m);
  }
}

TEST(UrdfImport, MaterialsAreFoundByName) {
  const BodyModel m =
      import_text(R"(<robot name="r"><material name="red"><color rgba="1 0 0 0.5"/></material><link name="a">
    <visual><geometry><box size="1 1 1"/></geometry><material name="red"/></visual>
    <visual><geometry><box size="1 1 1"/></geometry><material name="own"><color rgba="0 1 0 1"/></material></visual>
    <visual><geometry><box size="1 1 1"/></geometry><material name="own"/></visual>
    <visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>)");
  const std::vector<PlacedShape>& v = m.links[0].visuals;
  ASSERT_EQ(v.size(), 4u);
  EXPECT_EQ(v[0].color, Vec3(1, 0, 0));
  EXPECT_DOUBLE_EQ(v[0].alpha, 0.5);
  EXPECT_EQ(v[2].color, Vec3(0, 1, 0));
  EXPECT_FALSE(v[3].color);
}

TEST(UrdfImport, GeometriesIncludingCapsuleAndPlane) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a">
    <collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision>
    <collision><geometry><cylinder radius="0.2" length="0.6"/></geometry></collision>
    <collision><geometry><plane normal="0 2 0"/></geometry></collision>
    <collision><origin xyz="1 2 3"/><geometry><box size="1 2 3"/></geometry></collision></link></robot>)");
  const std::vector<PlacedShape>& c = m.links[0].collisions;
  ASSERT_EQ(c.size(), 4u);
  EXPECT_EQ(c[0].shape.kind, ShapeKind::capsule);
  EXPECT_DOUBLE_EQ(c[0].shape.height, 0.4);
  EXPECT_EQ(c[1].shape.kind, ShapeKind::cylinder);
  EXPECT_EQ(c[2].shape.normal, Vec3(0, 1, 0));
  EXPECT_EQ(c[3].shape.size, Vec3(1, 2, 3));
  EXPECT_EQ(c[3].origin.position, Vec3(1, 2, 3));
}

TEST(UrdfImport, NothingOfAnUnknownKindStopsTheRest) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a">
<collision><geometry><cdf/></geometry></collision>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<transmission name="t"/><gazebo/><gazebo/></robot>)");
  EXPECT_EQ(m.links[0].collisions.size(), 1u);
  EXPECT_TRUE(says(m, Severity::error, "<cdf>", 2));
  EXPECT_TRUE(says(m, Severity::note, "2 <gazebo> elements", 4)) << test::all_problems(m);
  EXPECT_TRUE(says(m, Severity::note, "1 <transmission> element", 4));
}

TEST(UrdfImport, SameTextGivesTheSameModel) {
  const BodyModel a = import_text(kFixed);
  const BodyModel b = import_text(kFixed);
  ASSERT_EQ(a.links.size(), b.links.size());
  for (std::size_t i = 0; i < a.links.size(); ++i) {
    EXPECT_EQ(a.links[i].inertial.tensor, b.links[i].inertial.tensor);
    EXPECT_EQ(a.links[i].start.position, b.links[i].start.position);
  }
}

}  // namespace
}  // namespace limber
