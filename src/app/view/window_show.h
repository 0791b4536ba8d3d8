// WindowShow: shows a running scene in a window: draws interpolated snapshots and sends the user's input.
#pragma once

#include <memory>
#include <string>

#include "app/view/display_options.h"
#include "app/view/frame_pace.h"
#include "app/view/output_window.h"
#include "app/view/viewport_mouse.h"
#include "app/view/window.h"
#include "engine/output/engine_link.h"
#include "ui/panel/gui.h"
#include "ui/render/camera.h"
#include "ui/render/renderer.h"

namespace limber {

/// [main]
class WindowShow {
 public:
  /// Must be called after all other threads were created: this thread lowers its priority, so that drawing never delays
  /// the simulation. The error says why there is no window. [main]
  static Result<std::unique_ptr<WindowShow>> open(const DisplayOptions& options, const std::string& scene,
                                                  EngineLink& link);

  /// Saves the panel's settings.
  ~WindowShow();
  WindowShow(const WindowShow&) = delete;
  WindowShow& operator=(const WindowShow&) = delete;

  /// Reason why the window has ended.
  enum class End : std::uint8_t { none, closed, lost };
  /// Handles input, draws one frame and waits until it is time for it. `lost`: drawing is no longer possible (already
  /// reported). [main]
  End frame();

 private:
  WindowShow(std::unique_ptr<Window> window, std::unique_ptr<Renderer> renderer, const DisplayOptions& options,
             const PanelSettings& settings, std::string scene, EngineLink& link);

  void update_snapshots(double now);
  void check_for_changes(double now);
  void set_camera(const Orbit& orbit);
  void handle_input(int width, int height, double now);
  void act(HotkeyAction action);
  void toggle_output();
  Result<void> draw_window(double mix, int width, int height);
  Result<void> draw_output(double mix);
  void follow_part();
  void handle_mouse();
  void send(std::vector<Message> messages);
  void update_title(double now);

  std::unique_ptr<Window> window_;
  std::unique_ptr<Renderer> renderer_;    // destroyed before its context
  std::unique_ptr<OutputWindow> output_;  // null: there is none
  ViewportMouse viewport_mouse_;
  std::optional<std::uint32_t> follow_part_;  // the part that follow_offset_ belongs to
  Vec3 follow_offset_{0};                     // position of the eye relative to the followed part
  std::string settings_file_;
  PanelSettings saved_settings_;  // the settings as saved in the file
  double panel_scale_ = 1;        // scale of the panel relative to the screen's own
  bool fixed_size_ = false;       // the command line sets the window's size
  std::unique_ptr<Gui> gui_;      // destroyed before its context
  std::string scene_;
  EngineLink& link_;
  std::shared_ptr<const Snapshot> before_, now_;
  double snapshot_time_ = 0;      // time at which now_ was read, s
  double interval_ = 0;           // time between before_ and now_, s
  Orbit orbit_;                   // used while the mouse moves the camera
  Orbit initial_view_;            // default view, of the first snapshot
  double camera_move_time_ = -1;  // time of the last camera movement, s
  FramePace pace_;
  std::shared_ptr<const Snapshot> last_seen_;  // at the last visible change
  int seen_width_ = 0;
  int seen_height_ = 0;
  double title_time_ = 0;
  double shader_check_time_ = 0;
  int frames_ = 0;  // since title_time_
};

}  // namespace limber
