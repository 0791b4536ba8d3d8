// The frame loop of the window of `limber breed`.
#include "app/breed/breed_window.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/output.h"
#include "base/system/clock.h"
#include "ui/render/texture.h"

namespace limber::app {

namespace {

constexpr double kFrameTime = 1.0 / 60;   // s
constexpr double kHiddenTime = 1.0 / 10;  // s between checks of a window that is iconified

panel::GuiHostOptions host_options(Window& window) {
  panel::GuiHostOptions options;
  options.glsl = render::gl_api_info(window.api()).glsl;
  options.copy = [&window](const std::string& text) { window.set_clipboard(text); };
  options.paste = [&window] { return window.clipboard(); };
  return options;
}

}  // namespace

Result<std::unique_ptr<BreedWindow>> BreedWindow::open(const DisplayOptions& options, const std::string& scene) {
  const Result<ImageSize> size = image_size(options);
  if (!size) return Error{size.error()};
  Result<std::unique_ptr<Window>> window =
      Window::open(fmt::format("Limber breed: {}", scene), size->width, size->height, render::gl_apis(options.gl));
  if (!window) return Error{window.error()};
  print_notice("window {} × {}, drawn by {} with {}", size->width, size->height, render::gl_driver(),
               render::gl_api_info((*window)->api()).name);
  return std::unique_ptr<BreedWindow>(new BreedWindow(std::move(*window), options));
}

BreedWindow::BreedWindow(std::unique_ptr<Window> window, const DisplayOptions& options)
    : window_(std::move(window)),
      text_size_(panel::load_settings(panel::settings_file()).text_size),
      panel_scale_(options.panel_scale.value_or(1)),
      gui_(std::make_unique<panel::BreedGui>(host_options(*window_))) {
  if (options.full_screen.value_or(false)) window_->toggle_full_screen();
}

bool BreedWindow::frame(BreedSession& session) {
  window_->poll(0);
  if (window_->lost() || window_->closed()) return false;
  const int width = window_->width();
  const int height = window_->height();
  if (width <= 0 || height <= 0) {  // iconified
    (void)session.read_images(kHiddenTime);
    return true;
  }
  for (const panel::InputEvent& event : window_->consume_events()) gui_->push(event);
  panel::BreedView view = session.view();
  for (std::size_t i = 0; i < textures_.size(); i++) view.cells[i].texture = session.failed(i) ? 0 : *textures_[i];
  const double now = system::clock_seconds();
  const std::vector<panel::BreedAction> actions = gui_->frame(
      {static_cast<double>(width), static_cast<double>(height), window_->content_scale() * panel_scale_, now},
      text_size_, view);
  for (const panel::BreedAction& action : actions) {
    if (action.kind == panel::BreedAction::Kind::full_screen) window_->toggle_full_screen();
    session.perform(action);
  }
  const MouseMovement mouse = window_->consume_mouse();
  session.request_images(gui_->cell_width(), gui_->cell_height(), gui_->moves_camera() ? mouse : MouseMovement{}, now);
  gui_->render();
  window_->swap();
  const std::array<bool, BreedSession::kCount> changed =
      session.read_images(std::max(kFrameTime - (system::clock_seconds() - now), 0.001));
  for (std::size_t i = 0; i < textures_.size(); i++) {
    if (changed[i]) render::update_texture(textures_[i], session.image(i));
  }
  return true;
}

}  // namespace limber::app
