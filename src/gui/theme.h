// The panel's colours and sizes: one table of tones, one accent, red for errors alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace limber {

enum class Tone : std::uint8_t {
  back,    ///< Behind everything.
  panel,   ///< A panel.
  line,    ///< Its edge.
  field,   ///< What takes a value.
  hover,   ///< The same, under the mouse.
  head,    ///< The head of a section.
  chosen,  ///< What is chosen.
  text,    ///< Words and numbers.
  dim,     ///< Words of less weight.
  accent,  ///< The one accent: marks, what is on.
  fill,    ///< A bar's part up to its value.
  lit,     ///< A button that is on.
  ink,     ///< What is written on `lit`.
  red,     ///< Errors.
  green,   ///< What goes out, lamps.
  blue,    ///< What comes in.
  none_count
};

/// Red, green, blue, 0 .. 255.
using Rgb = std::array<std::uint8_t, 3>;
Rgb tone(Tone tone);
std::uint32_t packed(Tone tone, double alpha = 1);

/// WCAG's ratio of two colours' luminances, 1 .. 21.
double contrast(const Rgb& a, const Rgb& b);

/// Which tones are written on which: each with a contrast of at least kLeastContrast.
inline constexpr double kLeastContrast = 4.5;
struct Written {
  Tone words;
  Tone on;
};
std::span<const Written> written();

/// Dear ImGui's style of the current context, made anew. `scale`: pixels for what is a pixel at text of 16.
void apply_theme(double scale);

}  // namespace limber
