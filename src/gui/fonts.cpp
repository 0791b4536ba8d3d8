// Files of fonts-inter and fonts-jetbrains-mono, else of DejaVu.
#include "gui/fonts.h"

#include <cmath>
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <imgui.h>

namespace limber {

namespace {

struct Wanted {
  const char* name;
  const char* package;
  const char* file;
  const char* instead;
};
constexpr Wanted kWords{"Inter", "fonts-inter", "usr/share/fonts/opentype/inter/Inter-Medium.otf",
                        "usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
constexpr Wanted kCode{"JetBrains Mono", "fonts-jetbrains-mono",
                       "usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                       "usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"};

// Latin, Greek, Cyrillic, punctuation, letters and arrows of formulas, signs of mathematics
constexpr ImWchar kLetters[] = {0x20,   0x17f,  0x370,  0x3ff,  0x400,  0x52f,  0x1e00, 0x1eff, 0x2010, 0x2044, 0x2070,
                                0x209f, 0x20a0, 0x20bf, 0x2100, 0x214f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};

std::string look_for(const Wanted& wanted, const std::string& root, std::vector<std::string>& said) {
  namespace fs = std::filesystem;
  std::error_code fault;
  const fs::path best = fs::path(root) / wanted.file;
  if (fs::is_regular_file(best, fault)) return best.string();
  const fs::path other = fs::path(root) / wanted.instead;
  const bool dejavu = fs::is_regular_file(other, fault);
  said.push_back(fmt::format("the font {} is not there, {} stands in; apt-get install {}", wanted.name,
                             dejavu ? "DejaVu" : "a coarse one of fixed size", wanted.package));
  return dejavu ? other.string() : "";
}

ImFont* load(const std::string& file, double pixels, const char* name) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.RasterizerMultiply = 1.1F;
  std::snprintf(config.Name, sizeof config.Name, "%s", name);
  const auto size = static_cast<float>(std::floor(pixels));
  ImFont* font = nullptr;
  if (!file.empty()) font = atlas.AddFontFromFileTTF(file.c_str(), size, &config, kLetters);
  if (font != nullptr) return font;
  config.SizePixels = size;
  return atlas.AddFontDefault(&config);
}

}  // namespace

FontFiles find_fonts(const std::string& root) {
  FontFiles files;
  files.words = look_for(kWords, root, files.said);
  files.code = look_for(kCode, root, files.said);
  return files;
}

Fonts load_fonts(const FontFiles& files, double pixels) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.Flags |= ImFontAtlasFlags_NoPowerOfTwoHeight;
  Fonts fonts;
  fonts.words = load(files.words, pixels, "words");
  fonts.code = load(files.code, pixels * 17 / 16, "code");  // its letters are lower
  atlas.Build();
  return fonts;
}

}  // namespace limber
