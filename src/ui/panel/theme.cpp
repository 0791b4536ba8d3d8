// The palette and its mapping to the style of Dear ImGui.
#include "ui/panel/theme.h"

#include <cmath>
#include <cstddef>

#include <imgui.h>

namespace limber::panel {

namespace {

constexpr std::array<Rgb, static_cast<std::size_t>(ThemeColor::count)> kThemeColors = {{
    {0x09, 0x0b, 0x12},  // back
    {0x12, 0x14, 0x18},  // panel
    {0x2c, 0x30, 0x3b},  // line
    {0x26, 0x2a, 0x33},  // field
    {0x30, 0x35, 0x41},  // hover
    {0x1d, 0x21, 0x28},  // header
    {0x41, 0x34, 0x20},  // selected
    {0xe3, 0xe6, 0xeb},  // text
    {0xa0, 0xa7, 0xb3},  // secondary
    {0xe9, 0xa5, 0x3f},  // accent
    {0x6b, 0x4e, 0x26},  // fill
    {0xc8, 0x8e, 0x38},  // active
    {0x14, 0x10, 0x0a},  // on_active
    {0xff, 0x81, 0x78},  // red
    {0x45, 0xc9, 0x8a},  // green
    {0x7c, 0xc1, 0xf8},  // blue
}};

constexpr std::array kTextCombinations = {
    TextOnBackground{ThemeColor::text, ThemeColor::panel},
    TextOnBackground{ThemeColor::text, ThemeColor::field},
    TextOnBackground{ThemeColor::text, ThemeColor::hover},
    TextOnBackground{ThemeColor::text, ThemeColor::header},
    TextOnBackground{ThemeColor::text, ThemeColor::selected},
    TextOnBackground{ThemeColor::text, ThemeColor::fill},
    TextOnBackground{ThemeColor::secondary, ThemeColor::panel},
    TextOnBackground{ThemeColor::secondary, ThemeColor::field},
    TextOnBackground{ThemeColor::secondary, ThemeColor::header},
    TextOnBackground{ThemeColor::secondary, ThemeColor::selected},
    TextOnBackground{ThemeColor::accent, ThemeColor::panel},
    TextOnBackground{ThemeColor::accent, ThemeColor::field},
    TextOnBackground{ThemeColor::accent, ThemeColor::header},
    TextOnBackground{ThemeColor::on_active, ThemeColor::active},
    TextOnBackground{ThemeColor::red, ThemeColor::panel},
    TextOnBackground{ThemeColor::red, ThemeColor::field},
    TextOnBackground{ThemeColor::green, ThemeColor::panel},
    TextOnBackground{ThemeColor::blue, ThemeColor::panel},
    TextOnBackground{ThemeColor::green, ThemeColor::back},
    TextOnBackground{ThemeColor::blue, ThemeColor::back},
    TextOnBackground{ThemeColor::text, ThemeColor::back},
    TextOnBackground{ThemeColor::secondary, ThemeColor::back},
    TextOnBackground{ThemeColor::red, ThemeColor::back},
};

constexpr double kPanelAlpha = 0.94;  // opacity of panels: the view is slightly visible through them

double linear(std::uint8_t channel) {
  const double v = channel / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double luminance(const Rgb& c) { return 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]); }

ImVec4 color(ThemeColor t, double alpha = 1) { return ImGui::ColorConvertU32ToFloat4(packed_color(t, alpha)); }

void set_colors(ImVec4* colors) {
  const auto set = [&](ThemeColor t, std::initializer_list<ImGuiCol> slots, double alpha = 1) {
    for (const ImGuiCol slot : slots) colors[slot] = color(t, alpha);
  };
  for (int i = 0; i < ImGuiCol_COUNT; i++) colors[i] = color(ThemeColor::line);
  set(ThemeColor::text, {ImGuiCol_Text, ImGuiCol_CheckMark});
  set(ThemeColor::secondary, {ImGuiCol_TextDisabled});
  set(ThemeColor::panel, {ImGuiCol_WindowBg}, kPanelAlpha);
  set(ThemeColor::panel, {ImGuiCol_PopupBg, ImGuiCol_TitleBg, ImGuiCol_TitleBgActive, ImGuiCol_MenuBarBg}, 0.98);
  set(ThemeColor::panel, {ImGuiCol_ChildBg, ImGuiCol_ScrollbarBg, ImGuiCol_BorderShadow, ImGuiCol_TableRowBg}, 0);
  set(ThemeColor::line, {ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong});
  set(ThemeColor::field, {ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_TabActive, ImGuiCol_TabUnfocusedActive});
  set(ThemeColor::hover, {ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_ButtonHovered, ImGuiCol_TabHovered,
                          ImGuiCol_HeaderHovered, ImGuiCol_ScrollbarGrab});
  set(ThemeColor::header, {ImGuiCol_Tab, ImGuiCol_TabUnfocused, ImGuiCol_TableHeaderBg});
  set(ThemeColor::selected, {ImGuiCol_Header, ImGuiCol_HeaderActive, ImGuiCol_ButtonActive});
  set(ThemeColor::fill, {ImGuiCol_TextSelectedBg});
  set(ThemeColor::accent, {ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive, ImGuiCol_NavHighlight,
                           ImGuiCol_PlotLines, ImGuiCol_PlotHistogram, ImGuiCol_DragDropTarget});
  set(ThemeColor::secondary, {ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive});
  set(ThemeColor::back, {ImGuiCol_ModalWindowDimBg, ImGuiCol_NavWindowingDimBg}, 0.6);
}

}  // namespace

Rgb color_of(ThemeColor color) { return kThemeColors[static_cast<std::size_t>(color)]; }

std::uint32_t packed_color(ThemeColor which, double alpha) {
  const Rgb c = color_of(which);
  return IM_COL32(c[0], c[1], c[2], static_cast<std::uint32_t>(std::lround(alpha * 255)));
}

double contrast(const Rgb& a, const Rgb& b) {
  const double x = luminance(a);
  const double y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

std::span<const TextOnBackground> text_combinations() { return kTextCombinations; }

void apply_theme(double scale) {
  ImGuiStyle style;  // a new style, because ScaleAllSizes() multiplies the current sizes
  style.WindowPadding = {9, 7};
  style.FramePadding = {8, 3};
  style.ItemSpacing = {7, 5};
  style.ItemInnerSpacing = {6, 4};
  style.WindowRounding = style.ChildRounding = style.PopupRounding = 5;
  style.FrameRounding = style.TabRounding = style.ScrollbarRounding = style.GrabRounding = 4;
  style.WindowBorderSize = style.PopupBorderSize = 1;
  style.FrameBorderSize = style.ChildBorderSize = style.TabBorderSize = 0;
  style.ScrollbarSize = 9;
  style.GrabMinSize = 4;
  style.IndentSpacing = 14;
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.DisplaySafeAreaPadding = {0, 0};
  set_colors(style.Colors);
  style.ScaleAllSizes(static_cast<float>(scale));
  style.WindowMinSize = {1, 1};
  ImGui::GetStyle() = style;
}

}  // namespace limber::panel
