// Invalid URDF text: the content that must still load, and the problems that must be reported, with line and fix.
#include "model/urdf/check.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::has_problem;
using test::import_text;
using test::try_import;

constexpr const char* kUnit = R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>)";

struct Number {
  const char* text;
  double mass;        // expected value
  const char* fault;  // part of the expected problem; empty: no problem
};

class MassText : public ::testing::TestWithParam<Number> {};

TEST_P(MassText, IsReadOrRejectedWithAReason) {
  const Number& n = GetParam();
  const BodyModel m =
      import_text(fmt::format("<robot name=\"r\"><link name=\"a\"><inertial>\n<mass "
                              "value=\"{}\"/>{}</inertial>\n<collision><geometry><box size=\"1 1 "
                              "1\"/></geometry></collision></link></robot>",
                              n.text, kUnit));
  ASSERT_EQ(m.file_links.size(), 1u);
  EXPECT_DOUBLE_EQ(m.file_links[0].mass, n.mass);
  EXPECT_EQ(m.links[0].collisions.size(), 1u) << "elements after an invalid inertial must not be lost";
  if (*n.fault) {
    EXPECT_TRUE(has_problem(m, n.mass == 0 ? Severity::error : Severity::note, n.fault, 2)) << all_problems(m);
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, MassText,
                         ::testing::Values(Number{"2", 2, ""}, Number{"2e0", 2, ""}, Number{"+1", 1, "notation"},
                                           Number{".5", 0.5, "notation"}, Number{"5.", 5, "notation"},
                                           Number{"2.0 ", 2, "notation"}, Number{"\t1.0", 1, "notation"},
                                           Number{"1,5", 0, "not a number"}, Number{"1d3", 0, "not a number"},
                                           Number{"0x10", 0, "not a number"}, Number{"1.0f", 0, "not a number"},
                                           Number{"", 0, "empty"}, Number{"nan", 0, "not finite"},
                                           Number{"inf", 0, "not finite"}, Number{"1e400", 0, "too large"},
                                           Number{"1e308", 0, "out of range"}, Number{"-1", 0, "out of range"},
                                           Number{"1e-400", 0, ""}, Number{"--1", 0, "not a number"},
                                           Number{"+-1", 0, "not a number"}, Number{"%s%s%n", 0, "not a number"},
                                           Number{"${m}", 0, "xacro"}));

TEST(UrdfCheck, VectorsRequireThreeNumbersWithAnyBlanks) {
  struct Case {
    const char* text;
    bool good;
  };
  const Case cases[] = {{"1 2 3", true},      {" 1  2   3 ", true}, {"1\t2\n3", true}, {"1 2", false},
                        {"1 2 3 4", false},   {"1, 2, 3", false},   {"", false},       {"1 nan 3", false},
                        {"1e308 2 3", false}, {"%n 2 3", false}};
  for (const Case& c : cases) {
    const BodyModel m = import_text(fmt::format(
        R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="{}"/></joint></robot>)",
        c.text));
    ASSERT_EQ(m.merged.size(), 1u) << c.text;
    EXPECT_EQ(m.merged[0].offset.position, c.good ? Vec3(1, 2, 3) : Vec3(0)) << c.text;
    bool reported = false;
    for (const Problem& p : m.problems)
      reported = reported || (p.severity == Severity::error && p.text.find("origin") != std::string::npos);
    EXPECT_EQ(reported, !c.good) << c.text;
  }
}

/// An invalid file that loads in part: expected counts, and the expected problem with its line.
struct PartlyValidFile {
  const char* name;
  const char* text;
  std::size_t links;  // links of the file that are in the tree
  std::size_t joints;
  Severity severity;
  const char* message;
  int line;
};

class PartlyGood : public ::testing::TestWithParam<PartlyValidFile> {};

TEST_P(PartlyGood, LoadsAndReports) {
  const PartlyValidFile& p = GetParam();
  const BodyModel m = import_text(p.text);
  EXPECT_EQ(m.file_links.size(), p.links);
  EXPECT_EQ(m.file_joints.size(), p.joints);
  EXPECT_TRUE(has_problem(m, p.severity, p.message, p.line)) << all_problems(m);
}

#define LINKS_AB "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n"
#define J(type, more) \
  "<joint name=\"j\" type=\"" type "\"><parent link=\"a\"/><child link=\"b\"/>" more "</joint>\n</robot>"

