// Where panels are: computed from the window's size and nothing else, so that there is nothing to drag about on stage.
#pragma once

#include <array>
#include <cstdint>

namespace limber {

/// Pixels, from the top left corner.
struct PanelRect {
  double x = 0, y = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

/// The places of a wide window; a compact one has `top`, `right` and `below`, and panels that share one are its tabs.
enum class Slot : std::uint8_t { top, left, left_below, right, below, below_middle, below_right, count };

struct Layout {
  bool compact = false;
  std::array<PanelRect, static_cast<std::size_t>(Slot::count)> slots;
  const PanelRect& at(Slot slot) const { return slots[static_cast<std::size_t>(slot)]; }
  /// What is left for the picture.
  PanelRect free;
};

/// Below so many pixels (of text of 16) a window is compact.
inline constexpr double kCompactBelow = 1200;

/// `scale`: pixels for what is a pixel at text of 16. What has no room is empty.
Layout lay_out(double width, double height, double scale);

}  // namespace limber
