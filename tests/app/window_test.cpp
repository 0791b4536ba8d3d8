// Real windows, on a display of the test's own: it opens, and the show outlives the display.
#include <atomic>

#include "app/program.h"

namespace limber::app_test {
namespace {

constexpr const char* kFallingBall = R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1) })
sim:on_step(function() if sim.tick % 60 == 0 then print("tick") end end)
)";

// an X server without a screen; it chooses its number itself
class Display {
 public:
  Display() : server_({"Xvfb", "-displayfd", "1", "-screen", "0", "320x240x24", "-nolisten", "tcp"}) {
    EXPECT_TRUE(server_.wait_for("\n", true)) << "apt-get install xvfb\n" << server_.err();
    name_ = ":" + server_.out().substr(0, server_.out().find('\n'));
  }
  void end() { server_.signal(SIGKILL); }
  std::vector<std::string> environment() const {
    std::vector<std::string> all = without_leak_search();
    all.insert(all.end(), {"DISPLAY=" + name_, "LIBGL_ALWAYS_SOFTWARE=1"});
    return all;
  }

 private:
  Running server_;
  std::string name_;
};

std::vector<std::string> quiet(const std::string& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> args = {scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--size", "64x36"};
  args.insert(args.end(), more.begin(), more.end());
  return args;
}

TEST(Window, OpensWhereThereIsADisplayAndEndsCleanly) {
  Display display;
  const Folder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  Running running(limber(quiet(scene, {"--hash"}), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 64 × 36, drawn by ")) << running.err();
  ASSERT_TRUE(running.wait_for("--quality high looks better")) << "software picks low by itself";
  ASSERT_TRUE(running.wait_for("tick", true));
  running.signal(SIGINT);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.err.find("playing headless"), std::string::npos) << ran.err;
  EXPECT_NE(ran.out.find("hash "), std::string::npos);
  EXPECT_NE(
      Running(limber(quiet(scene, {"--ticks", "5", "--hash"}), display.environment())).finish().out.find("tick 5\n"),
      std::string::npos)
      << "and by itself";
}

TEST(Window, TheShowOutlivesTheDisplay) {
  Display display;
  const Folder folder;
  Running running(limber(quiet(folder.file("s.lua", kFallingBall), {"--hash"}), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window ")) << running.err();
  ASSERT_TRUE(running.wait_for("tick", true));
  display.end();
  ASSERT_TRUE(running.wait_for("the display is lost")) << running.err();
  ASSERT_TRUE(running.wait_for(" real time")) << "the status line of those without a window\n" << running.err();
  running.signal(SIGINT);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("hash "), std::string::npos) << ran.out;
}

TEST(Window, WithoutOneItSaysWhy) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  const auto said = [&](const std::vector<std::string>& before, std::vector<std::string> more) {
    more.insert(more.end(), {"--ticks", "2"});
    const Ran ran = Running(limber(quiet(scene, more), before)).finish();
    EXPECT_EQ(ran.code, 0) << ran.err;
    return ran.err;
  };
  EXPECT_NE(said({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY"}, {}).find("headless (there is no display)"),
            std::string::npos);
  EXPECT_NE(said({"env", "DISPLAY=:77777"}, {}).find("headless (no window can be opened: X11: "), std::string::npos);
  EXPECT_NE(said({"env", "DISPLAY=:77777"}, {"--headless"}).find("headless; Ctrl+C"), std::string::npos);
}

TEST(Window, AFaultySceneLeavesAnEmptyStageThatWaits) {
  Display display;
  const Folder folder;
  const std::string scene = folder.file("s.lua", "oh no\n");
  Running running(limber(quiet(scene), display.environment()));
  ASSERT_TRUE(running.wait_for("waits for the mended file")) << running.err();
  folder.file("s.lua", kFallingBall);
  ASSERT_TRUE(running.wait_for("tick", true)) << running.err();
  running.signal(SIGINT);
  EXPECT_EQ(running.finish().code, 0);
  const Ran headless =
      Running(limber(quiet(folder.file("bad.lua", "oh no\n"), {"--headless"}), display.environment())).finish();
  EXPECT_EQ(headless.code, 1) << headless.err;
}

}  // namespace
}  // namespace limber::app_test
