// Compares the motion of MJCF models with MuJoCo: of own models of the usual kinds, and of public ones where they are
// present.
#include "mujoco_motion.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../model/files.h"
#include "../model/mjcf_models.h"
#include "support/skip.h"

namespace limber::sim {
namespace {

constexpr double kTolerance = 1e-3;  // m
constexpr double kEnd = 0.5;         // s

TEST(MujocoMotion, AgreesOnTheUsualModels) {
  const model::test::Files files;
  int moved = 0;
  for (const model::test::MjcfModel& model : model::test::kMjcfModels) {
    if (model.name == "chain") continue;  // its bodies have no names
    const std::string path = files.write(std::string(model.name) + ".xml", std::string(model.text));
    const test::MotionComparison result = test::compare_motion_with_mujoco(path);
    EXPECT_EQ(result.left_out, "") << model.name;
    EXPECT_LT(result.difference, kTolerance) << model.name << ": " << result.body;
    EXPECT_EQ(result.end, kEnd) << model.name;
    if (result.distance > 0.1) moved++;
  }
  EXPECT_GE(moved, 9) << "the swimmer alone is at rest";
}

// A spring through three bodies, and a damped spring between the outer ones.
TEST(MujocoMotion, AgreesOnSpatialTendons) {
  const model::test::Files files;
  const std::string path = files.write("tendons.xml", R"(<mujoco><compiler angle="radian"/><worldbody>
<body name="base" pos="0 0 1"><geom type="box" size=".1 .1 .05" mass="1"/><site name="s1" pos=".08 0 .05"/>
 <body name="upper" pos="0 0 .1"><joint name="a" axis="0 1 0"/><geom type="box" size=".03 .04 .2" pos="0 0 .2" mass="0.6"/>
  <site name="s2" pos=".07 0 .2"/><site name="s4" pos="-.06 .02 .1"/>
  <body name="lower" pos="0 0 .4"><joint name="b" axis="1 .3 0"/><geom type="box" size=".02 .03 .15" pos="0 0 .15" mass="0.3"/>
   <site name="s3" pos=".05 0 .1"/></body></body></body></worldbody>
<default><tendon width="0.01"/></default>
<tendon><spatial name="front" stiffness="300"><site site="s1"/><site site="s2"/><site site="s3"/></spatial>
<spatial name="back" stiffness="80" damping="2" springlength="0.3"><site site="s4"/><site site="s3"/></spatial></tendon></mujoco>)");
  const test::MotionComparison with = test::compare_motion_with_mujoco(path, true);
  EXPECT_EQ(with.left_out, "");
  EXPECT_LT(with.difference, kTolerance) << with.body;
  EXPECT_EQ(with.end, kEnd);
  EXPECT_GT(with.distance, 0.05);
}

TEST(MujocoMotion, AgreesOnPublicModels) {
  namespace fs = std::filesystem;
  const char* const folder = std::getenv("LIMBER_MJCF_MODELS");
  LIMBER_SKIP_IF(folder == nullptr, "LIMBER_MJCF_MODELS names no folder with MJCF files; AgreesOnTheUsualModels runs");
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    const test::MotionComparison result = test::compare_motion_with_mujoco(entry.path().string());
    if (!result.left_out.empty()) {
      fmt::print("left out: {}: {}\n", entry.path().string(), result.left_out);
      continue;
    }
    EXPECT_LT(result.difference, kTolerance) << entry.path() << ": " << result.body;
    fmt::print("{:9.5f} mm of {:7.4f} m in {:4.2f} s  {}\n", 1000 * result.difference, result.distance, result.end,
               entry.path().string());
    if (result.end == kEnd) count++;
  }
  fmt::print("{} files\n", count);
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace limber::sim
