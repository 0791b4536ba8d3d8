// The same scene and seed give the same hash in every new process, for all ways to play.
#include <fmt/ranges.h>

#include "app/determinism.h"

namespace limber::app::test {
namespace {

TEST(Determinism, HashIsIndependentOfTheWayToPlay) {
  const TempFolder folder;
  const std::string scene = folder.file("wild.lua", kWildScene);
  const std::string first = hash_of(scene, {"--fast"}, {});
  ASSERT_TRUE(first.starts_with("hash ") && first.ends_with(" tick 200\n")) << first;
  for (const auto& how : play_options())
    EXPECT_EQ(hash_of(scene, how, {}), first) << fmt::format("{}", fmt::join(how, " "));
  for (const auto& before : environments())
    EXPECT_EQ(hash_of(scene, {"--fast"}, before), first) << fmt::format("{}", fmt::join(before, " "));
}

TEST(Determinism, HashDependsOnSeedAndTick) {
  const TempFolder folder;
  const std::string scene = folder.file("wild.lua", kWildScene);
  const auto hash = [](const std::string& line) { return line.substr(0, line.find(" tick")); };
  const std::string first = hash(hash_of(scene, {"--fast"}, {}));
  EXPECT_NE(hash(hash_of(scene, {"--fast", "--seed", "2"}, {})), first);
  EXPECT_EQ(hash(hash_of(scene, {"--fast", "--seed", "1"}, {})), first) << "1 is the default";
  EXPECT_NE(hash(hash_of(scene, {"--fast"}, {}, "201")), first);
}

}  // namespace
}  // namespace limber::app::test
