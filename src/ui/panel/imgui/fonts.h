// The panel's fonts: Inter for text, JetBrains Mono for numbers and code, replacements if they are missing, and a
// fallback for characters in names that both lack, such as Chinese ones.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

struct ImFont;

namespace limber::panel {

struct FontFiles {
  std::string text;  ///< Empty: Dear ImGui's built-in font.
  std::string code;
  std::string fallback;  ///< Fallback for missing characters; empty: none was found.
  /// Log lines about missing fonts, with their replacement and the package to install.
  std::vector<std::string> warnings;
};
/// Searches the paths of Debian's packages below `root` ("/" except in tests). [any]
FontFiles find_fonts(const std::string& root = "/");

struct Fonts {
  ImFont* text = nullptr;
  ImFont* code = nullptr;
};
/// Collects the characters of a UTF-8 text that both fonts lack. Returns true if any of them is new. [any]
bool collect_characters(std::string_view text, std::set<unsigned>& characters);
/// Rebuilds the current context's font atlas for this text height in pixels. `characters` are added from
/// `files.fallback`. [main]
Fonts load_fonts(const FontFiles& files, double pixels, const std::set<unsigned>& characters = {});

}  // namespace limber::panel
