// The panel's two fonts: Inter for words, JetBrains Mono for numbers and code; what stands in for one that is missing.
#pragma once

#include <string>
#include <vector>

struct ImFont;

namespace limber {

struct FontFiles {
  std::string words;  ///< Empty: the one inside Dear ImGui.
  std::string code;
  std::vector<std::string> said;  ///< What is missing, what stands in, and the cure; a line each.
};
/// Below `root` ("/" but in tests), where Debian's packages put them. [any]
FontFiles find_fonts(const std::string& root = "/");

struct Fonts {
  ImFont* words = nullptr;
  ImFont* code = nullptr;
};
/// Makes the current context's atlas anew, words of that height in pixels. [main]
Fonts load_fonts(const FontFiles& files, double pixels);

}  // namespace limber
