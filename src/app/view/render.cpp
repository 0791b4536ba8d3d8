// One loop for still images and films: ticks the engine and interpolates each frame between two ticks.
#include "app/view/render.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/progress.h"
#include "app/view/film_file.h"
#include "app/view/offline_clock.h"
#include "app/view/panel_setup.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/text.h"
#include "ui/render/offscreen.h"

namespace limber::app {

namespace {

RenderResult failure(int code, const std::string& text) { return {fail(code, text), false}; }

// the panel over a still image: it processes all ticks before, so that its graphs are filled
class StillPanel {
 public:
  StillPanel(const DisplayOptions& options, render::GlApi api, const ImageSize& size, engine::Engine& engine,
             engine::EngineLink& link)
      : engine_(engine), link_(link), gui_(link, panel_options(nullptr, api)) {
    frame_ = {static_cast<double>(size.width), static_cast<double>(size.height), options.panel_scale.value_or(1), 0};
  }
  void frame() {
    frame_.clock += 1.0 / 60;
    gui_.frame(frame_);
  }
  render::FreeArea free() const {
    return free_part(gui_, static_cast<int>(frame_.width), static_cast<int>(frame_.height));
  }
  void draw_over(const render::Renderer& renderer) {
    const std::uint64_t request = link_.request_value_snapshot();
    const auto outdated = [&] {
      const std::shared_ptr<const engine::ValueSnapshot> image = link_.value_snapshots.read();
      return image == nullptr || image->request < request;
    };
    while (outdated()) engine_.idle();
    for (int i = 0; i < kLayoutFrames; i++) frame();
    renderer.draw_over([&] { gui_.render(); });
  }

 private:
  static constexpr int kLayoutFrames = 3;  // frames until the layout is stable
  engine::Engine& engine_;
  engine::EngineLink& link_;
  panel::Gui gui_;
  panel::GuiFrame frame_;
};

RenderResult draw_still(const DisplayOptions& options, const ImageSize& size, render::Renderer& renderer,
                        OfflineClock& clock, engine::Engine& engine, engine::EngineLink& link) {
  const double at = options.at.value_or(0);
  std::optional<StillPanel> panel;
  if (options.panel) {
    panel.emplace(options, renderer.api(), size, engine, link);
    clock.on_before_tick([&] { panel->frame(); });
  }
  const OfflineClock::Outcome outcome = clock.advance_to(at);
  if (outcome == OfflineClock::Outcome::canceled) return {kSuccess, true};
  if (outcome == OfflineClock::Outcome::stuck)
    return failure(kInputError, "the simulation is paused before the time of --at");
  if (panel) panel->frame();
  const render::FreeArea free = panel ? panel->free() : render::FreeArea{};
  if (const auto drawn = renderer.draw(clock.before(), clock.now(), clock.mix(at), size.width, size.height, free);
      !drawn)
    return failure(kMachineError, drawn.error());
  if (panel) panel->draw_over(renderer);
  if (const auto written = render::write_png(renderer.read(), options.screenshot); !written)
    return failure(kInputError, written.error());
  print_notice("{}: {} × {}, at {} s", printable(options.screenshot), size.width, size.height, number_text(at));
  return {};
}

RenderResult draw_film(const DisplayOptions& options, const ImageSize& size, render::Renderer& renderer,
                       OfflineClock& clock, double duration, const std::function<bool()>& cancel) {
  const double fps = options.fps.value_or(60);
  const auto frames = static_cast<std::uint64_t>(std::max(std::llround(duration * fps), 1LL));
  Result<std::unique_ptr<FilmFile>> film = FilmFile::open(options.render, size.width, size.height, fps);
  if (!film) return failure(kMachineError, film.error());
  Progress progress("frame", frames);
  std::uint64_t done = 0;
  bool canceled = false;
  for (; done < frames; done++) {
    const double at = static_cast<double>(done) / fps;
    const OfflineClock::Outcome outcome = clock.advance_to(at);
    if (outcome == OfflineClock::Outcome::stuck)
      return failure(kInputError, fmt::format("the simulation is paused at {:.2f} s", at));
    if (outcome == OfflineClock::Outcome::ended) break;
    if (outcome == OfflineClock::Outcome::canceled || cancel()) {
      canceled = true;
      break;
    }
    if (const auto drawn = renderer.draw(clock.before(), clock.now(), clock.mix(at), size.width, size.height); !drawn)
      return failure(kMachineError, drawn.error());
    if (const auto added = (*film)->add(renderer.read()); !added) return failure(kMachineError, added.error());
    progress.report(done + 1);
  }
  if (const auto finished = (*film)->finish(); !finished) return failure(kMachineError, finished.error());
  print_notice("{}: {}, {} × {}, {} a second{}", printable(options.render), counted(done, "frame"), size.width,
               size.height, number_text(fps),
               done < frames
                   ? fmt::format("; {}, {} were requested", canceled ? "cancelled" : "the take has ended", frames)
                   : "");
  // run to the full duration, like a run without --render
  if (canceled) return {kSuccess, true};
  const OfflineClock::Outcome outcome = clock.advance_to(duration);
  if (outcome == OfflineClock::Outcome::stuck) return failure(kInputError, "the simulation is paused");
  return {kSuccess, outcome == OfflineClock::Outcome::canceled};
}

}  // namespace

RenderResult render(const DisplayOptions& options, engine::Engine& engine, engine::EngineLink& link,
                    std::optional<double> duration, const std::function<bool()>& cancel) {
  const Result<ImageSize> size = image_size(options);
  if (!size) return failure(kUsageError, size.error());
  const Result<std::unique_ptr<render::OffscreenContext>> context = render::OffscreenContext::make(options.gl);
  if (!context) return failure(kMachineError, context.error());
  const render::Quality quality = render_quality(options, render::Quality::high);
  const Result<std::unique_ptr<render::Renderer>> renderer =
      render::Renderer::make((*context)->api(), shader_dir(), quality);
  if (!renderer) return failure(kMachineError, renderer.error());
  print_notice("drawn by {} with {}", render::gl_driver(), render::gl_api_info((*context)->api()).name);
  if (render::gl_is_software() && quality != render::Quality::low && !options.render.empty())
    print_notice("software rendering is slow; --quality low is several times faster");
  OfflineClock clock(engine, link, cancel);
  if (options.render.empty()) return draw_still(options, *size, **renderer, clock, engine, link);
  return draw_film(options, *size, **renderer, clock, duration.value_or(0), cancel);
}

}  // namespace limber::app
