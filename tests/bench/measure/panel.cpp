// Runs the panel without a window with 1000 arms; the engine takes value snapshots in between, as with a window.
#include "bench/measure/measures.h"

#include <string>

#include "bench/measure/arms.h"
#include "bench/measure/times.h"
#include "ui/panel/gui.h"

namespace limber {

namespace {

constexpr int kPanelArms = 1000;

class BenchPanel {
 public:
  explicit BenchPanel(engine::EngineLink& link) : gui_(link, options()) {}

  panel::Gui& gui() { return gui_; }
  /// Runs `count` frames and returns the processor time of each.
  TimeSamples frames(BenchArms& arms, int count) {
    TimeSamples samples;
    for (int i = 0; i < count; i++) {
      arms.engine().idle();
      clock_ += 1.0 / 60;
      const double begin = system::thread_seconds();
      gui_.frame({1600, 900, 1, clock_});
      samples.add(system::thread_seconds() - begin);
    }
    return samples;
  }
  void click(const std::string& name) {
    const panel::NamedWidget* const widget = gui_.names().find(name);
    if (widget == nullptr) return;
    panel::InputEvent event;
    event.kind = panel::InputEvent::Kind::move;
    event.x = widget->visible.x + widget->visible.width / 2;
    event.y = widget->visible.y + widget->visible.height / 2;
    gui_.push(event);
    event.kind = panel::InputEvent::Kind::button;
    for (const bool down : {true, false}) {
      event.down = down;
      gui_.push(event);
    }
  }
  void type(const std::string& text) {
    panel::InputEvent event;
    event.kind = panel::InputEvent::Kind::text;
    for (const char c : text) {
      event.character = static_cast<unsigned char>(c);
      gui_.push(event);
    }
  }

 private:
  static panel::GuiOptions options() {
    panel::GuiOptions options;
    options.draws = false;
    return options;
  }

  panel::Gui gui_;
  double clock_ = 0;
};

}  // namespace

nlohmann::ordered_json measure_panel(const MeasureOptions& options) {
  const int frames = options.ticks > 0 ? options.ticks : 600;
  BenchArms arms(arm_scene(kPanelArms));
  arms.tick();
  BenchPanel panel(arms.link());
  panel.frames(arms, 60);
  const TimeSamples plain = panel.frames(arms, frames);
  panel.click("tree:/physics/body/arm1");
  panel.frames(arms, 10);
  panel.click("tree:/physics/body/arm1");
  panel.frames(arms, 10);
  const TimeSamples with_selection = panel.frames(arms, frames);
  panel.click("scene.search");
  panel.frames(arms, 5);
  panel.type("part16");
  panel.frames(arms, 5);
  const TimeSamples filtered = panel.frames(arms, frames);
  return {{"parts", kPanelArms * 17},
          {"frame_us", plain.microseconds()},
          {"frame_with_a_body_chosen_us", with_selection.microseconds()},
          {"frame_with_the_tree_filtered_us", filtered.microseconds()}};
}

}  // namespace limber
