// Playing models: the floor, files that are written, pictures, reloads, and models that are dropped on the window.
#include <stb_image.h>
#include <stdlib.h>

#include <map>
#include <thread>

#include "app/program.h"
#include "app/show/scene_loader.h"
#include "app/viewer/played_file.h"
#include "app/viewer/shown_models.h"
#include "engine/show.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::app::test {
namespace {

// A red box around the origin on a foot, a sphere whose lowest point is at z = -0.55; with a base, the box turns on it.
std::string hopper(const std::string& base = "") {
  return R"(<robot name="hopper">)" + base + R"(
<link name="trunk"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.4 0.2 0.1"/></geometry><material name="m"><color rgba="0.9 0 0 1"/></material></visual>
<collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>
<link name="foot"><inertial><mass value="0.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="hip" type="revolute"><parent link="trunk"/><child link="foot"/><axis xyz="0 1 0"/><limit lower="-1" upper="0.5" effort="50" velocity="9"/></joint>
</robot>)";
}
constexpr const char* kBase =
    "<link name='base'/><joint name='turn' type='continuous'><parent link='base'/><child link='trunk'/>"
    "<origin xyz='0 0 0.3'/><axis xyz='0 0 1'/></joint>";

/// All files of a folder with their contents.
std::map<std::string, std::string> files_of(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    files[entry.path().string()] = entry.is_regular_file() ? content(entry.path()) : "folder";
  return files;
}

/// A model, and a state folder of the test's own for its scene.
struct ViewerTest : testing::Test {
  ViewerTest() { setenv("XDG_STATE_HOME", (folder.path() + "/state").c_str(), 1); }

  std::string scene_of(const std::string& model) {
    const Result<PlayedFile> played = find_played(model);
    EXPECT_TRUE(played) << played.error();
    return played ? played->scene : "";
  }

  TempFolder folder;
  std::string model = folder.file("robot/hopper.urdf", hopper());
};

TEST_F(ViewerTest, PutsAFreeRobotOnTheFloor) {
  engine::test::Show show(scene_of(model));
  const sim::Body& body = *show.engine.world().find_body("hopper");
  EXPECT_NEAR(body.find_part("trunk")->pose().position.z, 0.55, 1e-6);
  EXPECT_NEAR(show.engine.world().find_body("floor")->root()->pose().position.z, 0, 1e-9);
  show.ticks(120);
  EXPECT_NEAR(body.find_part("trunk")->pose().position.z, 0.55, 0.01) << "its servo holds the pose";
}

TEST_F(ViewerTest, PutsTheFloorBelowAFixedRobot) {
  const std::string fixed = folder.file("robot/fixed.urdf", hopper(kBase));
  engine::test::Show show(scene_of(fixed));
  sim::World& world = show.engine.world();
  EXPECT_NEAR(world.find_body("hopper")->find_part("trunk")->pose().position.z, 0.3, 1e-6) << "as in its file";
  EXPECT_NEAR(world.find_body("floor")->root()->pose().position.z, 0.3 - 0.55, 1e-6);
}

