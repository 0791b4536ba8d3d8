// Home and start poses, poses in the import options, mimic joints.
#include "model/urdf/import.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "robots.h"

namespace limber::model {
namespace {

using test::has_problem;
using test::import_text;
using test::kArm;
using test::try_import;

constexpr double kHalf = kPi / 2;

TEST(UrdfPose, HomePoseIsForwardKinematicsAtZero) {
  const BodyModel m = import_text(kArm);
  // the elbow's origin is rotated by 90 degrees about z, so the slide's offset of 1 m along x is along world y
  test::expect_near(m.links[1].home.position, {0, 0, 1}, 1e-12);
  test::expect_near(m.links[2].home.position, {0, 0, 2}, 1e-12);
  test::expect_near(m.links[3].home.position, {0, 1, 2}, 1e-12);
  EXPECT_NEAR(test::angle_between(m.links[3].home.rotation, quat_axis({0, 0, 1}, kHalf)), 0, 1e-12);
}

TEST(UrdfPose, StartsAtTheNearestAllowedAngle) {
  const BodyModel m = import_text(kArm);
  // 0 is below the elbow's lower limit 0.5: it starts at 0.5 about -y of its frame; the frame's x is world y
  EXPECT_DOUBLE_EQ(m.joints[1].start, 0.5);
  test::expect_near(m.links[3].start.position, {0, std::cos(0.5), 2 + std::sin(0.5)}, 1e-12);
  EXPECT_TRUE(has_problem(m, Severity::note, "starts at 0.5", 7)) << test::all_problems(m);
}

TEST(UrdfPose, ClampsAndAppliesTheRequestedPose) {
  ImportOptions options;
  options.pose = {{"shoulder", kHalf}, {"slide", 9.0}};
  const BodyModel m = import_text(kArm, options);
  EXPECT_DOUBLE_EQ(m.joints[0].start, kHalf);
  EXPECT_DOUBLE_EQ(m.joints[2].start, 0.2);
  // the shoulder rotates y to -x; the slide moves 0.2 m along (1,1,0)/sqrt(2) of the lower link
  const double s = 0.2 / std::sqrt(2.0);
  const double along = 1 + s;
  test::expect_near(m.links[3].start.position, {-along * std::cos(0.5), -s, 2 + along * std::sin(0.5)}, 1e-12);
}

TEST(UrdfPose, RejectsUnknownJointsWithASuggestion) {
  ImportOptions options;
  options.pose = {{"elbov", 1.0}};
  const auto result = try_import(kArm, options);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().find("elbow"), std::string::npos) << result.error();
}

std::string finger(const char* mimic1, const char* mimic2) {
  return fmt::format(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="i" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0.2" upper="1" effort="1" velocity="1"/></joint>
<joint name="j" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>{}</joint>
<joint name="k" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>{}</joint>
</robot>)",
                     mimic1, mimic2);
}

TEST(UrdfPose, ResolvesMimicChains) {
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
  EXPECT_TRUE(has_problem(m, Severity::note,
                          "joint 'k': follows 'j', which follows another joint; it follows 'i' * -1 + 0.25", 4))
      << test::all_problems(m);
}

TEST(UrdfPose, ReportsFollowersThatReachTheirLimits) {
  struct Case {
    const char *mimic, *text;
  };
  // i: 0.2 .. 1, k and j: -2 .. 2
  const Case cases[] = {
      {R"(<mimic joint="i" multiplier="-1"/>)", nullptr},
      {R"(<mimic joint="i" multiplier="2"/>)", nullptr},
      {R"(<mimic joint="i" multiplier="4"/>)",
       "joint 'j' follows 'i' * 4: its limits -2..2 are reached when 'i' is at 0.5 (range of 'i': 0.2..1)"},
      {R"(<mimic joint="i" multiplier="-4" offset="2.4"/>)", nullptr},
      {R"(<mimic joint="i" multiplier="-8" offset="4"/>)",
       "joint 'j' follows 'i' * -8 + 4: its limits -2..2 are reached when 'i' is at 0.75 and at 0.25"},
      {R"(<mimic joint="i" multiplier="0" offset="3"/>)",
       "joint 'j' follows 'i' * 0 + 3: its limits -2..2 are reached when 'i' is anywhere"}};
  for (const Case& c : cases) {
    const BodyModel m = import_text(finger(c.mimic, ""));
    EXPECT_EQ(m.joints[1].mimic, 0) << c.mimic;
    const bool reported = test::all_problems(m).find("are reached when") != std::string::npos;
    EXPECT_EQ(reported, c.text != nullptr) << c.mimic << test::all_problems(m);
    EXPECT_TRUE(c.text == nullptr || has_problem(m, Severity::warning, c.text, 3)) << test::all_problems(m);
  }
}

TEST(UrdfPose, ReportsMimicsOfUnsupportedJointTypes) {
  for (const char* type : {"fixed", "planar", "floating"}) {
    const BodyModel m = import_text(fmt::format(
        R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="i" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="j" type="{}"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><mimic joint="i"/></joint></robot>)",
        type));
    for (const JointModel& joint : m.joints) EXPECT_EQ(joint.mimic, -1) << type;
    EXPECT_TRUE(has_problem(m, Severity::error, fmt::format("joint 'j': is {} and can't follow 'i'", type), 3))
        << test::all_problems(m);
  }
}

TEST(UrdfPose, DropsInvalidMimics) {
  struct Case {
    const char *first, *second, *text;
  };
  const Case cases[] = {{R"(<mimic joint="nope"/>)", "", "'nope'"},
                        {R"(<mimic joint="j"/>)", "", "itself"},
                        {R"(<mimic joint="k"/>)", R"(<mimic joint="j"/>)", "cycle"},
                        {R"(<mimic/>)", "", "names no joint"}};
  for (const Case& c : cases) {
    const BodyModel m = import_text(finger(c.first, c.second));
    ASSERT_EQ(m.joints.size(), 3u);
    EXPECT_EQ(m.joints[1].mimic, -1) << c.text;
    EXPECT_EQ(m.joints[2].mimic, -1) << c.text;
    EXPECT_TRUE(has_problem(m, Severity::error, c.text, 3)) << test::all_problems(m);
  }
}

}  // namespace
}  // namespace limber::model
