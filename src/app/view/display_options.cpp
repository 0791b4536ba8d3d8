// Declares and checks the options of the window, of still images and of films.
#include "app/view/display_options.h"

#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/option_checks.h"
#include "app/view/film_file.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr int kMaxSize = 16384;

constexpr const char* kGlVariable = "LIMBER_GL";

// returns the error of an invalid value of --gl; empty: valid
std::string gl_choice_error(const std::string& text) {
  if (text == "auto" || render::gl_apis(text).size() == 1) return {};
  return fmt::format("'{}' must be auto, core, es or 3.1 ({} sets it, too)", text, kGlVariable);
}

void add_picture_options(CLI::App& command, DisplayOptions& o) {
  add_gl_option(command, o.gl);
  command
      .add_option(
          "--quality", o.quality,
          "Rendering quality; default: high, but low in a window with software rendering, OpenGL ES or OpenGL 3.1.")
      ->type_name("low|medium|high")
      ->check(CLI::IsMember({"low", "medium", "high"}));
  command.add_option("--size", o.size, "Size of the window or image; default 1280x720.")->type_name("WxH");
}

void add_panel_scale(CLI::App& command, DisplayOptions& o) {
  command
      .add_option("--panel-scale", o.panel_scale, "Scale of the panel, multiplied by the screen's scale; default 1.")
      ->type_name("N")
      ->check(between(0.5, 4.0));
}

}  // namespace

void add_window_options(CLI::App& command, DisplayOptions& options) {
  add_picture_options(command, options);
  command.add_flag_function(
      "--fullscreen", [&options](std::int64_t) { options.full_screen = true; }, "Fill the monitor.");
  add_panel_scale(command, options);
}

void add_display_options(CLI::App& play, DisplayOptions& o) {
  play.add_flag("--headless", o.headless, "Play without a window.");
  add_picture_options(play, o);
  // a function, because add_flag() sets an optional even if the flag is not given
  const auto flag = [&play](const char* name, std::optional<bool>& value, bool is, const char* text) {
    play.add_flag_function(
        name, [&value, is](std::int64_t) { value = is; }, text);
  };
  flag("--fullscreen", o.full_screen, true, "Fill the monitor; remembered for the next start.");
  flag("--windowed", o.full_screen, false, "Use a normal window; remembered.");
  play.add_option("--monitor", o.monitor, "Monitor of the window: a number from 1, or a name; remembered.")
      ->type_name("N|NAME");
  flag("--hide-pointer", o.hide_pointer, true, "Hide the mouse pointer over the window; remembered.");
  flag("--show-pointer", o.hide_pointer, false, "Show the mouse pointer; remembered.");
  play.add_option("--screenshot", o.screenshot, "Render an image without a display, and exit.")->type_name("FILE.png");
  play.add_option("--at", o.at, "Simulated time of --screenshot in seconds; default 0.")
      ->type_name("S")
      ->check(between(0.0, 1e6));
  play.add_option(
          "--render", o.render,
          "Render a film of length --duration without a display: film.mp4 (with ffmpeg), or shot_%05d.png for images; "
          "frame k shows the time k/fps.")
      ->type_name("FILE|PATTERN");
  play.add_option("--fps", o.fps, "Frames per second of --render; default 60.")
      ->type_name("N")
      ->check(between(0.001, 1000.0));
  play.add_flag("--panel", o.panel, "With --screenshot: draw the panel, too.");
  add_panel_scale(play, o);
}

void add_gl_option(CLI::App& command, std::string& choice) {
  const CLI::Option* const option =
      command
          .add_option("--gl", choice,
                      "OpenGL version: 3.3 (core), ES 3.0 (es) or 3.1; default: the value of LIMBER_GL, else "
                      "auto, the first of them that the driver supports.")
          ->type_name("auto|core|es|3.1")
          ->check(CLI::Validator([](std::string& text) { return gl_choice_error(text); }, "", "gl"));
  // not CLI11's envname(): its newer versions ignore a variable with an invalid value
  command.parse_complete_callback([option, &choice] {
    const char* const variable = std::getenv(kGlVariable);
    if (option->count() > 0 || variable == nullptr || *variable == 0) return;
    choice = variable;
    if (const std::string error = gl_choice_error(choice); !error.empty()) throw CLI::ValidationError("--gl", error);
  });
}

Result<ImageSize> image_size(const DisplayOptions& options) {
  ImageSize size;
  if (options.size.empty()) return size;
  const auto words = split(options.size, 'x');
  const auto number = [&](std::size_t i) {
    const auto n = parse_number(words[i]);
    return n && *n >= 1 && *n <= kMaxSize && *n == static_cast<int>(*n) ? static_cast<int>(*n) : 0;
  };
  if (words.size() == 2) size = {number(0), number(1)};
  if (words.size() == 2 && size.width > 0 && size.height > 0) return size;
  return Error{fmt::format("--size '{}': write width x height in pixels, each 1 to {}, such as 1280x720",
                           printable(options.size), kMaxSize)};
}

render::Quality render_quality(const DisplayOptions& options, render::Quality fallback) {
  if (options.quality == "low") return render::Quality::low;
  if (options.quality == "medium") return render::Quality::medium;
  return options.quality == "high" ? render::Quality::high : fallback;
}

Result<void> check_display_options(const DisplayOptions& o, const std::optional<double>& duration) {
  const Result<ImageSize> size = image_size(o);
  if (!size) return Error{size.error()};
  if (!o.screenshot.empty() && !o.render.empty()) return Error{"--screenshot and --render exclude each other"};
  if (o.screenshot.empty() && o.at) return Error{"--at requires --screenshot"};
  if (o.screenshot.empty() && o.panel) return Error{"--panel requires --screenshot"};
  if (o.render.empty() && o.fps) return Error{"--fps requires --render"};
  if (!o.screenshot.empty() && !o.screenshot.ends_with(".png"))
    return Error{fmt::format("--screenshot '{}': the file name must end with .png", printable(o.screenshot))};
  if (o.render.empty()) return {};
  if (!duration) return Error{"--render requires --duration S, the length of the film in simulated seconds"};
  return check_film_file(o.render, size->width, size->height);
}

}  // namespace limber::app
