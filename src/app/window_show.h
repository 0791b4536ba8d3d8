// WindowShow: the show in a window: draws what the snapshots say, smooth between two of them, and sends what hands do.
#pragma once

#include <memory>
#include <string>

#include "app/frame_pace.h"
#include "app/output_window.h"
#include "app/picture_hand.h"
#include "app/picture_options.h"
#include "app/window.h"
#include "engine/link.h"
#include "gui/gui.h"
#include "view/lens.h"
#include "view/renderer.h"

namespace limber {

class WindowShow {
 public:
  /// After all other threads were made: this one steps behind them, so that drawing never holds up the simulation. An
  /// error says why there is no window. [main]
  static Result<std::unique_ptr<WindowShow>> open(const PictureOptions& options, const std::string& scene,
                                                  EngineLink& link);

  /// Keeps what the panel remembers.
  ~WindowShow();
  WindowShow(const WindowShow&) = delete;
  WindowShow& operator=(const WindowShow&) = delete;

  enum class End : std::uint8_t { none, closed, lost };
  /// What hands did, one picture, and the wait for its time. `lost`: nothing can be drawn any more, which was said.
  /// [main]
  End frame();

 private:
  WindowShow(std::unique_ptr<Window> window, std::unique_ptr<Renderer> renderer, const PictureOptions& options,
             const PanelSettings& settings, std::string scene, EngineLink& link);

  void look_at_snapshots(double now);
  void look_for_changes(double now);
  void look_from(const Orbit& orbit);
  void hear_hands(int width, int height, double now);
  void act(HotkeyAction action);
  void toggle_output();
  Result<void> draw_window(double mix, int width, int height);
  Result<void> draw_output(double mix);
  void follow();
  void hear_mouse();
  void send(std::vector<Message> messages);
  void tell_rate(double now);

  std::unique_ptr<Window> window_;
  std::unique_ptr<Renderer> renderer_;    // before its context goes
  std::unique_ptr<OutputWindow> output_;  // null: there is none
  PictureHand hand_;
  std::optional<std::uint32_t> follows_;  // what of hand_.followed() is followed already
  Vec3 follows_from_{0};                  // the eye, as seen from what is followed
  std::string settings_file_;
  PanelSettings kept_;        // as they are in the file
  double panel_scale_ = 1;    // of the panel, beside the screen's own
  bool own_size_ = false;     // the command line says how large the window is
  std::unique_ptr<Gui> gui_;  // before its context goes, too
  std::string scene_;
  EngineLink& link_;
  std::shared_ptr<const Snapshot> before_, now_;
  double came_ = 0;      // when now_ was seen, s
  double interval_ = 0;  // between the two, s
  Orbit orbit_;          // while a hand moves it
  Orbit home_;           // as it was at first
  double moved_ = -1;    // when one did last, s
  FramePace pace_;
  std::shared_ptr<const Snapshot> seen_;  // at the last change
  int seen_width_ = 0;
  int seen_height_ = 0;
  double told_ = 0;
  double shaders_looked_ = 0;
  int pictures_ = 0;  // since told_
};

}  // namespace limber
