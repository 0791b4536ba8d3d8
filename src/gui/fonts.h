// The panel's two fonts: Inter for words, JetBrains Mono for numbers and code; what stands in for one that is missing;
// and a third for letters of names that those two lack, such as Chinese ones.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

struct ImFont;

namespace limber {

struct FontFiles {
  std::string words;  ///< Empty: the one inside Dear ImGui.
  std::string code;
  std::string others;             ///< For letters that these lack; empty: no font that is known here has them.
  std::vector<std::string> said;  ///< What is missing, what stands in, and the cure; a line each.
};
/// Below `root` ("/" but in tests), where Debian's packages put them. [any]
FontFiles find_fonts(const std::string& root = "/");

struct Fonts {
  ImFont* words = nullptr;
  ImFont* code = nullptr;
};
/// Adds the letters of a text, in UTF-8, that words and code lack; true: one of them is new. [any]
bool gather_letters(std::string_view text, std::set<unsigned>& letters);
/// Makes the current context's atlas anew, words of that height in pixels. [main]
/// `letters`: what is taken of `files.others`.
Fonts load_fonts(const FontFiles& files, double pixels, const std::set<unsigned>& letters = {});

}  // namespace limber
