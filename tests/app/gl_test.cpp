// Kinds of OpenGL, from outside: which is picked, that it draws the same, and the fix where none can be had.
#include <cstdlib>

#include <stb_image.h>

#include "app/display.h"

namespace limber::app_test {
namespace {

// what the driver of a Raspberry Pi 4 has: OpenGL 3.1 and OpenGL ES 3 without these extensions of Mesa's software. With
// `es` 2.0: OpenGL 3.1 alone, where Mesa calls the last one's feature by the same name.
std::vector<std::string> like_a_pi(const std::string& es) {
  return {"MESA_GL_VERSION_OVERRIDE=3.1", "MESA_GLSL_VERSION_OVERRIDE=140", "MESA_GLES_VERSION_OVERRIDE=" + es,
          fmt::format("MESA_EXTENSION_OVERRIDE=-GL_ARB_depth_clamp -GL_EXT_depth_clamp -GL_EXT_clip_cull_distance{}",
                      es == "2.0" ? "" : " -GL_EXT_sRGB_write_control")};
}

constexpr const char* kScene = R"(
params { { "rate", 0.3, min = 0, max = 1 } }
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.3), { position = vec3(0, 0, 3) })
)";

Ran still(const std::string& scene, const std::string& file, const std::vector<std::string>& variables,
          const std::vector<std::string>& more = {}) {
  std::vector<std::string> before = without_leak_search();
  before.insert(before.end(), variables.begin(), variables.end());
  std::vector<std::string> args = {scene, "--screenshot", file, "--at", "0.25", "--panel", "--size", "640x360"};
  args.insert(args.end(), more.begin(), more.end());
  return Running(limber(args, before)).finish();
}

struct Picture {
  int width = 0;
  int height = 0;
  std::string bytes;  // red, green, blue
};

Picture picture(const std::string& file) {
  Picture read;
  int channels = 0;
  stbi_uc* const bytes = stbi_load(file.c_str(), &read.width, &read.height, &channels, 3);
  if (bytes == nullptr) return read;
  read.bytes.assign(reinterpret_cast<const char*>(bytes), 3 * static_cast<std::size_t>(read.width * read.height));
  stbi_image_free(bytes);
  return read;
}

TEST(Gl, AStillWithThePanelIsTheSameWithEachKind) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kScene);
  const std::string expected_file = folder.path() + "/core.png";
  const Ran core = still(scene, expected_file, {"LIMBER_GL=core"});
  ASSERT_EQ(core.code, 0) << core.err;
  EXPECT_NE(core.err.find("with OpenGL 3.3\n"), std::string::npos) << core.err;
  const Picture expected = picture(expected_file);
  ASSERT_EQ(expected.width, 640);
  struct Case {
    std::vector<std::string> variables;
    std::vector<std::string> more;
    const char* with;
  };
  const Case cases[] = {{{"LIMBER_GL=core"}, {"--gl", "es"}, "with OpenGL ES 3.0\n"},
                        {{"LIMBER_GL=3.1"}, {}, "with OpenGL 3.1\n"},
                        {like_a_pi("3.0"), {}, "with OpenGL ES 3.0\n"},
                        {like_a_pi("2.0"), {}, "with OpenGL 3.1\n"}};
  for (const Case& c : cases) {
    const std::string file = folder.path() + "/other.png";
    const Ran ran = still(scene, file, c.variables, c.more);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find(c.with), std::string::npos) << ran.err;
    const Picture other = picture(file);
    ASSERT_EQ(other.bytes.size(), expected.bytes.size()) << c.with;
    std::size_t differ = 0;  // by more than OpenGL ES rounds
    for (std::size_t i = 0; i < expected.bytes.size(); i++) {
      const int a = static_cast<unsigned char>(expected.bytes[i]);
      const int b = static_cast<unsigned char>(other.bytes[i]);
      differ += std::abs(a - b) > 2 ? 1 : 0;
    }
    EXPECT_LT(differ, expected.bytes.size() / 1000) << c.with;
  }
}

