// Compares the URDF reader with urdfdom, an independent one, on all files.
#include "urdfdom_reference.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include <gtest/gtest.h>

#include "model/urdf/check.h"
#include "model/xml_text.h"

namespace limber::model::test {
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

TEST(UrdfdomReference, AgreesOnEveryKindOfElement) {
  UrdfFile file = robot();
  for (const JointType type : {JointType::revolute, JointType::prismatic, JointType::continuous, JointType::fixed,
                               JointType::planar, JointType::floating}) {
    file.joints[0].type = type;
    file.joints[0].limited = type == JointType::revolute || type == JointType::prismatic;
    EXPECT_EQ(urdfdom_differences(file, kTree), std::vector<std::string>()) << joint_type_name(type);
  }
}

// The robots of the repository and the shared data, malformed files, and the inputs of the fuzz target.
TEST(UrdfdomReference, AgreesOnAllFiles) {
  namespace fs = std::filesystem;
  int files = 0;
  std::error_code fault;
  for (const char* folder : {"urdf", "tests/fuzz/corpus/urdf", "../shared/data"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(LIMBER_SOURCE_DIR) / folder, fault)) {
      if (entry.path().extension() != ".urdf") continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(stream), {});
      Problems problems;
      const Result<std::string> text = clean_urdf_text(bytes, problems);
      const Result<UrdfFile> file = text ? check_urdf(*text, "robot", problems) : Error{text.error()};
      if (!file) continue;
      const Result<std::vector<UrdfNode>> tree = find_tree(*file, problems);
      if (!tree) continue;
      // ball joints are those of dialects, which urdfdom rejects
      const auto is_ball = [](const UrdfJoint& joint) { return joint.type == JointType::spherical; };
      if (std::any_of(file->joints.begin(), file->joints.end(), is_ball)) continue;
      EXPECT_EQ(urdfdom_differences(*file, *tree), std::vector<std::string>()) << entry.path();
      files++;
    }
  }
  EXPECT_GE(files, 10);
}

TEST(UrdfdomReference, FindsDifferences) {
  UrdfFile file = robot();
  file.links[1].inertial->mass = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(urdfdom_differences(file, kTree), std::vector<std::string>{"link 'a\"<&>'"});
  file = robot();
  file.joints[0].origin.xyz.x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(urdfdom_differences(file, kTree), std::vector<std::string>{"urdfdom rejects the file"});
}

}  // namespace
}  // namespace limber::model::test
