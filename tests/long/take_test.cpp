// Ten minutes of floods, reloads, spawned bodies, stopped scripts and morphs, recorded and replayed repeatedly.
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

TEST(LongTake, TenMinutesReplayExactly) {
  const ShowFolder folder;
  write_take_scene(folder);
  const std::string take = folder.path("long.take");
  const std::uint64_t hash = record_take(folder, take, 36000, 1);
  for (int i = 0; i < 10; i++) {
    const ReplayOutcome again = replay_take(take);
    ASSERT_EQ(again.error, "");
    EXPECT_FALSE(again.result.diverged_at.has_value()) << engine::text_of(again.result);
    EXPECT_EQ(again.hash, hash);
  }
}

TEST(LongTake, ShowsOfManySeedsReplay) {
  for (std::uint64_t seed = 10; seed < 30; seed++) {
    const ShowFolder folder;
    write_take_scene(folder);
    const std::string take = folder.path("many.take");
    const std::uint64_t hash = record_take(folder, take, 400, seed);
    const ReplayOutcome again = replay_take(take);
    ASSERT_EQ(again.error, "") << seed;
    EXPECT_FALSE(again.result.diverged_at.has_value()) << seed << ": " << engine::text_of(again.result);
    EXPECT_EQ(again.hash, hash) << seed;
  }
}

}  // namespace
}  // namespace limber::engine::test
