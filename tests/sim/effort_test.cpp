// Effort: what was spent, and when that is enough.
#include "sim/effort.h"

#include <gtest/gtest.h>

using namespace limber;

namespace {

// A line costs its numbers and eight more.
TEST(Effort, IsOverWhenItWasEnough) {
  Effort effort;
  EXPECT_FALSE(effort.over(1e12)) << "before anything is allowed there is no end";
  effort.begin();
  effort.allow(1000);
  EXPECT_FALSE(effort.over(1000));
  EXPECT_TRUE(effort.over(1001));
  effort.lines(40, 12);
  EXPECT_EQ(effort.spent(), 800);
  EXPECT_FALSE(effort.over(200));
  EXPECT_TRUE(effort.over(201));
  EXPECT_EQ(effort.tolerance(1e-6), 1e-6);
  effort.lines(11, 12);
  EXPECT_TRUE(effort.over());
  EXPECT_EQ(effort.tolerance(1e-6), 1e-2);
  EXPECT_EQ(effort.tolerance(0.5), 0.5) << "who asks for less gets that";
  effort.allow(3000);
  EXPECT_FALSE(effort.over());
  effort.begin();
  EXPECT_EQ(effort.spent(), 0);
}

}  // namespace
