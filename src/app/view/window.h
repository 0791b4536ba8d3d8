// Window: one window with an OpenGL context and its input events in order, through GLFW.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ui/panel/hotkeys.h"
#include "ui/panel/imgui/input.h"
#include "ui/render/gl.h"

struct GLFWwindow;

namespace limber::app {

/// Mouse movement since the last call: pixels of the window, steps of the wheel.
struct MouseMovement {
  double orbit_x = 0, orbit_y = 0;  ///< Left button pressed.
  double pan_x = 0, pan_y = 0;      ///< Right or middle button pressed, or left with Shift.
  double wheel = 0;                 ///< Up is positive.
  bool any() const { return orbit_x != 0 || orbit_y != 0 || pan_x != 0 || pan_y != 0 || wheel != 0; }
};

/// [main]
class Window {
 public:
  /// True if DISPLAY or WAYLAND_DISPLAY is set. [any]
  static bool has_display();
  /// Opens a window with the first of `apis` that is available and makes its context current. The error says why no
  /// window can be opened. [main]
  static Result<std::unique_ptr<Window>> open(const std::string& title, int width, int height,
                                              std::span<const render::GlApi> apis);
  /// Opens a second window with a context that shares objects with that of `first`, on another screen if there is one.
  /// The context of `first` stays current. `first` must outlive it. [main]
  static Result<std::unique_ptr<Window>> open_beside(const Window& first, const std::string& title, int width,
                                                     int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Sets the callback for a lost display. It must never return, because Xlib would end the program. [main]
  static void on_display_lost(std::function<void()> callback);

  /// Processes events; waits for one at most `seconds`. [main]
  void poll(double seconds);
  render::GlApi api() const { return api_; }
  bool closed() const;
  /// True if the window was destroyed from outside. [main]
  bool lost() const;
  /// Size of the framebuffer, pixels; 0 while the window is iconified. [main]
  int width() const;
  int height() const;
  /// Refresh rate of the window's screen, 1/s. [main]
  double refresh_rate() const;
  /// Scale of the window's screen: 2 on a screen with twice the pixel density. [main]
  double content_scale() const;
  /// Returns the input events since the last call, for the panel. [main]
  std::vector<panel::InputEvent> consume_events();
  /// True if there was input since the last consume_events(). [main]
  bool has_events() const { return !events_.empty() || mouse_.any() || !dropped_.empty(); }
  MouseMovement consume_mouse();
  /// Returns the paths of files that were dropped on the window since the last call. [main]
  std::vector<std::string> consume_dropped();
  /// Returns the labels of keys that are identified by their position. [main]
  panel::KeyLabels key_labels() const;
  std::string clipboard() const;
  void set_clipboard(const std::string& text);
  void set_title(const std::string& text);
  /// Centers the window on a monitor, given by its number from 1 or by its name or a part of it (case-insensitive). The
  /// error lists the monitors. [main]
  Result<void> move_to_monitor(const std::string& which);
  void hide_pointer();
  /// Switches between the full screen and the window. [main]
  void toggle_full_screen();
  bool is_full_screen() const;
  void swap();
  /// Makes the window's context current. [main]
  void make_current();
  /// Sets whether swap() waits for the vertical blank; the context must be current. [main]
  void set_vsync(bool enabled);

 private:
  Window(GLFWwindow* window, render::GlApi api);
  static void on_key(GLFWwindow* window, int key, int code, int action, int mods);
  static void on_move(GLFWwindow* window, double x, double y);
  static void on_scroll(GLFWwindow* window, double x, double y);
  static void on_button(GLFWwindow* window, int button, int action, int mods);
  static void on_char(GLFWwindow* window, unsigned character);
  static void on_focus(GLFWwindow* window, int focused);
  static void on_drop(GLFWwindow* window, int count, const char** paths);

  GLFWwindow* window_;
  render::GlApi api_;
  std::vector<panel::InputEvent> events_;
  MouseMovement mouse_;
  std::vector<std::string> dropped_;
  double x_ = 0;
  double y_ = 0;
  int windowed_rect_[4] = {0, 0, 0, 0};  // position and size before full screen
};

}  // namespace limber::app
