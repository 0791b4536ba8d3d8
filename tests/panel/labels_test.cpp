// Labels that fit a width: different names stay different.
#include "ui/panel/text/labels.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace limber::panel::test {
namespace {

// Each character is one unit wide.
float characters(std::string_view text) {
  float count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xc0) == 0x80 ? 0 : 1;
  return count;
}

std::vector<std::string> apart(const std::vector<std::string>& names, float width) {
  return elided_apart(names, width, characters);
}

TEST(Labels, ShortensInTheMiddle) {
  EXPECT_EQ(elided("left_upper_arm", 14, characters), "left_upper_arm");
  EXPECT_EQ(elided("left_upper_arm", 13, characters), "left_u…er_arm");
  EXPECT_EQ(elided("left_upper_arm", 6, characters), "lef…rm");
  EXPECT_EQ(elided("left_upper_arm", 1, characters), "…");
  EXPECT_EQ(elided("éèàùçâêîôû", 7, characters), "éèà…îôû") << "no character is split";
}

TEST(Labels, KeepsDifferentNamesDifferent) {
  EXPECT_EQ(apart({"left_upper_arm_of_it", "left_lower_arm_of_it"}, 11),
            (std::vector<std::string>{"l…upper_ar…", "l…lower_ar…"}));
  EXPECT_EQ(apart({"arm_1_of_the_left", "arm_2_of_the_left", "arm"}, 5),
            (std::vector<std::string>{"a…1_…", "a…2_…", "arm"}));
  EXPECT_EQ(apart({"same_long_name", "same_long_name"}, 7), (std::vector<std::string>{"sam…ame", "sam…ame"}))
      << "equal names have equal texts";
}

TEST(Labels, AreDifferentForRandomNames) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; i++) {
    std::set<std::string> names;
    while (names.size() < 12) {
      std::string name = "the_long_beginning_";
      for (int k = 0; k < 4; k++) name += static_cast<char>('a' + random() % 2);
      names.insert(name + "_and_the_long_end");
    }
    for (const float width : {5.0F, 7.0F, 11.0F, 20.0F, 30.0F}) {
      const std::vector<std::string> texts = apart({names.begin(), names.end()}, width);
      EXPECT_EQ(std::set<std::string>(texts.begin(), texts.end()).size(), names.size()) << width;
      for (const std::string& text : texts) EXPECT_LE(characters(text), width) << text;
    }
  }
}

TEST(Labels, WrapsAtSeparators) {
  EXPECT_EQ(wrapped("/physics/body/arm/mass", 14, characters),
            (std::vector<std::string>{"/physics/body/", "arm/mass"}));
  EXPECT_EQ(wrapped("short", 14, characters), std::vector<std::string>{"short"});
  EXPECT_EQ(wrapped("", 14, characters), std::vector<std::string>{""});
  EXPECT_EQ(wrapped("abcdefghij", 4, characters), (std::vector<std::string>{"abcd", "efgh", "ij"}));
  EXPECT_EQ(wrapped("abc", 0, characters), (std::vector<std::string>{"a", "b", "c"}))
      << "at least one character a line";
}

}  // namespace
}  // namespace limber::panel::test
