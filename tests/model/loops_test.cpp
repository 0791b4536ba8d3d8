// Joints that close loops, in URDF and MJCF files.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "import_text.h"
#include "model/import.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::has_problem;
using test::import_text;

BodyModel import_mjcf(const std::string& text, const ImportOptions& options = {}) {
  MeshLibrary meshes;
  const auto model = import_model_text(text, "model.xml", options, meshes);
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

void expect_at(const Vec3& a, const Vec3& b, double tolerance = 1e-12) { EXPECT_LE(glm::length(a - b), tolerance); }

// The pose of the loop's frame, as the start pose of each of its links places it.
Vec3 point_of_parent(const BodyModel& m, const JointModel& loop) {
  return m.links[static_cast<std::size_t>(loop.parent)].start * loop.frame_in_parent.position;
}
Vec3 point_of_child(const BodyModel& m, const JointModel& loop) {
  return m.links[static_cast<std::size_t>(loop.child)].start * loop.frame_in_child.position;
}

std::string link_text(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><mass value='1'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' "
         "iyz='0'/></inertial></link>\n";
}
std::string hinge_text(const std::string& name, const std::string& parent, const std::string& child,
                       const std::string& xyz, const std::string& limit = "effort='1' velocity='1'") {
  return "<joint name='" + name + "' type='continuous'><origin xyz='" + xyz + "'/><parent link='" + parent +
         "'/><child link='" + child + "'/><axis xyz='0 0 1'/><limit " + limit + "/></joint>\n";
}
std::string frame_text(const std::string& name, const std::string& parent, const std::string& xyz) {
  return "<link name='" + name +
         "'><inertial><mass value='1e-9'/><inertia ixx='0' iyy='0' izz='0' ixy='0' ixz='0' "
         "iyz='0'/></inertial></link>\n<joint name='" +
         name + "_frame' type='fixed'><origin xyz='" + xyz + "'/><parent link='" + parent + "'/><child link='" + name +
         "'/></joint>\n";
}

std::string robot_with(const std::string& closing) {
  return "<robot name='r' xmlns:limber='https://limber/urdf'>\n" + link_text("base") + link_text("crank") +
         link_text("coupler") + link_text("rocker") + hinge_text("a", "base", "crank", "0 0 0") +
         hinge_text("b", "crank", "coupler", "0 1 0") + hinge_text("d", "base", "rocker", "2 0 0") + closing +
         "</robot>";
}

const std::string kLoopText =
    "<limber:loop name='c' type='revolute'><parent link='coupler'><origin xyz='2 0 0'/></parent>"
    "<child link='rocker'><origin xyz='0 1 0'/></child><axis xyz='0 0 1'/><limit lower='-1' upper='2'/>"
    "<dynamics friction='.5'/></limber:loop>";

TEST(Loops, ExtensionClosesALoop) {
  const BodyModel m = import_text(robot_with(kLoopText));
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  const JointModel& loop = m.loops[0];
  EXPECT_EQ(loop.name, "c");
  EXPECT_EQ(loop.type, JointType::revolute);
  EXPECT_EQ(m.links[static_cast<std::size_t>(loop.parent)].name, "coupler");
  EXPECT_EQ(m.links[static_cast<std::size_t>(loop.child)].name, "rocker");
  EXPECT_TRUE(loop.limited);
  EXPECT_EQ(loop.lower, -1);
  EXPECT_EQ(loop.upper, 2);
  EXPECT_EQ(loop.friction, 0.5);
  expect_at(point_of_parent(m, loop), {2, 1, 0});
  expect_at(point_of_child(m, loop), {2, 1, 0});
  EXPECT_FALSE(loop.driven);
}

TEST(Loops, RootIsNeverTheChild) {
  const BodyModel m = import_text(
      robot_with("<limber:loop name='c' type='revolute'><parent link='coupler'><origin xyz='2 0 0'/></parent>"
                 "<child link='base'><origin xyz='2 1 0'/></child><axis xyz='0 0 1'/><limit lower='-1' "
                 "upper='2'/></limber:loop>"));
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].parent, 0);
  EXPECT_EQ(m.links[static_cast<std::size_t>(m.loops[0].child)].name, "coupler");
  EXPECT_EQ(m.loops[0].lower, -2);
  EXPECT_EQ(m.loops[0].upper, 1);
}

