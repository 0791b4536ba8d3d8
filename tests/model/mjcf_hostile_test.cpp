// MJCF files that are broken or hostile: they are rejected or repaired, within bounded time and memory.
#include <string>

#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "model/import.h"
#include "model/mjcf/document.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::has_problem;

Result<std::shared_ptr<const BodyModel>> import(const std::string& text) {
  MeshLibrary meshes;
  return import_model_text(text, "model.xml", {}, meshes);
}

BodyModel body_with(const std::string& content) {
  const auto model = import("<mujoco><worldbody><body name='b'><freejoint/><geom size='.1'/>\n" + content +
                            "</body></worldbody></mujoco>");
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

TEST(MjcfHostile, RejectsFilesWithoutABody) {
  EXPECT_EQ(import("<mujoco/>").error(),
            "model.xml:1: no body and no geom found. Write <worldbody> with at least one <body>.");
  EXPECT_EQ(import("<mujoco><worldbody></mujoco>").error(),
            "model.xml:1: an element is not closed, or closed by another's end tag. Close every element with its own "
            "end tag, in order.");
}

TEST(MjcfHostile, BoundsIncludes) {
  const test::Files files;
  // each file includes itself and the next one
  for (int i = 0; i < 150; ++i) {
    files.write("f" + std::to_string(i) + ".xml", "<mujoco><include file='f" + std::to_string(i) +
                                                      ".xml'/><include file='f" + std::to_string(i + 1) +
                                                      ".xml'/></mujoco>");
  }
  const std::string path = files.write("model.xml",
                                       "<mujoco><include file='f0.xml'/><include/><include file='none.xml'/>"
                                       "<include file='/'/><worldbody><geom size='1'/></worldbody></mujoco>");
  const auto model = import_model(path);
  ASSERT_TRUE(model) << model.error();
  EXPECT_TRUE(has_problem(**model, Severity::error, "includes are nested too deep", 1)) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "the file was read already", 1)) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "<include> names no file", 1)) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "none.xml: file not found", 1)) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "is a folder or a device", 1)) << all_problems(**model);
}

TEST(MjcfHostile, ReportsFaultsInIncludedFiles) {
  const test::Files files;
  files.write("broken.xml", "<mujoco>\n<worldbody></mujoco>");
  files.write("robot.xml", "<robot/>");
  const std::string path = files.write("model.xml",
                                       "<mujoco>\n<include file='broken.xml'/>\n<include file='robot.xml'/>"
                                       "<worldbody><geom size='1'/></worldbody></mujoco>");
  const auto model = import_model(path);
  ASSERT_TRUE(model) << model.error();
  EXPECT_TRUE(
      has_problem(**model, Severity::error, "<include file='broken.xml'> ignored: line 2: an element is not closed", 2))
      << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "the root element is <robot>, not <mujoco>", 3))
      << all_problems(**model);
}

TEST(MjcfHostile, RejectsBadNumbers) {
  for (const char* const size : {"nan", "inf", "-1", "0", "1e300", "1e9", "1e13", "", "x", "0,5", "1 2 3 4"}) {
    const BodyModel m = body_with(std::string("<geom size='") + size + "'/>");
    ASSERT_EQ(m.links.size(), 1u) << size;
    EXPECT_EQ(m.links[0].collisions.size(), 1u) << size;
    EXPECT_TRUE(has_problem(m, Severity::error, "", 2)) << size << '\n' << all_problems(m);
  }
  const BodyModel odd = body_with(
      R"(<inertial pos="0 0 0" mass="nan" diaginertia="1 1 1"/><body pos="1e9 0 0" quat="0 0 0 0"><joint axis="0 0 0" range="5 -5" damping="-1"/>
<inertial mass="1" diaginertia="1 1 9"/></body><body euler="1 2"><joint type="spiral"/></body>)");
  EXPECT_TRUE(has_problem(odd, Severity::error, "<inertial> has no valid mass", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::error, "farther than 10000 m", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::error, "quat is not a direction", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::error, "axis 0 0 0 is not a direction", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::error, "can't be a limit", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::warning, "its inertia tensor is impossible", 2)) << all_problems(odd);
  EXPECT_TRUE(has_problem(odd, Severity::error, "'spiral' is not a joint type", 3)) << all_problems(odd);
}

