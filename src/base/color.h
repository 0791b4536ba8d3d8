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

/// Converts an sRGB-encoded channel in [0, 1] to linear light (IEC 61966-2-1).
inline double linear_light_of(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : fixed::pow((encoded + 0.055) / 1.055, 2.4);
}
/// Converts linear light in [0, 1] to an sRGB-encoded channel.
inline double encoded_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * fixed::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace limber