TEST(Loops, InvalidOnesAreReported) {
  const auto problem_of = [](const std::string& closing, const std::string& text) {
    const BodyModel m = import_text(robot_with(closing));
    EXPECT_TRUE(m.loops.empty()) << closing;
    EXPECT_NE(all_problems(m).find(text), std::string::npos) << all_problems(m);
  };
  problem_of("<limber:loop name='c' type='revolute'><parent link='coupler'/></limber:loop>",
             "loop 'c' names no child link; the loop stays open");
  problem_of("<limber:loop name='c' type='fixed'><parent link='couple'/><child link='rocker'/></limber:loop>",
             "its parent link 'couple' is not part of the tree; did you mean 'coupler'?");
  problem_of("<limber:loop name='c' type='floating'><parent link='coupler'/><child link='rocker'/></limber:loop>",
             "a floating joint closes nothing");
  problem_of("<limber:loop name='c' type='fixed'><parent link='coupler'/><child link='coupler'/></limber:loop>",
             "both sides are on the same rigid link");
  problem_of("<limber:lop name='c'/>", "Did you mean <limber:loop>?");
}

TEST(Loops, OpenOnesAndTakenNamesAreReported) {
  const BodyModel m = import_text(
      robot_with("<limber:loop name='a' type='ball'><parent link='coupler'/><child link='rocker'/></limber:loop>"));
  ASSERT_EQ(m.loops.size(), 1u);
  EXPECT_EQ(m.loops[0].name, "a_2");
  EXPECT_EQ(m.loops[0].type, JointType::spherical);
  EXPECT_NE(all_problems(m).find("loop 'a' has the name of another joint; it is called 'a_2'"), std::string::npos);
  EXPECT_NE(all_problems(m).find("loop 'a_2' is open at the start by 2.24e+03 mm"), std::string::npos)
      << all_problems(m);
}

TEST(Loops, ClosingFramesCloseALoopWithABallJoint) {
  const BodyModel m = import_text(
      robot_with(frame_text("closing_top_1", "coupler", "2 0 0") + frame_text("closing_top_2", "rocker", "0 1 0")));
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].name, "closing_top");
  EXPECT_EQ(m.loops[0].type, JointType::spherical);
  expect_at(point_of_parent(m, m.loops[0]), {2, 1, 0});
  expect_at(point_of_child(m, m.loops[0]), {2, 1, 0});
  EXPECT_EQ(m.links.size(), 4u);
}

TEST(Loops, ClosingFramesOnAnAxisCloseALoopWithAHinge) {
  const BodyModel m = import_text(robot_with(
      frame_text("closing_top_1", "coupler", "2 0 0") + frame_text("closing_top_2", "rocker", "0 1 0") +
      frame_text("closing_top_1_z", "coupler", "2 0.1 0") + frame_text("closing_top_2_z", "rocker", "0 1.1 0")));
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].type, JointType::continuous);
  expect_at(m.loops[0].frame_in_parent.rotation * Vec3(0, 0, 1), {0, 1, 0});
  expect_at(m.loops[0].frame_in_child.rotation * Vec3(0, 0, 1), {0, 1, 0});
}

TEST(Loops, ExtensionReplacesClosingFrames) {
  const BodyModel m = import_text(
      robot_with(frame_text("closing_top_1", "coupler", "2 0 0") + frame_text("closing_top_2", "rocker", "0 1 0") +
                 "<limber:loop name='weld' type='fixed'><parent link='closing_top_1'/><child "
                 "link='closing_top_2'/></limber:loop>"));
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].type, JointType::fixed);
  expect_at(point_of_parent(m, m.loops[0]), {2, 1, 0});
}

