// Window: one window with OpenGL and what hands do in it, through GLFW, in its order.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "gui/hotkeys.h"
#include "gui/input.h"
#include "view/gl.h"

struct GLFWwindow;

namespace limber {

/// What a mouse has done since the last look: pixels of the window, steps of the wheel.
struct MouseMoves {
  double turn_x = 0, turn_y = 0;    ///< Left button held.
  double shift_x = 0, shift_y = 0;  ///< Right or middle button, or left with Shift.
  double wheel = 0;                 ///< Up is positive.
  bool any() const { return turn_x != 0 || turn_y != 0 || shift_x != 0 || shift_y != 0 || wheel != 0; }
};

class Window {
 public:
  /// Whether this process was told of one. [any]
  static bool has_display();
  /// Its context is current on this thread, of the first of `apis` that can be had. An error says why there can be
  /// none. [main]
  static Result<std::unique_ptr<Window>> open(const std::string& title, int width, int height,
                                              std::span<const GlApi> apis);
  /// Another one, whose context shares objects with `first`'s; on another screen where there is one. First's context
  /// stays current. It goes before `first`. [main]
  static Result<std::unique_ptr<Window>> open_beside(const Window& first, const std::string& title, int width,
                                                     int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Called when the display is gone: it never returns, as Xlib would end the program. [main]
  static void on_display_lost(std::function<void()> go_on);

  /// Takes what came; waits for it so many seconds at most. [main]
  void poll(double seconds);
  GlApi api() const { return api_; }
  bool closed() const;
  /// Somebody else took it away. [main]
  bool lost() const;
  /// Of the framebuffer, pixels; 0 while it is iconified. [main]
  int width() const;
  int height() const;
  /// Of the screen that it is on, 1/s. [main]
  double refresh_rate() const;
  /// Of the screen that it is on: 2 where there are twice the pixels. [main]
  double content_scale() const;
  /// What hands have done since the last call, for the panel. [main]
  std::vector<InputEvent> take_events();
  /// Whether hands have done something since then. [main]
  bool has_events() const { return !events_.empty() || mouse_.any(); }
  MouseMoves take_mouse();
  /// What the keyboard prints on keys that act by their place. [main]
  KeyLabels key_labels() const;
  std::string clipboard() const;
  void clipboard(const std::string& text);
  void title(const std::string& text);
  /// To the middle of a monitor: its number from 1, or its name or a part of it, in any case. The error lists them.
  /// [main]
  Result<void> move_to_monitor(const std::string& which);
  void hide_pointer();
  /// To the whole screen that it is on, and back. [main]
  void toggle_full_screen();
  bool is_full_screen() const;
  void swap();
  /// Its context is current from here on. [main]
  void use();
  /// Whether swap() waits for the screen, while its context is current. [main]
  void wait_for_screen(bool waits);

 private:
  Window(GLFWwindow* window, GlApi api);
  static void on_key(GLFWwindow* window, int key, int code, int action, int mods);
  static void on_move(GLFWwindow* window, double x, double y);
  static void on_scroll(GLFWwindow* window, double x, double y);
  static void on_button(GLFWwindow* window, int button, int action, int mods);
  static void on_letter(GLFWwindow* window, unsigned letter);
  static void on_focus(GLFWwindow* window, int focused);

  GLFWwindow* window_;
  GlApi api_;
  std::vector<InputEvent> events_;
  MouseMoves mouse_;
  double x_ = 0;
  double y_ = 0;
  int place_[4] = {0, 0, 0, 0};  // before it was full screen
};

}  // namespace limber
