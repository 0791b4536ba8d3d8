// OutputWindow: a second window with the scene alone, for a projector. It shares OpenGL objects with the first window,
// and the renderer of that window draws both.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/view/window.h"
#include "ui/render/renderer.h"

namespace limber::app {

/// [main]
class OutputWindow {
 public:
  /// Opens the window, on another screen than `first` if there is one, and prints a notice. `first` must outlive it.
  /// The error says why it can't be opened. [main]
  static Result<std::unique_ptr<OutputWindow>> open(Window& first, const std::string& scene);
  ~OutputWindow();
  OutputWindow(const OutputWindow&) = delete;
  OutputWindow& operator=(const OutputWindow&) = delete;

  /// True if the user has closed it. [main]
  bool closed() const { return window_->closed(); }
  void toggle_full_screen() { window_->toggle_full_screen(); }
  bool has_events() const { return window_->has_events(); }
  /// Returns the key events since the last call. [main]
  std::vector<panel::InputEvent> consume_keys();
  /// Draws the scene interpolated between two snapshots. The context of the first window is current before and after.
  /// [main]
  Result<void> draw(render::Renderer& renderer, const engine::Snapshot& before, const engine::Snapshot& now,
                    double mix);

 private:
  OutputWindow(Window& first, std::unique_ptr<Window> window);

  Window& first_;
  std::unique_ptr<Window> window_;
  render::GlFramebuffer framebuffer_;  // belongs to the context of this window
};

}  // namespace limber::app
