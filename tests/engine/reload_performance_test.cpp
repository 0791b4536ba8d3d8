// Unmanaged objects: made in callbacks, removed by commands, adopted by the scene; and models that change on disk.
#include <cmath>
#include <map>

#include "base/random.h"
#include "engine/edited.h"

namespace limber::engine::test {
namespace {

constexpr const char* kHeavyShow = R"(
sim.gravity = vec3(0, 0, 0)
local s = sim:add_sphere_shape("s", 0.1)
local stone = sim:add_body("stone")
stone:add_part("p", s, { position = vec3(0, 0, 1), friction = 0.3 })
osc:on("/copy", function(name)
  local copy = stone:copy(name, { position = vec3(3, 0, 1), linear_velocity = vec3(0, 1, 0) })
  copy.root.friction = 0.9
end)
osc:on("/shape", function() sim:add_body("box"):add_part("b", sim:add_box_shape("own", vec3(1, 1, 1))) end)
--MORE
)";

TEST(ReloadUnmanaged, ObjectsOfCallbacksSurviveReloadsButNotAReset) {
  EditedShow edited(kHeavyShow);
  edited.show().send("/copy", "mine");
  edited.show().send("/shape");
  edited.show().ticks(30);
  const std::vector<double> there = motion_of(edited.part("mine", "p"));
  edited.edit("--MORE", "-- nothing");
  edited.edit("friction = 0.3", "friction = 0.4");
  EXPECT_EQ(motion_of(edited.part("mine", "p")), there);
  EXPECT_EQ(edited.show().read("/physics/body/mine/part/p/friction"), 0.9);
  EXPECT_NE(edited.world().shapes().find("own"), nullptr);
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().find_body("mine"), nullptr);
  EXPECT_EQ(edited.world().shapes().find("own"), nullptr);
}

TEST(ReloadUnmanaged, ObjectsAreAdoptedWhenTheSceneDeclaresThem) {
  EditedShow edited(kHeavyShow);
  edited.show().send("/copy", "mine");
  edited.show().ticks(30);
  const NodeId id = edited.body("mine").id();
  const Vec3 there = edited.part("mine", "p").pose().position;
  ASSERT_NE(there.y, 0);
  edited.edit("--MORE", "sim:add_body('mine'):add_part('p', s, { restitution = 0.5 })");
  EXPECT_EQ(edited.body("mine").id(), id);
  EXPECT_EQ(edited.part("mine", "p").pose().position, there) << "no position was set";
  EXPECT_EQ(edited.show().read("/physics/body/mine/part/p/restitution"), 0.5);
  EXPECT_EQ(edited.show().read("/physics/body/mine/part/p/friction"), 0.9) << "nor a friction";
  edited.edit("restitution = 0.5", "restitution = 0.5, position = vec3(5, 0, 0)");
  EXPECT_EQ(edited.part("mine", "p").pose().position, Vec3(5, 0, 0));
  // from now on it belongs to the scene
  edited.edit("sim:add_body('mine')", "sim:add_body('yours')");
  EXPECT_EQ(edited.world().find_body("mine"), nullptr);
}

TEST(ReloadUnmanaged, AnAdoptedObjectOfOtherConstructionIsRebuiltInPlace) {
  EditedShow edited(kHeavyShow);
  edited.show().send("/copy", "mine");
  edited.show().ticks(30);
  const Pose there = edited.part("mine", "p").pose();
  edited.edit("--MORE", "sim:add_body('mine'):add_part('p', sim:add_box_shape('box', vec3(1, 1, 1)))");
  EXPECT_EQ(edited.world().shapes().find("box")->id(), edited.part("mine", "p").shape());
  EXPECT_EQ(edited.part("mine", "p").pose().position, there.position);
  EXPECT_EQ(edited.part("mine", "p").linear_velocity(), Vec3(0, 1, 0));
  EXPECT_EQ(edited.show().read("/physics/body/mine/part/p/friction"), 0.9);
}

TEST(ReloadUnmanaged, RemovedObjectsAreAddedAgainAtTheirStart) {
  EditedShow edited(kHeavyShow);
  edited.show().ticks(3);
  edited.show().send("/physics/part/friction", "stone", 0.9);
  edited.show().send("/physics/body/stone/remove");
  edited.show().ticks(1);
  ASSERT_EQ(edited.world().find_body("stone"), nullptr);
  edited.edit("--MORE", "-- nothing");
  ASSERT_NE(edited.world().find_body("stone"), nullptr);
  EXPECT_EQ(edited.part("stone", "p").pose().position, Vec3(0, 0, 1));
  EXPECT_EQ(edited.show().read("/physics/body/stone/part/p/friction"), 0.3);
  edited.show().send("/copy", "again");
  edited.show().ticks(1);
  EXPECT_NE(edited.world().find_body("again"), nullptr) << "the run's handle refers to the added body";
}

