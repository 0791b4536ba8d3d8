// Columns left and right, rows above and below.
#include "gui/layout.h"

#include <algorithm>

namespace limber {

namespace {

constexpr double kGap = 8;
constexpr double kTop = 66;         // two rows
constexpr double kTopCompact = 94;  // three
constexpr double kLeastForSides = 520;
constexpr double kLeastForBelow = 420;
constexpr double kLeastForTop = 300;

struct Sizes {
  double left, right, below;
};

PanelRect scaled(const PanelRect& r, double scale) {
  return {r.x * scale, r.y * scale, std::max(r.width, 0.0) * scale, std::max(r.height, 0.0) * scale};
}

}  // namespace

Layout lay_out(double width, double height, double scale) {
  const double w = width / scale;
  const double h = height / scale;
  Layout layout;
  layout.compact = w < kCompactBelow;
  const auto put = [&](Slot slot, const PanelRect& r) {
    layout.slots[static_cast<std::size_t>(slot)] = scaled(r, scale);
  };
  const double top = w < kLeastForTop || h < 2 * kTop ? 0 : layout.compact ? kTopCompact : kTop;
  const double begin = top > 0 ? top + 2 * kGap : kGap;
  if (top > 0) put(Slot::top, {kGap, kGap, w - 2 * kGap, top});
  const bool sides = w >= kLeastForSides && h >= kLeastForTop;
  const bool under = w >= kLeastForSides && h >= kLeastForBelow;
  const Sizes sizes{layout.compact ? 0 : std::clamp(0.17 * w, 216.0, 272.0),
                    std::clamp(0.27 * w, layout.compact ? 300.0 : 340.0, 440.0),
                    under ? std::clamp(0.25 * h, 150.0, 226.0) : 0};
  const double end = h - kGap - (under ? sizes.below + kGap : 0);
  double free_left = 0;
  double free_right = w;
  if (sides) {
    put(Slot::right, {w - kGap - sizes.right, begin, sizes.right, end - begin});
    free_right = w - kGap - sizes.right;
  }
  if (sides && !layout.compact) {
    const double half = (end - begin - kGap) * 0.56;
    put(Slot::left, {kGap, begin, sizes.left, half});
    put(Slot::left_below, {kGap, begin + half + kGap, sizes.left, end - begin - half - kGap});
    free_left = kGap + sizes.left;
  }
  if (under) {
    const double y = h - kGap - sizes.below;
    if (layout.compact) {
      put(Slot::below, {kGap, y, w - 2 * kGap, sizes.below});
    } else {
      const double inner = w - sizes.right - 4 * kGap;
      put(Slot::below, {kGap, y, inner * 0.55, sizes.below});
      put(Slot::below_middle, {2 * kGap + inner * 0.55, y, inner * 0.45, sizes.below});
      put(Slot::below_right, {w - kGap - sizes.right, y, sizes.right, sizes.below});
    }
  }
  layout.free = scaled({free_left, begin, free_right - free_left, end - begin}, scale);
  return layout;
}

}  // namespace limber
