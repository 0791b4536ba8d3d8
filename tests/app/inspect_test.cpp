// `limber inspect`: the JSON, the table, the exit codes.
#include "app/commands/commands.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "model/mesh/surface.h"
#include "model/urdf/import.h"

namespace limber::app {
namespace {

using nlohmann::json;

constexpr const char* kRobot = R"(<robot name="r"><link name="base"/>
<link name="arm"><inertial><origin xyz="0 0 0.5"/><mass value="2"/><inertia ixx="1" ixy="0.1" ixz="0.2" iyy="1.5" iyz="0.3" izz="1.25"/></inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual></link><link name="mark"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 2 0"/><limit lower="0.5" upper="1" effort="3" velocity="4"/></joint>
<joint name="weld" type="fixed"><parent link="arm"/><child link="mark"/><origin xyz="1 0 0"/></joint></robot>)";

model::BodyModel model() {
  model::MeshLibrary meshes;
  const auto imported = model::import_urdf_text(kRobot, "r.urdf", {}, meshes);
  EXPECT_TRUE(imported);
  return **imported;
}

TEST(Inspect, JsonHasEveryLinkAndJointOfTheFile) {
  const json j = json::parse(inspect_json(model()));
  EXPECT_EQ(j.at("robot"), "r");
  ASSERT_EQ(j.at("links").size(), 3u);
  const json& arm = j["links"][1];
  EXPECT_EQ(arm.at("name"), "arm");
  EXPECT_EQ(arm.at("mass"), 2.0);
  EXPECT_EQ(arm.at("com"), json({0.0, 0.0, 0.5}));
  EXPECT_EQ(arm.at("inertia"), json({1.0, 0.1, 0.2, 1.5, 0.3, 1.25}));
  EXPECT_EQ(arm.at("visuals"), 1);
  EXPECT_EQ(arm.at("collisions"), 0);
  EXPECT_EQ(arm.at("home").at("position"), json({0.0, 0.0, 1.0}));
  EXPECT_EQ(arm.at("home").at("rotation"), json({0.0, 0.0, 0.0, 1.0}));
  // 0 is below the joint's limits: it starts at 0.5 about y
  EXPECT_NEAR(arm.at("start").at("rotation").at(1).get<double>(), std::sin(0.25), 1e-12);
  const json& mark = j["links"][2];
  EXPECT_EQ(mark.at("home").at("position"), json({1.0, 0.0, 1.0}));
  EXPECT_NEAR(mark.at("start").at("position").at(0).get<double>(), std::cos(0.5), 1e-12);
  EXPECT_NEAR(mark.at("start").at("position").at(2).get<double>(), 1 - std::sin(0.5), 1e-12);
}

TEST(Inspect, ListsMimicRelations) {
  model::MeshLibrary meshes;
  const auto imported = model::import_urdf_text(R"(<robot name="jaw"><link name="post"/><link name="a"/><link name="b"/>
<joint name="lead" type="continuous"><parent link="post"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="follow" type="continuous"><parent link="post"/><child link="b"/><axis xyz="0 0 1"/><mimic joint="lead" multiplier="-2" offset="0.5"/></joint></robot>)",
                                                "jaw.urdf", {}, meshes);
  ASSERT_TRUE(imported);
  const json joints = json::parse(inspect_json(**imported))["joints"];
  EXPECT_FALSE(joints.at(0).contains("mimic"));
  EXPECT_EQ(joints.at(1).at("mimic"), json({{"joint", "lead"}, {"multiplier", -2.0}, {"offset", 0.5}}));
  const std::string table = inspect_table(**imported);
  EXPECT_NE(table.find("\nmimic\n  follow = -2 * lead + 0.5\n"), std::string::npos) << table;
}

TEST(Inspect, ListsLoops) {
  model::MeshLibrary meshes;
  const auto imported =
      model::import_urdf_text(R"(<robot name="ring" xmlns:limber="x"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="k" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/></joint>
<limber:loop name="closing" type="ball"><parent link="b"/><child link="c"/></limber:loop></robot>)",
                              "ring.urdf", {}, meshes);
  ASSERT_TRUE(imported);
  EXPECT_EQ(json::parse(inspect_json(**imported)).at("loops"),
            json::array({{{"name", "closing"}, {"type", "spherical"}, {"parent", "b"}, {"child", "c"}}}));
  const std::string table = inspect_table(**imported);
  EXPECT_NE(table.find("\nloops\n  closing: spherical, b -> c\n"), std::string::npos) << table;
}

TEST(Inspect, ListsColorsAndLinksWithoutCollision) {
  model::MeshLibrary meshes;
  const auto imported =
      model::import_urdf_text(R"(<robot name="two"><material name="skin"><color rgba="0.8 0.6 0.5 1"/></material>
<link name="a"><visual><geometry><sphere radius="1"/></geometry><material name="skin"/></visual>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<link name="b"><visual><geometry><box size="1 1 1"/></geometry><material name="skin"/></visual>
<visual><geometry><box size="2 1 1"/></geometry><material name=""><color rgba="0 0 1 0.5"/></material></visual></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>)",
                              "two.urdf", {}, meshes);
  ASSERT_TRUE(imported);
  const json all = json::parse(inspect_json(**imported));
  EXPECT_EQ(all.at("materials"), json({{{"color", {0.8, 0.6, 0.5, 1.0}}, {"links", {"a", "b"}}},
                                       {{"color", {0.0, 0.0, 1.0, 0.5}}, {"links", json::array({"b"})}}}));
  EXPECT_EQ(all.at("no_collision"), json::array({"b"}));
  const std::string table = inspect_table(**imported);
  EXPECT_NE(table.find("\n  0.8 0.6 0.5 1: a, b\n  0 0 1 0.5: b\n"), std::string::npos) << table;
  EXPECT_NE(table.find("links without collision shapes (they touch nothing)\n  b\n"), std::string::npos) << table;
}

