// Real windows on a private display: opening, and a show that outlives its display.

#include "app/display.h"

namespace limber::app::test {
namespace {

constexpr const char* kFallingBall = R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 1) })
sim:on_step(function() if sim.tick % 60 == 0 then print("tick") end end)
)";

TEST(Window, OpensOnADisplayAndEndsCleanly) {
  Display display;
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  Process running(limber_command(quiet(scene, {"--hash"}), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 64 × 36, drawn by ")) << running.err();
  ASSERT_TRUE(running.wait_for("--quality high looks better")) << "software picks low by itself";
  ASSERT_TRUE(running.wait_for("tick", true));
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("playing headless"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("hash "), std::string::npos);
  EXPECT_NE(Process(limber_command(quiet(scene, {"--ticks", "5", "--hash"}), display.environment()))
                .finish()
                .out.find("tick 5\n"),
            std::string::npos)
      << "and by itself";
}

TEST(Window, DoesNotWaitForAMissingTake) {
  const Display display;
  const RunResult result =
      Process(limber_command({"--replay", "/nowhere/evening.take", "--osc-in", "off", "--osc-out", "off"},
                             display.environment()))
          .finish();
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_NE(result.err.find("/nowhere/evening.take: take not found"), std::string::npos) << result.err;
}

// input in the panel reaches the scene, which prints it
TEST(Window, PanelHandlesMouseAndKeys) {
  const Display display("1280x720x24");
  const TempFolder folder;
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
  Process running(limber_command(args, display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 1280 × 720")) << running.err();
  ASSERT_TRUE(running.wait_for("begun", true));
  // drags the first slider of the parameters from its middle to its end; repeated until the panel is ready, slowly, as
  // each event needs its own frame
  const auto dragged = [&] { return running.out().find("rate 1.0") != std::string::npos; };
  for (int i = 0; i < 200 && !dragged(); i++) {
    display.xdotool(
        {"mousemove", "1100", "182", "mousedown", "1", "mousemove", "1260", "182", "mouseup", "1", "sleep", "0.5"});
    running.read_available();
  }
  ASSERT_TRUE(dragged()) << running.out();
  // a key pressed and released between two frames
  display.xdotool({"mousemove", "600", "300", "key", "F1"});
  display.xdotool({"key", "Escape"});
  display.xdotool({"key", "ctrl+equal"});
  display.xdotool({"key", "ctrl+equal"});
  display.xdotool({"key", "space", "key", "period"});
  ASSERT_TRUE(running.wait_for("one step", true)) << "Escape doesn't end the program; keys arrive in order";
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(display.settings().find("\"hidden\": true"), std::string::npos) << display.settings();
  EXPECT_NE(display.settings().find("\"text_size\": 18"), std::string::npos) << display.settings();
}

TEST(Window, FillsTheScreenAndRemembersIt) {
  const Display display("320x240x24");
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  const auto play = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--ticks", "30"});
    const RunResult result = Process(limber_command(quiet(scene, more), display.environment())).finish();
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  const auto remembers = [&](const std::string& setting) {
    return display.settings().find(setting) != std::string::npos;
  };
  play({});
  EXPECT_FALSE(remembers("\"fullscreen\": true"));
  play({"--fullscreen", "--monitor", "1", "--hide-pointer"});
  for (const char* setting : {"\"fullscreen\": true", "\"hide_pointer\": true", "\"monitor\": \"1\""})
    EXPECT_TRUE(remembers(setting)) << display.settings();
  play({});
  EXPECT_TRUE(remembers("\"fullscreen\": true"));
  EXPECT_NE(play({"--windowed", "--show-pointer", "--monitor", "nowhere"})
                .find("monitor 'nowhere' not found; available: 1 ("),
            std::string::npos);
  EXPECT_FALSE(remembers("\"fullscreen\": true") || remembers("\"hide_pointer\": true"));
}

// on Dvorak the period is at the position of E on a US keyboard; AZERTY prints it with Shift only, so it keeps its
// position
TEST(Window, KeysFollowTheLayout) {
  for (const std::string layout : {"us(dvorak)", "fr"}) {
    const Display display("320x240x24", {"-noreset"});  // otherwise the layout is reset with the program that set it
    std::vector<std::string> words = display.environment();
    words.insert(words.end(), {"setxkbmap", layout});
    ASSERT_EQ(Process(words).finish().code, 0) << "apt-get install x11-xkb-utils";
    const TempFolder folder;
    const std::string scene = folder.file(
        "s.lua", "sim:on_step(function() print(sim.paused and 'one step' or sim.tick == 30 and 'begun' or '') end)\n");
    Process running(limber_command(quiet(scene), display.environment()));
    ASSERT_TRUE(running.wait_for("limber: window")) << running.err();
    ASSERT_TRUE(running.wait_for("begun", true));
    display.xdotool({"mousemove", "30", "20"});
    const auto stepped = [&] { return running.out().find("one step") != std::string::npos; };
    // repeated until the window accepts input
    for (int i = 0; i < 200 && !stepped(); i++) {
      display.xdotool({"key", layout == "fr" ? "colon" : "period", "key", "space", "sleep", "0.3"});
      running.read_available();
    }
    EXPECT_TRUE(stepped()) << layout << running.err();
    running.signal(SIGINT);
    EXPECT_EQ(running.finish().code, 0);
  }
}

// F10 opens it; it shows the scene without the panel; it may be resized, maximized and closed while the show plays
TEST(Window, OutputWindowShowsTheSceneAlone) {
  const Display display("1280x720x24");
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", R"(
visuals.background = vec3(1 / 3, 1, 1)
visuals.look.floor = false
sim:on_step(function() if sim.tick % 30 == 0 then print("tick") end end)
)");
  std::vector<std::string> args = {scene,     "--osc-in", "off",    "--osc-out", "off",
                                   "--query", "off",      "--size", "1280x720"};
  Process running(limber_command(args, display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 1280 × 720")) << running.err();
  ASSERT_TRUE(running.wait_for("tick", true));
  const auto waits_for = [&](auto&& is) {
    for (int i = 0; i < 600 && !is(); i++) display.xdotool({"sleep", "0.1"});
    return is();
  };
  const auto green = [&](std::size_t x, std::size_t y) {
    const unsigned color = display.pixel(x, y);
    return (color >> 8 & 0xff) > 200 && (color >> 16) < 60 && (color & 0xff) < 60;
  };
  const std::string output = "^Limber output: ";
  const auto with_output = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"search", "--name", output});
    display.xdotool(words);
  };
  ASSERT_TRUE(waits_for([&] { return green(640, 300); })) << std::hex << display.pixel(640, 300);
  ASSERT_TRUE(waits_for([&] { return !green(1240, 545); })) << "covered by the panel";
  display.xdotool({"mousemove", "640", "300", "key", "F10"});
  ASSERT_TRUE(running.wait_for("limber: output window 960 × 540")) << running.err();
  // the second window's background covers the first window's panel
  with_output({"windowmove", "320", "180"});
  EXPECT_TRUE(waits_for([&] { return green(1240, 545); })) << std::hex << display.pixel(1240, 545);
  with_output({"windowsize", "300", "200"});
  EXPECT_TRUE(waits_for([&] { return !green(1240, 545) && green(610, 370); })) << "the panel is visible again";
  // its keys are handled, too
  with_output({"windowmove", "0", "0", "mousemove", "100", "100", "key", "F11"});
  EXPECT_TRUE(waits_for([&] { return green(1240, 545) && green(100, 100); }));
  display.xdotool({"key", "F11"});
  EXPECT_TRUE(waits_for([&] { return !green(1240, 545); }));
  display.xdotool({"key", "F10"});
  EXPECT_TRUE(waits_for([&] { return !green(100, 100); })) << "closed: the panel of the first window is visible";
  // the show ends cleanly while it is open
  display.xdotool({"mousemove", "640", "300", "key", "F10"});
  EXPECT_TRUE(waits_for([&] { return green(100, 100); }));
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("headless"), std::string::npos) << result.err;
}

TEST(Window, ShowOutlivesTheDisplay) {
  Display display;
  const TempFolder folder;
  Process running(limber_command(quiet(folder.file("s.lua", kFallingBall), {"--hash"}), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window ")) << running.err();
  ASSERT_TRUE(running.wait_for("tick", true));
  display.kill();
  ASSERT_TRUE(running.wait_for("the display is lost")) << running.err();
  ASSERT_TRUE(running.wait_for(" real time")) << "the status line without a window\n" << running.err();
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("hash "), std::string::npos) << result.out;
}

TEST(Window, RequestedWindowWaitsForItsDisplay) {
  Display display("320x240x24", {}, Display::own_number());
  display.kill();
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  Process running(limber_command(quiet(scene, {"--windowed"}), display.environment()));
  ASSERT_TRUE(running.wait_for("the window opens as soon as there is a display")) << running.err();
  ASSERT_TRUE(running.wait_for(" real time")) << running.err();
  display.restart();
  ASSERT_TRUE(running.wait_for("limber: window ")) << running.err();
  running.signal(SIGINT);
  EXPECT_EQ(running.finish().code, 0);
}

TEST(Window, ReportsWhyThereIsNone) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kFallingBall);
  const auto stderr_of = [&](const std::vector<std::string>& before, std::vector<std::string> more) {
    more.insert(more.end(), {"--ticks", "2"});
    const RunResult result = Process(limber_command(quiet(scene, more), before)).finish();
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_NE(stderr_of({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY"}, {})
                .find("headless (no display: DISPLAY and WAYLAND_DISPLAY are not set; "),
            std::string::npos);
  // libX11 1.8 leaks memory if a display can't be opened
  std::vector<std::string> no_display = without_leak_check();
  no_display.emplace_back("DISPLAY=:77777");
  EXPECT_NE(stderr_of(no_display, {}).find("headless (no window can be opened: X11: "), std::string::npos);
  EXPECT_NE(stderr_of({"env", "DISPLAY=:77777"}, {"--headless"}).find("headless; Ctrl+C"), std::string::npos);
}

TEST(Window, FaultySceneWaitsForAFix) {
  Display display;
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "oh no\n");
  Process running(limber_command(quiet(scene), display.environment()));
  ASSERT_TRUE(running.wait_for("until the file is fixed")) << running.err();
  folder.file("s.lua", kFallingBall);
  ASSERT_TRUE(running.wait_for("tick", true)) << running.err();
  running.signal(SIGINT);
  EXPECT_EQ(running.finish().code, 0);
  // a file is fixed while the window opens, before the files are watched
  const std::string other = folder.file("other.lua", "require 'part'\n");
  folder.file("scripts/lib/part.lua", "oh no\n");
  Process second(limber_command(quiet(other), display.environment()));
  ASSERT_TRUE(second.wait_for("OSC in off")) << second.err();
  folder.file("scripts/lib/part.lua", kFallingBall);
  ASSERT_TRUE(second.wait_for("tick", true)) << second.err();
  second.signal(SIGINT);
  EXPECT_EQ(second.finish().code, 0);
  const RunResult headless =
      Process(limber_command(quiet(folder.file("bad.lua", "oh no\n"), {"--headless"}), display.environment())).finish();
  EXPECT_EQ(headless.code, 1) << headless.err;
}

}  // namespace
}  // namespace limber::app::test