TEST(MjcfHostile, BoundsNestingAndCounts) {
  std::string deep = "<mujoco><worldbody>";
  for (int i = 0; i < 20000; ++i) deep += "<body><joint/><geom size='.1'/>";
  for (int i = 0; i < 20000; ++i) deep += "</body>";
  const auto nested = import(deep + "</worldbody></mujoco>");
  ASSERT_TRUE(nested) << nested.error();
  EXPECT_LT((*nested)->links.size(), 96u);
  EXPECT_TRUE(has_problem(**nested, Severity::error, "elements are nested more than 96 deep", 1));
  std::string frames = "<mujoco><worldbody>";
  for (int i = 0; i < 100; ++i) frames += "<frame pos='1 0 0'>";
  frames += "<geom size='1'/>";
  for (int i = 0; i < 100; ++i) frames += "</frame>";
  EXPECT_FALSE(import(frames + "</worldbody></mujoco>"));
  std::string many;
  for (int i = 0; i < 1200; ++i) many += "<geom size='.1'/>";
  EXPECT_TRUE(has_problem(body_with(many), Severity::error, "a body has more than 1000 geoms", 2));
}

// Takes linear time; each would take minutes in quadratic time.
TEST(MjcfHostile, ManyEqualAndUnknownNamesAreReported) {
  std::string bodies, actuators;
  for (int i = 0; i < 9000; ++i) {
    bodies +=
        "<body name='n'><joint name='n'/><joint/><geom size='.1' mass='1' sizes='1' contype='0' "
        "conaffinity='0'/></body>";
    actuators += "<motor joint='m" + std::to_string(i) + "'/><motor joint='n'/>";
  }
  const auto model = import("<mujoco><worldbody><body name='r'>" + bodies + "</body></worldbody><actuator>" +
                            actuators + actuators + "</actuator></mujoco>");
  ASSERT_TRUE(model) << model.error();
  EXPECT_EQ((*model)->links.size(), 18001u);
  EXPECT_EQ((*model)->links.back().name, "n_9000");
}

TEST(MjcfHostile, LoadsWithoutItsMeshes) {
  const auto model = import(
      R"(<mujoco><asset><mesh name="m" file="none.stl"/><mesh name="e" file="/etc/passwd"/><mesh name="v" vertex="1 2 3"/></asset>
<worldbody><body name="b"><freejoint/><geom size=".1"/><geom type="mesh" mesh="m"/><geom type="mesh" mesh="e"/><geom type="mesh" mesh="v"/>
<geom type="mesh" mesh="n"/><geom type="mesh"/></body></worldbody></mujoco>)");
  ASSERT_TRUE(model) << model.error();
  const BodyModel& m = **model;
  EXPECT_EQ(m.links[0].collisions.size(), 1u);
  EXPECT_TRUE(has_problem(m, Severity::error, "body 'b': mesh ignored: 'none.stl' not found", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "body 'b': mesh ignored: '/etc/passwd'", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "vertex '1 2 3' has 3 numbers", 1)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "mesh 'n' does not exist", 3)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "names no mesh", 3)) << all_problems(m);
}

TEST(MjcfHostile, RejectsCyclesOfClassesAndJoints) {
  const auto model = import(
      R"(<mujoco><default><default class="a"><default class="a"><geom size=".2"/></default></default><default><geom/></default></default>
<worldbody><body name="b"><geom class="a"/><geom class="none" size=".1"/><body name="c"><joint name="j"/><geom size=".1"/></body>
<body name="d"><joint name="k"/><geom size=".1"/></body></body></worldbody>
<equality><joint joint1="j" joint2="k"/><joint joint1="k" joint2="j"/><joint joint1="k"/></equality></mujoco>)");
  ASSERT_TRUE(model) << model.error();
  EXPECT_TRUE(has_problem(**model, Severity::error, "a nested <default> has no class", 1)) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "names the class 'none', which does not exist", 2))
      << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::error, "forms a cycle", 4)) << all_problems(**model);
}

TEST(MjcfHostile, RejectsFreeJointsInsideATree) {
  const BodyModel m = body_with("<body name='c'><freejoint/><geom size='.1'/></body>");
  EXPECT_EQ(m.links.size(), 1u);
  EXPECT_TRUE(has_problem(m, Severity::error, "a free joint must be the only joint of a top-level body", 2))
      << all_problems(m);
}

}  // namespace
}  // namespace limber::model
