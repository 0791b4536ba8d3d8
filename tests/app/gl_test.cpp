// Kinds of OpenGL from outside: the selection, identical output, and the fix if none is available.
#include <cstdlib>

#include <stb_image.h>

#include "app/display.h"

namespace limber::app::test {
namespace {

// Emulates the driver of a Raspberry Pi 4: OpenGL 3.1 and OpenGL ES 3 without some extensions of Mesa's software
// renderer. `es` 2.0: OpenGL 3.1 only; Mesa uses the same name for the last extension's feature there.
std::vector<std::string> raspberry_pi_variables(const std::string& es) {
  return {"MESA_GL_VERSION_OVERRIDE=3.1", "MESA_GLSL_VERSION_OVERRIDE=140", "MESA_GLES_VERSION_OVERRIDE=" + es,
          fmt::format("MESA_EXTENSION_OVERRIDE=-GL_ARB_depth_clamp -GL_EXT_depth_clamp -GL_EXT_clip_cull_distance{}",
                      es == "2.0" ? "" : " -GL_EXT_sRGB_write_control")};
}

constexpr const char* kScene = R"(
params { { "rate", 0.3, min = 0, max = 1 } }
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.3), { position = vec3(0, 0, 3) })
)";

RunResult take_screenshot(const std::string& scene, const std::string& file, const std::vector<std::string>& variables,
                          const std::vector<std::string>& more = {}) {
  std::vector<std::string> before = without_leak_check();
  before.insert(before.end(), variables.begin(), variables.end());
  std::vector<std::string> args = {scene, "--screenshot", file, "--at", "0.25", "--panel", "--size", "640x360"};
  args.insert(args.end(), more.begin(), more.end());
  return Process(limber_command(args, before)).finish();
}

struct LoadedImage {
  int width = 0;
  int height = 0;
  std::string bytes;  // red, green, blue
};

LoadedImage load_image(const std::string& file) {
  LoadedImage read;
  int channels = 0;
  stbi_uc* const bytes = stbi_load(file.c_str(), &read.width, &read.height, &channels, 3);
  if (bytes == nullptr) return read;
  read.bytes.assign(reinterpret_cast<const char*>(bytes), 3 * static_cast<std::size_t>(read.width * read.height));
  stbi_image_free(bytes);
  return read;
}

TEST(Gl, ImagesAreTheSameWithEachKind) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kScene);
  const std::string expected_file = folder.path() + "/core.png";
  const RunResult core = take_screenshot(scene, expected_file, {"LIMBER_GL=core"});
  ASSERT_EQ(core.code, 0) << core.err;
  EXPECT_NE(core.err.find("with OpenGL 3.3\n"), std::string::npos) << core.err;
  const LoadedImage expected = load_image(expected_file);
  ASSERT_EQ(expected.width, 640);
  struct Case {
    std::vector<std::string> variables;
    std::vector<std::string> more;
    const char* with;
  };
  const Case cases[] = {{{"LIMBER_GL=core"}, {"--gl", "es"}, "with OpenGL ES 3.0\n"},
                        {{"LIMBER_GL=3.1"}, {}, "with OpenGL 3.1\n"},
                        {raspberry_pi_variables("3.0"), {}, "with OpenGL ES 3.0\n"},
                        {raspberry_pi_variables("2.0"), {}, "with OpenGL 3.1\n"}};
  for (const Case& c : cases) {
    const std::string file = folder.path() + "/other.png";
    const RunResult result = take_screenshot(scene, file, c.variables, c.more);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find(c.with), std::string::npos) << result.err;
    const LoadedImage other = load_image(file);
    ASSERT_EQ(other.bytes.size(), expected.bytes.size()) << c.with;
    std::size_t differ = 0;  // by more than the rounding of OpenGL ES
    for (std::size_t i = 0; i < expected.bytes.size(); i++) {
      const int a = static_cast<unsigned char>(expected.bytes[i]);
      const int b = static_cast<unsigned char>(other.bytes[i]);
      differ += std::abs(a - b) > 2 ? 1 : 0;
    }
    EXPECT_LT(differ, expected.bytes.size() / 1000) << c.with;
  }
}

