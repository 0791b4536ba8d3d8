// Editing a scene while it plays: reload on save, errors and their fix, and files that are not watched.
#include "app/program.h"

namespace limber::app::test {
namespace {

const std::vector<std::string> kQuietPorts = {"--osc-in", "off", "--osc-out", "off", "--query", "off"};

std::vector<std::string> play(const std::string& scene, std::vector<std::string> more = kQuietPorts) {
  more.insert(more.begin(), scene);
  return limber_command(std::move(more));
}

TEST(Reload, ReloadsOnSaveAndRecoversFromErrors) {
  const TempFolder folder;
  const std::string scene = folder.file("scripts/s.lua", "print('version 1')\nrequire 'part'\n");
  folder.file("scripts/lib/part.lua", "");
  Process running(play(folder.path() + "/scripts/s.lua"));
  ASSERT_TRUE(running.wait_for("playing headless"));
  folder.file("scripts/s.lua",
              "require 'part'\nsim:on_step(function() if sim.tick % 5 == 0 then print('version 2') end end)\n");
  EXPECT_TRUE(running.wait_for("version 2\n", true));
  EXPECT_TRUE(running.wait_for("scripts/s.lua: reloaded"));
  folder.file("scripts/lib/part.lua", "sim.gravty = 1\n");
  EXPECT_TRUE(running.wait_for("scripts/lib/part.lua:1: sim has no property 'gravty'; did you mean 'gravity'?"));
  folder.file("scripts/lib/part.lua", "print('mended')\n");
  EXPECT_TRUE(running.wait_for("mended\n", true));
  running.signal(SIGTERM);
  EXPECT_EQ(running.finish().code, 0);
}

TEST(Reload, ParameterWithRerunReloads) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", R"(
params { { "count", 1, min = 0, max = 20, rerun = true } }
for i = 1, params.count do sim:add_body("b" .. i) end
sim:every(0.1, function() params.count = 7 print(#sim.bodies) end)
)");
  Process running(play(scene));
  EXPECT_TRUE(running.wait_for("1\n7\n", true) || running.wait_for("7\n", true));
  running.signal(SIGINT);
  EXPECT_EQ(running.finish().code, 0);
}

TEST(Reload, FastRunsWatchOnlyOnRequest) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "print('first') sim:at(0.1, function() print('go') end)");
  // plays until the second version is active
  Process running(play(scene, {"--fast", "--watch"}));
  ASSERT_TRUE(running.wait_for("go\n", true));
  folder.file("s.lua", "print('second')");
  EXPECT_TRUE(running.wait_for("second\n", true));
  running.signal(SIGINT);
  EXPECT_EQ(running.finish().code, 0);
}

}  // namespace
}  // namespace limber::app::test
