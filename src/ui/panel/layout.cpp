// Places columns at the left and right, and rows at the top and bottom.
#include "ui/panel/layout.h"

#include <algorithm>

namespace limber::panel {

namespace {

constexpr double kGap = 8;
constexpr double kTop = 66;         // two rows
constexpr double kTopCompact = 94;  // three
constexpr double kMinWidthForSides = 520;
constexpr double kMinHeightForBottom = 420;
constexpr double kMinForTop = 300;

struct Sizes {
  double left, right, bottom;
};

PanelRect scaled(const PanelRect& r, double scale) {
  return {r.x * scale, r.y * scale, std::max(r.width, 0.0) * scale, std::max(r.height, 0.0) * scale};
}

// Height of the panel at the top; 0: none.
double top_height(double width, double height, bool compact) {
  if (width < kMinForTop || height < 2 * kTop) return 0;
  return compact ? kTopCompact : kTop;
}

}  // namespace

Layout lay_out(double width, double height, double scale) {
  const double w = width / scale;
  const double h = height / scale;
  Layout layout;
  layout.compact = w < kCompactBelow;
  const auto put = [&](PanelSlot slot, const PanelRect& r) {
    layout.slots[static_cast<std::size_t>(slot)] = scaled(r, scale);
  };
  const double top = top_height(w, h, layout.compact);
  const double begin = top > 0 ? top + 2 * kGap : kGap;
  if (top > 0) put(PanelSlot::top, {kGap, kGap, w - 2 * kGap, top});
  const bool has_sides = w >= kMinWidthForSides && h >= kMinForTop;
  const bool has_bottom = w >= kMinWidthForSides && h >= kMinHeightForBottom;
  const Sizes sizes{layout.compact ? 0 : std::clamp(0.17 * w, 216.0, 272.0),
                    std::clamp(0.27 * w, layout.compact ? 300.0 : 340.0, 440.0),
                    has_bottom ? std::clamp(0.25 * h, 150.0, 226.0) : 0};
  const double end = h - kGap - (has_bottom ? sizes.bottom + kGap : 0);
  double view_left = 0;
  double view_right = w;
  if (has_sides) {
    put(PanelSlot::right, {w - kGap - sizes.right, begin, sizes.right, end - begin});
    view_right = w - kGap - sizes.right;
  }
  if (has_sides && !layout.compact) {
    const double half = (end - begin - kGap) * 0.56;
    put(PanelSlot::left, {kGap, begin, sizes.left, half});
    put(PanelSlot::left_bottom, {kGap, begin + half + kGap, sizes.left, end - begin - half - kGap});
    view_left = kGap + sizes.left;
  }
  if (has_bottom) {
    const double y = h - kGap - sizes.bottom;
    if (layout.compact) {
      put(PanelSlot::bottom, {kGap, y, w - 2 * kGap, sizes.bottom});
    } else {
      const double inner = w - sizes.right - 4 * kGap;
      put(PanelSlot::bottom, {kGap, y, inner * 0.55, sizes.bottom});
      put(PanelSlot::bottom_middle, {2 * kGap + inner * 0.55, y, inner * 0.45, sizes.bottom});
      put(PanelSlot::bottom_right, {w - kGap - sizes.right, y, sizes.right, sizes.bottom});
    }
  }
  layout.view = scaled({view_left, begin, view_right - view_left, end - begin}, scale);
  return layout;
}

}  // namespace limber::panel
