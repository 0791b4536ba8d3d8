// Reports about URDF content that has no effect or an unexpected one; quaternions.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "model/problems.h"
#include "solids.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::has_problem;
using test::import_text;

TEST(Reported, QuaternionsRotateOrigins) {
  const BodyModel m = import_text(R"(<robot name="r" version="1.1"><link name="a"/><link name="b"/>
<joint name="j" type="fixed"><origin xyz="0 0 1" quat_xyzw="0 0 0.7071068 0.7071068"/><parent link="a"/><child link="b"/></joint></robot>)");
  EXPECT_LT(test::angle_between(m.file_links[1].home.rotation, quat_euler(0, 0, kPi / 2)), 1e-7);
  for (const Problem& p : m.problems) EXPECT_EQ(p.severity, Severity::note) << p.text;
}

TEST(Reported, QuaternionsRotateEveryOrigin) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><inertial>
<origin xyz="0 0 0" quat_xyzw="0.5 0.5 0.5 0.5"/><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial>
<collision><origin quat_xyzw="0.5 0.5 0.5 0.5"/><geometry><box size="1 2 3"/></geometry></collision></link></robot>)");
  // x -> y -> z -> x
  EXPECT_NEAR(m.file_links[0].tensor[1][1], 1, 1e-12);
  EXPECT_NEAR(m.file_links[0].tensor[2][2], 2, 1e-12);
  EXPECT_NEAR(m.file_links[0].tensor[0][0], 2.5, 1e-12);
  test::expect_near(m.links[0].collisions[0].origin.rotation * Vec3(1, 0, 0), {0, 1, 0}, 1e-12);
}

TEST(Reported, ReportsBadQuaternions) {
  const auto with = [](const char* origin) {
    return import_text(std::string(R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="fixed"><origin )") +
                       origin + R"(/><parent link="a"/><child link="b"/></joint></robot>)");
  };
  EXPECT_TRUE(has_problem(with("quat_xyzw=\"0 0 0 0\""), Severity::error, "not a rotation", 2));
  EXPECT_TRUE(has_problem(with("quat_xyzw=\"0 0 1\""), Severity::error, "3 numbers, expected 4", 2));
  EXPECT_TRUE(has_problem(with("quat_xyzw=\"0 0 0 2\""), Severity::note, "length 2", 2));
  const BodyModel both = with("rpy=\"1 0 0\" quat_xyzw=\"0 0 0 1\"");
  EXPECT_TRUE(has_problem(both, Severity::warning, "both rpy and quat_xyzw; rpy ignored", 2)) << all_problems(both);
  EXPECT_LT(test::angle_between(both.file_links[1].home.rotation, quat_identity()), 1e-12);
}

TEST(Reported, ReportsMisspelledAttributes) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="revolute"><origin RPY="0 0 1"/><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" uper="1" effort="1" velocity="1"/></joint>
<joint name="k" type="revolute"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/>
<limit lower="-1" uper="1" effort="1" velocity="1" drake:acceleration="4" xmlns:drake="x"/></joint></robot>)");
  EXPECT_TRUE(has_problem(m, Severity::warning, "<limit> has no attribute 'uper'; ignored in 2 places", 3))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "<origin> has no attribute 'RPY'; ignored", 2)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::note, "'drake:acceleration'", 5)) << all_problems(m);
  bool hinted = false;
  for (const Problem& p : m.problems) hinted = hinted || p.fix == "Did you mean 'upper'?";
  EXPECT_TRUE(hinted) << all_problems(m);
}

TEST(Reported, ReportsMisspelledElements) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="a"><colision/>
<collision><orign xyz="1 0 0"/><geometry><box size="1 1 1"/></geometry></collision>
<contact/><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<gazebo/><transmission/><sensor/></robot>)");
  EXPECT_TRUE(has_problem(m, Severity::warning, "1 <colision> element ignored", 1)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::warning, "1 <orign> element ignored", 2)) << all_problems(m);
  EXPECT_NE(all_problems(m).find("Did you mean <collision>?"), std::string::npos);
  for (const char* const kind : {"<contact>", "<gazebo>", "<transmission>", "<sensor>"}) {
    bool note = false;
    for (const Problem& p : m.problems)
      note = note || (p.severity == Severity::note && p.text.find(kind) != std::string::npos);
    EXPECT_TRUE(note) << kind << '\n' << all_problems(m);
  }
}

