// Two contexts, of which one is current at a time.
#include "app/output_window.h"

#include <utility>

#include <fmt/format.h>

#include "base/output.h"

namespace limber {

namespace {
constexpr int kWidth = 960;
constexpr int kHeight = 540;
}  // namespace

Result<std::unique_ptr<OutputWindow>> OutputWindow::open(Window& first, const std::string& scene) {
  Result<std::unique_ptr<Window>> window =
      Window::open_beside(first, fmt::format("Limber output: {}", scene), kWidth, kHeight);
  if (!window) return Error{window.error()};
  print_notice("output window {} × {}; F11: the whole screen, F10: away with it", (*window)->width(),
               (*window)->height());
  return std::unique_ptr<OutputWindow>(new OutputWindow(first, std::move(*window)));
}

// the audience's screen sets the pace; waiting for both would halve it
OutputWindow::OutputWindow(Window& first, std::unique_ptr<Window> window) : first_(first), window_(std::move(window)) {
  first_.wait_for_screen(false);
  window_->use();
  window_->wait_for_screen(true);
  frame_ = GlFramebuffer::make();
  first_.use();
}

OutputWindow::~OutputWindow() {
  window_->use();
  frame_ = {};
  window_.reset();
  first_.use();
  first_.wait_for_screen(true);
}

std::vector<InputEvent> OutputWindow::take_keys() {
  std::vector<InputEvent> events = window_->take_events();
  (void)window_->take_mouse();
  std::erase_if(events, [](const InputEvent& event) { return event.kind != InputEvent::Kind::key; });
  return events;
}

Result<void> OutputWindow::draw(Renderer& renderer, const Snapshot& before, const Snapshot& now, double mix) {
  const int width = window_->width();
  const int height = window_->height();
  if (width == 0 || height == 0) return {};
  if (Result<void> drawn = renderer.draw_output(before, now, mix, width, height); !drawn) return drawn;
  glFlush();  // else the other context may see the picture before
  window_->use();
  renderer.show_output(frame_, width, height);
  window_->swap();
  first_.use();
  return {};
}

}  // namespace limber
