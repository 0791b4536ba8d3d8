// More messages than a tick takes: they are spread over the next ticks, in their order, and no datagram is split.
#include "engine/show.h"

namespace limber::engine_test {
namespace {

constexpr int kMany = 10000;
constexpr int kEachTick = Engine::kTickWork / 2;  // a message and its value

double gravity(int i) { return -0.001 * (i + 1); }

TEST(ManyMessages, AreSpreadOverTicksInTheirOrder) {
  Show show;
  for (int i = 0; i < kMany; i++) show.send("/physics/sim/gravity", gravity(i));
  for (int done = kEachTick; done < kMany; done += kEachTick) {
    show.ticks(1);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(done - 1));
  }
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kMany - 1));
  EXPECT_EQ(show.engine.world().tick(), 3u);
}

TEST(ManyMessages, WhatComesLaterWaitsBehind) {
  Show show;
  for (int i = 0; i < kMany; i++) show.send("/physics/sim/gravity", gravity(i));
  show.ticks(1);
  show.send("/physics/sim/gravity", -5);
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(2 * kEachTick - 1));
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -5) << "in the tick in which the others ended";
}

TEST(ManyMessages, ADatagramIsNeverSplit) {
  Show show;
  Command command;
  command.origin = {Hand::osc, 0x7f000001, 4000};
  for (int i = 0; i < kMany; i++) command.messages.push_back(message("/physics/sim/gravity", gravity(i)));
  show.link.inbox.push(std::move(command));
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kMany - 1));
}

TEST(ManyMessages, WhatIsSlowCountsForMore) {
  Show show;
  for (int i = 0; i < kMany; i++) show.send("/physics/part/mass", "nobody", "tip", i);
  show.ticks(1);
  const auto refused = static_cast<int>(show.link.counters.refused.load());
  EXPECT_LT(refused, kEachTick / 2);
  show.ticks((kMany + refused - 1) / refused - 1);
  EXPECT_EQ(show.link.counters.refused.load(), static_cast<std::uint64_t>(kMany));
}

// who asks for an image after a message finds the message's effect in it
TEST(ManyMessages, AnImageHoldsAllThatCameBeforeItWasAskedFor) {
  Show show;
  for (int i = 0; i < kMany; i++) show.send("/physics/sim/gravity", gravity(i));
  const std::uint64_t ask = show.link.ask_image();
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    const auto image = show.link.images.read();
    if (image == nullptr || image->asks < ask) continue;
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kMany - 1));
    return;
  }
  FAIL() << "no image is made";
}

TEST(ManyMessages, ArePlayedWhileTimeStandsStill) {
  Show show;
  show.send("/transport/pause");
  for (int i = 0; i < kMany; i++) show.send("/physics/sim/gravity", gravity(i));
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kMany - 1));
  EXPECT_EQ(show.engine.world().tick(), 0u);
}

}  // namespace
}  // namespace limber::engine_test
