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
  explicit Display(const std::string& screen = "320x240x24")
      : server_({"Xvfb", "-displayfd", "1", "-screen", "0", screen, "-nolisten", "tcp"}) {
    EXPECT_TRUE(server_.wait_for("\n", true)) << "apt-get install xvfb\n" << server_.err();
    name_ = ":" + server_.out().substr(0, server_.out().find('\n'));
  }
  void end() { server_.signal(SIGKILL); }
  std::vector<std::string> environment() const {
    std::vector<std::string> all = without_leak_search();
    all.insert(all.end(),
               {"DISPLAY=" + name_, "LIBGL_ALWAYS_SOFTWARE=1", "XDG_CONFIG_HOME=" + (folder_.path() + "/config"),
                "XDG_STATE_HOME=" + (folder_.path() + "/state")});
    return all;
  }
  /// Hands of somebody at this display. Keys go to the window under the pointer.
  void xdotool(std::vector<std::string> words) const {
    words.insert(words.begin(), "xdotool");
    std::vector<std::string> all = environment();
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = Running(all).finish();
    EXPECT_EQ(ran.code, 0) << "apt-get install xdotool\n" << ran.err;
  }
  std::string settings() const { return content(folder_.path() + "/config/limber/panel.json"); }

 private:
  Folder folder_;
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

// what the panel's hands do arrives in the scene, which says so
TEST(Window, ThePanelIsPlayedByMouseAndKeys) {
  const Display display("1280x720x24");
  const Folder folder;
  const std::string scene = folder.file("s.lua", R"(
params { { "rate", 0, min = 0, max = 1 } }
local rate = 0
sim:on_step(function()
  if params.rate ~= rate then rate = params.rate; print(string.format("rate %.1f", rate)) end
  if sim.tick == 30 then print("begun") end
  if sim.paused then print("one step") end
end)
)");
  std::vector<std::string> args = {scene,     "--osc-in", "off",    "--osc-out", "off",
                                   "--query", "off",      "--size", "1280x720"};
  Running running(limber(args, display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 1280 × 720")) << running.err();
  ASSERT_TRUE(running.wait_for("begun", true));
  // the first bar of the parameters, from its middle to its end
  // again, until the panel is there to be played; slowly, as each takes pictures of its own and none is left out
  const auto dragged = [&] { return running.out().find("rate 1.0") != std::string::npos; };
  for (int i = 0; i < 200 && !dragged(); i++) {
    display.xdotool(
        {"mousemove", "1100", "182", "mousedown", "1", "mousemove", "1260", "182", "mouseup", "1", "sleep", "0.5"});
    running.look();
  }
  ASSERT_TRUE(dragged()) << running.out();
  // a key that is pressed and released between two pictures
  display.xdotool({"mousemove", "600", "300", "key", "F1"});
  display.xdotool({"key", "Escape"});
  display.xdotool({"key", "ctrl+equal"});
  display.xdotool({"key", "ctrl+equal"});
  display.xdotool({"key", "space", "key", "period"});
  ASSERT_TRUE(running.wait_for("one step", true)) << "Escape ends nothing; keys come in their order";
  running.signal(SIGINT);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(display.settings().find("\"hidden\": true"), std::string::npos) << display.settings();
  EXPECT_NE(display.settings().find("\"text_size\": 18"), std::string::npos) << display.settings();
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