TEST(Gl, AWindowOpensWithWhatARaspberryPiHas) {
  const Display display("1280x720x24");
  const Folder folder;
  const std::string scene = folder.file("s.lua", R"(
params { { "rate", 0, min = 0, max = 1 } }
visuals.background = vec3(1 / 3, 1, 1)
visuals.look.floor = false
local rate = 0
sim:on_step(function() if params.rate ~= rate then rate = params.rate; print(string.format("rate %.1f", rate)) end end)
)");
  const auto green = [&](std::size_t x, std::size_t y) {
    const unsigned color = display.pixel(x, y);
    return (color >> 8 & 0xff) > 200 && (color >> 16) < 60 && (color & 0xff) < 60;
  };
  const auto waits_for = [&](auto&& is) {
    for (int i = 0; i < 600 && !is(); i++) display.xdotool({"sleep", "0.1"});
    return is();
  };
  for (const auto& [es, with] : {std::pair("3.0", "OpenGL ES 3.0"), {"2.0", "OpenGL 3.1"}}) {
    std::vector<std::string> before = display.environment();
    for (const std::string& variable : like_a_pi(es)) before.push_back(variable);
    Running running(
        limber({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--size", "1280x720"}, before));
    ASSERT_TRUE(running.wait_for(fmt::format(" with {}\n", with))) << running.err();
    ASSERT_TRUE(running.wait_for("so the picture is of quality low")) << running.err();
    EXPECT_TRUE(waits_for([&] { return green(640, 300); })) << with << std::hex << " " << display.pixel(640, 300);
    EXPECT_TRUE(waits_for([&] { return !green(1240, 545); })) << with << ": the panel is there";
    // its first bar is dragged; again until it has been laid out
    const auto dragged = [&] { return running.out().find("rate 1.0") != std::string::npos; };
    for (int i = 0; i < 200 && !dragged(); i++) {
      display.xdotool(
          {"mousemove", "1100", "182", "mousedown", "1", "mousemove", "1260", "182", "mouseup", "1", "sleep", "0.5"});
      running.look();
    }
    EXPECT_TRUE(dragged()) << with << running.out();
    // the second window shares the picture
    display.xdotool({"mousemove", "640", "300", "key", "F10"});
    ASSERT_TRUE(running.wait_for("limber: output window 960 × 540")) << running.err();
    display.xdotool({"search", "--name", "^Limber output: ", "windowmove", "320", "180"});
    EXPECT_TRUE(waits_for([&] { return green(1240, 545); })) << with << std::hex << " " << display.pixel(1240, 545);
    running.signal(SIGINT);
    const Ran ran = running.finish();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("error"), std::string::npos) << ran.err;
  }
}

TEST(Gl, AWindowNeedsNoGlx) {
  const Display display("320x240x24", {"-extension", "GLX"});
  const Folder folder;
  const Ran ran =
      Running(limber(quiet(folder.file("s.lua", kScene), {"--ticks", "5"}), display.environment())).finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find("with OpenGL 3.3\n"), std::string::npos) << ran.err;
}

// a library that can't be loaded, as if it were not installed
std::string without(const Folder& folder, const std::vector<std::string>& libraries) {
  static int count = 0;
  const std::string name = fmt::format("lib{}", count++);
  for (const std::string& library : libraries) folder.file(name + "/" + library, "");
  return fmt::format("LD_LIBRARY_PATH={}/{}", folder.path(), name);
}

const std::vector<std::string> kTooOld = {"MESA_GL_VERSION_OVERRIDE=2.1", "MESA_GLES_VERSION_OVERRIDE=2.0"};
constexpr const char* kNoDriver = "__EGL_VENDOR_LIBRARY_DIRS=/nowhere";

TEST(Gl, AStillThatCantBeDrawnNamesTheFix) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kScene);
  struct Case {
    std::vector<std::string> variables;
    int code;
    const char* said;
  };
  std::vector<std::string> software = kTooOld;
  software.emplace_back("LIBGL_ALWAYS_SOFTWARE=1");
  const std::vector<std::string> hardware = {"env", "-u", "LIBGL_ALWAYS_SOFTWARE", kTooOld[0], kTooOld[1]};
  const Case cases[] = {
      {hardware, 3,
       "OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1 is needed, and the driver offers OpenGL 2.1 and OpenGL ES 2.0. Draw in "
       "software (LIBGL_ALWAYS_SOFTWARE=1), or update the graphics driver"},
      {software, 3, "OpenGL ES 2.0. Update Mesa (on Debian the package libgl1-mesa-dri)"},
      {{"MESA_GL_VERSION_OVERRIDE=3.1", "LIMBER_GL=core"}, 3, ". Set --gl (or LIMBER_GL) to auto, or "},
      {{kNoDriver}, 3, "apt-get install libgl1-mesa-dri libegl-mesa0"},
      {{without(folder, {"libEGL.so.1"})}, 3, "libEGL.so.1 can't be loaded. On Debian: apt-get install libegl1"},
      {{without(folder, {"libGLESv2.so.2"}), "LIMBER_GL=es"}, 3, "apt-get install libgles2"},
      {{without(folder, {"libGLESv2.so.2"}), kTooOld[0]}, 3, "apt-get install libgles2. Or: "},
      {{without(folder, {"libGLESv2.so.2", "libGL.so.1", "libOpenGL.so.0"})}, 3, "apt-get install libgl1"},
      {{"LIMBER_GL=vulkan"}, 2, "'vulkan' must be auto, core, es or 3.1 (LIMBER_GL sets it, too)"}};
  for (const Case& c : cases) {
    const Ran ran = still(scene, folder.path() + "/a.png", c.variables);
    EXPECT_EQ(ran.code, c.code) << c.said << "\n" << ran.err;
    EXPECT_NE(ran.err.find(c.said), std::string::npos) << c.said << "\n" << ran.err;
  }
}

