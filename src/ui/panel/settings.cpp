// Settings as JSON; the file is replaced atomically.
#include "ui/panel/settings.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "base/log/log.h"
#include "base/text.h"

namespace limber::panel {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kMaxWindowSize = 16384;
constexpr std::uintmax_t kMaxFileSize = 1u << 20;

double number_of(const Json& json, const char* name, double fallback, double low, double high) {
  const auto found = json.find(name);
  return found != json.end() && found->is_number() ? std::clamp(found->get<double>(), low, high) : fallback;
}

void read_lists(const Json& json, GuiSettings& settings) {
  if (const auto list = json.find("favourites"); list != json.end() && list->is_array()) {
    for (const Json& path : *list) {
      if (path.is_string()) settings.favorites.insert(path.get<std::string>());
    }
  }
  if (const auto keys = json.find("keys"); keys != json.end() && keys->is_object()) {
    for (const auto& [name, key] : keys->items()) {
      if (key.is_string()) settings.keys[name] = key.get<std::string>();
    }
  }
}

}  // namespace

Result<GuiSettings> read_settings(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return Error{"not a JSON object"};
  GuiSettings settings;
  settings.text_size =
      number_of(json, "text_size", settings.text_size, GuiSettings::kMinTextSize, GuiSettings::kMaxTextSize);
  settings.morph_seconds = number_of(json, "morph_seconds", settings.morph_seconds, 0, GuiSettings::kMaxMorphSeconds);
  settings.easing = static_cast<int>(number_of(json, "easing", settings.easing, 0, 3));
  settings.window_width = static_cast<int>(number_of(json, "window_width", 0, 0, kMaxWindowSize));
  settings.window_height = static_cast<int>(number_of(json, "window_height", 0, 0, kMaxWindowSize));
  for (const auto& [name, value] : {std::pair("hidden", &settings.hidden),
                                    {"fullscreen", &settings.full_screen},
                                    {"hide_pointer", &settings.hide_pointer}}) {
    if (const auto found = json.find(name); found != json.end() && found->is_boolean()) *value = found->get<bool>();
  }
  for (const auto& [name, value] : {std::pair("style", &settings.style), {"monitor", &settings.monitor}}) {
    if (const auto found = json.find(name); found != json.end() && found->is_string())
      *value = found->get<std::string>();
  }
  read_lists(json, settings);
  return settings;
}

std::string settings_text(const GuiSettings& s) {
  const Json json = {{"text_size", s.text_size},
                     {"hidden", s.hidden},
                     {"morph_seconds", s.morph_seconds},
                     {"easing", s.easing},
                     {"favourites", s.favorites},
                     {"style", s.style},
                     {"keys", s.keys},
                     {"window_width", s.window_width},
                     {"window_height", s.window_height},
                     {"fullscreen", s.full_screen},
                     {"hide_pointer", s.hide_pointer},
                     {"monitor", s.monitor}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string settings_file() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && config[0] == '/') return std::string(config) + "/limber/panel.json";
  const char* const home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.config/limber/panel.json" : "";
}

GuiSettings load_settings(const std::string& file) {
  std::error_code error;
  if (file.empty() || !fs::is_regular_file(file, error)) return {};
  std::string text;
  if (fs::file_size(file, error) <= kMaxFileSize && !error) {
    std::ifstream in(file, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const Result<GuiSettings> read = read_settings(text);
  if (read) return *read;
  const std::string renamed = file + ".damaged";
  fs::rename(file, renamed, error);
  log_warning("panel settings in {} are damaged ({}); using the defaults. The file {}", printable(file), read.error(),
              error ? "will be overwritten" : "was renamed to " + printable(renamed));
  return {};
}

void save_settings(const std::string& file, const GuiSettings& settings) {
  if (file.empty()) return;
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  const std::string temporary = file + ".new";
  bool written = false;
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out << settings_text(settings);
    out.close();
    written = out.good();
  }
  if (written) fs::rename(temporary, file, error);
  if (!written || error)
    log_warning("can't save the panel settings to {}. Check that the folder is writable", printable(file));
}

}  // namespace limber::panel
