// Color conversions. Scenes and messages use hue, saturation, brightness, each in [0, 1].
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace limber {

/// Converts red, green, blue in [0, 1] to hue, saturation, brightness.
inline Vec3 hsb_of(const Vec3& rgb) {
  const double max = std::max({rgb.x, rgb.y, rgb.z});
  const double range = max - std::min({rgb.x, rgb.y, rgb.z});
  if (max <= 0 || range <= 0) return {0, 0, std::max(max, 0.0)};
  double sixth = 4 + (rgb.x - rgb.y) / range;
  if (max == rgb.x) {
    sixth = (rgb.y - rgb.z) / range;
  } else if (max == rgb.y) {
    sixth = 2 + (rgb.z - rgb.x) / range;
  }
  return {sixth / 6 - std::floor(sixth / 6), range / max, max};
}

/// Converts hue, saturation, brightness to red, green, blue in [0, 1]. The hue wraps around.
inline Vec3 rgb_of(const Vec3& hsb) {
  const auto channel = [&](double turn) {
    const double h = (hsb.x + turn - std::floor(hsb.x + turn)) * 6;
    return hsb.z * (1 - hsb.y * std::clamp(2 - std::abs(h - 3), 0.0, 1.0));
  };
  // Red is at its maximum at hue 0, green at 1/3, blue at 2/3.
  return {channel(0), channel(2.0 / 3), channel(1.0 / 3)};
}

/// Converts a gamma-encoded channel in [0, 1] to linear light (gamma 2.2).
inline double linear_light_of(double encoded) { return fixed::pow(encoded, 2.2); }

}  // namespace limber
