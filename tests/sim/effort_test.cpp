// Effort: how exactly laws have to be met as a step costs more, and when it is over.
#include "sim/effort.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace limber;

namespace {

// 0.01·part⁶: what is asked for until a fifth is spent, a hundredth when it was enough.
TEST(Effort, AsksForLessTheMoreWasSpent) {
  Effort effort;
  effort.begin(1000);
  EXPECT_EQ(effort.tolerance(1e-6), 1e-6);
  double spent = 0;
  for (int i = 0; i < 10; ++i) {
    effort.lines(5, 12);
    spent += 5 * (12 + 8);
    EXPECT_EQ(effort.spent(), spent);
    EXPECT_NEAR(effort.tolerance(1e-6), std::fmax(1e-6, 1e-2 * std::pow(spent / 1000, 6)), 1e-15);
  }
  effort.begin(1000);
  EXPECT_EQ(effort.tolerance(1e-6), 1e-6);
}

TEST(Effort, IsOverWhenWhatIsKeptForTheEndIsLeft) {
  Effort effort;
  EXPECT_FALSE(effort.over(1e12)) << "before a step began nothing is counted";
  effort.begin(1000);
  EXPECT_FALSE(effort.over(1500));
  EXPECT_TRUE(effort.over(1501));
  effort.keep(700);
  EXPECT_FALSE(effort.over(800));
  EXPECT_TRUE(effort.over(801));
  effort.keep(0);
  EXPECT_FALSE(effort.over(1500));
}

}  // namespace