TEST(Loops, AClosingFrameAloneIsReported) {
  const BodyModel m = import_text(robot_with(frame_text("closing_top_1", "coupler", "2 0 0")));
  EXPECT_TRUE(m.loops.empty());
  EXPECT_NE(all_problems(m).find("there is no link 'closing_top_2' to close a loop with"), std::string::npos);
}

TEST(Loops, FramesWithoutMassAreReportedOnce) {
  const BodyModel m = import_text(
      robot_with(frame_text("closing_top_1", "coupler", "2 0 0") + frame_text("closing_top_2", "rocker", "0 1 0")));
  EXPECT_EQ(m.links[2].inertial.mass, 1);
  EXPECT_NE(all_problems(m).find("2 links of 1e-07 kg or less, first 'closing_top_1', only mark a frame"),
            std::string::npos)
      << all_problems(m);
  EXPECT_EQ(all_problems(m).find("is too small"), std::string::npos) << all_problems(m);
  ImportOptions keep;
  keep.keep_fixed = true;
  EXPECT_EQ(import_text(robot_with(frame_text("f", "coupler", "2 0 0")), keep).links.size(), 4u);
}

constexpr const char* kMjcfLinkage =
    R"(<mujoco><worldbody><body name="base"><geom size=".1"/><site name="pin" pos="0 3 0"/>
<body name="crank"><joint name="a"/><geom size=".1" pos=".5 0 0"/><body name="coupler" pos="1 0 0" euler="0 0 90"><joint name="b"/><geom size=".1" pos=".5 0 0"/><site name="tip" pos="3 0 0"/></body></body>
<body name="rocker" pos="0 1 0"><joint name="d"/><geom size=".1"/></body></body></worldbody>
<equality>)";

BodyModel import_linkage(const std::string& equality) {
  return import_mjcf(kMjcfLinkage + equality + "</equality></mujoco>");
}

TEST(Loops, ConnectKeepsTheHomePoseTogether) {
  const BodyModel m = import_linkage(R"(<connect name="c" body1="coupler" body2="rocker" anchor="3 0 0"/>)");
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].name, "c");
  EXPECT_EQ(m.loops[0].type, JointType::spherical);
  expect_at(point_of_parent(m, m.loops[0]), {1, 3, 0});
  expect_at(point_of_child(m, m.loops[0]), {1, 3, 0});
  expect_at(m.loops[0].frame_in_child.position, {1, 2, 0});
}

TEST(Loops, ConnectToTheWorldUsesTheFixedRoot) {
  const BodyModel m = import_linkage(R"(<connect body1="coupler" anchor="3 0 0"/>)");
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].parent, 0);
  expect_at(m.loops[0].frame_in_parent.position, {1, 3, 0});
}

TEST(Loops, ConnectOfSitesMayStartOpen) {
  const BodyModel m = import_linkage(R"(<connect site1="tip" site2="pin"/>)");
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "is open at the start by 1e+03 mm", 4)) << all_problems(m);
}

TEST(Loops, WeldHasTheHomePoseOrAGivenOne) {
  const BodyModel m = import_linkage(R"(<weld body1="coupler" body2="rocker"/>)");
  ASSERT_EQ(m.loops.size(), 1u) << all_problems(m);
  EXPECT_EQ(m.loops[0].type, JointType::fixed);
  EXPECT_EQ(all_problems(m).find("is open"), std::string::npos) << all_problems(m);
  const BodyModel given = import_linkage(R"(<weld body1="coupler" body2="rocker" relpose="0 1 0 1 0 0 0"/>)");
  ASSERT_EQ(given.loops.size(), 1u);
  expect_at(given.loops[0].frame_in_parent.position, {0, 1, 0});
  expect_at(given.loops[0].frame_in_child.position, {0, 0, 0});
}

