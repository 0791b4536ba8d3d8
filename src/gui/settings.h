// PanelSettings: what of the panel is remembered from show to show, as a small JSON text; where it is kept.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "base/result.h"

namespace limber {

struct PanelSettings {
  static constexpr double kSmallestText = 12;
  static constexpr double kLargestText = 28;

  double text_size = 16;  ///< Pixels, before the display's own scale.
  bool hidden = false;    ///< F1.
  double morph_seconds = 1.5;
  int easing = 1;                           ///< Of Easing.
  std::set<std::string> favourites;         ///< Addresses of rows.
  std::map<std::string, std::string> keys;  ///< Chosen keys by the name of their hotkey: "Ctrl+R".
  std::string style;                        ///< Of the look; empty: none was chosen.
  bool fullscreen = false;
  bool hide_pointer = false;
  std::string monitor;   ///< Number or name; empty: none was chosen.
  int window_width = 0;  ///< 0: none yet.
  int window_height = 0;
  bool operator==(const PanelSettings&) const = default;
};

/// What is missing in the text has its default; numbers beyond their range are brought into it. An error: it is none of
/// ours. [any]
Result<PanelSettings> read_settings(std::string_view text);
std::string settings_text(const PanelSettings& settings);

/// $XDG_CONFIG_HOME/limber/panel.json, else below ~/.config; empty when there is no home. [any]
std::string settings_file();
/// The file's; one that is damaged is set aside as panel.json.damaged, which is said. Without a file: defaults. [main]
PanelSettings load_settings(const std::string& file);
/// Whole or not at all; a file that can't be written is said and no more. [main]
void save_settings(const std::string& file, const PanelSettings& settings);

}  // namespace limber