TEST(Inspect, ListsHullsSurfacesAndTendons) {
  model::BodyModel m = model();
  auto mesh = std::make_shared<model::MeshModel>();
  mesh->name = "angle";
  mesh->pieces.resize(2);  // boxes
  mesh->closed = true;
  mesh->unit_inertial.mass = 2;
  mesh->hull_volume = 2.5;
  model::PlacedShape& shape = m.links[1].collisions.emplace_back();
  shape.shape.kind = model::ShapeKind::mesh;
  shape.shape.mesh = mesh;
  auto triangle = std::make_shared<model::MeshModel>();
  triangle->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle->triangles = {0, 1, 2};
  model::PlacedShape& ground = m.links[0].collisions.emplace_back(shape);
  ground.shape.mesh = triangle;
  ground.shape.surface = std::make_shared<model::Surface>(triangle);
  m.tendons.push_back({"cable", {{0, {}}, {1, {}}}, 100, 2, 0.5, false, {}});
  const json all = json::parse(inspect_json(m));
  EXPECT_EQ(all.at("hulls"),
            json({{{"link", "arm"}, {"mesh", "angle"}, {"count", 2}, {"volume_ratio", 1.25}, {"error", 0.0}}}));
  EXPECT_EQ(all.at("surfaces"), json({{{"link", "base"}, {"triangles", 1}}}));
  EXPECT_EQ(all.at("tendons"), json({{{"name", "cable"},
                                      {"links", {"base", "arm"}},
                                      {"stiffness", 100.0},
                                      {"damping", 2.0},
                                      {"rest", 0.5},
                                      {"pushes", false}}}));
  const std::string table = inspect_table(m);
  for (const char* part :
       {"surface of 1 triangle", "2 convex pieces (2 boxes; 1.25 times the mesh's volume, farthest vertex 0 m outside)",
        "\ntendons\n  cable: through base, arm, 100 N/m, 2 N·s/m, rest length 0.5 m\n"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
}

TEST(Inspect, JsonLimitsAreNullWhenFree) {
  model::BodyModel m = model();
  json j = json::parse(inspect_json(m))["joints"][0];
  EXPECT_EQ(j.at("name"), "turn");
  EXPECT_EQ(j.at("type"), "revolute");
  EXPECT_EQ(j.at("axis"), json({0.0, 1.0, 0.0}));
  EXPECT_EQ(j.at("lower"), 0.5);
  EXPECT_EQ(j.at("upper"), 1.0);
  EXPECT_EQ(j.at("effort"), 3.0);
  EXPECT_EQ(j.at("velocity"), 4.0);
  EXPECT_EQ(j.at("free"), false);
  m.file_joints[0].free = true;
  j = json::parse(inspect_json(m))["joints"][0];
  EXPECT_TRUE(j.at("lower").is_null());
  EXPECT_TRUE(j.at("upper").is_null());
}

TEST(Inspect, ProblemsHaveLineSeverityTextCure) {
  const json problems = json::parse(inspect_json(model())).at("problems");
  ASSERT_FALSE(problems.empty());
  bool found = false;
  for (const json& p : problems) {
    EXPECT_EQ(p.size(), 4u);
    EXPECT_FALSE(p.at("cure").get<std::string>().empty());
    const bool start = p.at("text").get<std::string>().find("starts at 0.5") != std::string::npos;
    found = found || (start && p.at("line") == 4 && p.at("severity") == "note");
  }
  EXPECT_TRUE(found) << problems.dump(1);
}

TEST(Inspect, TableNamesEverything) {
  const std::string table = inspect_table(model());
  for (const char* part :
       {"r: 3 links, 2 joints, 2 kg", "base -> arm", "0.5 .. 1", "mark: merged into arm", "r.urdf:4: note: "}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
}

TEST(Inspect, ExitCodeIsOneOnlyWithoutABody) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("limber_inspect_" + std::to_string(getpid()) + ".urdf");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::ofstream(file) << kRobot;
  const int good = inspect_command({file.string(), true, {}, {}});
  std::ofstream(file) << "<robot name=\"r\"><link name=\"a\"></robot>";
  const int bad = inspect_command({file.string(), true, {}, {}});
  std::filesystem::remove(file);
  const int missing = inspect_command({file.string(), true, {}, {}});
  const std::string out = testing::internal::GetCapturedStdout();
  const std::string err = testing::internal::GetCapturedStderr();
  EXPECT_EQ(good, 0);
  EXPECT_EQ(bad, 1);
  EXPECT_EQ(missing, 1);
  EXPECT_EQ(json::parse(out).at("robot"), "r") << "only the result of the valid file goes to stdout";
  EXPECT_NE(err.find(file.string() + ":1: "), std::string::npos) << err;
  EXPECT_NE(err.find("file not found"), std::string::npos) << err;
}

}  // namespace
}  // namespace limber::app
