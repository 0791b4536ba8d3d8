// Models that are added to a running show: their name and place, resets and other scenes, takes, and errors.
#include "engine/reload/added_model.h"

#include <filesystem>

#include "engine/edited.h"
#include "engine/taken.h"
#include "model/import.h"
#include "sim/shapes/bounds.h"

namespace limber::engine::test {
namespace {

constexpr const char* kFloorScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { position = vec3(0, 0, 0.25) })
sim:add_body("box"):add_part("box", sim:add_box_shape("box", vec3(0.5, 0.5, 0.5)), { mass = 0, position = vec3(0, 0, 0.5) })
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 1, position = vec3(3, 0, 5) })
return 1
)";
// its origin is 0.7 m above the lower end of its cylinder, which lies along y
constexpr const char* kRoller = R"(<robot name="roller"><link name="wheel">
  <inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0 0 -0.5" rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.2" length="0.6"/></geometry></collision>
</link></robot>)";

struct AddedModels : testing::Test {
  AddedModels() : edited(kFloorScene, {{"roller.urdf", kRoller}}) {}

  Result<AddedModel> add(const std::string& name) {
    const std::string path = edited.folder.path(name);
    const auto model = model::import_model_text(kRoller, path, {}, meshes);
    EXPECT_TRUE(model.ok());
    Result<AddedModel> added = Error{};
    run_while_ticking(edited.show(), [&] { added = edited.show().engine.add_model(path, **model); });
    return added;
  }
  sim::Bounds bounds(const std::string& body) { return sim::bounds_of(edited.body(body)); }

  EditedShow edited;
  model::MeshLibrary meshes;
};

TEST_F(AddedModels, GetUniqueNamesAndFreePlacesOnTheFloor) {
  for (const char* name : {"roller", "roller_2", "roller_3"}) {
    const Result<AddedModel> added = add("roller.urdf");
    ASSERT_TRUE(added) << added.error();
    EXPECT_EQ(added->name, name);
    // computed from the file: radius 0.2 around a center that is 0.5 below the origin
    EXPECT_NEAR(added->position.z - 0.7, 0.25, 1e-9) << "the lowest point is on the floor";
  }
  const std::vector<std::string> names = {"box", "roller", "roller_2", "roller_3"};
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      EXPECT_EQ(bounds(a).overlaps(bounds(b)), a == b) << a << " " << b;
    }
    EXPECT_LT(glm::length(bounds(a).center()), 3) << "nearby";
  }
}

TEST_F(AddedModels, LeaveOtherObjectsUntouched) {
  edited.show().ticks(5);
  ASSERT_TRUE(add("roller.urdf"));
  EditedShow twin(kFloorScene);
  twin.show().ticks(static_cast<int>(edited.world().tick()));
  EXPECT_EQ(motion_of(edited.part("ball", "ball")), motion_of(twin.part("ball", "ball")));
}

TEST_F(AddedModels, SurviveResetsAndReloadsButNotAnotherScene) {
  ASSERT_TRUE(add("roller.urdf"));
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  EXPECT_NE(edited.world().find_body("roller"), nullptr);
  EXPECT_EQ(edited.edit("vec3(3, 0, 5)", "vec3(4, 0, 5)"), SceneReloader::ApplyResult::applied);
  EXPECT_NE(edited.world().find_body("roller"), nullptr);
  edited.folder.write("scripts/other.lua", "sim:add_body('other')");
  run_while_ticking(edited.show(),
                    [&] { EXPECT_TRUE(edited.show().engine.change_scene(edited.folder.path("scripts/other.lua"))); });
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  EXPECT_EQ(edited.world().body_names(), std::vector<std::string_view>{"other"});
}

TEST_F(AddedModels, WatchTheirFiles) {
  ASSERT_TRUE(add("roller.urdf"));
  const std::vector<script::SourceFile> files = edited.show().engine.files();
  const std::string path = edited.folder.path("roller.urdf");
  EXPECT_TRUE(std::ranges::any_of(files, [&](const script::SourceFile& file) { return file.path == path; }));
}

TEST_F(AddedModels, AreRejectedWithoutATrace) {
  const Result<AddedModel> added = add("missing.urdf");
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().find("missing.urdf"), std::string::npos) << added.error();
  EXPECT_EQ(edited.world().find_body("roller"), nullptr);
  EXPECT_EQ(edited.edit("vec3(3, 0, 5)", "vec3(4, 0, 5)"), SceneReloader::ApplyResult::applied) << "no line is left";
  EXPECT_TRUE(add("roller.urdf"));
}

TEST_F(AddedModels, ReplayFromTheTakeWithoutTheirFiles) {
  const std::string take = edited.folder.path("takes/added.take");
  std::filesystem::create_directories(edited.folder.path("takes"));
  edited.show().send("/take/record", "added");
  edited.show().ticks(10);
  ASSERT_TRUE(add("roller.urdf"));
  edited.show().ticks(30);
  edited.show().send("/transport/reset");
  edited.show().ticks(30);
  ASSERT_NE(edited.world().find_body("roller"), nullptr);
  edited.show().send("/take/stop");
  edited.show().ticks(1);
  const std::uint64_t hash = edited.show().engine.state_hash();
  edited.show().engine.finish_saving();
  edited.folder.remove("roller.urdf");
  expect_replay(take, hash);
  // played inside a show, its models stay when the show continues
  ASSERT_TRUE(play_take(edited.show(), take));
  while (edited.show().read("/take/plays") != 0) edited.show().ticks(1);
  EXPECT_NE(edited.world().find_body("roller"), nullptr);
}

TEST(NeedsServos, OnlyWithoutAnyActuator) {
  model::MeshLibrary meshes;
  const auto load = [&](const std::string& actuator) {
    const std::string text =
        "<mujoco><worldbody><body><joint name='a' axis='0 1 0'/><joint name='b'/>"
        "<geom size='0.1'/></body></worldbody>" +
        actuator + "</mujoco>";
    const auto model = model::import_model_text(text, "m.xml", {}, meshes);
    EXPECT_TRUE(model);
    return needs_servos(**model);
  };
  EXPECT_TRUE(load(""));
  EXPECT_FALSE(load("<actuator><motor joint='a'/></actuator>"));
}

}  // namespace
}  // namespace limber::engine::test
