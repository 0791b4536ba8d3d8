// Colors: the examples of WCAG, and the contrast of all text.
#include "ui/panel/theme.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limber::panel {
namespace {

TEST(Theme, ContrastMatchesWcag) {
  EXPECT_NEAR(contrast({255, 255, 255}, {0, 0, 0}), 21, 1e-9);
  EXPECT_NEAR(contrast({0x77, 0x77, 0x77}, {255, 255, 255}), 4.478, 0.001) << "the well-known grey that just fails";
  EXPECT_NEAR(contrast({255, 0, 0}, {255, 255, 255}), 3.998, 0.001);
  EXPECT_EQ(contrast({1, 2, 3}, {9, 8, 7}), contrast({9, 8, 7}, {1, 2, 3}));
}

TEST(Theme, TextHasEnoughContrast) {
  for (const TextOnBackground& pair : text_combinations()) {
    EXPECT_GE(contrast(color_of(pair.text), color_of(pair.background)), kMinContrast)
        << "color " << static_cast<int>(pair.text) << " on " << static_cast<int>(pair.background);
  }
}

TEST(Theme, CoversAllCombinationsOfColors) {
  for (const ThemeColor words : {ThemeColor::text, ThemeColor::secondary, ThemeColor::accent, ThemeColor::red,
                                 ThemeColor::green, ThemeColor::blue}) {
    EXPECT_TRUE(std::any_of(text_combinations().begin(), text_combinations().end(), [&](const TextOnBackground& w) {
      return w.text == words && w.background == ThemeColor::panel;
    }));
  }
}

}  // namespace
}  // namespace limber::panel
