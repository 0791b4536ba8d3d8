// OutputWindow: a second window with the picture alone, for a projector. It shares OpenGL's objects with the first,
// whose renderer draws for both.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/window.h"
#include "view/renderer.h"

namespace limber {

class OutputWindow {
 public:
  /// On another screen than `first` where there is one; said on stderr. `first` outlives it. An error says why there is
  /// none. [main]
  static Result<std::unique_ptr<OutputWindow>> open(Window& first, const std::string& scene);
  ~OutputWindow();
  OutputWindow(const OutputWindow&) = delete;
  OutputWindow& operator=(const OutputWindow&) = delete;

  /// Somebody has closed it. [main]
  bool closed() const { return window_->closed(); }
  void toggle_full_screen() { window_->toggle_full_screen(); }
  bool has_events() const { return window_->has_events(); }
  /// Keys that were pressed in it since the last call. [main]
  std::vector<InputEvent> take_keys();
  /// Its own picture between two snapshots; the first window's context is current before and after. [main]
  Result<void> draw(Renderer& renderer, const Snapshot& before, const Snapshot& now, double mix);

 private:
  OutputWindow(Window& first, std::unique_ptr<Window> window);

  Window& first_;
  std::unique_ptr<Window> window_;
  GlFramebuffer frame_;  // of the window's own context
};

}  // namespace limber
