// The engine on its thread, with many writers to its command queue and readers of its snapshots: for the thread
// sanitizer, and to check that nothing is torn or lost.
#include <atomic>
#include <thread>

#include "engine/everything.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr int kWriters = 4;
constexpr int kCommandsPerWriter = 500;

void write_commands(EngineLink& link, int writer) {
  const CommandOrigin origin{CommandSource::osc, 1, static_cast<std::uint16_t>(writer)};
  for (int i = 0; i < kCommandsPerWriter; i++) {
    Command command;
    command.origin = origin;
    command.messages.push_back(message("/physics/motor/target", "arm", 0.001 * i));
    command.messages.push_back(message("/physics/part/friction", "arm", 0.5));
    command.messages.push_back(message("/seen", writer));
    command.messages.push_back(message("/physics/sim/gravty", 1));
    EXPECT_TRUE(link.command_queue.push(std::move(command)));
    link.wake_engine();
  }
}

// each snapshot is consistent: its list of bodies fits its values, and ticks never decrease
void read_snapshots(const EngineLink& link, const std::atomic<bool>& done) {
  std::uint64_t last = 0;
  std::shared_ptr<const Snapshot> retained;
  while (!done.load()) {
    const std::shared_ptr<const Snapshot> now = link.snapshots.read();
    if (now == nullptr) continue;
    EXPECT_GE(now->tick, last);
    last = now->tick;
    for (const BodyEntry& body : now->body_list->bodies) {
      EXPECT_EQ(now->transient.at(body.enabled_offset), 1);
      for (const std::uint32_t joint : body.joint_offsets)
        EXPECT_LE(joint + transient_offsets().joint_rotation + 4, now->transient.size());
    }
    if (last % 7 == 0) retained = now;
  }
}

TEST(Threads, ManyWritersAndReadersLoseNothing) {
  const SceneFile scene(std::string(kEverything) + "osc:on('/seen', function(n) osc:send('/got', n) end)\n");
  EngineLink link;
  Engine engine(link, fast_options(scene.path()));
  ASSERT_TRUE(engine.start().ok());
  std::atomic<bool> done{false};
  std::thread sim([&] { engine.run(); });
  std::vector<std::thread> readers;
  readers.reserve(3);
  for (int i = 0; i < 3; i++) readers.emplace_back([&] { read_snapshots(link, done); });
  std::vector<std::thread> writers;
  writers.reserve(kWriters);
  for (int i = 0; i < kWriters; i++) writers.emplace_back([&, i] { write_commands(link, i); });
  // the network's part: drains the output
  int replies = 0;
  int errors = 0;
  std::vector<Outgoing> out;
  while (replies < kWriters * kCommandsPerWriter || errors < kWriters * kCommandsPerWriter) {
    link.output_queue.drain(out);
    for (const Outgoing& o : out) {
      replies += o.message.address == "/got";
      errors += o.message.address == "/error";
    }
    std::this_thread::yield();
  }
  for (std::thread& writer : writers) writer.join();
  engine.stop();
  sim.join();
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(replies, kWriters * kCommandsPerWriter);
  EXPECT_EQ(errors, kWriters * kCommandsPerWriter);
  EXPECT_EQ(link.counters.unknown.load(), static_cast<std::uint64_t>(kWriters * kCommandsPerWriter));
  EXPECT_EQ(link.output_queue.dropped(), 0U);
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
}  // namespace limber::engine::test