TEST(ReloadUnmanaged, ACallbackCanReplaceABodyOfTheSameName) {
  EditedShow edited(std::string(kHeavyShow) + R"(
osc:on("/swap", function()
  stone:remove()
  sim:add_body("stone"):add_part("p", sim:add_box_shape("brick", vec3(1, 1, 1)), { position = vec3(0, 0, 9) })
end))");
  edited.show().send("/swap");
  edited.show().ticks(2);
  edited.edit("--MORE", "-- nothing");
  EXPECT_EQ(edited.world().shapes().find("s")->id(), edited.part("stone", "p").shape())
      << "constructed as in the scene";
  EXPECT_EQ(edited.part("stone", "p").pose().position, Vec3(0, 0, 1)) << "and at its start pose";
}

std::string crane(const char* length, const char* mass, const char* extra = "") {
  return fmt::format(R"(<robot name="crane"><link name="base"/>
<link name="jib"><inertial><origin xyz="0 0 0.5"/><mass value="{}"/>
  <inertia ixx="0.2" iyy="0.2" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hook"><inertial><mass value="0.5"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>{}
<joint name="lift" type="revolute"><parent link="base"/><child link="jib"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="30" velocity="2"/></joint>
<joint name="swing" type="revolute"><parent link="jib"/><child link="hook"/><origin xyz="0 0 {}"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="30" velocity="2"/></joint></robot>)",
                     mass, extra, length);
}

TEST(ReloadModels, AChangedUrdfIsRebuiltAtTheCurrentPose) {
  EditedShow edited(
      "local c = sim:load_urdf('urdf/crane.urdf', { motors = 'off' })\nc:copy('twin', { position = vec3(3, 0, 0) })\n"
      "c:motor('lift').damping = 0.2",
      {{"urdf/crane.urdf", crane("1", "2")}});
  edited.show().send("/physics/part/friction", "crane", "jib", 0.9);
  edited.show().ticks(1);
  edited.show().send("/physics/part/angularvelocity", "twin", "jib", 0, 1, 0);
  edited.show().ticks(10);
  for (const char* name : {"crane", "twin"}) {
    const double lift = edited.body(name).find_joint("lift")->value();
    const Pose root = edited.body(name).pose();
    edited.folder.write("urdf/crane.urdf", crane(name[0] == 'c' ? "1.5" : "2.5", "3"));
    ASSERT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
    edited.world().flush();
    EXPECT_NEAR(edited.body(name).find_joint("lift")->value(), lift, 1e-6);
    EXPECT_EQ(edited.body(name).pose().position, root.position);
    const Pose jib = edited.part(name, "jib").pose();
    EXPECT_NEAR(glm::length(edited.part(name, "hook").pose().position - jib.position), name[0] == 'c' ? 1.5 : 2.5,
                1e-4);
    EXPECT_EQ(edited.show().read(std::string("/physics/body/") + name + "/part/jib/mass"), 3) << "another default";
    EXPECT_EQ(edited.show().read(std::string("/physics/body/") + name + "/motor/lift/damping"),
              name[0] == 'c' ? 0.2 : 0);
  }
  EXPECT_EQ(edited.show().read("/physics/body/crane/part/jib/friction"), 0.9);
}

TEST(ReloadModels, AddedAndRemovedLinksDoNotMoveOthers) {
  EditedShow edited("sim.gravity = vec3(0, 0, 0) sim:load_urdf('urdf/crane.urdf', { motors = 'off' })",
                    {{"urdf/crane.urdf", crane("1", "2")}});
  edited.show().send("/physics/part/angularvelocity", "crane", "jib", 0, 1, 0);
  edited.show().ticks(20);
  const std::vector<double> jib = motion_of(edited.part("crane", "jib"));
  const std::vector<double> hook = motion_of(edited.part("crane", "hook"));
  edited.folder.write("urdf/crane.urdf", crane("1", "2", R"(<link name="lamp"/><joint name="lamp" type="continuous">
<parent link="hook"/><child link="lamp"/><origin xyz="0 0 0.3"/></joint>)"));
  ASSERT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  ASSERT_NE(edited.body("crane").find_part("lamp"), nullptr);
  EXPECT_EQ(motion_of(edited.part("crane", "jib")), jib);
  EXPECT_EQ(motion_of(edited.part("crane", "hook")), hook);
  const Pose at = edited.part("crane", "hook").pose();
  EXPECT_NEAR(glm::length(edited.part("crane", "lamp").pose().position - at * Vec3(0, 0, 0.3)), 0, 1e-6);
  edited.show().ticks(3);
}

TEST(ReloadModels, ATouchedFileChangesNothing) {
  const std::string scene = "sim.gravity = vec3(0, 0, -9.81) sim:load_urdf('urdf/crane.urdf', { motors = 'off' })";
  EditedShow edited(scene, {{"urdf/crane.urdf", crane("1", "2")}});
  EditedShow control(scene, {{"urdf/crane.urdf", crane("1", "2")}});
  edited.show().ticks(20);
  control.show().ticks(20);
  edited.folder.write("urdf/crane.urdf", crane("1", "2"));
  ASSERT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  edited.show().ticks(20);
  control.show().ticks(20);
  EXPECT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash());
}

