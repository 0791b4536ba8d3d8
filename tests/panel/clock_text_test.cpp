// Formatting of seconds as a clock.
#include "ui/panel/widgets/time_widgets.h"

#include <gtest/gtest.h>

namespace limber::panel::test {
namespace {

TEST(ClockText, FormatsMinutesSecondsHundredths) {
  EXPECT_EQ(clock_text(0), "00:00.00");
  EXPECT_EQ(clock_text(83.459), "01:23.45");
  EXPECT_EQ(clock_text(59.999), "00:59.99") << "the minute has not come";
  EXPECT_EQ(clock_text(6000), "100:00.00");
  double ticks = 0;
  for (int i = 0; i < 60; i++) ticks += 1.0 / 60;
  EXPECT_EQ(clock_text(ticks), "00:01.00") << "sixty ticks are a second";
}

}  // namespace
}  // namespace limber::panel::test
