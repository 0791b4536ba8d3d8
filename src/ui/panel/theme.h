// The panel's colors and sizes: one palette with one accent color; red is used only for errors.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace limber::panel {

/// The palette, by purpose.
enum class ThemeColor : std::uint8_t {
  back,       ///< Background.
  panel,      ///< Panel background.
  line,       ///< Panel border.
  field,      ///< Input field.
  hover,      ///< Hovered input field.
  header,     ///< Section header.
  selected,   ///< Selected item.
  text,       ///< Text and numbers.
  secondary,  ///< Secondary text.
  accent,     ///< The accent color: marks, active items.
  fill,       ///< Filled part of a bar.
  active,     ///< Active button.
  on_active,  ///< Text on `active`.
  red,        ///< Errors.
  green,      ///< Outgoing messages, indicators.
  blue,       ///< Incoming messages.
  count
};

/// Red, green, blue, 0 .. 255.
using Rgb = std::array<std::uint8_t, 3>;
/// Returns its value.
Rgb color_of(ThemeColor color);
/// Returns the color as Dear ImGui's ImU32.
std::uint32_t packed_color(ThemeColor color, double alpha = 1);

/// WCAG contrast ratio of two colors, 1 .. 21.
double contrast(const Rgb& a, const Rgb& b);

inline constexpr double kMinContrast = 4.5;
struct TextOnBackground {
  ThemeColor text;
  ThemeColor background;
};
/// Returns the combinations of text and background in use. Each has a contrast of at least kMinContrast.
std::span<const TextOnBackground> text_combinations();

/// Resets the style of Dear ImGui's current context. `scale`: pixels per unit, where a unit is a pixel at text size 16.
void apply_theme(double scale);

}  // namespace limber::panel