TEST(Loops, InvalidEqualitiesAreReported) {
  const auto problem_of = [](const std::string& equality, const std::string& text) {
    const BodyModel m = import_linkage(equality);
    EXPECT_TRUE(m.loops.empty()) << equality;
    EXPECT_NE(all_problems(m).find(text), std::string::npos) << all_problems(m);
  };
  problem_of(R"(<connect body1="couple" body2="rocker" anchor="0 0 0"/>)",
             "body 'couple' does not exist; did you mean");
  problem_of(R"(<connect site1="tap" site2="pin"/>)", "site 'tap' does not exist; did you mean 'tip'?");
  problem_of(R"(<connect body1="rocker" body2="rocker" anchor="0 0 0"/>)", "connects a body to itself");
  problem_of(R"(<weld active="false" body1="coupler" body2="rocker"/>)",
             "<weld> in <equality> ignored: it is not active");
  problem_of(R"(<conect body1="coupler" body2="rocker"/>)", "Did you mean <connect>?");
  problem_of(R"(<flex flex="f"/>)", "<flex> in <equality> ignored");
  problem_of(R"(<connect body1="coupler" body2="rocker" anchr="0 0 0" anchor="x"/>)", "Did you mean 'anchor'?");
}

TEST(Loops, LoopsToOtherTreesNeedTheWorld) {
  const std::string text = R"(<mujoco><worldbody><body name="a"><freejoint/><geom size=".1"/></body>
<body name="b" pos="1 0 0"><freejoint/><geom size=".1"/></body></worldbody>
<equality><connect body1="a" body2="b" anchor=".5 0 0"/></equality></mujoco>)";
  const BodyModel alone = import_mjcf(text);
  EXPECT_TRUE(alone.loops.empty());
  EXPECT_TRUE(has_problem(alone, Severity::warning, "leads to a body that is not part of this tree", 3))
      << all_problems(alone);
  ImportOptions all;
  all.root = "world";
  EXPECT_EQ(import_mjcf(text, all).loops.size(), 1u);
}

TEST(Loops, FixedTendonsCoupleTwoJoints) {
  const BodyModel m = import_mjcf(std::string(kMjcfLinkage) + R"(<tendon tendon1="t" polycoef=".5"/></equality>
<tendon><fixed name="t"><joint joint="a" coef="2"/><joint joint="b" coef="-4"/></fixed></tendon>
<actuator><motor tendon="t" ctrlrange="-3 3"/></actuator></mujoco>)");
  const auto joint = [&](const std::string& name) {
    return *std::find_if(m.joints.begin(), m.joints.end(), [&](const JointModel& j) { return j.name == name; });
  };
  EXPECT_GE(joint("b").mimic, 0) << all_problems(m);
  EXPECT_EQ(joint("b").mimic_multiplier, 0.5);
  EXPECT_EQ(joint("b").mimic_offset, -0.125);
  EXPECT_TRUE(joint("a").driven);
  EXPECT_EQ(joint("a").effort, 6);
}

TEST(UrdfDialects, AWrittenEffortOfZeroIsPassiveIfOthersHaveEffort) {
  const BodyModel m = import_text("<robot name='r'>\n" + link_text("base") + link_text("w") + link_text("x") +
                                  link_text("y") + hinge_text("w", "base", "w", "0 0 0", "effort='0' velocity='0'") +
                                  hinge_text("x", "base", "x", "0 0 0", "effort='2' velocity='1'") +
                                  hinge_text("y", "base", "y", "0 0 0", "velocity='1'") + "</robot>");
  EXPECT_FALSE(m.joints[0].driven);
  EXPECT_TRUE(m.joints[1].driven);
  EXPECT_TRUE(m.joints[2].driven);
  EXPECT_EQ(m.joints[0].velocity, 0);
  EXPECT_EQ(m.joints[1].effort, 2);
  EXPECT_EQ(m.joints[2].effort, 10000);
  EXPECT_TRUE(has_problem(m, Severity::note, "1 joint has effort 0, first 'w', and gets no motor", 6))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "1 joint has no effort, first 'y'; it gets a servo of 10000 N·m or N", 8))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "1 joint has velocity 0, first 'w', which means no limit", 6))
      << all_problems(m);
}

