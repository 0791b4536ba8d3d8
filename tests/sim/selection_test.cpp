// Selections: names, patterns, "all", left out, none.
#include "sim/selection.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

using Words = std::vector<std::string>;

TEST(Selection, LeftOutMeansAll) {
  const Selection all;
  EXPECT_TRUE(all.left_out());
  EXPECT_TRUE(all.all());
  EXPECT_TRUE(all.means("x"));
  EXPECT_FALSE(all.means("x", false));  // what "all" leaves out
  EXPECT_FALSE(all.has_names());
}

TEST(Selection, TheWordAllMeansAllBesideNames) {
  const Selection some(Words{"base", "all"});
  EXPECT_FALSE(some.left_out());
  EXPECT_TRUE(some.all());
  EXPECT_TRUE(some.means("tip"));
  EXPECT_FALSE(some.means("tip", false));
  EXPECT_TRUE(some.means("base", false));  // by its own name
}

TEST(Selection, PatternsAreOscs) {
  const Selection some(Words{"left_*", "{a,b}"});
  EXPECT_TRUE(some.means("left_arm", false));
  EXPECT_TRUE(some.means("b"));
  EXPECT_FALSE(some.means("right_arm"));
  EXPECT_FALSE(some.has_names());
  EXPECT_EQ(some.missing({}), "");
}

TEST(Selection, NoneMeansNothing) {
  const Selection none{Words{}};
  EXPECT_FALSE(none.left_out());
  EXPECT_FALSE(none.all());
  EXPECT_FALSE(none.means("x"));
}

TEST(Selection, SaysWhichNameIsMissing) {
  const Selection some(Words{"*", "base", "tipp", "all"});
  EXPECT_TRUE(some.has_names());
  EXPECT_EQ(some.missing({"base", "tip"}), "tipp");
  EXPECT_EQ(some.missing({"base", "tipp"}), "");
}

}  // namespace
}  // namespace limber
