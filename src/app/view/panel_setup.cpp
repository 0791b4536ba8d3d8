// Collects the data from the modules and the user's folders.
#include "app/view/panel_setup.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/console/history.h"
#include "app/paths.h"
#include "app/view/window.h"
#include "app/viewer/shown_models.h"
#include "sim/behavior/behavior_type.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;

// the built-in types and those in behaviors_lua
std::vector<std::string> behavior_types() {
  std::vector<std::string> names;
  const sim::BehaviorTypes built_in;
  for (const auto& type : built_in.all()) names.push_back(type->name);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(data_dir()) / "behaviors_lua", error)) {
    if (entry.path().extension() == ".lua") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

render::FreeArea free_part(const panel::Gui& gui, int width, int height) {
  const panel::PanelRect& free = gui.layout().view;
  if (gui.settings().hidden || free.empty()) return {};
  return {free.x / width, free.y / height, free.width / width, free.height / height};
}

panel::GuiOptions panel_options(Window* window, render::GlApi api, const ShownModels* models) {
  panel::GuiOptions options;
  options.glsl = render::gl_api_info(api).glsl;
  options.behavior_types = behavior_types();
  const auto history = std::make_shared<ConsoleHistory>(ConsoleHistory::default_file());
  options.history = history->lines();
  options.store_line = [history](const std::string& line) { history->add(line); };
  if (models != nullptr && models->can_save()) {
    options.scene_file = models->proposed_file();
    options.save_scene = [models](const std::string& file, bool overwrite) { return models->save(file, overwrite); };
  }
  if (window == nullptr) return options;
  options.copy = [window](const std::string& text) { window->set_clipboard(text); };
  options.paste = [window] { return window->clipboard(); };
  return options;
}

}  // namespace limber::app
