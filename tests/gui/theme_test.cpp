// Colours: WCAG's own examples, and what is written on what.
#include "gui/theme.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Theme, ContrastIsWcagsRatio) {
  EXPECT_NEAR(contrast({255, 255, 255}, {0, 0, 0}), 21, 1e-9);
  EXPECT_NEAR(contrast({0x77, 0x77, 0x77}, {255, 255, 255}), 4.478, 0.001) << "the well-known grey that just fails";
  EXPECT_NEAR(contrast({255, 0, 0}, {255, 255, 255}), 3.998, 0.001);
  EXPECT_EQ(contrast({1, 2, 3}, {9, 8, 7}), contrast({9, 8, 7}, {1, 2, 3}));
}

TEST(Theme, WhateverIsWrittenCanBeRead) {
  for (const Written& pair : written()) {
    EXPECT_GE(contrast(tone(pair.words), tone(pair.on)), kLeastContrast)
        << "tone " << static_cast<int>(pair.words) << " on " << static_cast<int>(pair.on);
  }
}

TEST(Theme, EachToneOfWordsIsTestedOnWhatItIsWrittenOn) {
  for (const Tone words : {Tone::text, Tone::dim, Tone::accent, Tone::red, Tone::green, Tone::blue}) {
    EXPECT_TRUE(std::any_of(written().begin(), written().end(),
                            [&](const Written& w) { return w.words == words && w.on == Tone::panel; }));
  }
}

}  // namespace
}  // namespace limber