INSTANTIATE_TEST_SUITE_P(
    Files, PartlyGood,
    ::testing::Values(
        PartlyValidFile{"type_unknown", LINKS_AB J("hinge", ""), 2, 1, Severity::error,
                        "'hinge' is not a URDF joint type", 2},
        PartlyValidFile{"type_case", LINKS_AB J("Revolute", ""), 2, 1, Severity::warning, "read as revolute", 2},
        PartlyValidFile{"type_missing",
                        LINKS_AB "<joint name=\"j\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>", 2, 1,
                        Severity::error, "has no type", 2},
        PartlyValidFile{"axis_zero", LINKS_AB J("revolute", "<axis xyz=\"0 0 0\"/>"), 2, 1, Severity::error,
                        "not a direction", 2},
        PartlyValidFile{"axis_none", LINKS_AB J("revolute", ""), 2, 1, Severity::warning, "has no axis", 2},
        PartlyValidFile{"axis_long", LINKS_AB J("revolute", "<axis xyz=\"0 0 1e-200\"/>"), 2, 1, Severity::note,
                        "not 1", 2},
        PartlyValidFile{"limit_none", LINKS_AB J("revolute", ""), 2, 1, Severity::warning, "no <limit>", 2},
        PartlyValidFile{"limit_inverted",
                        LINKS_AB J("revolute", "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>"), 2, 1,
                        Severity::warning, "above upper", 2},
        PartlyValidFile{"dynamics_empty", LINKS_AB J("revolute", "<dynamics/>"), 2, 1, Severity::warning,
                        "<dynamics> has neither", 2},
        PartlyValidFile{"safety", LINKS_AB J("revolute", "<safety_controller k_position=\"1\"/>"), 2, 1, Severity::note,
                        "<safety_controller>", 2},
        PartlyValidFile{"self_parent",
                        "<robot name=\"r\"><link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
                        "<child link=\"a\"/></joint></robot>",
                        1, 0, Severity::error, "to itself", 2},
        PartlyValidFile{"parent_unknown",
                        "<robot name=\"r\"><link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"zz\"/>"
                        "<child link=\"a\"/></joint></robot>",
                        1, 0, Severity::error, "parent link 'zz' does not exist", 2},
        PartlyValidFile{"two_roots", LINKS_AB "</robot>", 1, 0, Severity::error, "'b' is not connected", 1},
        PartlyValidFile{"dup_link", "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"a\"/></robot>", 1, 0,
                        Severity::error, "declared twice", 2},
        PartlyValidFile{"no_link_name", "<robot name=\"r\"><link name=\"a\"/>\n<link/></robot>", 1, 0, Severity::error,
                        "has no name", 2},
        PartlyValidFile{"no_robot_name", "<robot><link name=\"a\"/></robot>", 1, 0, Severity::warning, "called 'robot'",
                        1},
        PartlyValidFile{"version", "<robot name=\"r\" version=\"2.0\"><link name=\"a\"/></robot>", 1, 0,
                        Severity::warning, "read as 1.0", 1},
        PartlyValidFile{"prefix", "<r:robot xmlns:r=\"x\" name=\"r\"><link name=\"a\"/></r:robot>", 1, 0,
                        Severity::warning, "prefix", 1},
        PartlyValidFile{"material_twice",
                        "<robot name=\"r\"><material name=\"m\"><color rgba=\"1 1 1 1\"/></material>\n<material "
                        "name=\"m\"><color rgba=\"1 0 1 1\"/></material><link name=\"a\"/></robot>",
                        1, 0, Severity::warning, "'m' is declared twice", 2},
        PartlyValidFile{"material_percent", "<robot name=\"r\"><material name=\"%s%s%n\"/><link name=\"a\"/></robot>",
                        1, 0, Severity::warning, "no color", 1},
        PartlyValidFile{"box_negative",
                        "<robot name=\"r\"><link name=\"a\"><collision><geometry>\n<box size=\"-1 1 "
                        "1\"/></geometry></collision></link></robot>",
                        1, 0, Severity::error, "out of range", 2},
        PartlyValidFile{"no_geometry", "<robot name=\"r\"><link name=\"a\"><collision/></link></robot>", 1, 0,
                        Severity::error, "no geometry", 1},
        PartlyValidFile{
            "mesh_no_file",
            "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh/></geometry></collision></link></robot>", 1,
            0, Severity::error, "names no file", 1},
        PartlyValidFile{
            "mesh_scale_zero",
            "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"x.stl\" scale=\"0 1 1\"/>"
            "</geometry></collision></link></robot>",
            1, 0, Severity::error, "scale of 0", 1},
        PartlyValidFile{
            "mesh_missing",
            "<robot name=\"r\"><link name=\"a\"><collision>\n<geometry><mesh filename=\"package://no/x.stl\"/>"
            "</geometry></collision></link></robot>",
            1, 0, Severity::error, "not found in", 1},
        PartlyValidFile{"mesh_passwd",
                        "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"../../etc/passwd\"/>"
                        "</geometry></collision></link></robot>",
                        1, 0, Severity::error, "not a supported mesh format", 1},
        PartlyValidFile{"mesh_network",
                        "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh filename=\"https://x.org/x.stl\"/>"
                        "</geometry></visual></link></robot>",
                        1, 0, Severity::error, "a network address", 1}),
    [](const auto& info) { return std::string(info.param.name); });

#undef J
#undef LINKS_AB

