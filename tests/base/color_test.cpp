// Color conversions: the six primary and secondary hues, and round trips.
#include "base/color.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Color, ConvertsPrimaryAndSecondaryHues) {
  const Vec3 corners[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}};
  for (int i = 0; i < 6; i++) {
    const Vec3 rgb = rgb_of({i / 6.0, 1, 1});
    EXPECT_LT(glm::length(rgb - corners[i]), 1e-12) << i;
  }
  EXPECT_LT(glm::length(rgb_of({1, 1, 1}) - Vec3(1, 0, 0)), 1e-12) << "the hue wraps around";
  EXPECT_EQ(rgb_of({0.3, 0, 0.25}), Vec3(0.25)) << "gray without saturation";
}

TEST(Color, ConversionsRoundTrip) {
  for (const Vec3& hsb : {Vec3(0.62, 0.45, 0.06), Vec3(0.1, 1, 1), Vec3(0.99, 0.2, 0.7), Vec3(0.5, 0.5, 0.5)})
    EXPECT_LT(glm::length(hsb_of(rgb_of(hsb)) - hsb), 1e-12) << hsb.x;
}

}  // namespace
}  // namespace limber
