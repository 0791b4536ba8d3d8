// Singular and plural of counts.
#include "base/plural.h"

#include <gtest/gtest.h>

namespace limber::test {
namespace {

TEST(Plural, FollowsTheNumber) {
  EXPECT_EQ(counted(0, "part"), "0 parts");
  EXPECT_EQ(counted(1, "part"), "1 part");
  EXPECT_EQ(counted(17, "part"), "17 parts");
  EXPECT_EQ(counted(1, "body", "bodies"), "1 body");
  EXPECT_EQ(counted(2, "body", "bodies"), "2 bodies");
  EXPECT_EQ(plural(1, "value"), "value");
  EXPECT_EQ(plural(21, "value"), "values");
}

}  // namespace
}  // namespace limber::test
