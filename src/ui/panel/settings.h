// GuiSettings: the panel's persistent settings, stored as JSON.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "base/result.h"

namespace limber::panel {

struct GuiSettings {
  static constexpr double kMinTextSize = 12;
  static constexpr double kMaxTextSize = 28;
  static constexpr double kMaxMorphSeconds = 60;

  double text_size = 16;  ///< Pixels, before the display's scale.
  bool hidden = false;    ///< F1.
  double morph_seconds = 1.5;
  int easing = 1;                           ///< Index in easings().
  std::set<std::string> favorites;          ///< Addresses of properties.
  std::map<std::string, std::string> keys;  ///< Rebound hotkeys by name: "Ctrl+R".
  std::string style;                        ///< Of the view; empty: none was selected.
  bool full_screen = false;
  bool hide_pointer = false;
  std::string monitor;   ///< Number or name; empty: none was selected.
  int window_width = 0;  ///< 0: not known yet.
  int window_height = 0;
  bool operator==(const GuiSettings&) const = default;
};

/// Parses settings. Missing values get their default, numbers are clamped to their range. Fails if the text is not a
/// JSON object. [any]
Result<GuiSettings> read_settings(std::string_view text);
/// Returns the settings in the format of read_settings(). [any]
std::string settings_text(const GuiSettings& settings);

/// Returns $XDG_CONFIG_HOME/limber/panel.json, or the same below ~/.config; empty if there is no home directory. [any]
std::string settings_file();
/// Reads the file; without it, returns the defaults. A damaged file is renamed to panel.json.damaged, which is logged.
/// [main]
GuiSettings load_settings(const std::string& file);
/// Writes the file atomically; a failure is only logged. [main]
void save_settings(const std::string& file, const GuiSettings& settings);

}  // namespace limber::panel
