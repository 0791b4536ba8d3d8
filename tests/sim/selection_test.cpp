// Selections: names, patterns, "all", unspecified, empty.
#include "sim/behavior/selection.h"

#include <gtest/gtest.h>

namespace limber::sim {
namespace {

using Words = std::vector<std::string>;

TEST(Selection, DefaultSelectsAll) {
  const Selection all;
  EXPECT_TRUE(all.is_default());
  EXPECT_TRUE(all.selects_all());
  EXPECT_TRUE(all.selects("x"));
  EXPECT_FALSE(all.selects("x", false));  // not selected by "all"
  EXPECT_FALSE(all.has_names());
}

TEST(Selection, AllCanBeCombinedWithNames) {
  const Selection some(Words{"base", "all"});
  EXPECT_FALSE(some.is_default());
  EXPECT_TRUE(some.selects_all());
  EXPECT_TRUE(some.selects("tip"));
  EXPECT_FALSE(some.selects("tip", false));
  EXPECT_TRUE(some.selects("base", false));  // selected by its name
}

TEST(Selection, UsesOscPatterns) {
  const Selection some(Words{"left_*", "{a,b}"});
  EXPECT_TRUE(some.selects("left_arm", false));
  EXPECT_TRUE(some.selects("b"));
  EXPECT_FALSE(some.selects("right_arm"));
  EXPECT_FALSE(some.has_names());
  EXPECT_EQ(some.first_missing({}), "");
}

TEST(Selection, EmptySelectsNothing) {
  const Selection none{Words{}};
  EXPECT_FALSE(none.is_default());
  EXPECT_FALSE(none.selects_all());
  EXPECT_FALSE(none.selects("x"));
}

TEST(Selection, ReportsTheMissingName) {
  const Selection some(Words{"*", "base", "tipp", "all"});
  EXPECT_TRUE(some.has_names());
  EXPECT_EQ(some.first_missing({"base", "tip"}), "tipp");
  EXPECT_EQ(some.first_missing({"base", "tipp"}), "");
}

}  // namespace
}  // namespace limber::sim
