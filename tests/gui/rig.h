// A panel without a window over an engine that plays a scene: hands by name, effects read back from the world.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/show.h"
#include "gui/gui.h"

namespace limber::gui_test {

/// A scene with everything that a panel shows: two bodies with joints and motors, behaviours, parameters.
inline constexpr KeyMods kCtrl{true, false, false};
inline constexpr KeyMods kShift{false, true, false};
inline constexpr KeyMods kCtrlShift{true, true, false};

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

class PanelRig {
 public:
  explicit PanelRig(const std::string& scene = kScene, double width = 1600, double height = 900)
      : file_(scene), show(file_.path()), width_(width), height_(height) {
    GuiOptions options = headless();
    options.copy = [this](const std::string& text) { clipboard = text; };
    options.behavior_types = {"force", "torque"};
    gui = std::make_unique<Gui>(show.link, std::move(options));
    heard();
  }

  /// The same over an engine of these options, such as one that replays a take.
  explicit PanelRig(EngineOptions options) : file_(kScene), show(std::move(options)), width_(1600), height_(900) {
    gui = std::make_unique<Gui>(show.link, headless());
    heard();
  }

  static GuiOptions headless() {
    GuiOptions options;
    options.paints = false;
    return options;
  }

  /// A picture of the panel, after what waits in the simulation's inbox has been done; time stands still for that.
  void frame() {
    show.engine.idle();
    clock_ += 1.0 / 60;
    gui->frame({width_, height_, scale, clock_});
  }
  void frames(int count) {
    for (int i = 0; i < count; i++) frame();
  }
  /// Until the simulation has done what hands have sent, and the panel has heard it.
  void heard() {
    const std::uint64_t ask = show.link.ask_image();
    for (int i = 0; i < kPatience; i++) {
      frame();
      if (gui->has_events()) continue;
      const std::shared_ptr<const Image> image = show.link.images.read();
      if (image != nullptr && image->asks >= ask && gui->desk().image == image) return frame();
    }
    ADD_FAILURE() << "the simulation made no image";
  }

  // hands
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
    heard();
  }
  /// Ctrl, Shift and Alt are let go of.
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
      event.letter = static_cast<unsigned char>(c);
      push(event);
    }
    heard();
  }

  /// Where it is seen; a widget that is not seen is a failure.
  PanelRect where(const std::string& name) const {
    const NamedWidget* const widget = gui->names().find(name);
    if (widget == nullptr || widget->visible.empty()) {
      ADD_FAILURE() << "there is no widget '" << name << "' to be seen";
      return {};
    }
    return widget->visible;
  }
  bool sees(const std::string& name) const {
    const NamedWidget* const widget = gui->names().find(name);
    return widget != nullptr && !widget->visible.empty();
  }
  void point(const std::string& name, double part = 0.5) {
    const PanelRect at = where(name);
    move(at.x + part * at.width, at.y + at.height / 2);
    frames(2);
  }
  void click(const std::string& name, int which = 0, KeyMods mods = {}, double part = 0.5) {
    point(name, part);
    button(true, which, mods);
    button(false, which, mods);
    release(mods);
    heard();
    frames(2);
  }
  /// To that part of its width, and lets go.
  void drag(const std::string& name, double to) {
    const PanelRect at = where(name);
    move(at.x + at.width / 2, at.y + at.height / 2);
    button(true);
    move(at.x + to * at.width, at.y + at.height / 2);
    frames(3);
    button(false);
    heard();
  }
  void scroll(const std::string& over, double steps) {
    point(over);
    InputEvent event;
    event.kind = InputEvent::Kind::wheel;
    event.y = steps;
    push(event);
    frames(2);
  }

  /// Where the scene lies.
  std::filesystem::path folder() const { return std::filesystem::path(file_.path()).parent_path(); }
  double read(const std::string& path, std::size_t index = 0) { return show.read(path, index); }

 private:
  static constexpr int kPatience = 100000;
  engine_test::SceneFile file_;

 public:
  engine_test::Show show;
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

}  // namespace limber::gui_test
