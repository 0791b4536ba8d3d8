// Options of `play` for the window, still images and films.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "ui/render/renderer.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// The options as typed.
struct DisplayOptions {
  bool headless = false;
  std::string gl;                    ///< Kind of OpenGL, see gl_apis().
  std::string quality;               ///< Empty: not given.
  std::string size;                  ///< Empty: not given.
  std::optional<bool> full_screen;   ///< Fill the monitor; nothing: as in the last session.
  std::string monitor;               ///< Number from 1, or name; empty: as in the last session.
  std::optional<bool> hide_pointer;  ///< Hide the mouse pointer over the window; nothing: as in the last session.
  std::string screenshot;            ///< File of a still image; empty: none.
  std::optional<double> at;
  std::string render;  ///< File of a film, or pattern of still images; empty: none.
  std::optional<double> fps;
  bool panel = false;                 ///< Draw the panel over a still image, too.
  std::optional<double> panel_scale;  ///< Scale of the panel, multiplied by the screen's own.

  bool offline() const { return !screenshot.empty() || !render.empty(); }
};

void add_display_options(CLI::App& play, DisplayOptions& options);
/// Declares the options of a window that doesn't remember them: OpenGL, quality, size, full screen, the panel's scale.
void add_window_options(CLI::App& command, DisplayOptions& options);
/// Declares `--gl`, for each command that draws.
void add_gl_option(CLI::App& command, std::string& choice);

/// Pixels.
struct ImageSize {
  int width = 1280;
  int height = 720;
};

/// Fails if the options contradict each other. `duration`: of the run, if limited.
Result<void> check_display_options(const DisplayOptions& options, const std::optional<double>& duration);
/// Parses "1280x720".
Result<ImageSize> image_size(const DisplayOptions& options);
/// Returns the requested quality, else `fallback`.
render::Quality render_quality(const DisplayOptions& options, render::Quality fallback);

}  // namespace limber::app
