// Broken URDF text: what must load all the same, and what must be said, with line and cure.
#include "model/urdf_check.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"

namespace limber {
namespace {

using test::all_problems;
using test::import_text;
using test::says;
using test::try_import;

constexpr const char* kUnit = R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>)";

struct Number {
  const char* text;
  double mass;        // as it must be read
  const char* fault;  // part of what must be said; empty: nothing about the mass
};

class MassText : public ::testing::TestWithParam<Number> {};

TEST_P(MassText, IsReadOrRefusedWithTheReason) {
  const Number& n = GetParam();
  const BodyModel m =
      import_text(fmt::format("<robot name=\"r\"><link name=\"a\"><inertial>\n<mass "
                              "value=\"{}\"/>{}</inertial>\n<collision><geometry><box size=\"1 1 "
                              "1\"/></geometry></collision></link></robot>",
                              n.text, kUnit));
  ASSERT_EQ(m.file_links.size(), 1u);
  EXPECT_DOUBLE_EQ(m.file_links[0].mass, n.mass);
  EXPECT_EQ(m.links[0].collisions.size(), 1u) << "what follows a bad inertial must not be lost";
  if (*n.fault) {
    EXPECT_TRUE(says(m, n.mass == 0 ? Severity::error : Severity::note, n.fault, 2)) << all_problems(m);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Numbers, MassText,
    ::testing::Values(Number{"2", 2, ""}, Number{"2e0", 2, ""}, Number{"+1", 1, "spelled"},
                      Number{".5", 0.5, "spelled"}, Number{"5.", 5, "spelled"}, Number{"2.0 ", 2, "spelled"},
                      Number{"\t1.0", 1, "spelled"}, Number{"1,5", 0, "not a number"}, Number{"1d3", 0, "not a number"},
                      Number{"0x10", 0, "not a number"}, Number{"1.0f", 0, "not a number"}, Number{"", 0, "empty"},
                      Number{"nan", 0, "not finite"}, Number{"inf", 0, "not finite"}, Number{"1e400", 0, "too large"},
                      Number{"1e308", 0, "out of range"}, Number{"-1", 0, "out of range"}, Number{"1e-400", 0, ""},
                      Number{"--1", 0, "not a number"}, Number{"+-1", 0, "not a number"},
                      Number{"%s%s%n", 0, "not a number"}, Number{"${m}", 0, "xacro"}));

TEST(UrdfCheck, VectorsTakeAnyBlanksAndExactlyThreeNumbers) {
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
    bool said = false;
    for (const Problem& p : m.problems)
      said = said || (p.severity == Severity::error && p.text.find("origin") != std::string::npos);
    EXPECT_EQ(said, !c.good) << c.text;
  }
}

/// A file of which something loads: counts, and what must be said on which line.
struct Partly {
  const char* name;
  const char* text;
  std::size_t links;  // of the file, in the tree
  std::size_t joints;
  Severity severity;
  const char* says;
  int line;
};

class PartlyGood : public ::testing::TestWithParam<Partly> {};

TEST_P(PartlyGood, LoadsAndSays) {
  const Partly& p = GetParam();
  const BodyModel m = import_text(p.text);
  EXPECT_EQ(m.file_links.size(), p.links);
  EXPECT_EQ(m.file_joints.size(), p.joints);
  EXPECT_TRUE(says(m, p.severity, p.says, p.line)) << all_problems(m);
}

#define LINKS_AB "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n"
#define J(type, more) \
  "<joint name=\"j\" type=\"" type "\"><parent link=\"a\"/><child link=\"b\"/>" more "</joint>\n</robot>"

INSTANTIATE_TEST_SUITE_P(
    Files, PartlyGood,
    ::testing::Values(
        Partly{"type_unknown", LINKS_AB J("ball", ""), 2, 1, Severity::error, "'ball' is not a URDF joint type", 2},
        Partly{"type_case", LINKS_AB J("Revolute", ""), 2, 1, Severity::warning, "read as revolute", 2},
        Partly{"type_missing", LINKS_AB "<joint name=\"j\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>", 2,
               1, Severity::error, "has no type", 2},
        Partly{"axis_zero", LINKS_AB J("revolute", "<axis xyz=\"0 0 0\"/>"), 2, 1, Severity::error, "no direction", 2},
        Partly{"axis_none", LINKS_AB J("revolute", ""), 2, 1, Severity::warning, "has no axis", 2},
        Partly{"axis_long", LINKS_AB J("revolute", "<axis xyz=\"0 0 1e-200\"/>"), 2, 1, Severity::note, "not 1", 2},
        Partly{"limit_none", LINKS_AB J("revolute", ""), 2, 1, Severity::warning, "no <limit>", 2},
        Partly{"limit_inverted",
               LINKS_AB J("revolute", "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>"), 2, 1,
               Severity::warning, "above upper", 2},
        Partly{"dynamics_empty", LINKS_AB J("revolute", "<dynamics/>"), 2, 1, Severity::warning,
               "<dynamics> says nothing", 2},
        Partly{"safety", LINKS_AB J("revolute", "<safety_controller k_position=\"1\"/>"), 2, 1, Severity::note,
               "<safety_controller>", 2},
        Partly{"self_parent",
               "<robot name=\"r\"><link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
               "<child link=\"a\"/></joint></robot>",
               1, 0, Severity::error, "to itself", 2},
        Partly{"parent_unknown",
               "<robot name=\"r\"><link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"zz\"/>"
               "<child link=\"a\"/></joint></robot>",
               1, 0, Severity::error, "parent link 'zz' does not exist", 2},
        Partly{"two_roots", LINKS_AB "</robot>", 1, 0, Severity::error, "'b' is not connected", 1},
        Partly{"dup_link", "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"a\"/></robot>", 1, 0, Severity::error,
               "there twice", 2},
        Partly{"no_link_name", "<robot name=\"r\"><link name=\"a\"/>\n<link/></robot>", 1, 0, Severity::error,
               "has no name", 2},
        Partly{"no_robot_name", "<robot><link name=\"a\"/></robot>", 1, 0, Severity::warning, "called 'robot'", 1},
        Partly{"version", "<robot name=\"r\" version=\"2.0\"><link name=\"a\"/></robot>", 1, 0, Severity::warning,
               "read as 1.0", 1},
        Partly{"prefix", "<r:robot xmlns:r=\"x\" name=\"r\"><link name=\"a\"/></r:robot>", 1, 0, Severity::warning,
               "prefix", 1},
        Partly{"material_twice",
               "<robot name=\"r\"><material name=\"m\"><color rgba=\"1 1 1 1\"/></material>\n<material "
               "name=\"m\"><color rgba=\"1 0 1 1\"/></material><link name=\"a\"/></robot>",
               1, 0, Severity::warning, "'m' is there twice", 2},
        Partly{"material_percent", "<robot name=\"r\"><material name=\"%s%s%n\"/><link name=\"a\"/></robot>", 1, 0,
               Severity::warning, "no colour", 1},
        Partly{"box_negative",
               "<robot name=\"r\"><link name=\"a\"><collision><geometry>\n<box size=\"-1 1 "
               "1\"/></geometry></collision></link></robot>",
               1, 0, Severity::error, "out of range", 2},
        Partly{"no_geometry", "<robot name=\"r\"><link name=\"a\"><collision/></link></robot>", 1, 0, Severity::error,
               "no geometry", 1},
        Partly{"mesh_no_file",
               "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh/></geometry></collision></link></robot>",
               1, 0, Severity::error, "names no file", 1},
        Partly{"mesh_scale_zero",
               "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"x.stl\" scale=\"0 1 1\"/>"
               "</geometry></collision></link></robot>",
               1, 0, Severity::error, "scale of 0", 1},
        Partly{"mesh_missing",
               "<robot name=\"r\"><link name=\"a\"><collision>\n<geometry><mesh filename=\"package://no/x.stl\"/>"
               "</geometry></collision></link></robot>",
               1, 0, Severity::error, "looked in", 1},
        Partly{"mesh_passwd",
               "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"../../etc/passwd\"/>"
               "</geometry></collision></link></robot>",
               1, 0, Severity::error, "no mesh that is read", 1},
        Partly{"mesh_network",
               "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh filename=\"https://x.org/x.stl\"/>"
               "</geometry></visual></link></robot>",
               1, 0, Severity::error, "on a network", 1}),
    [](const auto& info) { return std::string(info.param.name); });

#undef J
#undef LINKS_AB

TEST(UrdfCheck, LoopsAreOpenedAtTheJointThatClosesThem) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="r0"/><link name="a"/><link name="b"/>
<joint name="j0" type="fixed"><parent link="r0"/><child link="a"/></joint>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)");
  EXPECT_EQ(m.file_links.size(), 3u);
  EXPECT_EQ(m.file_joints.size(), 2u);
  EXPECT_TRUE(says(m, Severity::error, "'j2'", 4)) << all_problems(m);
}

