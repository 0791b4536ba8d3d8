// The panel layout. It depends only on the window's size, so that no panel can be moved by accident during a show.
#pragma once

#include <array>
#include <cstdint>

namespace limber::panel {

/// Pixels, from the top left corner.
struct PanelRect {
  double x = 0, y = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

/// The panel slots of a wide window. A compact one has only `top`, `right` and `bottom`; panels that share a slot are
/// its tabs.
enum class PanelSlot : std::uint8_t { top, left, left_bottom, right, bottom, bottom_middle, bottom_right, count };

struct Layout {
  bool compact = false;
  std::array<PanelRect, static_cast<std::size_t>(PanelSlot::count)> slots;
  const PanelRect& at(PanelSlot slot) const { return slots[static_cast<std::size_t>(slot)]; }
  /// The area left for the view.
  PanelRect view;
};

/// A window narrower than this many units (pixels at text size 16) is compact.
inline constexpr double kCompactBelow = 1200;

/// Width in units at the right end of the top panel's second row, which the morph controls use.
inline constexpr double kMorphWidth = 380;

/// `scale`: pixels per unit, where a unit is a pixel at text size 16. Slots that do not fit are empty.
Layout lay_out(double width, double height, double scale);

}  // namespace limber::panel