TEST(UrdfDialects, AllEffortsZeroMeansTheDefaultServo) {
  const BodyModel m = import_text("<robot name='r'>\n" + link_text("base") + link_text("w") + link_text("x") +
                                  hinge_text("w", "base", "w", "0 0 0", "effort='0' velocity='1'") +
                                  hinge_text("x", "base", "x", "0 0 0", "effort='0' velocity='1'") + "</robot>");
  EXPECT_TRUE(m.joints[0].driven);
  EXPECT_EQ(m.joints[0].effort, 10000);
  EXPECT_TRUE(has_problem(m, Severity::note, "2 joints have no effort, first 'w'; each gets a servo", 5))
      << all_problems(m);
}

TEST(UrdfDialects, BallJointsAreSpherical) {
  for (const char* const type : {"spherical", "ball"}) {
    const BodyModel m =
        import_text("<robot name='r'>\n" + link_text("base") + link_text("w") + "<joint name='j' type='" + type +
                    "'><parent link='base'/><child link='w'/><limit lower='-1' upper='1'/></joint></robot>");
    ASSERT_EQ(m.joints.size(), 1u);
    EXPECT_EQ(m.joints[0].type, JointType::spherical);
    EXPECT_FALSE(m.joints[0].driven);
    EXPECT_EQ(m.joints[0].frame_in_parent.rotation, quat_identity());
    EXPECT_TRUE(has_problem(m, Severity::warning, "the limits of a spherical joint are ignored", 4)) << all_problems(m);
    EXPECT_EQ(all_problems(m).find("has no axis"), std::string::npos);
  }
}

TEST(UrdfDialects, BallJointsHaveConesAndTwistLimits) {
  const auto limits = [](const std::string& attributes) {
    return import_text("<robot name='r'>\n" + link_text("base") + link_text("w") +
                       "<joint name='j' type='spherical'><parent link='base'/><child link='w'/><limit " + attributes +
                       "/></joint></robot>");
  };
  const BodyModel m = limits("cone='0.5' twist_lower='-0.2' twist_upper='0.3' rotation='1.5'");
  EXPECT_EQ(m.joints[0].ball.cone, 0.5);
  EXPECT_EQ(m.joints[0].ball.twist_lower, -0.2);
  EXPECT_EQ(m.joints[0].ball.twist_upper, 0.3);
  EXPECT_EQ(m.joints[0].ball.angle, 1.5);
  EXPECT_EQ(all_problems(m).find("ignored"), std::string::npos) << all_problems(m);
  const BodyModel free = limits("effort='1'");
  EXPECT_EQ(free.joints[0].ball.cone, kPi);
  EXPECT_GT(free.joints[0].ball.twist_lower, free.joints[0].ball.twist_upper);
  EXPECT_EQ(free.joints[0].ball.angle, kPi);
  EXPECT_EQ(limits("cone='-1'").joints[0].ball.cone, kPi);
  const BodyModel half = limits("twist_lower='0'");
  EXPECT_GT(half.joints[0].ball.twist_lower, half.joints[0].ball.twist_upper);
  EXPECT_TRUE(has_problem(half, Severity::warning, "has only one limit of its twist", 4)) << all_problems(half);
  const BodyModel crossed = limits("twist_lower='1' twist_upper='-0.5'");
  EXPECT_GT(crossed.joints[0].ball.twist_lower, crossed.joints[0].ball.twist_upper);
  EXPECT_TRUE(has_problem(crossed, Severity::warning, "twist_lower 1 is above twist_upper -0.5", 4));
}

}  // namespace
}  // namespace limber::model