TEST(Gl, WindowOpensOnARaspberryPi) {
  const Display display("1280x720x24");
  const TempFolder folder;
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
    for (const std::string& variable : raspberry_pi_variables(es)) before.push_back(variable);
    Process running(
        limber_command({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--size", "1280x720"}, before));
    ASSERT_TRUE(running.wait_for(fmt::format(" with {}\n", with))) << running.err();
    ASSERT_TRUE(running.wait_for("using --quality low because of")) << running.err();
    EXPECT_TRUE(waits_for([&] { return green(640, 300); })) << with << std::hex << " " << display.pixel(640, 300);
    EXPECT_TRUE(waits_for([&] { return !green(1240, 545); })) << with << ": the panel is there";
    // drags the first slider; repeated until the layout is done
    const auto dragged = [&] { return running.out().find("rate 1.0") != std::string::npos; };
    for (int i = 0; i < 200 && !dragged(); i++) {
      display.xdotool(
          {"mousemove", "1100", "182", "mousedown", "1", "mousemove", "1260", "182", "mouseup", "1", "sleep", "0.5"});
      running.read_available();
    }
    EXPECT_TRUE(dragged()) << with << running.out();
    // the second window shares the scene
    display.xdotool({"mousemove", "640", "300", "key", "F10"});
    ASSERT_TRUE(running.wait_for("limber: output window 960 × 540")) << running.err();
    display.xdotool({"search", "--name", "^Limber output: ", "windowmove", "320", "180"});
    EXPECT_TRUE(waits_for([&] { return green(1240, 545); })) << with << std::hex << " " << display.pixel(1240, 545);
    running.signal(SIGINT);
    const RunResult result = running.finish();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.find("error"), std::string::npos) << result.err;
  }
}

TEST(Gl, WindowNeedsNoGlx) {
  const Display display("320x240x24", {"-extension", "GLX"});
  const TempFolder folder;
  const RunResult result =
      Process(limber_command(quiet(folder.file("s.lua", kScene), {"--ticks", "5"}), display.environment())).finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("with OpenGL 3.3\n"), std::string::npos) << result.err;
}

// makes libraries unloadable, as if they were not installed
std::string without(const TempFolder& folder, const std::vector<std::string>& libraries) {
  static int count = 0;
  const std::string name = fmt::format("lib{}", count++);
  for (const std::string& library : libraries) folder.file(name + "/" + library, "");
  return fmt::format("LD_LIBRARY_PATH={}/{}", folder.path(), name);
}

const std::vector<std::string> kTooOld = {"MESA_GL_VERSION_OVERRIDE=2.1", "MESA_GLES_VERSION_OVERRIDE=2.0"};
constexpr const char* kNoDriver = "__EGL_VENDOR_LIBRARY_DIRS=/nowhere";

TEST(Gl, ImageErrorsNameTheFix) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kScene);
  struct Case {
    std::vector<std::string> variables;
    int code;
    const char* message;
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
    const RunResult result = take_screenshot(scene, folder.path() + "/a.png", c.variables);
    EXPECT_EQ(result.code, c.code) << c.message << "\n" << result.err;
    EXPECT_NE(result.err.find(c.message), std::string::npos) << c.message << "\n" << result.err;
  }
}

TEST(Gl, WindowErrorsNameTheFix) {
  const Display display;
  const Display without_glx("320x240x24", {"-extension", "GLX"});
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kScene);
  const auto headless_notice = [&](const Display& where, const std::vector<std::string>& variables) {
    std::vector<std::string> before = where.environment();
    before.insert(before.end(), variables.begin(), variables.end());
    const RunResult result = Process(limber_command(quiet(scene, {"--ticks", "2"}), before)).finish();
    EXPECT_EQ(result.code, 0) << result.err;
    const std::size_t at = result.err.find("playing headless (");
    return at == std::string::npos ? "a window opened\n" + result.err : result.err.substr(at);
  };
  EXPECT_NE(headless_notice(display, kTooOld).find("the driver offers OpenGL 2.1 and OpenGL ES 2.0. Update Mesa"),
            std::string::npos);
  EXPECT_NE(headless_notice(without_glx, {kNoDriver}).find("apt-get install libgl1-mesa-dri"), std::string::npos);
  EXPECT_NE(headless_notice(without_glx, {without(folder, {"libEGL.so.1"})}).find("apt-get install libegl1"),
            std::string::npos);
  EXPECT_NE(headless_notice(display, {"DISPLAY=:77777"}).find("Set DISPLAY (and XAUTHORITY)"), std::string::npos);
  EXPECT_NE(headless_notice(display, {"DISPLAY=", "WAYLAND_DISPLAY="}).find("a desktop session or xvfb-run sets one"),
            std::string::npos);
  // some builds of GLFW support X only
  const std::string wayland = headless_notice(display, {"DISPLAY=", "WAYLAND_DISPLAY=nobody"});
  EXPECT_NE(wayland.find(wayland.find("Wayland:") == std::string::npos ? "apt-get install xwayland"
                                                                       : "WAYLAND_DISPLAY as in the desktop session"),
            std::string::npos)
      << wayland;
}

}  // namespace
}  // namespace limber::app::test
