// WindowShow: shows a running scene in a window: draws interpolated snapshots and sends the user's input.
#pragma once

#include <memory>
#include <string>

#include "app/view/camera_control.h"
#include "app/view/change_detector.h"
#include "app/view/display_options.h"
#include "app/view/frame_pace.h"
#include "app/view/output_window.h"
#include "app/view/snapshot_interpolation.h"
#include "app/view/viewport_mouse.h"
#include "app/view/window.h"
#include "app/viewer/shown_models.h"
#include "engine/output/engine_link.h"
#include "ui/panel/gui.h"
#include "ui/render/renderer.h"

namespace limber::app {

/// [main]
class WindowShow {
 public:
  /// Must be called after all other threads were created: this thread lowers its priority, so that drawing never delays
  /// the simulation. The error says why there is no window. [main]
  static Result<std::unique_ptr<WindowShow>> open(const DisplayOptions& options, const std::string& scene,
                                                  engine::EngineLink& link, const ShownModels& models);

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
  WindowShow(std::unique_ptr<Window> window, std::unique_ptr<render::Renderer> renderer, const DisplayOptions& options,
             const panel::GuiSettings& settings, std::string scene, engine::EngineLink& link,
             const ShownModels& models);

  void update_snapshots(double now);
  void check_for_changes(double now);
  void handle_input(int width, int height, double now);
  void act(panel::HotkeyAction action);
  void frame(panel::HotkeyAction action);
  void toggle_output();
  Result<void> draw_window(double mix, int width, int height);
  Result<void> draw_output(double mix);
  void follow_part();
  void handle_mouse();
  void send(std::vector<Message> messages);
  void update_title(double now);

  std::unique_ptr<Window> window_;
  std::unique_ptr<render::Renderer> renderer_;  // destroyed before its context
  std::unique_ptr<OutputWindow> output_;        // null: there is none
  ViewportMouse viewport_mouse_;
  CameraControl camera_;
  std::string settings_file_;
  panel::GuiSettings saved_settings_;  // the settings as saved in the file
  double panel_scale_ = 1;             // scale of the panel relative to the screen's own
  bool fixed_size_ = false;            // the command line sets the window's size
  std::unique_ptr<panel::Gui> gui_;    // destroyed before its context
  std::string scene_;
  engine::EngineLink& link_;
  const ShownModels& models_;
  SnapshotInterpolation snapshots_;
  FramePace pace_;
  ChangeDetector changes_;
  FrameCounter frames_;
  double shader_check_time_ = 0;
};

}  // namespace limber::app
