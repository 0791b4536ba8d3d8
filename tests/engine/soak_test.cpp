// A short soak test (the long ones are in tests/long), and reduced lists of actions that have failed once.
#include "engine/soak.h"

namespace limber::engine::test {
namespace {

TEST(TakeSoak, AFewSecondsReplayExactly) { expect_soaks(200, 1); }

// a step that was pending during a rewind
TEST(TakeSoak, PendingStepsSurviveARewind) {
  const std::vector<SoakAction> actions = {{340, 17, 0.968}, {341, 23, 0.0657}};
  EXPECT_EQ(soak(actions, 360).fault, "");
}

TEST(TakeSoak, MinimizingFindsTheFailingActions) {
  std::vector<SoakAction> actions;
  for (int i = 0; i < 100; i++) actions.push_back({i, i % 7, 0.5});
  int runs = 0;
  const auto fails = [&](const std::vector<SoakAction>& some) {
    runs++;
    const auto has = [&](int tick) { return std::ranges::any_of(some, [&](const auto& a) { return a.tick == tick; }); };
    return has(13) && has(57) && has(58);
  };
  const std::vector<SoakAction> few = minimize(actions, fails);
  ASSERT_EQ(few.size(), 3u);
  EXPECT_EQ((std::vector<int>{few[0].tick, few[1].tick, few[2].tick}), (std::vector<int>{13, 57, 58}));
  EXPECT_LT(runs, 200);
}

}  // namespace
}  // namespace limber::engine::test
