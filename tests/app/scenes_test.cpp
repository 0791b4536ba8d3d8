// Loading another scene of the folder through OSC.
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "app/program.h"
#include "console/private_folder.h"

namespace limber::app::test {
namespace {

// a folder of several scenes; plays the first, with an OSC port chosen by the system
struct SceneFolderShow {
  SceneFolderShow()
      : running(limber_command({first, "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", "off"},
                               {"env", "XDG_RUNTIME_DIR=" + runtime.path(), "TMPDIR=" + runtime.path()})) {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    in = running.text_after("OSC in ");
  }
  RunResult send(std::vector<std::string> words) const {
    words.insert(words.begin(), "send");
    words.insert(words.end(), {"--to", in});
    return run(std::move(words));
  }
  TempFolder folder;
  console::PrivateFolder runtime;
  std::string first = folder.file("scripts/first.lua",
                                  "params { { 'wind', 1, max = 9 } }\n"
                                  "sim:add_body('only_here')\n"
                                  "state.times = (state.times or 0) + 1\n");
  std::string second = folder.file("scripts/second.lua",
                                   "sim.gravity = vec3(0, 0, -3)\n"
                                   "sim:add_body('a') sim:add_body('b')\n"
                                   "sim:on_start(function() print('second begins', state.times) end)\n"
                                   "osc:on('/who', function() osc:reply('/i/am', 'second', sim.tick) end)\n");
  std::string broken = folder.file("scripts/broken.lua", "sim:add_body('half')\nsim.gravty = 1\n");
  std::string library = folder.file("scripts/lib/no_scene.lua", "");
  Process running;
  std::string in;
};

TEST(Scenes, LoadsAnotherScene) {
  SceneFolderShow show;
  EXPECT_EQ(show.send({"/list/scenes", "--wait", "30"}).out, "/list/scenes broken first second\n");
  EXPECT_EQ(show.send({"/physics/sim/speed", "2"}).code, 0);
  EXPECT_EQ(show.send({"/physics/sim/substeps", "7"}).code, 0);
  const RunResult changed = show.send({"/transport/scene", "second", "--wait", "30"});
  EXPECT_EQ(changed.out, "/transport/playing second\n") << changed.err;
  ASSERT_TRUE(show.running.wait_for("second begins\tnil\n", true)) << "it has its own state";
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies a b\n");
  EXPECT_TRUE(show.send({"/who"}).out.starts_with("/i/am second "));
  EXPECT_EQ(show.send({"/get", "/physics/sim/gravity"}).out, "/physics/sim/gravity 0 0 -3\n");
  EXPECT_EQ(show.send({"/get", "/physics/sim/substeps"}).out, "/physics/sim/substeps 4\n")
      << "values set by clients are reset";
  EXPECT_EQ(show.send({"/get", "/physics/sim/speed"}).out, "/physics/sim/speed 2\n") << "session state is preserved";
  EXPECT_EQ(show.send({"/scene/wind", "3"}).code, 1) << "nothing of the first scene remains";
  // its files are watched now, and a reset runs it
  show.folder.file("scripts/second.lua", "sim:add_body('c')\nprint('second again')\n");
  EXPECT_TRUE(show.running.wait_for("second again\n", true));
  EXPECT_EQ(show.send({"/transport/reset"}).code, 0);
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies c\n");
  EXPECT_EQ(show.send({"/get", "/physics/sim/substeps"}).out, "/physics/sim/substeps 4\n");
  // back to the first, by its file name
  EXPECT_EQ(show.send({"/transport/scene", "first.lua", "--wait", "30"}).out, "/transport/playing first\n");
  ASSERT_TRUE(show.running.wait_for("first plays from its start"));
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies only_here\n");
  show.running.signal(SIGTERM);
  EXPECT_EQ(show.running.finish().code, 0);
}

TEST(Scenes, InvalidSceneChangesNothing) {
  SceneFolderShow show;
  const auto expect_rejected = [&](const std::string& name, const std::string& why) {
    const RunResult result = show.send({"/transport/scene", name, "--wait", "30"});
    EXPECT_EQ(result.code, 1) << name;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies only_here\n");
  };
  expect_rejected("secnd", "scene 'secnd' not found");
  expect_rejected("secnd", "did you mean 'second'?");
  expect_rejected("broken", "scripts/broken.lua:2: sim has no property 'gravty'; did you mean 'gravity'?");
  // nothing outside the folder
  expect_rejected("../scripts/second", "scene '../scripts/second' not found");
  expect_rejected("lib/no_scene", "scene 'lib/no_scene' not found");
  expect_rejected(show.second, "not found in scripts/");
  expect_rejected("", "scene '' not found");
  expect_rejected("7", "takes the name of a scene");
  EXPECT_EQ(show.send({"/list/scenes", "x"}).code, 1);
  // the files of the first are still watched
  show.folder.file("scripts/first.lua", "sim:add_body('only_here')\nprint('first again')\n");
  EXPECT_TRUE(show.running.wait_for("first again\n", true));
}

TEST(Scenes, PlaysATakeOfTheFolder) {
  SceneFolderShow show;
  const auto expect_rejected = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.end(), {"--wait", "30"});
    const RunResult result = show.send(std::move(words));
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  };
  expect_rejected({"/take/play"}, "no take in takes/ of the show's folder; record one with /take/record");
  EXPECT_EQ(show.send({"/take/record", "dusk", "--wait", "30"}).out, "/take/recording dusk\n");
  EXPECT_EQ(show.send({"/scene/wind", "8"}).code, 0);
  expect_rejected({"/take/play", "dusk"}, "a take is being recorded already");
  EXPECT_EQ(show.send({"/take/stop"}).out, "/take/stopped\n");
  EXPECT_EQ(show.send({"/transport/scene", "second", "--wait", "30"}).out, "/transport/playing second\n");
  expect_rejected({"/take/play", "dsk"}, "did you mean 'dusk'?");
  expect_rejected({"/take/play", "../dusk"}, "take '../dusk' not found");
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies a b\n");
  EXPECT_EQ(show.send({"/take/play", "--wait", "30"}).out, "/take/playing dusk\n");
  ASSERT_TRUE(show.running.wait_for("all hashes match the take; live input resumed"));
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies only_here\n");
  EXPECT_EQ(show.send({"/get", "/scene/wind"}).out, "/scene/wind 8\n");
  EXPECT_EQ(show.send({"/scene/wind", "2"}).code, 0);
  // the files of its scene are watched now
  show.folder.file("scripts/first.lua", "sim:add_body('new')\nprint('first again')\n");
  EXPECT_TRUE(show.running.wait_for("first again\n", true));
  show.running.signal(SIGTERM);
  EXPECT_EQ(show.running.finish().code, 0);
}

