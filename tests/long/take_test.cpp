// Ten minutes of floods, reloads, spawned bodies, stopped scripts and morphs, recorded and replayed again and again.
#include "engine/taken.h"

namespace limber::engine_test {
namespace {

TEST(LongTake, TenMinutesComeAgainToTheBit) {
  const ShowFolder folder;
  lay_out(folder);
  const std::string take = folder.path("long.take");
  const std::uint64_t hash = record_take(folder, take, 36000, 1);
  for (int i = 0; i < 10; i++) {
    const Replayed again = replay_take(take);
    ASSERT_EQ(again.error, "");
    EXPECT_FALSE(again.verdict.parted.has_value()) << text_of(again.verdict);
    EXPECT_EQ(again.hash, hash);
  }
}

TEST(LongTake, ShowsOfManySeedsComeAgain) {
  for (std::uint64_t seed = 10; seed < 30; seed++) {
    const ShowFolder folder;
    lay_out(folder);
    const std::string take = folder.path("many.take");
    const std::uint64_t hash = record_take(folder, take, 400, seed);
    const Replayed again = replay_take(take);
    ASSERT_EQ(again.error, "") << seed;
    EXPECT_FALSE(again.verdict.parted.has_value()) << seed << ": " << text_of(again.verdict);
    EXPECT_EQ(again.hash, hash) << seed;
  }
}

}  // namespace
}  // namespace limber::engine_test