TEST(Gl, AWindowThatCantBeOpenedNamesTheFix) {
  const Display display;
  const Display without_glx("320x240x24", {"-extension", "GLX"});
  const Folder folder;
  const std::string scene = folder.file("s.lua", kScene);
  const auto said = [&](const Display& where, const std::vector<std::string>& variables) {
    std::vector<std::string> before = where.environment();
    before.insert(before.end(), variables.begin(), variables.end());
    const Ran ran = Running(limber(quiet(scene, {"--ticks", "2"}), before)).finish();
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::size_t at = ran.err.find("playing headless (");
    return at == std::string::npos ? "a window opened\n" + ran.err : ran.err.substr(at);
  };
  EXPECT_NE(said(display, kTooOld).find("the driver offers OpenGL 2.1 and OpenGL ES 2.0. Update Mesa"),
            std::string::npos);
  EXPECT_NE(said(without_glx, {kNoDriver}).find("apt-get install libgl1-mesa-dri"), std::string::npos);
  EXPECT_NE(said(without_glx, {without(folder, {"libEGL.so.1"})}).find("apt-get install libegl1"), std::string::npos);
  EXPECT_NE(said(display, {"DISPLAY=:77777"}).find("Set DISPLAY (and XAUTHORITY)"), std::string::npos);
  EXPECT_NE(said(display, {"DISPLAY=", "WAYLAND_DISPLAY="}).find("a desktop session or xvfb-run sets one"),
            std::string::npos);
  // some GLFWs know X alone
  const std::string wayland = said(display, {"DISPLAY=", "WAYLAND_DISPLAY=nobody"});
  EXPECT_NE(wayland.find(wayland.find("Wayland:") == std::string::npos ? "apt-get install xwayland"
                                                                       : "WAYLAND_DISPLAY as in the desktop session"),
            std::string::npos)
      << wayland;
}

}  // namespace
}  // namespace limber::app_test