TEST(Scenes, EachHasItsOwnPresets) {
  SceneFolderShow show;
  const auto change = [&](const std::string& name) {
    EXPECT_EQ(show.send({"/transport/scene", name, "--wait", "30"}).out, "/transport/playing " + name + "\n");
  };
  EXPECT_EQ(show.send({"/scene/wind", "8"}).code, 0);
  EXPECT_EQ(show.send({"/preset/store", "dusk"}).code, 0);
  EXPECT_EQ(show.send({"/preset/recall", "script"}).code, 0);
  EXPECT_EQ(show.send({"/preset/recall", "dusk", "86400"}).code, 0);
  EXPECT_NE(show.send({"/get", "/preset/progress"}).out, "/preset/progress 1\n");
  change("second");
  EXPECT_EQ(show.send({"/get", "/preset/progress"}).out, "/preset/progress 1\n") << "morphs end with their scene";
  EXPECT_EQ(show.send({"/list/presets"}).out, "/list/presets \"\"\n");
  EXPECT_NE(show.send({"/preset/recall", "dusk"}).err.find("there is no preset 'dusk'"), std::string::npos);
  EXPECT_EQ(show.send({"/preset/store", "low"}).code, 0);
  EXPECT_EQ(show.send({"/physics/sim/gravity", "-1"}).code, 0);
  EXPECT_EQ(show.send({"/preset/recall", "script"}).code, 0);
  EXPECT_EQ(show.send({"/get", "/physics/sim/gravity"}).out, "/physics/sim/gravity 0 0 -3\n")
      << "the value of the second scene";
  // back, and from the scene to itself: the presets are there, also on disk
  for (int i = 0; i < 2; i++) {
    change("first");
    EXPECT_EQ(show.send({"/list/presets"}).out, "/list/presets dusk\n");
    EXPECT_EQ(show.send({"/preset/recall", "dusk"}).code, 0);
    EXPECT_EQ(show.send({"/get", "/scene/wind"}).out, "/scene/wind 8\n");
  }
  EXPECT_EQ(show.send({"/preset/store", "late"}).code, 0);
  show.running.signal(SIGTERM);
  EXPECT_EQ(show.running.finish().code, 0);
  const auto stored = [&](const std::string& name) {
    std::ifstream in(show.folder.path() + "/scripts/" + name);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  for (const char* name : {"dusk", "late"})
    EXPECT_NE(stored("first.presets.json").find(fmt::format("\"name\": \"{}\"", name)), std::string::npos) << name;
  EXPECT_NE(stored("second.presets.json").find("\"name\": \"low\""), std::string::npos);
  EXPECT_EQ(stored("second.presets.json").find("dusk"), std::string::npos);
}

TEST(Scenes, FastRunPlaysOneScene) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "osc:on('/x', function() end)\n");
  const RunResult result = run({scene, "--fast", "--ticks", "2", "--set", "/transport/scene=other"});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find("--set /transport/scene"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test