TEST_F(ViewerTest, WritesNothingBesideTheModel) {
  const std::string robot = folder.path() + "/robot";
  const auto before = files_of(robot);
  EXPECT_EQ(run({model, "--fast", "--ticks", "5"}).code, 0);
  EXPECT_EQ(run({robot, "--fast", "--ticks", "5", "--record", folder.path() + "/a.take"}).code, 0);
  Process live(limber_command({robot, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off"}));
  ASSERT_TRUE(live.wait_for("playing headless"));
  live.signal(SIGTERM);
  EXPECT_EQ(live.finish().code, 0);
  EXPECT_EQ(files_of(robot), before);
  const std::string scene = scene_of(model);
  EXPECT_TRUE(scene.starts_with(folder.path() + "/state/limber/models/hopper-")) << scene;
  EXPECT_EQ(scene_of(robot), scene) << "a model has one scene, and so one set of presets";
}

TEST_F(ViewerTest, NeedsNoHomeFolder) {
  const auto play_with = [&](const std::string& temporary) {
    return Process(limber_command({model, "--fast", "--ticks", "2", "--hash"},
                                  {"env", "-u", "HOME", "-u", "XDG_STATE_HOME", "TMPDIR=" + temporary}))
        .finish();
  };
  const RunResult played = play_with(folder.path());
  EXPECT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.out.find("hash"), std::string::npos);
  const RunResult failed = play_with("/nowhere");
  EXPECT_EQ(failed.code, 1) << failed.err;
  EXPECT_NE(failed.err.find("Set HOME or TMPDIR to a folder that is writable"), std::string::npos) << failed.err;
}

TEST_F(ViewerTest, ReplaysFromTheTake) {
  const std::string take = folder.path() + "/a.take";
  const RunResult recorded = run({model, "--fast", "--ticks", "40", "--hash", "--record", take});
  EXPECT_EQ(recorded.code, 0) << recorded.err;
  std::filesystem::remove(model);
  const RunResult replayed = run({"--replay", take, "--fast", "--hash"});
  EXPECT_EQ(replayed.code, 0) << replayed.err;
  EXPECT_EQ(replayed.out, recorded.out);
}

TEST_F(ViewerTest, ReloadsASavedModel) {
  Process live(limber_command({model, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off"}));
  ASSERT_TRUE(live.wait_for("playing headless"));
  std::string heavier = hopper();
  heavier.replace(heavier.find("value=\"2\""), 9, "value=\"3\"");
  folder.file("robot/hopper.urdf", heavier);
  EXPECT_TRUE(live.wait_for("scripts/hopper.lua: reloaded"));
  folder.file("robot/hopper.urdf", "<robot");
  EXPECT_TRUE(live.wait_for("hopper.urdf:1: "));
  live.signal(SIGTERM);
  EXPECT_EQ(live.finish().code, 0);
}

TEST_F(ViewerTest, WritesTheSceneAndExits) {
  const std::string scene = folder.path() + "/my scene.lua";
  const RunResult saved = run({model, "--save-scene", scene});
  EXPECT_EQ(saved.code, 0) << saved.err;
  EXPECT_EQ(run({scene, "--fast", "--ticks", "60", "--hash"}).out,
            run({model, "--fast", "--ticks", "60", "--hash"}).out);
  EXPECT_EQ(run({model, "--save-scene", scene}).code, 1);
  EXPECT_EQ(run({model, "--save-scene", scene, "--overwrite"}).code, 0);
  EXPECT_EQ(run({scene, "--save-scene", folder.path() + "/b.lua"}).code, 2) << "it is not a model";
}

// the number of pixels that are clearly red
int red_pixels(const std::string& file) {
  int width = 0, height = 0, channels = 0, count = 0;
  stbi_uc* const bytes = stbi_load(file.c_str(), &width, &height, &channels, 3);
  if (bytes == nullptr) return -1;
  for (int i = 0; i < width * height; i++) {
    if (bytes[3 * i] > 100 && bytes[3 * i + 1] < bytes[3 * i] / 3 && bytes[3 * i + 2] < bytes[3 * i] / 3) count++;
  }
  stbi_image_free(bytes);
  return count;
}

TEST_F(ViewerTest, PicturesShowTheRobot) {
  const auto before = files_of(folder.path() + "/robot");
  for (const std::string command : {"play", "inspect"}) {
    const std::string picture = folder.path() + "/" + command + ".png";
    std::vector<std::string> before_program = {"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY"};
    before_program.push_back(without_leak_check()[1]);
    const RunResult result =
        Process(limber_command({command, model, "--screenshot", picture, "--size", "320x180"}, before_program))
            .finish();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_GT(red_pixels(picture), 320 * 180 / 100) << command << ": the box fills a part of the picture";
    EXPECT_EQ(result.out.find("hopper: 2 links") != std::string::npos, command == "inspect") << result.out;
  }
  EXPECT_EQ(files_of(folder.path() + "/robot"), before);
}

TEST_F(ViewerTest, DroppedModelsAreAddedToTheScene) {
  engine::EngineOptions options = engine::test::fast_options(scene_of(model));
  ShownModels models(ModelScene{model, {}, "", {}}, {});
  engine::EngineLink link;
  engine::Engine engine(link, options);
  SceneLoader loader(link, engine, options.scene, &models);
  ASSERT_TRUE(engine.start());
  loader.start();
  std::thread simulation([&] { engine.run(); });
  std::vector<engine::Outgoing> replies;
  const auto wait_for_reply = [&](const std::string& path) {
    replies.clear();
    models.drop(path);
    while (replies.empty()) {
      link.panel_output_queue.drain(replies);
      std::this_thread::yield();
    }
    return engine::test::text_of(replies.front().message);
  };
  EXPECT_EQ(wait_for_reply(model), "/transport/added hopper_2");
  EXPECT_EQ(wait_for_reply(folder.path() + "/robot"), "/transport/added hopper_3") << "a folder with one model";
  EXPECT_NE(wait_for_reply(folder.file("notes.txt", "")).find("'" + folder.path() + "/notes.txt' is not a model"),
            std::string::npos);
  EXPECT_NE(wait_for_reply(folder.file("bad.urdf", "<robot name='x'>")).find("bad.urdf:1: "), std::string::npos);
  const std::string saved = folder.path() + "/all.lua";
  ASSERT_TRUE(models.save(saved, false));
  engine.stop();
  simulation.join();
  EXPECT_EQ(engine.world().body_names(), (std::vector<std::string_view>{"hopper", "floor", "hopper_2", "hopper_3"}));
  loader.stop();
  engine::test::Show show(saved);
  EXPECT_EQ(show.engine.world().body_names(), engine.world().body_names()) << content(saved);
  EXPECT_NE(content(saved).find("sim:load_urdf(\"robot/hopper.urdf\", { name = \"hopper_2\""), std::string::npos)
      << content(saved);
}

}  // namespace
}  // namespace limber::app::test
