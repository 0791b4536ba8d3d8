// Masses and tensors of links: from the file, merged, estimated from shapes, repaired.
#include "model/mesh/mass_properties.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "robots.h"

namespace limber::model {
namespace {

using test::has_problem;
using test::import_text;
using test::kFixed;

TEST(UrdfMass, MergesFixedChildrenWithTheirInertia) {
  const BodyModel m = import_text(kFixed);
  ASSERT_EQ(m.links.size(), 2u);
  ASSERT_EQ(m.joints.size(), 1u);
  const Inertial& i = m.links[1].inertial;
  EXPECT_DOUBLE_EQ(i.mass, 4);
  // b's center is at (0.4, 0.1, 0), that of the sum at 3/4 of it
  test::expect_near(i.center, {0.3, 0.075, 0}, 1e-12);
  // parallel axis theorem with the reduced mass 0.75 kg and d² = 0.17 m²; the rotation swaps b's x and y
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

TEST(UrdfMass, KeepsFixedJointsIfRequested) {
  ImportOptions options;
  options.keep_fixed = true;
  const BodyModel m = import_text(kFixed, options);
  // a link without mass is merged anyway, because it would be static
  ASSERT_EQ(m.links.size(), 3u);
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[1].type, JointType::fixed);
  EXPECT_DOUBLE_EQ(m.links[2].inertial.mass, 3);
  ASSERT_EQ(m.merged.size(), 1u);
  EXPECT_EQ(m.merged[0].name, "mark");
}

TEST(UrdfMass, RootWithoutMassIsStaticByDefault) {
  const char* text =
      R"(<robot name="r"><link name="a"><collision><geometry><box size="0.1 0.2 0.5"/></geometry></collision></link></robot>)";
  EXPECT_DOUBLE_EQ(import_text(text).links[0].inertial.mass, 0);
  ImportOptions options;
  options.fixed_base = false;
  const Inertial free = import_text(text, options).links[0].inertial;
  EXPECT_NEAR(free.mass, 10, 1e-12);
  EXPECT_NEAR(free.tensor[0][0], 10.0 / 12 * (0.04 + 0.25), 1e-12);
}

TEST(UrdfMass, RootWithMassIsFreeByDefault) {
  const char* text = R"(<robot name="r"><link name="a"><inertial><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>)";
  EXPECT_DOUBLE_EQ(import_text(text).links[0].inertial.mass, 2);
  ImportOptions options;
  options.fixed_base = true;
  const BodyModel fixed = import_text(text, options);
  EXPECT_DOUBLE_EQ(fixed.links[0].inertial.mass, 0);
  EXPECT_DOUBLE_EQ(fixed.file_links[0].mass, 2);
}

TEST(UrdfMass, EstimatesMissingMassesFromShapes) {
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
  EXPECT_TRUE(has_problem(m, Severity::warning, "no mass", 2)) << test::all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "no mass", 3));
}

TEST(UrdfMass, ReplacesImpossibleTensors) {
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
    EXPECT_TRUE(has_problem(m, Severity::warning, "shape's", 1)) << inertia << test::all_problems(m);
  }
  const BodyModel good = box(R"(<inertia ixx="1" ixy="0.1" ixz="0" iyy="1" iyz="0" izz="1.5"/>)");
  EXPECT_DOUBLE_EQ(good.links[0].inertial.tensor[0][1], 0.1);
}

TEST(UrdfMass, InertialOriginRotatesTheTensor) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><inertial>
    <origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial></link></robot>)");
  test::expect_near(m.links[0].inertial.center, {0.1, 0.2, 0.3}, 1e-15);
  EXPECT_NEAR(m.links[0].inertial.tensor[0][0], 2, 1e-12);
  EXPECT_NEAR(m.links[0].inertial.tensor[1][1], 1, 1e-12);
}

TEST(UrdfMass, RaisesTinyMomentsForTheSolver) {
  // a rod: the moment about its axis is raised to a thousandth of the large ones
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="1e-9"/></inertial></link></robot>)");
  EXPECT_NEAR(m.links[0].inertial.tensor[2][2], 1e-4, 1e-15);
  EXPECT_NEAR(m.links[0].inertial.tensor[0][0], 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(m.file_links[0].tensor[2][2], 1e-9);
}

}  // namespace
}  // namespace limber::model
