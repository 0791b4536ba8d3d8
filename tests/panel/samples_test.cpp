// Samples: the number is limited, and rewinding discards later ones.
#include "ui/panel/widgets/samples.h"

#include <gtest/gtest.h>

namespace limber::panel::test {
namespace {

TEST(Samples, KeepLatest) {
  Samples samples(3);
  for (std::uint64_t tick = 1; tick <= 5; tick++) samples.add(tick, {static_cast<double>(10 * tick)});
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[0][0], 30);
  EXPECT_EQ(samples[2][0], 50);
}

TEST(Samples, DiscardLaterOnesAfterRewind) {
  Samples samples(10);
  for (std::uint64_t tick = 1; tick <= 6; tick++) samples.add(tick, {static_cast<double>(tick)});
  samples.add(4, {-4});
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[2][0], 3);
  EXPECT_EQ(samples[3][0], -4) << "the new fourth tick";
  samples.add(0, {0});
  EXPECT_EQ(samples.size(), 1u) << "the scene from its start";
}

}  // namespace
}  // namespace limber::panel::test
