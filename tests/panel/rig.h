// A panel without a window on an engine that runs a scene: tests act on widgets by name and read the effects from the
// world.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/show.h"
#include "ui/panel/gui.h"

namespace limber::panel::test {

inline constexpr KeyMods kCtrl{true, false, false};
inline constexpr KeyMods kShift{false, true, false};
inline constexpr KeyMods kCtrlShift{true, true, false};

/// A scene that uses all parts of the panel: two bodies with joints and motors, behaviors, parameters.
inline constexpr const char* kScene = R"(
params {
  { "rate", 0.5, min = 0, max = 2, unit = "Hz", doc = "How often." },
  { "lit", true, doc = "Whether." },
  { "mode", "slow", choices = { "slow", "fast" }, doc = "Which." },
}
for i, name in ipairs { "arm", "leg" } do
  local body = sim:add_body(name)
  local ball = name .. " ball"
  sim:add_sphere_shape(ball, 0.1)
  body:add_part("base", ball, { position = vec3(i, 0, 1), mass = 0 })
  body:add_part("tip", ball, { position = vec3(i, 0, 1.5), mass = 1 })
  body:add_joint("hinge", "base", "tip", { axis = vec3(0, 1, 0) })
  body:add_motor("hinge")
  body:add_behavior("force", "push", { parts = "tip", amp = 0 })
end
)";

class PanelFixture {
 public:
  explicit PanelFixture(const std::string& scene = kScene, double width = 1600, double height = 900,
                        GuiOptions options = headless())
      : file_(scene), show(file_.path()), width_(width), height_(height) {
    options.copy = [this](const std::string& text) { clipboard = text; };
    options.behavior_types = {"force", "torque"};
    gui = std::make_unique<Gui>(show.link, std::move(options));
    sync();
  }

  /// The same on an engine with these options, for example for a replay.
  explicit PanelFixture(engine::EngineOptions options)
      : file_(kScene), show(std::move(options)), width_(1600), height_(900) {
    gui = std::make_unique<Gui>(show.link, headless());
    sync();
  }

  static GuiOptions headless() {
    GuiOptions options;
    options.draws = false;
    return options;
  }

  /// Draws a frame after the commands in the simulation's command queue have been executed; simulated time does not
  /// advance.
  void frame() {
    show.engine.idle();
    clock_ += 1.0 / 60;
    gui->frame({width_, height_, scale, clock_});
  }
  void frames(int count) {
    for (int i = 0; i < count; i++) frame();
  }
  /// Waits until the simulation has executed all sent messages and the panel has read the result.
  void sync() {
    const std::uint64_t ask = show.link.request_value_snapshot();
    for (int i = 0; i < kMaxFrames; i++) {
      frame();
      if (gui->has_events()) continue;
      const std::shared_ptr<const engine::ValueSnapshot> snapshot = show.link.value_snapshots.read();
      if (snapshot != nullptr && snapshot->request >= ask && gui->context().value_snapshot == snapshot) return frame();
    }
    ADD_FAILURE() << "the simulation made no value snapshot";
  }

  // input
  void push(const InputEvent& event) { gui->push(event); }
  void move(double x, double y) {
    InputEvent event;
    event.kind = InputEvent::Kind::move;
    event.x = x;
    event.y = y;
    push(event);
  }
  void button(bool down, int which = 0, KeyMods mods = {}) {
    InputEvent event;
    event.kind = InputEvent::Kind::button;
    event.button = which;
    event.down = down;
    event.mods = mods;
    push(event);
  }
  void key(GuiKey key, KeyMods mods = {}) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = key;
    event.mods = mods;
    event.down = true;
    push(event);
    event.down = false;
    push(event);
    release(mods);
    sync();
  }
  /// Releases Ctrl, Shift and Alt.
  void release(KeyMods mods) {
    if (mods == KeyMods{}) return;
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    push(event);
  }
  void type(const std::string& text) {
    for (const char c : text) {
      InputEvent event;
      event.kind = InputEvent::Kind::text;
      event.character = static_cast<unsigned char>(c);
      push(event);
    }
    sync();
  }

  /// Returns the visible rectangle; fails if the widget is not visible.
  PanelRect rect_of(const std::string& name) const {
    const NamedWidget* const widget = gui->names().find(name);
    if (widget == nullptr || widget->visible.empty()) {
      ADD_FAILURE() << "there is no widget '" << name << "' to be seen";
      return {};
    }
    return widget->visible;
  }
  bool is_visible(const std::string& name) const {
    const NamedWidget* const widget = gui->names().find(name);
    return widget != nullptr && !widget->visible.empty();
  }
  void point(const std::string& name, double part = 0.5) {
    const PanelRect at = rect_of(name);
    move(at.x + part * at.width, at.y + at.height / 2);
    frames(2);
  }
  void click(const std::string& name, int which = 0, KeyMods mods = {}, double part = 0.5) {
    point(name, part);
    button(true, which, mods);
    button(false, which, mods);
    release(mods);
    sync();
    frames(2);
  }
  /// Drags to this fraction of the widget's width and releases.
  void drag(const std::string& name, double to) {
    const PanelRect at = rect_of(name);
    move(at.x + at.width / 2, at.y + at.height / 2);
    button(true);
    move(at.x + to * at.width, at.y + at.height / 2);
    frames(3);
    button(false);
    sync();
  }
  void scroll(const std::string& over, double steps) {
    point(over);
    InputEvent event;
    event.kind = InputEvent::Kind::wheel;
    event.y = steps;
    push(event);
    frames(2);
  }

  /// Names of the widgets whose names start with `prefix`, in the order in which they were drawn.
  std::vector<std::string> names_with(const std::string& prefix) const {
    std::vector<std::string> names;
    for (const NamedWidget& widget : gui->names().all()) {
      if (widget.name.starts_with(prefix)) names.push_back(widget.name);
    }
    return names;
  }
  /// Shows only the parameter with this address, by searching for it.
  void search(const std::string& address) {
    key(GuiKey::f, kCtrl);
    key(GuiKey::a, kCtrl);
    type(address);
    frames(2);
  }

  /// The folder of the scene.
  std::filesystem::path folder() const { return std::filesystem::path(file_.path()).parent_path(); }
  double read(const std::string& path, std::size_t index = 0) { return show.read(path, index); }

 private:
  static constexpr int kMaxFrames = 100000;
  engine::test::SceneFile file_;

 public:
  engine::test::Show show;
  std::unique_ptr<Gui> gui;
  std::string clipboard;
  double scale = 1;
  void resize(double width, double height) {
    width_ = width;
    height_ = height;
    frames(3);
  }

 private:
  double width_;
  double height_;
  double clock_ = 0;
};

}  // namespace limber::panel::test
