// Scenes of models: their text, the paths in it, and the models of folders.
#include "app/viewer/model_scene.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/program.h"
#include "app/viewer/model_file.h"
#include "base/lua_text.h"
#include "model/import.h"

namespace limber::app::test {
namespace {

// a box of 0.4 x 0.2 x 0.1 m around the origin, on a leg whose end is a sphere of radius 0.05 at z = -0.5
constexpr const char* kHopper = R"(<robot name="hopper">
<link name="trunk"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.4 0.2 0.1"/></geometry><material name="m"><color rgba="0.9 0.05 0.05 1"/></material></visual>
<collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>
<link name="foot"><inertial><mass value="0.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="hip" type="revolute"><parent link="trunk"/><child link="foot"/><axis xyz="0 1 0"/><limit lower="-1" upper="0.5" effort="50" velocity="9"/></joint>
</robot>)";

std::shared_ptr<const model::BodyModel> import(const std::string& text) {
  model::MeshLibrary meshes;
  const auto model = model::import_model_text(text, "hopper.urdf", {}, meshes);
  EXPECT_TRUE(model.ok());
  return model ? *model : nullptr;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ModelScene, ListsMotorsWithTheirRanges) {
  const std::string text =
      model_scene_text({"/m/hopper.urdf", {}, "", {}}, "hopper.lua", "hopper.urdf", *import(kHopper));
  EXPECT_NE(text.find("--     limber hopper.lua\n"), std::string::npos) << text;
  EXPECT_NE(text.find("local robot = sim:load_urdf(\"hopper.urdf\")\n"), std::string::npos) << text;
  EXPECT_NE(text.find("-- robot:motor(\"hip\").target = 0 -- -1 .. 0.5 rad\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("visuals.camera"), std::string::npos) << "a common size needs no settings\n" << text;
  EXPECT_EQ(text.find("sim.substeps"), std::string::npos) << text;
}

TEST(ModelScene, TakesOverTheOptionsOfTheImport) {
  const std::string text =
      model_scene_text({"/m/hopper.urdf", {"/ros/a \"b\""}, "torso", {}}, "h.lua", "hopper.urdf", *import(kHopper));
  EXPECT_NE(text.find("{ root = \"torso\", package_path = { \"/ros/a \\\"b\\\"\" } }"), std::string::npos) << text;
}

TEST(ModelScene, NamesTheFloorDifferentlyBesideARobotOfThatName) {
  const std::string text = model_scene_text({"/m/f.urdf", {}, "", {}}, "f.lua", "f.urdf",
                                            *import(replaced(kHopper, "\"hopper\"", "\"floor\"")));
  EXPECT_NE(text.find("sim:add_body(\"ground\")"), std::string::npos) << text;
}

TEST(ModelScene, RunsForNastyNamesOfFiles) {
  const TempFolder folder;
  const std::vector<std::string> names = {"two words.urdf",
                                          "it's.urdf",
                                          "say \"hi\".urdf",
                                          "100%d %s.urdf",
                                          "back\\slash.urdf",
                                          "tänzerin 舞.urdf",
                                          "new\nline.urdf",
                                          "]] -- x.urdf",
                                          "bad\xff"
                                          "byte.urdf",
                                          "$HOME;`ls`.urdf"};
  for (const std::string& name : names) {
    const std::string file = folder.file("models/" + name, kHopper);
    const std::string scene = folder.path() + "/scene.lua";
    ASSERT_TRUE(save_model_scene({file, {}, "", {}}, scene, true)) << name;
    const RunResult saved = run({scene, "--fast", "--ticks", "2", "--hash"});
    EXPECT_EQ(saved.code, 0) << name << saved.err << content(scene);
    const RunResult direct = run({file, "--fast", "--ticks", "2", "--hash"});
    EXPECT_EQ(direct.code, 0) << name << direct.err;
    EXPECT_EQ(direct.out, saved.out) << name;
  }
}

TEST(ModelScene, RunsWithItsLinesUncommented) {
  const TempFolder folder;
  const std::string scene = folder.path() + "/scene.lua";
  ASSERT_TRUE(save_model_scene({folder.file("hopper.urdf", kHopper), {}, "", {}}, scene, false));
  std::string text = content(scene);
  int lines = 0;
  for (const std::string_view start : {"\n-- robot:", "\n-- sim:"}) {
    for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at)) {
      text.erase(at + 1, 3);
      lines++;
    }
  }
  EXPECT_EQ(lines, 2);
  folder.file("scene.lua", text);
  const RunResult result = run({scene, "--fast", "--ticks", "30", "--strict"});
  EXPECT_EQ(result.code, 0) << result.err << text;
}

TEST(ModelScene, PathsAreRelativeInsideTheFolderOfTheScene) {
  EXPECT_EQ(model_path_in_scene("/show/urdf/a.urdf", "/show/scene.lua"), "urdf/a.urdf");
  EXPECT_EQ(model_path_in_scene("/show/urdf/a.urdf", "/show/scripts/scene.lua"), "urdf/a.urdf");
  EXPECT_EQ(model_path_in_scene("/show/scripts/a.urdf", "/show/scripts/scene.lua"), "a.urdf");
  EXPECT_EQ(model_path_in_scene("/other/a.urdf", "/show/scene.lua"), "/other/a.urdf");
  EXPECT_EQ(model_path_in_scene("/show/urdf/a.urdf", "/show/dances/scene.lua"), "/show/urdf/a.urdf");
}

TEST(ModelScene, NeverOverwritesAFileWithoutTheOption) {
  const TempFolder folder;
  const std::string model = folder.file("hopper.urdf", kHopper);
  const std::string mine = folder.file("mine.lua", "-- mine\n");
  const Result<void> saved = save_model_scene({model, {}, "", {}}, mine, false);
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().find("already exists"), std::string::npos) << saved.error();
  EXPECT_EQ(content(mine), "-- mine\n");
  EXPECT_TRUE(save_model_scene({model, {}, "", {}}, mine, true));
  EXPECT_NE(content(mine).find("sim:load_urdf(\"hopper.urdf\")"), std::string::npos);
}

