// GuiHost: a context of Dear ImGui with its input, fonts and drawing, which each user interface of a window has.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "ui/panel/imgui/fonts.h"
#include "ui/panel/imgui/input.h"

struct ImGuiContext;

namespace limber::panel {

struct GuiHostOptions {
  bool draws = true;                       ///< Draw with OpenGL in the current context; false: nothing is drawn.
  std::string glsl = "#version 330 core";  ///< First line of the shaders, as required by the context.
  std::string font_root = "/";             ///< Root of the file system for the search of fonts; tests set another.
  std::function<void(const std::string&)> copy = [](const std::string&) {};  ///< Copies to the clipboard.
  std::function<std::string()> paste = [] { return std::string(); };
};

/// Size, scale and time of a frame.
struct GuiFrame {
  double width = 0;  ///< Pixels.
  double height = 0;
  double display_scale = 1;  ///< Scale of the display: 2 on high-density screens.
  double clock = 0;          ///< Monotonic time in s.
};

/// [main]
class GuiHost {
 public:
  explicit GuiHost(const GuiHostOptions& options);
  ~GuiHost();
  GuiHost(const GuiHost&) = delete;
  GuiHost& operator=(const GuiHost&) = delete;

  /// Queues an input event.
  void push(const InputEvent& event) { input_.push(event); }
  /// True if queued events are left for further frames.
  bool has_events() const { return !input_.empty(); }
  /// Prepares the context for a frame, before ImGui::NewFrame(), and returns the keys that were pressed. `text_size`:
  /// height of the text at a display scale of 1, pixels. `characters`: those that both fonts lack; `reload`: they have
  /// changed.
  std::vector<KeyPress> begin_frame(const GuiFrame& frame, double text_size, const std::set<unsigned>& characters = {},
                                    bool reload = false);
  /// Draws the last frame to the current OpenGL framebuffer.
  void render();
  /// Makes the context Dear ImGui's current one.
  void make_current() const;

  const Fonts& fonts() const { return fonts_; }
  bool has_fallback_font() const { return !files_.fallback.empty(); }
  /// Pixels per unit, where a unit is a pixel at text size 16.
  double scale() const { return scale_; }

 private:
  void update_fonts(const GuiFrame& frame, double text_size, const std::set<unsigned>& characters, bool reload);

  GuiHostOptions options_;
  ImGuiContext* context_;
  InputQueue input_;
  FontFiles files_;
  Fonts fonts_;
  double scale_ = 1;
  double font_pixels_ = 0;  // current font size
  double last_clock_ = 0;
  bool fonts_drawn_ = false;
};

}  // namespace limber::panel
