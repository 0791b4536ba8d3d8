// OSC addresses matched against patterns.
#include "base/osc_pattern.h"

#include <gtest/gtest.h>

#include <string>

namespace limber {
namespace {

TEST(Address, ComponentsMatchSeparately) {
  EXPECT_TRUE(address_matches("/a/b", "/a/b"));
  EXPECT_TRUE(address_matches("/a/*", "/a/b"));
  EXPECT_TRUE(address_matches("/?/[a-c]", "/a/b"));
  EXPECT_FALSE(address_matches("/a/*", "/a/b/c")) << "a star does not cross a slash";
  EXPECT_FALSE(address_matches("/a", "/a/b"));
  EXPECT_FALSE(address_matches("/a/b", "/a"));
  EXPECT_FALSE(address_matches("", "/a"));
  EXPECT_FALSE(address_matches("/a", ""));
}

TEST(Address, TwoSlashesMatchAnyDepth) {
  for (const char* address : {"/mass", "/a/mass", "/a/b/c/mass"}) EXPECT_TRUE(address_matches("//mass", address));
  EXPECT_TRUE(address_matches("/a//z", "/a/b/c/z"));
  EXPECT_TRUE(address_matches("/a//z", "/a/z"));
  EXPECT_FALSE(address_matches("/a//z", "/b/z"));
}

TEST(Address, TooManyAttemptsMatchNothing) {
  std::string pattern;
  std::string address;
  for (int i = 0; i < 12; i++) pattern += "//*";
  for (int i = 0; i < 60; i++) address += "/a";
  EXPECT_FALSE(address_matches(pattern + "/b", address));
}

}  // namespace
}  // namespace limber
