// Switches between two OpenGL contexts, of which one is current at a time.
#include "app/view/output_window.h"

#include <utility>

#include <fmt/format.h>

#include "base/log/output.h"

namespace limber::app {

namespace {
constexpr int kWidth = 960;
constexpr int kHeight = 540;
}  // namespace

Result<std::unique_ptr<OutputWindow>> OutputWindow::open(Window& first, const std::string& scene) {
  Result<std::unique_ptr<Window>> window =
      Window::open_beside(first, fmt::format("Limber output: {}", scene), kWidth, kHeight);
  if (!window) return Error{window.error()};
  print_notice("output window {} × {}; F11: full screen, F10: close it", (*window)->width(), (*window)->height());
  return std::unique_ptr<OutputWindow>(new OutputWindow(first, std::move(*window)));
}

// only the output window waits for the vertical blank; waiting for both would halve the frame rate
OutputWindow::OutputWindow(Window& first, std::unique_ptr<Window> window) : first_(first), window_(std::move(window)) {
  first_.set_vsync(false);
  window_->make_current();
  window_->set_vsync(true);
  framebuffer_ = render::GlFramebuffer::make();
  first_.make_current();
}

OutputWindow::~OutputWindow() {
  window_->make_current();
  framebuffer_ = {};
  window_.reset();
  first_.make_current();
  first_.set_vsync(true);
}

std::vector<panel::InputEvent> OutputWindow::consume_keys() {
  std::vector<panel::InputEvent> events = window_->consume_events();
  (void)window_->consume_mouse();
  std::erase_if(events, [](const panel::InputEvent& event) { return event.kind != panel::InputEvent::Kind::key; });
  return events;
}

Result<void> OutputWindow::draw(render::Renderer& renderer, const engine::Snapshot& before, const engine::Snapshot& now,
                                double mix) {
  const int width = window_->width();
  const int height = window_->height();
  if (width == 0 || height == 0) return {};
  if (Result<void> drawn = renderer.draw_output(before, now, mix, width, height); !drawn) return drawn;
  render::Renderer::flush();  // otherwise the other context may see an older frame
  window_->make_current();
  renderer.present_output(framebuffer_, width, height);
  window_->swap();
  first_.make_current();
  return {};
}

}  // namespace limber::app
