// Cross-check with urdfdom: reports nothing for equal results, and an error for each difference.
#include "model/urdf/confirm.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace limber {
namespace {

/// Two links and a joint that use all kinds of elements.
UrdfFile robot() {
  UrdfFile file;
  file.links.resize(2);
  file.links[0].name = "%s%n";
  file.links[1].name = "a\"<&>";
  file.links[1].line = 7;
  file.links[1].inertial = UrdfInertial{2.5, {{0.1, 0.2, 0.3}, {1, 2, 3}}, true, Mat3(1.5)};
  for (const ShapeKind kind : {ShapeKind::box, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::capsule,
                               ShapeKind::plane, ShapeKind::mesh}) {
    UrdfShape shape;
    shape.shape.kind = kind;
    shape.origin.rpy = {0.1, -0.2, 3};
    file.links[1].collisions.push_back(shape);
    file.links[1].visuals.push_back(shape);
  }
  UrdfJoint joint;
  joint.name = "%s";
  joint.line = 9;
  joint.type = JointType::revolute;
  joint.parent = file.links[0].name;
  joint.child = file.links[1].name;
  joint.origin = {{1.0 / 3, -2, 1e-7}, {0.4, 1.2, -2.5}};
  joint.axis = normalized(Vec3(1, 2, -3));
  joint.limited = true;
  joint.lower = -1.25;
  joint.upper = 7;
  file.joints.push_back(joint);
  return file;
}

const std::vector<UrdfNode> kTree{{0, -1, -1}, {1, 0, 0}};

std::vector<Problem> cross_check(const UrdfFile& file) {
  Problems problems;
  cross_check_with_urdfdom(file, kTree, problems);
  return problems.release();
}

TEST(UrdfConfirm, AgreesWithTheReader) {
  UrdfFile file = robot();
  for (const JointType type : {JointType::revolute, JointType::prismatic, JointType::continuous, JointType::fixed,
                               JointType::planar, JointType::floating}) {
    file.joints[0].type = type;
    file.joints[0].limited = type == JointType::revolute || type == JointType::prismatic;
    const std::vector<Problem> problems = cross_check(file);
    EXPECT_TRUE(problems.empty()) << joint_type_name(type) << ": " << problems[0].text;
  }
}

TEST(UrdfConfirm, ReportsDifferences) {
  UrdfFile file = robot();
  file.links[1].inertial->mass = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Problem> problems = cross_check(file);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].severity, Severity::error);
  EXPECT_EQ(problems[0].line, 7);
  EXPECT_NE(problems[0].text.find("urdfdom reads link"), std::string::npos);
}

TEST(UrdfConfirm, ReportsWhenUrdfdomFails) {
  UrdfFile file = robot();
  file.joints[0].origin.xyz.x = std::numeric_limits<double>::infinity();
  const std::vector<Problem> problems = cross_check(file);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].text.find("urdfdom rejects"), std::string::npos);
}

}  // namespace
}  // namespace limber
