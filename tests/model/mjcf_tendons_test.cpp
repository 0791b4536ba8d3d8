// Import of spatial tendons of MJCF: their path, springs, actuators, and what is reported.
#include <string>

#include <gtest/gtest.h>

#include "import_text.h"
#include "model/import.h"
#include "solids.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::expect_near;
using test::has_problem;

BodyModel read_model(const std::string& text) {
  MeshLibrary meshes;
  const auto model = import_model_text(text, "model.xml", {}, meshes);
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

// Three sites on the base and the arm, and a tendon with these attributes and additional elements.
BodyModel with_tendon(const std::string& attributes, const std::string& more = "", const std::string& rest = "") {
  return read_model(
      "<mujoco><worldbody><body name='base'><geom size='.1'/><site name='s1' pos='1 0 0'/><body name='arm' "
      "pos='0 0 2'><joint name='j'/><geom size='.1'/><site name='s2' pos='1 0 0'/><site name='s3' pos='1 0 "
      "1'/></body></body></worldbody><default><tendon stiffness='7' width='.02'/></default><tendon><spatial "
      "name='t' " +
      attributes + "><site site='s1'/><site site='s2'/>" + more + "</spatial></tendon>" + rest + "</mujoco>");
}

TEST(MjcfTendons, ReadsSpatialTendons) {
  const TendonModel spring = with_tendon("damping='2'", "<site site='s3'/>").tendons.at(0);
  EXPECT_EQ(spring.name, "t");
  ASSERT_EQ(spring.points.size(), 3u);
  EXPECT_EQ(spring.points[0].link, 0);
  EXPECT_EQ(spring.points[2].link, 1);
  expect_near(spring.points[2].position, {1, 0, 1}, 1e-12);
  EXPECT_EQ(spring.stiffness, 7) << "of the defaults";
  EXPECT_EQ(spring.damping, 2);
  EXPECT_NEAR(spring.rest.value(), 3, 1e-12) << "the length at home";
  EXPECT_EQ(spring.radius, 0.02);
  EXPECT_TRUE(spring.pushes);
  const TendonModel cable = with_tendon("springlength='0 1.5'").tendons.at(0);
  EXPECT_EQ(cable.rest, 1.5);
  EXPECT_FALSE(cable.pushes);
  const TendonModel limit = with_tendon("stiffness='0' range='0 2.5' limited='true'").tendons.at(0);
  EXPECT_EQ(limit.rest, 2.5);
  EXPECT_GT(limit.stiffness, 1e4);
  EXPECT_FALSE(limit.pushes);
}

TEST(MjcfTendons, DrivesSpatialTendons) {
  const BodyModel position =
      with_tendon("stiffness='0'", "", "<actuator><position tendon='t' kp='50' gear='2'/></actuator>");
  EXPECT_EQ(position.tendons.at(0).stiffness, 200);
  const BodyModel motor = with_tendon("", "", "<actuator><motor tendon='t'/></actuator>");
  EXPECT_TRUE(has_problem(motor, Severity::note, "<motor> on a spatial tendon: the scene sets its force", 1))
      << all_problems(motor);
}

TEST(MjcfTendons, ReportsWhatTendonsLack) {
  const BodyModel m = with_tendon("frictionloss='1' range='0 1' limited='true'",
                                  "<geom geom='g'/><site site='s9'/><pulley divisor='2'/><site site='s3'/>");
  EXPECT_EQ(m.tendons.at(0).points.size(), 2u);
  EXPECT_TRUE(has_problem(m, Severity::warning, "<geom> in <spatial> ignored: the tendon goes straight on", 1));
  EXPECT_TRUE(has_problem(m, Severity::warning, "<pulley> in <spatial> ignored: the tendon ends before it", 1));
  EXPECT_TRUE(has_problem(m, Severity::warning, "friction of <spatial> in <tendon> ignored", 1));
  EXPECT_TRUE(has_problem(m, Severity::warning, "range of <spatial> in <tendon> ignored", 1));
  EXPECT_TRUE(has_problem(m, Severity::error, "site 's9' does not exist", 1)) << all_problems(m);
}

}  // namespace
}  // namespace limber::model