TEST(ReloadModels, AnEditedPoseTurnsItsJoints) {
  EditedShow edited(
      "sim.gravity = vec3(0, 0, 0) sim:load_urdf('urdf/crane.urdf', { motors = 'off', pose = { lift = 0.5 } })",
      {{"urdf/crane.urdf", crane("1", "2")}});
  edited.show().send("/physics/part/angularvelocity", "crane", "hook", 0, 1, 0);
  edited.show().ticks(20);
  const double swing = edited.body("crane").find_joint("swing")->value();
  ASSERT_GT(std::abs(swing), 0.1);
  edited.edit("lift = 0.5", "lift = 0.8");
  edited.world().flush();
  EXPECT_NEAR(edited.body("crane").find_joint("lift")->value(), 0.8, 1e-5);
  EXPECT_NEAR(edited.body("crane").find_joint("swing")->value(), swing, 1e-5);
}

TEST(ReloadModels, FilesOfTheRunAreListed) {
  EditedShow edited("require 'dance' sim:load_urdf('urdf/crane.urdf')",
                    {{"urdf/crane.urdf", crane("1", "2")},
                     {"scripts/lib/dance.lua", "require 'dance.steps'"},
                     {"scripts/lib/dance/steps.lua", ""}});
  const auto has = [&](const std::string& name) {
    for (const script::SourceFile& file : edited.show().engine.files()) {
      if (file.path == edited.folder.path(name)) return true;
    }
    return false;
  };
  for (const char* name :
       {"scripts/scene.lua", "scripts/lib/dance.lua", "scripts/lib/dance/steps.lua", "urdf/crane.urdf"})
    EXPECT_TRUE(has(name)) << name;
  EXPECT_TRUE(has("scripts/urdf/crane.urdf")) << "a new file in that folder takes precedence";
  EXPECT_FALSE(has("scripts/lib/other.lua"));
  // a failed run must be tried again when the missing file appears
  edited.edit("require 'dance'", "require 'other'");
  EXPECT_TRUE(has("scripts/lib/other.lua"));
  EXPECT_TRUE(has("scripts/lib/dance.lua")) << "the files of the successful run stay";
  edited.folder.write("scripts/lib/other.lua", "");
  EXPECT_EQ(edited.show().engine.reload_now(), SceneReloader::ApplyResult::applied);
  EXPECT_FALSE(has("scripts/lib/dance.lua"));
}

// a file may be saved before it is watched, so the text that was read is compared with the file then
TEST(ReloadModels, ListedFilesHaveTheContentsThatWereRead) {
  const ShowFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    folder.write(name, text);
    return std::pair(folder.path(name), hash_bytes(text));
  };
  const std::string mesh = R"(<link name="shell"><visual><geometry><mesh filename="jib.stl"/></geometry></visual></link>
<joint name="fix" type="fixed"><parent link="jib"/><child link="shell"/></joint>)";
  std::map<std::string, std::uint64_t> read = {
      write("scripts/lib/dance.lua", "return 1"), write("urdf/crane.urdf", crane("1", "2", mesh.c_str())),
      write("urdf/jib.stl",
            "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
            "endfacet\nendsolid s\n")};
  const auto hashes_of_files = [&](const Engine& engine) {
    std::map<std::string, std::uint64_t> all;
    for (const script::SourceFile& file : engine.files()) {
      if (file.content) all[file.path] = *file.content;
    }
    return all;
  };
  const std::string scene = R"(
params { { "count", 1, min = 0, max = 9, rerun = true } }
require 'dance'
sim:load_urdf('urdf/crane.urdf')
)";
  read.insert(write("scripts/scene.lua", scene));
  Show show(folder.path("scripts/scene.lua"));
  EXPECT_EQ(hashes_of_files(show.engine), read);
  show.send("/scene/count", 2.0);
  show.ticks(2);
  EXPECT_EQ(hashes_of_files(show.engine), read) << "after a run without the disk";
  // the first run fails, in a file that it includes
  read[folder.path("scripts/scene.lua")] = write("scripts/scene.lua", scene + "require 'broken'").second;
  read.insert(write("scripts/lib/broken.lua", "oh no"));
  EngineLink link;
  Engine engine(link, fast_options(folder.path("scripts/scene.lua")));
  EXPECT_FALSE(engine.start().ok());
  EXPECT_EQ(hashes_of_files(engine), read);
}

}  // namespace
}  // namespace limber::engine::test
