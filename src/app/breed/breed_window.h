// BreedWindow: shows a BreedSession in a window. [main]
#pragma once

#include <array>
#include <memory>
#include <string>

#include "app/breed/breed_session.h"
#include "app/view/display_options.h"
#include "app/view/window.h"
#include "ui/panel/breed/breed_gui.h"
#include "ui/panel/settings.h"
#include "ui/render/gl.h"

namespace limber::app {

class BreedWindow {
 public:
  /// The error says why there is no window. `scene`: its name, for the title.
  static Result<std::unique_ptr<BreedWindow>> open(const DisplayOptions& options, const std::string& scene);
  BreedWindow(const BreedWindow&) = delete;
  BreedWindow& operator=(const BreedWindow&) = delete;

  /// Draws one frame and performs the user's actions; waits until it is time for the next. False: the window was
  /// closed.
  bool frame(BreedSession& session);

 private:
  BreedWindow(std::unique_ptr<Window> window, const DisplayOptions& options);

  std::unique_ptr<Window> window_;
  double text_size_;
  double panel_scale_;
  std::unique_ptr<panel::BreedGui> gui_;  // destroyed before its context
  std::array<render::GlTexture, BreedSession::kCount> textures_;
};

}  // namespace limber::app
