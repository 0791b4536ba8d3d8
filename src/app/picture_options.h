// What the command line of `play` says about the picture.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "view/renderer.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace limber {

/// As it was typed.
struct PictureOptions {
  bool headless = false;
  std::string gl;                    ///< Kind of OpenGL, see gl_apis().
  std::string quality;               ///< Empty: not given.
  std::string size;                  ///< Empty: not given.
  std::optional<bool> fullscreen;    ///< Of the window; nothing: as it was last.
  std::string monitor;               ///< Its number from 1 or its name; empty: as it was last.
  std::optional<bool> hide_pointer;  ///< Over the window; nothing: as it was last.
  std::string screenshot;            ///< File of a still; empty: none.
  std::optional<double> at;
  std::string render;  ///< File of a film, or a pattern of stills; empty: none.
  std::optional<double> fps;
  bool panel = false;                 ///< Over a still, too.
  std::optional<double> panel_scale;  ///< Beside the screen's own.

  bool offline() const { return !screenshot.empty() || !render.empty(); }
};

void add_picture_options(CLI::App& play, PictureOptions& options);
/// `--gl`, of each command that draws.
void add_gl_option(CLI::App& command, std::string& choice);

struct PictureSize {
  int width = 1280;
  int height = 720;
};

/// What of them is wrong together, or nothing. `duration`: of the run, where it has one.
Result<void> check_picture(const PictureOptions& options, const std::optional<double>& duration);
/// "1280x720".
Result<PictureSize> picture_size(const PictureOptions& options);
/// The one that was asked for; else `otherwise`.
Quality picture_quality(const PictureOptions& options, Quality otherwise);

}  // namespace limber
