// Twenty processes with the same hash: all modes of playing in all environments.
#include <fmt/ranges.h>

#include "app/determinism.h"

namespace limber::app::test {
namespace {

TEST(LongDeterminism, TwentyProcessesHaveOneHash) {
  const TempFolder folder;
  const std::string scene = folder.file("wild.lua", kWildScene);
  const std::string first = hash_of(scene, {"--fast"}, {}, "2000");
  ASSERT_TRUE(first.ends_with(" tick 2000\n")) << first;
  int processes = 0;
  while (processes < 20) {
    for (const auto& before : environments()) {
      for (const auto& how : play_options()) {
        EXPECT_EQ(hash_of(scene, how, before, "2000"), first)
            << fmt::format("{} {}", fmt::join(before, " "), fmt::join(how, " "));
        processes++;
      }
    }
  }
}

}  // namespace
}  // namespace limber::app::test