TEST(Reported, ReportsUndefinedMaterials) {
  const BodyModel m = import_text(R"(<robot name="r"><material name="red"><color rgba="1 0 0 1"/></material>
<link name="a"><visual><geometry><sphere radius="1"/></geometry><material name="rde"/></visual>
<visual><geometry><sphere radius="1"/></geometry><material name="rde"/></visual>
<visual><geometry><sphere radius="1"/></geometry><material name="red"/></visual></link></robot>)");
  EXPECT_TRUE(has_problem(m, Severity::warning, "material 'rde' of 2 visuals is not defined", 2)) << all_problems(m);
  std::size_t materials = 0;
  for (const Problem& p : m.problems) materials += p.text.find("material") != std::string::npos ? 1u : 0u;
  EXPECT_EQ(materials, 1u);
}

TEST(Reported, CountsLinksWithoutCollision) {
  const BodyModel m = import_text(R"(<robot name="r"><link name="base"/>
<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link><link name="b"/>
<joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="k" type="continuous"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  EXPECT_TRUE(has_problem(m, Severity::warning, "2 links have no collision geometry: a, b", 2)) << all_problems(m);
}

TEST(Reported, ReportsHullsThatFillAHollow) {
  const test::Files files;
  // a cup: 10 cm wide inside, walls of 1 cm
  files.write("cup.stl", test::binary_stl(
                             test::revolved({{0, 0}, {0.1, 0}, {0.1, 0.2}, {0.09, 0.2}, {0.09, 0.01}, {0, 0.01}}, 32)));
  files.write("solid.stl", test::binary_stl(test::revolved({{0, 0}, {0.1, 0}, {0.07, 0.2}, {0, 0.2}}, 32)));
  const auto import = [&](const std::string& mesh) {
    const std::string shape = "<collision><geometry><mesh filename=\"" + mesh + "\"/></geometry></collision>";
    const std::string path =
        files.write("robot.urdf", "<robot name=\"r\">\n<link name=\"a\">" + shape + shape + "</link></robot>");
    const auto model = import_urdf(path);
    return model ? **model : BodyModel{};
  };
  const BodyModel cup = import("cup.stl");
  EXPECT_TRUE(has_problem(cup, Severity::warning, "'cup' fills its hollows: ", 2)) << all_problems(cup);
  EXPECT_TRUE(has_problem(cup, Severity::warning, "… and 1 more of this kind", 2)) << all_problems(cup);
  // a trough of three boxes that share edges; its hull is a box
  test::Solid trough = test::box({0.4, 0.4, 0.04});
  trough.add(test::box({0.04, 0.4, 0.26}).moved({{0.18, 0, 0.15}, quat_identity()}));
  trough.add(test::box({0.04, 0.4, 0.26}).moved({{-0.18, 0, 0.15}, quat_identity()}));
  files.write("trough.stl", test::binary_stl(trough));
  const BodyModel joined = import("trough.stl");
  EXPECT_TRUE(has_problem(joined, Severity::warning, "'trough' fills its hollows: 3.26 times its volume", 2))
      << all_problems(joined);
  const BodyModel solid = import("solid.stl");
  ASSERT_EQ(solid.links.size(), 1u);
  EXPECT_EQ(all_problems(solid).find("hollow"), std::string::npos) << all_problems(solid);
}

TEST(Reported, ConcaveMeshesAreSurfacesOfFixedLinksOnly) {
  const test::Files files;
  test::Solid trough = test::box({0.4, 0.4, 0.04});
  files.write("trough.stl", test::binary_stl(trough));
  files.write("robot.urdf", R"(<robot name="r"><link name="a">
<collision concave="yes"><geometry><mesh filename="trough.stl"/></geometry></collision>
<collision concave="no"><geometry><mesh filename="trough.stl"/></geometry></collision></link><link name="b">
<inertial><mass value="1"/></inertial><collision><geometry><mesh filename="trough.stl" concave="yes"/></geometry></collision>
</link><joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  const auto model = import_urdf(files.path("robot.urdf"));
  ASSERT_TRUE(model) << model.error();
  const std::vector<LinkModel>& links = (*model)->links;
  EXPECT_NE(links[0].collisions[0].shape.surface, nullptr);
  EXPECT_EQ(links[0].collisions[0].shape.kind, ShapeKind::mesh) << "not the box that it is";
  EXPECT_EQ(links[0].collisions[1].shape.surface, nullptr);
  EXPECT_EQ(links[1].collisions[0].shape.surface, nullptr);
  EXPECT_TRUE(links[1].collisions[0].shape.mesh->pieces.empty()) << "convex";
  EXPECT_EQ(all_problems(**model).find("concave"), std::string::npos) << all_problems(**model);
}

TEST(Reported, DecomposesConcaveMeshes) {
  const test::Files folder;
  test::Solid angle = test::box({3, 1, 1});
  angle.add(test::box({1, 1, 2}).moved({{-1, 0, 1.5}, quat_identity()}));
  folder.write("angle.stl", test::binary_stl(angle));
  test::Solid open = angle;
  open.triangles.resize(open.triangles.size() - 3);
  folder.write("open.stl", test::binary_stl(open));
  const auto import = [&](const std::string& link, const std::string& collision, const std::string& geometry) {
    folder.write("r.urdf", "<robot name=\"r\"><link name=\"a\" " + link +
                               "><inertial><mass value=\"1\"/></inertial>\n<collision " + collision +
                               "><geometry><mesh " + geometry + "/></geometry></collision></link></robot>");
    const auto model = import_urdf(folder.path("r.urdf"));
    EXPECT_TRUE(model);
    return model ? **model : BodyModel();
  };
  const std::string file = "filename=\"angle.stl\"";
  for (const BodyModel& m : {import("concave=\"yes\"", "", file), import("", "concave=\"true\"", file),
                             import("", "", file + " concave=\"1\"")}) {
    ASSERT_EQ(m.links.size(), 1u);
    EXPECT_EQ(m.links[0].collisions[0].shape.mesh->pieces.size(), 2u);
    EXPECT_EQ(all_problems(m).find("concave"), std::string::npos) << all_problems(m);
    EXPECT_EQ(all_problems(m).find("hollow"), std::string::npos) << all_problems(m);
  }
  const BodyModel convex = import("", "concave=\"no\"", file);
  EXPECT_TRUE(convex.links[0].collisions[0].shape.mesh->pieces.empty());
  const BodyModel holed = import("", "concave=\"yes\"", "filename=\"open.stl\"");
  EXPECT_TRUE(has_problem(holed, Severity::warning,
                          "mesh 'open.stl' is open, so that its hollows are unknown; it collides as its hull", 2))
      << all_problems(holed);
}

TEST(Reported, SelfCollideExcludesALink) {
  const auto links = [](const std::string& gazebo) {
    return import_text(R"(<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
)" + gazebo + "</robot>");
  };
  const BodyModel one = links("<gazebo reference=\"b\"><selfCollide>false</selfCollide></gazebo>");
  EXPECT_TRUE(one.links[0].self_collision);
  EXPECT_FALSE(one.links[1].self_collision);
  EXPECT_FALSE(links("<gazebo reference='b'><self_collide>0</self_collide></gazebo>").links[1].self_collision);
  EXPECT_TRUE(links("<gazebo reference='b'><selfCollide>true</selfCollide></gazebo>").links[1].self_collision);
  const BodyModel all = links(
      "<gazebo><selfCollide>false</selfCollide></gazebo><gazebo reference='a'><selfCollide>1</selfCollide></gazebo>");
  EXPECT_TRUE(all.links[0].self_collision);
  EXPECT_FALSE(all.links[1].self_collision);
  EXPECT_TRUE(has_problem(links("<gazebo reference='zz'><selfCollide>false</selfCollide></gazebo>"), Severity::warning,
                          "names no link", 3));
  EXPECT_TRUE(has_problem(links("<gazebo reference='a'><selfCollide>maybe</selfCollide></gazebo>"), Severity::warning,
                          "<selfCollide> is 'maybe'", 3));
}

TEST(Reported, GroupsMessagesByKind) {
  BodyModel m;
  m.file = "robot.urdf";
  for (int i = 0; i < 60; i++) {
    m.problems.push_back({i + 1, Severity::warning, "joint 'j" + std::to_string(i) + "' has no axis", "Write one."});
    m.problems.push_back({i + 1, Severity::note, "a note", "Nothing to do."});
  }
  m.problems.push_back({7, Severity::error, "link 'a' has no name", "Give it one."});
  const std::vector<std::string> lines = load_messages(m);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0],
            "robot.urdf:1: joint 'j0' has no axis … and 59 more of this kind (limber inspect lists them). Write one.");
  EXPECT_EQ(lines[1], "robot.urdf:7: link 'a' has no name. Give it one.");
}

}  // namespace
}  // namespace limber::model
