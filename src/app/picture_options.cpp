// Options of the window, of stills and films.
#include "app/picture_options.h"

#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/film_file.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr int kLargest = 16384;

constexpr const char* kGlVariable = "LIMBER_GL";

// the error of a value of --gl; empty: it is valid
std::string gl_choice_fault(const std::string& text) {
  if (text == "auto" || gl_apis(text).size() == 1) return {};
  return fmt::format("'{}' must be auto, core, es or 3.1 ({} sets it, too)", text, kGlVariable);
}

}  // namespace

void add_picture_options(CLI::App& play, PictureOptions& o) {
  play.add_flag("--headless", o.headless, "without a window");
  add_gl_option(play, o.gl);
  play.add_option("--quality", o.quality,
                  "of the picture; left out: high, but low in a window that software, OpenGL ES or OpenGL 3.1 draws")
      ->type_name("low|medium|high")
      ->check(CLI::IsMember({"low", "medium", "high"}));
  play.add_option("--size", o.size, "of the picture or window; default 1280x720")->type_name("WxH");
  // by a function: add_flag() sets an optional that was not given
  const auto flag = [&play](const char* name, std::optional<bool>& value, bool is, const char* text) {
    play.add_flag_function(
        name, [&value, is](std::int64_t) { value = is; }, text);
  };
  flag("--fullscreen", o.fullscreen, true, "the window fills its monitor; remembered for the next start");
  flag("--windowed", o.fullscreen, false, "it does so no more");
  play.add_option("--monitor", o.monitor, "where the window opens: a number from 1, or a name; remembered")
      ->type_name("N|NAME");
  flag("--hide-pointer", o.hide_pointer, true, "no mouse pointer over the window; remembered");
  flag("--show-pointer", o.hide_pointer, false, "one again");
  play.add_option("--screenshot", o.screenshot, "draw a still, without any display, and end")->type_name("FILE.png");
  play.add_option("--at", o.at, "the simulated time that --screenshot shows; left out: the start")
      ->type_name("S")
      ->check(CLI::Range(0.0, 1e6));
  play.add_option("--render", o.render,
                  "draw a film of --duration, without any display: film.mp4 (by ffmpeg), or shot_%05d.png for stills; "
                  "frame k shows the time k/fps")
      ->type_name("FILE|PATTERN");
  play.add_option("--fps", o.fps, "frames in a second of --render; default 60")
      ->type_name("N")
      ->check(CLI::Range(0.001, 1000.0));
  play.add_flag("--panel", o.panel, "with --screenshot: the panel over the picture, too");
  play.add_option("--panel-scale", o.panel_scale, "of the panel, beside what the screen asks for; default 1")
      ->type_name("N")
      ->check(CLI::Range(0.5, 4.0));
}

void add_gl_option(CLI::App& command, std::string& choice) {
  const CLI::Option* const option =
      command
          .add_option(
              "--gl", choice,
              "draw with OpenGL 3.3 (core), OpenGL ES 3.0 (es) or OpenGL 3.1; default: what LIMBER_GL says, else "
              "auto, the first of them that the driver has")
          ->type_name("auto|core|es|3.1")
          ->check(CLI::Validator([](std::string& text) { return gl_choice_fault(text); }, "", "gl"));
  // not by CLI11's envname(): its newer versions ignore a variable whose value is invalid
  command.parse_complete_callback([option, &choice] {
    const char* const variable = std::getenv(kGlVariable);
    if (option->count() > 0 || variable == nullptr || *variable == 0) return;
    choice = variable;
    if (const std::string fault = gl_choice_fault(choice); !fault.empty()) throw CLI::ValidationError("--gl", fault);
  });
}

Result<PictureSize> picture_size(const PictureOptions& options) {
  PictureSize size;
  if (options.size.empty()) return size;
  const auto words = split(options.size, 'x');
  const auto number = [&](std::size_t i) {
    const auto n = parse_number(words[i]);
    return n && *n >= 1 && *n <= kLargest && *n == static_cast<int>(*n) ? static_cast<int>(*n) : 0;
  };
  if (words.size() == 2) size = {number(0), number(1)};
  if (words.size() == 2 && size.width > 0 && size.height > 0) return size;
  return Error{fmt::format("--size '{}': write width x height in pixels, each 1 to {}, such as 1280x720",
                           printable(options.size), kLargest)};
}

Quality picture_quality(const PictureOptions& options, Quality otherwise) {
  if (options.quality == "low") return Quality::low;
  if (options.quality == "medium") return Quality::medium;
  return options.quality == "high" ? Quality::high : otherwise;
}

Result<void> check_picture(const PictureOptions& o, const std::optional<double>& duration) {
  const Result<PictureSize> size = picture_size(o);
  if (!size) return Error{size.error()};
  if (!o.screenshot.empty() && !o.render.empty()) return Error{"--screenshot and --render don't go together"};
  if (o.screenshot.empty() && o.at) return Error{"--at says when --screenshot is taken; give that too"};
  if (o.screenshot.empty() && o.panel) return Error{"--panel is of --screenshot; give that too"};
  if (o.render.empty() && o.fps) return Error{"--fps is that of --render; give that too"};
  if (!o.screenshot.empty() && !o.screenshot.ends_with(".png"))
    return Error{fmt::format("--screenshot '{}': a still is a .png file", printable(o.screenshot))};
  if (o.render.empty()) return {};
  if (!duration) return Error{"--render needs --duration S: how many simulated seconds the film has"};
  return check_film_file(o.render, size->width, size->height);
}

}  // namespace limber
