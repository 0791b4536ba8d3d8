// The engine on its thread, many hands at its inbox, readers of its snapshots: for the thread sanitizer, and that
// nothing is torn or lost.
#include <atomic>
#include <thread>

#include "engine/everything.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

constexpr int kWriters = 4;
constexpr int kEach = 500;

void write_commands(EngineLink& link, int writer) {
  const Origin origin{Hand::osc, 1, static_cast<std::uint16_t>(writer)};
  for (int i = 0; i < kEach; i++) {
    Command command;
    command.origin = origin;
    command.messages.push_back(message("/physics/motor/target", "arm", 0.001 * i));
    command.messages.push_back(message("/physics/part/friction", "arm", 0.5));
    command.messages.push_back(message("/seen", writer));
    command.messages.push_back(message("/physics/sim/gravty", 1));
    EXPECT_TRUE(link.inbox.push(std::move(command)));
    link.wake_engine();
  }
}

// each snapshot whole: its own roster fits its numbers, ticks never go back
void read_snapshots(const EngineLink& link, const std::atomic<bool>& over) {
  std::uint64_t last = 0;
  std::shared_ptr<const Snapshot> held;
  while (!over.load()) {
    const std::shared_ptr<const Snapshot> now = link.snapshots.read();
    if (now == nullptr) continue;
    EXPECT_GE(now->tick, last);
    last = now->tick;
    for (const RosterBody& body : now->roster->bodies) {
      EXPECT_EQ(now->live.at(body.enabled_at), 1);
      for (const std::uint32_t joint : body.joints)
        EXPECT_LE(joint + live_offsets().joint_rotation + 4, now->live.size());
    }
    if (last % 7 == 0) held = now;
  }
}

TEST(Threads, ManyHandsOneEngineManyReaders) {
  const SceneFile scene(std::string(kEverything) + "osc:on('/seen', function(n) osc:send('/got', n) end)\n");
  EngineLink link;
  Engine engine(link, fast_options(scene.path()));
  ASSERT_TRUE(engine.start().ok());
  std::atomic<bool> over{false};
  std::thread sim([&] { engine.run(); });
  std::vector<std::thread> readers;
  readers.reserve(3);
  for (int i = 0; i < 3; i++) readers.emplace_back([&] { read_snapshots(link, over); });
  std::vector<std::thread> writers;
  writers.reserve(kWriters);
  for (int i = 0; i < kWriters; i++) writers.emplace_back([&, i] { write_commands(link, i); });
  // the network's part: takes what goes out
  int got = 0;
  int errors = 0;
  std::vector<Outgoing> out;
  while (got < kWriters * kEach || errors < kWriters * kEach) {
    link.outbox.drain(out);
    for (const Outgoing& o : out) {
      got += o.message.address == "/got";
      errors += o.message.address == "/error";
    }
    std::this_thread::yield();
  }
  for (std::thread& writer : writers) writer.join();
  engine.stop();
  sim.join();
  over = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(got, kWriters * kEach);
  EXPECT_EQ(errors, kWriters * kEach);
  EXPECT_EQ(link.counters.unknown.load(), static_cast<std::uint64_t>(kWriters * kEach));
  EXPECT_EQ(link.outbox.dropped(), 0U);
}

TEST(Threads, StoppingIsSafeAtAnyMoment) {
  for (int i = 0; i < 8; i++) {
    EngineLink link;
    EngineOptions options;
    options.fast = i % 2 == 0;
    Engine engine(link, options);
    ASSERT_TRUE(engine.start().ok());
    std::thread sim([&] { engine.run(); });
    for (int k = 0; k < i; k++) std::this_thread::yield();
    engine.stop();
    sim.join();
  }
}

}  // namespace
}  // namespace limber::engine_test
