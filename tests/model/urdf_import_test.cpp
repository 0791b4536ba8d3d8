// Import of valid files: order, frames, limits, merging, masses, mimic joints, start poses.
#include "model/urdf/import.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "robots.h"

namespace limber::model {
namespace {

using test::has_problem;
using test::import_text;
using test::kArm;
using test::kFixed;

TEST(UrdfImport, OrdersLinksAndJointsDepthFirst) {
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

TEST(UrdfImport, OrdersJointsOfABranchAsInTheFile) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="x"/><link name="y"/><link name="x2"/>
    <joint name="to_y" type="continuous"><parent link="a"/><child link="y"/><axis xyz="0 0 1"/></joint>
    <joint name="to_x" type="continuous"><parent link="a"/><child link="x"/><axis xyz="0 0 1"/></joint>
    <joint name="to_x2" type="continuous"><parent link="x"/><child link="x2"/><axis xyz="0 0 1"/></joint></robot>)");
  ASSERT_EQ(m.links.size(), 4u);
  EXPECT_EQ(m.links[1].name, "y");
  EXPECT_EQ(m.links[2].name, "x");
  EXPECT_EQ(m.links[3].name, "x2");
}

TEST(UrdfImport, NormalizesAxesAndAlignsFrames) {
  const BodyModel m = import_text(kArm);
  test::expect_near(m.file_joints[0].axis, {0, 0, 1}, 1e-15);
  test::expect_near(m.file_joints[2].axis, Vec3(1, 1, 0) / std::sqrt(2.0), 1e-15);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 z = m.joints[i].frame_in_child.rotation * Vec3(0, 0, 1);
    test::expect_near(z, m.file_joints[i].axis, 1e-12, m.joints[i].name);
    // at the home pose, both frames of a joint coincide
    const Pose a = m.links[static_cast<std::size_t>(m.joints[i].parent)].home * m.joints[i].frame_in_parent;
    const Pose b = m.links[static_cast<std::size_t>(m.joints[i].child)].home * m.joints[i].frame_in_child;
    test::expect_near(a.position, b.position, 1e-12);
    EXPECT_NEAR(test::angle_between(a.rotation, b.rotation), 0, 1e-7);
  }
}

TEST(UrdfImport, PlusZKeepsTheFrameAndMinusZRotatesAboutX) {
  const char* text = R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="up" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
    <joint name="down" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 -1"/></joint></robot>)";
  const BodyModel m = import_text(text);
  EXPECT_EQ(m.joints[0].frame_in_child.rotation, quat_identity());
  EXPECT_EQ(m.joints[1].frame_in_child.rotation, quat_xyzw(1, 0, 0, 0));
}

TEST(UrdfImport, ReadsLimitsByPresence) {
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

TEST(UrdfImport, DefaultsMissingEffortAndReportsIt) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
<limit effort="0" velocity="2" lower="-1" upper="1"/></joint></robot>)");
  EXPECT_DOUBLE_EQ(m.joints[0].effort, 10000);
  EXPECT_DOUBLE_EQ(m.file_joints[0].effort, 0);
  EXPECT_DOUBLE_EQ(m.joints[0].velocity, 2);
  EXPECT_TRUE(has_problem(m, Severity::note, "effort", 2)) << test::all_problems(m);
}

TEST(UrdfImport, ReadsDynamics) {
  const BodyModel m = import_text(kArm);
  EXPECT_DOUBLE_EQ(m.joints[2].damping, 0.3);
  EXPECT_DOUBLE_EQ(m.joints[2].friction, 0.4);
}

TEST(UrdfImport, ReadsAllJointTypes) {
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

TEST(UrdfImport, ResolvesMaterialsByName) {
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

TEST(UrdfImport, ReadsAllGeometriesIncludingCapsuleAndPlane) {
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

TEST(UrdfImport, UnknownElementsDoNotStopTheImport) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a">
<collision><geometry><cdf/></geometry></collision>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<transmission name="t"/><gazebo/><gazebo/></robot>)");
  EXPECT_EQ(m.links[0].collisions.size(), 1u);
  EXPECT_TRUE(has_problem(m, Severity::error, "<cdf>", 2));
  EXPECT_TRUE(has_problem(m, Severity::note, "2 <gazebo> elements", 4)) << test::all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "1 <transmission> element", 4));
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
}  // namespace limber::model