TEST(UrdfCheck, LoopsThatHangOnNothingAreLeftOut) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="r0"/><link name="a"/><link name="b"/>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)");
  ASSERT_EQ(m.file_links.size(), 1u);
  EXPECT_EQ(m.file_links[0].name, "r0");
  EXPECT_TRUE(says(m, Severity::error, "loop", 1));
}

TEST(UrdfCheck, TheLargestOfSeveralTreesIsTaken) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="stray"/><link name="a"/><link name="b"/>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>)");
  ASSERT_EQ(m.file_links.size(), 2u);
  EXPECT_EQ(m.file_links[0].name, "a");
  EXPECT_TRUE(says(m, Severity::error, "'stray' is not connected", 1));
}

TEST(UrdfCheck, PathsDoubledFortyTimesTakeNoTime) {
  // walked as paths it would be 2^40 of them
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

TEST(UrdfCheck, JointsOfOneNameAreKeptApart) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="j" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/></joint></robot>)");
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[0].name, "j");
  EXPECT_EQ(m.joints[1].name, "j_2");
  EXPECT_TRUE(says(m, Severity::error, "'j' is there twice", 3));
}

TEST(UrdfCheck, PlanesDoNotMove) {
  const BodyModel m = import_text(
      R"(<robot name="r"><link name="a"/><link name="b"><collision><geometry><plane/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  EXPECT_TRUE(m.links[1].collisions.empty());
  EXPECT_TRUE(says(m, Severity::error, "<plane>", 1)) << all_problems(m);
}

TEST(UrdfCheck, ComplaintsAreBounded) {
  std::string text = "<robot name=\"r\"><link name=\"a\"/>";
  for (int i = 0; i < 5000; ++i) text += "<link/>";
  const BodyModel m = import_text(text + "</robot>");
  EXPECT_LE(m.problems.size(), 301u);
  EXPECT_NE(m.problems.back().text.find("more complaints"), std::string::npos);
}

struct Refused {
  const char* name;
  const char* text;
  const char* says;
};

class NoBody : public ::testing::TestWithParam<Refused> {};

TEST_P(NoBody, IsRefusedWithPlaceAndCure) {
  const auto refused = try_import(GetParam().text);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().find("robot.urdf:"), 0u) << refused.error();
  EXPECT_NE(refused.error().find(GetParam().says), std::string::npos) << refused.error();
}

INSTANTIATE_TEST_SUITE_P(
    Files, NoBody,
    ::testing::Values(
        Refused{"empty", "", "robot.urdf:1: is empty"}, Refused{"blank", " \n ", "is empty"},
        Refused{"no_xml", "hello", "no XML element"},
        Refused{"not_robot", "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\"/>", ":2: the root element is <sdf>"},
        Refused{"no_link", "<robot name=\"r\"/>", "no link is left"},
        Refused{"unnamed_link", "<robot name=\"r\">\n<link/></robot>", "line 2: a <link> has no name"},
        Refused{"cut_off", "<robot name=\"r\">\n<link name=\"a\"/></robo", "may be cut off"},
        Refused{"mismatch", "<robot name=\"r\"><link name=\"a\"></robot></link>", "end tag"},
        Refused{"attribute_twice", "<robot name=\"r\">\n<link name=\"a\" name=\"b\"/></robot>", ":2: an attribute"},
        Refused{"loop", R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="j2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)",
                ":2: the joints run in a circle"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace limber