TEST(UrdfCheck, OpensLoopsAtTheClosingJoint) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="r0"/><link name="a"/><link name="b"/>
<joint name="j0" type="fixed"><parent link="r0"/><child link="a"/></joint>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)");
  EXPECT_EQ(m.file_links.size(), 3u);
  EXPECT_EQ(m.file_joints.size(), 2u);
  EXPECT_TRUE(has_problem(m, Severity::error, "'j2'", 4)) << all_problems(m);
}

TEST(UrdfCheck, IgnoresUnconnectedLoops) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="r0"/><link name="a"/><link name="b"/>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)");
  ASSERT_EQ(m.file_links.size(), 1u);
  EXPECT_EQ(m.file_links[0].name, "r0");
  EXPECT_TRUE(has_problem(m, Severity::error, "loop", 1));
}

TEST(UrdfCheck, UsesTheLargestOfSeveralTrees) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="stray"/><link name="a"/><link name="b"/>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>)");
  ASSERT_EQ(m.file_links.size(), 2u);
  EXPECT_EQ(m.file_links[0].name, "a");
  EXPECT_TRUE(has_problem(m, Severity::error, "'stray' is not connected", 1));
}

TEST(UrdfCheck, HandlesExponentiallyManyPathsInLinearTime) {
  // there are 2^40 paths through these joints
  std::string text = R"(<robot name="r"><link name="l0"/>)";
  for (int i = 1; i <= 40; ++i) {
    text += fmt::format(R"(<link name="l{}"/>)", i);
    for (const char* side : {"a", "b"}) {
      text += fmt::format(R"(<joint name="{0}{1}" type="fixed"><parent link="l{2}"/><child link="l{1}"/></joint>)",
                          side, i, i - 1);
    }
  }
  const BodyModel m = import_text(text + "</robot>");
  EXPECT_EQ(m.file_links.size(), 41u);
  EXPECT_EQ(m.file_joints.size(), 40u);
}

TEST(UrdfCheck, LongChainsDoNotRecurse) {
  std::string text = R"(<robot name="r"><link name="l0"/>)";
  for (int i = 1; i < 5000; ++i) {
    text += fmt::format(
        R"(<link name="l{0}"/><joint name="j{0}" type="fixed"><parent link="l{1}"/><child link="l{0}"/></joint>)", i,
        i - 1);
  }
  EXPECT_EQ(import_text(text + "</robot>").merged.size(), 4999u);
}

TEST(UrdfCheck, RenamesJointsWithDuplicateNames) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="j" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/></joint></robot>)");
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[0].name, "j");
  EXPECT_EQ(m.joints[1].name, "j_2");
  EXPECT_TRUE(has_problem(m, Severity::error, "'j' is declared twice", 3));
}

TEST(UrdfCheck, RejectsPlanesInMovingLinks) {
  const BodyModel m = import_text(
      R"(<robot name="r"><link name="a"/><link name="b"><collision><geometry><plane/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  EXPECT_TRUE(m.links[1].collisions.empty());
  EXPECT_TRUE(has_problem(m, Severity::error, "<plane>", 1)) << all_problems(m);
}

TEST(UrdfCheck, BoundsTheNumberOfProblems) {
  std::string text = "<robot name=\"r\"><link name=\"a\"/>";
  for (int i = 0; i < 5000; ++i) text += "<link/>";
  const BodyModel m = import_text(text + "</robot>");
  EXPECT_LE(m.problems.size(), 301u);
  EXPECT_NE(m.problems.back().text.find("more problems"), std::string::npos);
}

struct RejectedFile {
  const char* name;
  const char* text;
  const char* message;
};

class NoBody : public ::testing::TestWithParam<RejectedFile> {};

TEST_P(NoBody, IsRejectedWithPlaceAndFix) {
  const auto result = try_import(GetParam().text);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().find("robot.urdf:"), 0u) << result.error();
  EXPECT_NE(result.error().find(GetParam().message), std::string::npos) << result.error();
}

INSTANTIATE_TEST_SUITE_P(
    Files, NoBody,
    ::testing::Values(
        RejectedFile{"empty", "", "robot.urdf:1: is empty"}, RejectedFile{"blank", " \n ", "is empty"},
        RejectedFile{"no_xml", "hello", "no XML element"},
        RejectedFile{"not_robot", "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\"/>", ":2: the root element is <sdf>"},
        RejectedFile{"no_link", "<robot name=\"r\"/>", "no valid link found"},
        RejectedFile{"unnamed_link", "<robot name=\"r\">\n<link/></robot>", "line 2: a <link> has no name"},
        RejectedFile{"cut_off", "<robot name=\"r\">\n<link name=\"a\"/></robo", "may be truncated"},
        RejectedFile{"mismatch", "<robot name=\"r\"><link name=\"a\"></robot></link>", "end tag"},
        RejectedFile{"attribute_twice", "<robot name=\"r\">\n<link name=\"a\" name=\"b\"/></robot>",
                     ":2: an attribute"},
        RejectedFile{"loop", R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)",
                     ":2: the joints form a cycle"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace limber::model
