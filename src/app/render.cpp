// One loop for stills and films: time goes on tick by tick, each frame lies between two of them.
#include "app/render.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/film_file.h"
#include "app/moments.h"
#include "app/panel_setup.h"
#include "app/paths.h"
#include "app/progress.h"
#include "base/output.h"
#include "base/text.h"
#include "view/offscreen.h"

namespace limber {

namespace {

Rendered failed(int code, const std::string& text) { return {fail(code, text), false}; }

// the panel over a still: it has seen the ticks before, so that its graphs are full
class StillPanel {
 public:
  StillPanel(const PictureOptions& options, GlApi api, const PictureSize& size, Engine& engine, EngineLink& link)
      : engine_(engine), link_(link), gui_(link, panel_options(nullptr, api)) {
    frame_ = {static_cast<double>(size.width), static_cast<double>(size.height), options.panel_scale.value_or(1), 0};
  }
  void frame() {
    frame_.clock += 1.0 / 60;
    gui_.frame(frame_);
  }
  FreePart free() const { return free_part(gui_, static_cast<int>(frame_.width), static_cast<int>(frame_.height)); }
  void draw_over(const Renderer& renderer) {
    const std::uint64_t ask = link_.ask_image();
    const auto late = [&] {
      const std::shared_ptr<const Image> image = link_.images.read();
      return image == nullptr || image->asks < ask;
    };
    while (late()) engine_.idle();
    for (int i = 0; i < kSettle; i++) frame();
    renderer.draw_over([&] { gui_.paint(); });
  }

 private:
  static constexpr int kSettle = 3;  // frames until all has its place
  Engine& engine_;
  EngineLink& link_;
  Gui gui_;
  GuiFrame frame_;
};

Rendered draw_still(const PictureOptions& options, const PictureSize& size, Renderer& renderer, Moments& moments,
                    Engine& engine, EngineLink& link) {
  const double at = options.at.value_or(0);
  std::optional<StillPanel> panel;
  if (options.panel) {
    panel.emplace(options, renderer.api(), size, engine, link);
    moments.on_tick([&] { panel->frame(); });
  }
  const Moments::Went went = moments.go_to(at);
  if (went == Moments::Went::cancelled) return {kFine, true};
  if (went == Moments::Went::stuck) return failed(kInput, "time stands still: the scene is paused before --at");
  if (panel) panel->frame();
  const FreePart free = panel ? panel->free() : FreePart{};
  if (const auto drawn = renderer.draw(moments.before(), moments.now(), moments.mix(at), size.width, size.height, free);
      !drawn)
    return failed(kMachine, drawn.error());
  if (panel) panel->draw_over(renderer);
  if (const auto written = write_png(renderer.read(), options.screenshot); !written)
    return failed(kInput, written.error());
  print_notice("{}: {} × {}, at {} s", printable(options.screenshot), size.width, size.height, number_text(at));
  return {};
}

Rendered draw_film(const PictureOptions& options, const PictureSize& size, Renderer& renderer, Moments& moments,
                   double duration, const std::function<bool()>& cancel) {
  const double fps = options.fps.value_or(60);
  const auto frames = static_cast<std::uint64_t>(std::max(std::llround(duration * fps), 1LL));
  Result<std::unique_ptr<FilmFile>> film = FilmFile::open(options.render, size.width, size.height, fps);
  if (!film) return failed(kMachine, film.error());
  Progress progress("frame", frames);
  std::uint64_t done = 0;
  bool cancelled = false;
  for (; done < frames; done++) {
    const double at = static_cast<double>(done) / fps;
    const Moments::Went went = moments.go_to(at);
    if (went == Moments::Went::stuck)
      return failed(kInput, fmt::format("time stands still: the scene is paused at {:.2f} s", at));
    if (went == Moments::Went::ended) break;
    if (went == Moments::Went::cancelled || cancel()) {
      cancelled = true;
      break;
    }
    if (const auto drawn = renderer.draw(moments.before(), moments.now(), moments.mix(at), size.width, size.height);
        !drawn)
      return failed(kMachine, drawn.error());
    if (const auto added = (*film)->add(renderer.read()); !added) return failed(kMachine, added.error());
    progress.tell(done + 1);
  }
  if (const auto whole = (*film)->finish(); !whole) return failed(kMachine, whole.error());
  print_notice("{}: {} frames, {} × {}, {} a second{}", printable(options.render), done, size.width, size.height,
               number_text(fps),
               done < frames
                   ? fmt::format("; {}, {} were asked for", cancelled ? "cancelled" : "the take has ended", frames)
                   : "");
  // to the end, as a run of that duration goes
  if (cancelled) return {kFine, true};
  const Moments::Went went = moments.go_to(duration);
  if (went == Moments::Went::stuck) return failed(kInput, "time stands still: the scene is paused");
  return {kFine, went == Moments::Went::cancelled};
}

}  // namespace

Rendered render(const PictureOptions& options, Engine& engine, EngineLink& link, std::optional<double> duration,
                const std::function<bool()>& cancel) {
  const Result<PictureSize> size = picture_size(options);
  if (!size) return failed(kUsage, size.error());
  const Result<std::unique_ptr<Offscreen>> context = Offscreen::make(options.gl);
  if (!context) return failed(kMachine, context.error());
  const Quality quality = picture_quality(options, Quality::high);
  const Result<std::unique_ptr<Renderer>> renderer = Renderer::make((*context)->api(), shader_dir(), quality);
  if (!renderer) return failed(kMachine, renderer.error());
  print_notice("drawn by {} with {}", gl_driver(), gl_api_info((*context)->api()).name);
  if (gl_is_software() && quality != Quality::low && !options.render.empty())
    print_notice("that is software, and takes its time; --quality low is several times faster");
  Moments moments(engine, link, cancel);
  if (options.render.empty()) return draw_still(options, *size, **renderer, moments, engine, link);
  return draw_film(options, *size, **renderer, moments, duration.value_or(0), cancel);
}

}  // namespace limber
