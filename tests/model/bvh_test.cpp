// BVH files: poses compared with matrices, limits, and errors that name the line.
#include "model/mocap/bvh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace limber::model {
namespace {

constexpr const char* kArm = R"(HIERARCHY
ROOT hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT left arm
  {
    OFFSET 0 0 2
    CHANNELS 3 Yrotation Zrotation Xrotation
    End Site
    {
      OFFSET 0 0 1
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.5
0 0 0 0 0 0 0 0 0
4 5 6 90 0 0 0 0 90
8 5 6 90 0 0 0 0 -90
)";

std::shared_ptr<const BvhClip> read(const std::string& text) {
  Result<std::shared_ptr<const BvhClip>> clip = parse_bvh(text, "test.bvh");
  EXPECT_TRUE(clip.ok()) << (clip.ok() ? "" : clip.error());
  return clip.ok() ? *clip : nullptr;
}
std::string error_of(const std::string& text) {
  const Result<std::shared_ptr<const BvhClip>> clip = parse_bvh(text, "test.bvh");
  return clip.ok() ? "" : clip.error();
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}
void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

TEST(Bvh, ReadsTheHierarchy) {
  const auto clip = read(kArm);
  ASSERT_EQ(clip->joints.size(), 2u);
  EXPECT_EQ(clip->joints[1].name, "left arm");
  EXPECT_EQ(clip->joints[1].parent, 0);
  expect_near(clip->joints[0].offset, {1, 2, 3});
  EXPECT_EQ(clip->channels, 9u);
  EXPECT_EQ(clip->frames, 3u);
  EXPECT_EQ(clip->duration(), 1);
}

TEST(Bvh, PosesAreProductsOfTheChannelsInTheirOrder) {
  std::string text = kArm;
  text = replaced(text, "4 5 6 90 0 0 0 0 90", "4 5 6 10 20 30 40 50 60");
  const auto clip = read(text);
  const auto turn = [](int axis, double degrees) {
    Vec3 about(0);
    about[axis] = 1;
    return glm::mat3_cast(quat_axis(about, degrees * kPi / 180));
  };
  const Mat3 root = turn(2, 10) * turn(0, 20) * turn(1, 30);
  const Mat3 arm = turn(1, 40) * turn(2, 50) * turn(0, 60);
  for (int column = 0; column < 3; column++) {
    expect_near(glm::mat3_cast(clip->local_pose(0, 1).rotation)[column], root[column]);
    expect_near(glm::mat3_cast(clip->local_pose(1, 1).rotation)[column], arm[column]);
  }
  expect_near(clip->local_pose(0, 1).position, {4, 5, 6});
  expect_near(clip->local_pose(1, 1).position, {0, 0, 2});
}

TEST(Bvh, InterpolatesBetweenFramesAlongTheShorterArc) {
  const auto clip = read(kArm);
  const Pose root = clip->local_pose_at(0, 0.75);
  expect_near(root.position, {6, 5, 6});
  // from +90° to −90° about x, halfway: either way is as short, and the result is a half turn from neither
  const Pose quarter = clip->local_pose_at(1, 0.25);
  expect_near(quarter.rotation * Vec3(0, 0, 1), {0, -std::sqrt(0.5), std::sqrt(0.5)});
  expect_near(clip->local_pose_at(0, 99).position, {8, 5, 6});
  expect_near(clip->local_pose_at(0, -1).position, {0, 0, 0});
}

TEST(Bvh, ErrorsNameTheLineAndTheProblem) {
  const auto expect = [](const std::string& from, const std::string& to, const std::string& error) {
    EXPECT_EQ(error_of(replaced(kArm, from, to)), "test.bvh, line " + error) << to;
  };
  expect("HIERARCHY", "HIERARCHIE", "1: expected HIERARCHY, got 'HIERARCHIE'");
  expect("OFFSET 1 2 3", "OFFSET 1 2,5 3", "4: an OFFSET must be a number, got '2,5'");
  expect("OFFSET 1 2 3", "OFFSET 1 nan 3", "4: an OFFSET must be a number, got 'nan'");
  expect("OFFSET 1 2 3", "OFFSET 1 2e9 3", "4: an OFFSET must be -1000000 .. 1000000, got 2000000000");
  expect("CHANNELS 6", "CHANNELS 7", "5: a joint has 0 .. 6 CHANNELS, got 7");
  expect("Xposition", "Wposition", "5: expected a channel such as Xposition or Zrotation, got 'Wposition'");
  expect("Xposition", "Yposition", "5: joint 'hips' has the channel Yposition twice");
  expect("left arm", "hips", "6: there is a joint 'hips' already; rename one of them");
  expect("End Site", "End", "11: expected Site, got '{'");
  expect("Frames: 3", "Frames: 0", "17: Frames must be 1 .. 4444444 with 9 channels, got '0'");
  expect("Frames: 3", "Frames: 1e9", "17: Frames must be 1 .. 4444444 with 9 channels, got '1e9'");
  expect("Frames: 3", "Frames: 4", "22: ends in frame 4 of 4; the file is incomplete");
  expect("Frames: 3", "Frames: 2", "21: has more values than 2 frames");
  expect("Time: 0.5", "Time: 0", "18: Frame Time must be 0.0001 .. 10 s, got 0");
  expect("8 5 6", "8 5 x", "21: a channel's value must be a number, got 'x'");
  EXPECT_EQ(error_of(""), "test.bvh, line 1: expected HIERARCHY, got the end of the file");
  EXPECT_EQ(error_of("HIERARCHY MOTION"), "test.bvh, line 1: has no joint: a ROOT is missing before MOTION");
}

TEST(Bvh, LimitsTheNumberOfJoints) {
  const auto roots = [](std::size_t count) {
    std::string text = "HIERARCHY\n";
    for (std::size_t i = 0; i < count; i++)
      text += fmt::format("ROOT r{} {{ OFFSET 0 0 0 CHANNELS {} }}\n", i, i == 0 ? "1 Xrotation" : "0");
    return text + "MOTION Frames: 1 Frame Time: 1 0";
  };
  // a name extends to the brace or the end of its line
  EXPECT_EQ(read(roots(BvhClip::kMaxJoints))->joints.size(), BvhClip::kMaxJoints);
  EXPECT_EQ(error_of(roots(BvhClip::kMaxJoints + 1)), "test.bvh, line 258: has more than 256 joints");
}

TEST(Bvh, ReadsOurDancer) {
  std::ifstream in(LIMBER_SOURCE_DIR "/scripts/motion/dancer.bvh");
  const auto clip = read({std::istreambuf_iterator<char>(in), {}});
  ASSERT_NE(clip, nullptr);
  EXPECT_EQ(clip->joints.size(), 20u);
  EXPECT_NEAR(clip->duration(), 8, 1e-4);
  // the dance begins again without a jump
  for (std::size_t i = 0; i < clip->joints.size(); i++) {
    const Pose first = clip->local_pose(i, 0);
    const Pose last = clip->local_pose(i, clip->frames - 1);
    expect_near(first.position, last.position);
    EXPECT_GT(std::abs(glm::dot(first.rotation, last.rotation)), 1 - 1e-8) << clip->joints[i].name;
  }
}

}  // namespace
}  // namespace limber::model
