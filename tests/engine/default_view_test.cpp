// The view of a scene that sets no camera: it frames the bodies, in new takes only.
#include "engine/edited.h"
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

constexpr const char* kFarBall = R"(
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_sphere_shape("ball", 0.5)
sim:add_body("ball"):add_part("p", ball, { position = vec3(20, 0, 1), mass = 1 })
-- more
)";

Vec3 camera(Show& show, const char* name) {
  const std::string path = std::string("/visuals/camera/") + name;
  return {show.read(path, 0), show.read(path, 1), show.read(path, 2)};
}

TEST(DefaultView, FramesTheBodiesUnlessTheSceneSetsTheCamera) {
  EditedShow framed(kFarBall);
  EXPECT_NEAR(glm::length(camera(framed.show(), "target") - Vec3(20, 0, 1)), 0, 1e-9);
  EditedShow set(std::string(kFarBall) + "visuals.camera.eye = vec3(4.5, -6, 3.5)");
  EXPECT_NEAR(glm::length(camera(set.show(), "target") - Vec3(0, 0, 1)), 0, 1e-9) << "even to the default";
}

TEST(DefaultView, StaysWhenTheSceneIsSaved) {
  EditedShow edited(kFarBall);
  Show& show = edited.show();
  ASSERT_EQ(edited.edit("-- more", "sim:add_body('b'):add_part('p', ball, { position = vec3(0, 0, 9), mass = 1 })"),
            SceneReloader::ApplyResult::applied);
  EXPECT_NEAR(glm::length(camera(show, "target") - Vec3(20, 0, 1)), 0, 1e-9);
  show.send("/transport/reset");
  show.ticks(1);
  EXPECT_NEAR(glm::length(camera(show, "target") - Vec3(10, 0, 5)), 0, 1e-9) << "a reset frames both bodies";
}

TEST(DefaultView, IsThatOfThePresetScript) {
  EditedShow edited(kFarBall);
  Show& show = edited.show();
  show.send("/visuals/camera/target", 1, 2, 3);
  show.send("/preset/recall", "script");
  show.ticks(1);
  EXPECT_NEAR(glm::length(camera(show, "target") - Vec3(20, 0, 1)), 0, 1e-9);
}

TEST(DefaultView, OldTakesKeepTheOldOne) {
  ShowFolder folder;
  folder.write("scene.lua", kFarBall);
  EngineOptions options = fast_options(folder.path("scene.lua"));
  options.record = folder.path("new.take");
  Vec3 eye(0);
  {
    Show show(options);
    show.ticks(3);
    show.send("/visuals/camera/target", 1, 2, 3);  // relative to the present eye
    show.ticks(3);
    eye = camera(show, "eye");
    show.engine.end_take();
    show.engine.finish_saving();
  }
  EXPECT_GT(glm::length(eye - Vec3(4.5, -6, 3.5)), 5);
  EXPECT_EQ(replay_take(options.record).error, "");
  EXPECT_FALSE(replay_take(options.record).result.diverged_at);
  std::string bytes = file_bytes(options.record);
  ASSERT_EQ(bytes.substr(0, 13), fmt::format("limber take {}", kTakeVersion));
  bytes[12] = '4';
  folder.write("old.take", bytes);
  EXPECT_EQ(replay_take(folder.path("old.take")).result.diverged_at, 4u) << "its camera is at another position";
}

}  // namespace
}  // namespace limber::engine::test