TEST(ModelScene, AdaptsCameraAndTimeStepToTheSize) {
  const auto scaled = [](const std::string& box) {
    return import(replaced(kHopper, "<collision><geometry><box size=\"0.4 0.2 0.1\"/>",
                           "<collision><geometry><box size=\"" + box + "\"/>"));
  };
  const auto text = [](const model::BodyModel& body) {
    return model_scene_text({"/m.urdf", {}, "", {}}, "m.lua", "m.urdf", body);
  };
  EXPECT_NE(text(*scaled("120 2 1")).find("visuals.camera.far = "), std::string::npos);
  model::BodyModel small = *import(kHopper);
  small.links.resize(1);
  small.joints.clear();
  small.links[0].collisions[0].shape.size = {0.01, 0.005, 0.004};
  EXPECT_NE(text(small).find("visuals.camera.near = 0.0005\n"), std::string::npos) << text(small);
  EXPECT_NE(text(small).find("sim.substeps = 13\n"), std::string::npos) << "4 * sqrt(0.1 / 0.01)\n" << text(small);
}

TEST(LuaString, EscapesWhatEndsAStringOrALine) {
  EXPECT_EQ(lua_string("a \"b\" \\ \n\r\t"), "\"a \\\"b\\\" \\\\ \\n\\013\\009\"");
  EXPECT_EQ(lua_string("ä\xff\x7f"), "\"ä\\255\\127\"");
  EXPECT_EQ(lua_string(std::string_view("\0"
                                        "1",
                                        2)),
            "\"\\0001\"");
}

TEST(FindModel, FindsTheOnlyModelOfAFolder) {
  const TempFolder folder;
  folder.file("robot/package.xml", "<package/>");
  folder.file("robot/urdf/hopper.urdf", kHopper);
  folder.file("robot/.git/other.urdf", kHopper);
  folder.file("robot/meshes/notes.txt", "");
  const Result<std::string> found = find_model(folder.path() + "/robot");
  ASSERT_TRUE(found) << found.error();
  EXPECT_EQ(*found, folder.path() + "/robot/urdf/hopper.urdf");
  folder.file("robot/top.xml", "<?xml version='1.0'?>\n<!-- a robot -->\n<mujoco/>");
  EXPECT_EQ(*find_model(folder.path() + "/robot"), folder.path() + "/robot/top.xml") << "its own files come first";
}

TEST(FindModel, NamesASceneOfAShow) {
  const TempFolder folder;
  folder.file("urdf/hopper.urdf", kHopper);
  folder.file("scripts/b.lua", "");
  folder.file("scripts/a.lua", "");
  const Result<std::string> found = find_model(folder.path());
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().find("such as " + folder.path() + "/scripts/a.lua"), std::string::npos) << found.error();
}

TEST(FindModel, ListsSeveralModels) {
  const TempFolder folder;
  folder.file("b.urdf", kHopper);
  folder.file("a.URDF", kHopper);
  const Result<std::string> found = find_model(folder.path());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error(),
            fmt::format("'{0}' contains 2 models; name one of them:\n  {0}/a.URDF\n  {0}/b.urdf", folder.path()));
}

TEST(FindModel, NamesTheAcceptedKinds) {
  const TempFolder folder;
  for (const std::string& path : {folder.path(), folder.file("a.stl", "")}) {
    const Result<std::string> found = find_model(path);
    ASSERT_FALSE(found) << path;
    EXPECT_NE(found.error().find("a model is a .urdf or .xml (MJCF) file"), std::string::npos) << found.error();
  }
  EXPECT_NE(find_model(folder.file("r.urdf.xacro", "")).error().find("xacro r.urdf.xacro"), std::string::npos);
}

}  // namespace
}  // namespace limber::app::test
