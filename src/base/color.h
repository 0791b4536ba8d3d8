// Colours: hue, saturation, brightness, each 0 .. 1, as scenes and messages write them.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace limber {

/// From red, green, blue (0 .. 1).
inline Vec3 hsb_of(const Vec3& rgb) {
  const double most = std::max({rgb.x, rgb.y, rgb.z});
  const double range = most - std::min({rgb.x, rgb.y, rgb.z});
  if (most <= 0 || range <= 0) return {0, 0, std::max(most, 0.0)};
  double sixth = 4 + (rgb.x - rgb.y) / range;
  if (most == rgb.x) {
    sixth = (rgb.y - rgb.z) / range;
  } else if (most == rgb.y) {
    sixth = 2 + (rgb.z - rgb.x) / range;
  }
  return {sixth / 6 - std::floor(sixth / 6), range / most, most};
}

/// From hue, saturation, brightness (0 .. 1).
inline Vec3 rgb_of(const Vec3& hsb) {
  const auto channel = [&](double turn) {
    const double h = (hsb.x + turn - std::floor(hsb.x + turn)) * 6;
    return hsb.z * (1 - hsb.y * std::clamp(2 - std::abs(h - 3), 0.0, 1.0));
  };
  // red is furthest from the middle of its circle at hue 0
  return {channel(0), channel(2.0 / 3), channel(1.0 / 3)};
}

/// A channel as screens show it (0 .. 1) as light, of which twice the number is twice as much.
inline double light_of(double shown) { return fixed::pow(shown, 2.2); }

}  // namespace limber
