// Files of fonts-inter and fonts-jetbrains-mono, else of DejaVu.
#include "gui/fonts.h"

#include <cmath>
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "gui/imgui_versions.h"

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

// of Debian's fonts-droid-fallback, fonts-noto-cjk, fonts-wqy-microhei, fonts-ipafont-gothic, fonts-nanum
constexpr const char* kOthers[] = {
    "usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf", "usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc",
    "usr/share/fonts/truetype/wqy/wqy-microhei.ttc", "usr/share/fonts/opentype/ipafont-gothic/ipag.ttf",
    "usr/share/fonts/truetype/nanum/NanumGothic.ttf"};

bool is_known(unsigned letter) {
  for (const ImWchar* range = kLetters; range[0] != 0; range += 2)
    if (letter >= range[0] && letter <= range[1]) return true;
  return letter < kLetters[0];
}

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

ImFont* load(const std::string& file, double pixels, const char* name, const std::string& others,
             const ImVector<ImWchar>& letters) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.RasterizerMultiply = 1.1F;
  std::snprintf(config.Name, sizeof config.Name, "%s", name);
  const auto size = static_cast<float>(std::floor(pixels));
  ImFont* font = nullptr;
  if (!file.empty()) font = atlas.AddFontFromFileTTF(file.c_str(), size, &config, kLetters);
  if (font == nullptr) {
    config.SizePixels = size;
    font = atlas.AddFontDefault(&config);
  }
  if (others.empty() || letters.empty()) return font;
  config.MergeMode = true;
  // where glyphs are drawn on demand, the font needs no ranges, which would have to outlive it
  atlas.AddFontFromFileTTF(others.c_str(), size, &config, imgui::builds_fonts() ? letters.Data : nullptr);
  return font;
}

}  // namespace

FontFiles find_fonts(const std::string& root) {
  FontFiles files;
  files.words = look_for(kWords, root, files.said);
  files.code = look_for(kCode, root, files.said);
  std::error_code fault;
  for (const char* const other : kOthers) {
    const std::filesystem::path file = std::filesystem::path(root) / other;
    if (files.others.empty() && std::filesystem::is_regular_file(file, fault)) files.others = file.string();
  }
  return files;
}

bool gather_letters(std::string_view text, std::set<unsigned>& letters) {
  bool fresh = false;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    unsigned letter = static_cast<unsigned char>(*at);
    at += letter < 0x80 ? 1 : ImTextCharFromUtf8(&letter, at, end);
    if (letter <= IM_UNICODE_CODEPOINT_MAX && letter != IM_UNICODE_CODEPOINT_INVALID && !is_known(letter))
      fresh = letters.insert(letter).second || fresh;
  }
  return fresh;
}

Fonts load_fonts(const FontFiles& files, double pixels, const std::set<unsigned>& letters) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.Flags |= ImFontAtlasFlags_NoPowerOfTwoHeight;
  ImVector<ImWchar> ranges;  // each a range of its own
  for (const unsigned letter : letters) {
    ranges.push_back(static_cast<ImWchar>(letter));
    ranges.push_back(static_cast<ImWchar>(letter));
  }
  if (!ranges.empty()) ranges.push_back(0);
  Fonts fonts;
  fonts.words = load(files.words, pixels, "words", files.others, ranges);
  fonts.code = load(files.code, pixels * 17 / 16, "code", files.others, ranges);  // its letters are lower
  if (imgui::builds_fonts()) atlas.Build();
  return fonts;
}

}  // namespace limber
