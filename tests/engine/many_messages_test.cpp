// More messages than the budget of a tick: they are spread over the next ticks in order, and no datagram is split.
#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr int kFloodSize = 10000;
constexpr int kMessagesPerTick = Engine::kPassWork / 2;  // each message costs 2: 1, and 1 for its value

double gravity(int i) { return -0.001 * (i + 1); }

TEST(ManyMessages, AreSpreadOverTicksInOrder) {
  Show show;
  for (int i = 0; i < kFloodSize; i++) show.send("/physics/sim/gravity", gravity(i));
  for (int done = kMessagesPerTick; done < kFloodSize; done += kMessagesPerTick) {
    show.ticks(1);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(done - 1));
  }
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kFloodSize - 1));
  EXPECT_EQ(show.engine.world().tick(), 3u);
}

TEST(ManyMessages, LaterMessagesWaitBehindThem) {
  Show show;
  for (int i = 0; i < kFloodSize; i++) show.send("/physics/sim/gravity", gravity(i));
  show.ticks(1);
  show.send("/physics/sim/gravity", -5);
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(2 * kMessagesPerTick - 1));
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -5) << "in the tick in which the others ended";
}

TEST(ManyMessages, ADatagramIsNeverSplit) {
  Show show;
  Command command;
  command.origin = {CommandSource::osc, 0x7f000001, 4000};
  for (int i = 0; i < kFloodSize; i++) command.messages.push_back(message("/physics/sim/gravity", gravity(i)));
  show.link.command_queue.push(std::move(command));
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kFloodSize - 1));
}

TEST(ManyMessages, SlowMessagesCostMore) {
  Show show;
  for (int i = 0; i < kFloodSize; i++) show.send("/physics/part/mass", "missing", "tip", i);
  show.ticks(1);
  const auto rejected = static_cast<int>(show.link.counters.refused.load());
  EXPECT_LT(rejected, kMessagesPerTick / 2);
  show.ticks((kFloodSize + rejected - 1) / rejected - 1);
  EXPECT_EQ(show.link.counters.refused.load(), static_cast<std::uint64_t>(kFloodSize));
}

// a value snapshot requested after a message contains the message's effect
TEST(ManyMessages, AValueSnapshotContainsAllMessagesBeforeItsRequest) {
  Show show;
  for (int i = 0; i < kFloodSize; i++) show.send("/physics/sim/gravity", gravity(i));
  const std::uint64_t request = show.link.request_value_snapshot();
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    const auto value_snapshot = show.link.value_snapshots.read();
    if (value_snapshot == nullptr || value_snapshot->request < request) continue;
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kFloodSize - 1));
    return;
  }
  FAIL() << "no value snapshot is made";
}

TEST(ManyMessages, AreExecutedWhilePaused) {
  Show show;
  show.send("/transport/pause");
  for (int i = 0; i < kFloodSize; i++) show.send("/physics/sim/gravity", gravity(i));
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), gravity(kFloodSize - 1));
  EXPECT_EQ(show.engine.world().tick(), 0u);
}

}  // namespace
}  // namespace limber::engine::test
