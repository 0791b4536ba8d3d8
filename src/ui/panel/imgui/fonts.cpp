// Loads the fonts of fonts-inter and fonts-jetbrains-mono, or DejaVu.
#include "ui/panel/imgui/fonts.h"

#include <cmath>
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panel/imgui/imgui_versions.h"

namespace limber::panel {

namespace {

struct FontChoice {
  const char* name;
  const char* package;
  const char* file;
  const char* replacement;
};
constexpr FontChoice kTextFont{"Inter", "fonts-inter", "usr/share/fonts/opentype/inter/Inter-Medium.otf",
                               "usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
constexpr FontChoice kCodeFont{"JetBrains Mono", "fonts-jetbrains-mono",
                               "usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                               "usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"};

// Latin, Greek, Cyrillic, punctuation, superscripts, currency signs, arrows and mathematical symbols.
constexpr ImWchar kCharacters[] = {0x20,   0x17f,  0x370,  0x3ff,  0x400,  0x52f,  0x1e00,
                                   0x1eff, 0x2010, 0x2044, 0x2070, 0x209f, 0x20a0, 0x20bf,
                                   0x2100, 0x214f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};

// From Debian's fonts-droid-fallback, fonts-noto-cjk, fonts-wqy-microhei, fonts-ipafont-gothic, fonts-nanum.
constexpr const char* kFallbackFonts[] = {
    "usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf", "usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc",
    "usr/share/fonts/truetype/wqy/wqy-microhei.ttc", "usr/share/fonts/opentype/ipafont-gothic/ipag.ttf",
    "usr/share/fonts/truetype/nanum/NanumGothic.ttf"};

bool is_known(unsigned character) {
  for (const ImWchar* range = kCharacters; range[0] != 0; range += 2)
    if (character >= range[0] && character <= range[1]) return true;
  return character < kCharacters[0];
}

std::string find_font(const FontChoice& choice, const std::string& root, std::vector<std::string>& warnings) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path best = fs::path(root) / choice.file;
  if (fs::is_regular_file(best, error)) return best.string();
  const fs::path other = fs::path(root) / choice.replacement;
  const bool dejavu = fs::is_regular_file(other, error);
  warnings.push_back(fmt::format("font {} not found, using {} instead. Install it with apt-get install {}", choice.name,
                                 dejavu ? "DejaVu" : "a bitmap font of fixed size", choice.package));
  return dejavu ? other.string() : "";
}

ImFont* load(const std::string& file, double pixels, const char* name, const std::string& fallback,
             const ImVector<ImWchar>& characters) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.RasterizerMultiply = 1.1F;
  std::snprintf(config.Name, sizeof config.Name, "%s", name);
  const auto size = static_cast<float>(std::floor(pixels));
  ImFont* font = nullptr;
  if (!file.empty()) font = atlas.AddFontFromFileTTF(file.c_str(), size, &config, kCharacters);
  if (font == nullptr) {
    config.SizePixels = size;
    font = atlas.AddFontDefault(&config);
  }
  if (fallback.empty() || characters.empty()) return font;
  config.MergeMode = true;
  // if glyphs are rasterized on demand, the font needs no ranges, which would have to outlive it
  atlas.AddFontFromFileTTF(fallback.c_str(), size, &config, imgui::builds_fonts() ? characters.Data : nullptr);
  return font;
}

}  // namespace

FontFiles find_fonts(const std::string& root) {
  FontFiles files;
  files.text = find_font(kTextFont, root, files.warnings);
  files.code = find_font(kCodeFont, root, files.warnings);
  std::error_code error;
  for (const char* const other : kFallbackFonts) {
    const std::filesystem::path file = std::filesystem::path(root) / other;
    if (files.fallback.empty() && std::filesystem::is_regular_file(file, error)) files.fallback = file.string();
  }
  return files;
}

bool collect_characters(std::string_view text, std::set<unsigned>& characters) {
  bool added = false;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    unsigned character = static_cast<unsigned char>(*at);
    at += character < 0x80 ? 1 : ImTextCharFromUtf8(&character, at, end);
    if (character <= IM_UNICODE_CODEPOINT_MAX && character != IM_UNICODE_CODEPOINT_INVALID && !is_known(character))
      added = characters.insert(character).second || added;
  }
  return added;
}

Fonts load_fonts(const FontFiles& files, double pixels, const std::set<unsigned>& characters) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.Flags |= ImFontAtlasFlags_NoPowerOfTwoHeight;
  ImVector<ImWchar> ranges;  // one range per character
  for (const unsigned character : characters) {
    ranges.push_back(static_cast<ImWchar>(character));
    ranges.push_back(static_cast<ImWchar>(character));
  }
  if (!ranges.empty()) ranges.push_back(0);
  Fonts fonts;
  fonts.text = load(files.text, pixels, "words", files.fallback, ranges);
  // larger, because its letters are lower
  fonts.code = load(files.code, pixels * 17 / 16, "code", files.fallback, ranges);
  if (imgui::builds_fonts()) atlas.Build();
  return fonts;
}

}  // namespace limber::panel
