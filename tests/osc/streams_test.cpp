// The schedule of streams: no drift, missed frames are skipped, a paused world is sent repeatedly.
#include "net/osc/streams.h"

#include <gtest/gtest.h>

#include <array>

#include "base/system/net/udp_socket.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

system::UdpSender open_sender() {
  system::UdpSender sender;
  EXPECT_TRUE(sender.open().ok());
  return sender;
}

struct StreamsFixture {
  StreamsFixture() {
    auto snapshot = engine.link.snapshots.acquire_buffer();
    *snapshot = test_world({{"arm", 1}});
    engine.link.snapshots.publish(snapshot);
  }
  ResolvedTarget target(const Client& client, double rate) {
    StreamTarget config;
    config.rate = rate;
    config.rot = config.relrot = false;
    return {config, client.end()};
  }
  std::uint64_t sent() const { return engine.link.counters.sent; }
  // Waits for the timeout and sends the frames that are due, like the network thread's loop.
  void wait_and_send() {
    manual_clock.ns += streams.timeout().value();
    streams.send_due(sender);
  }

  FakeEngine engine;
  ManualClock manual_clock;
  NetClock clock = manual_clock.clock();
  system::UdpSender sender = open_sender();
  Streams streams{engine.link, kTestOffsets, clock};
  Client a, b;
};

TEST(Streams, SendsFramesWithoutDrift) {
  StreamsFixture fixture;
  fixture.streams.set_targets({fixture.target(fixture.a, 60)});
  EXPECT_EQ(fixture.streams.timeout(), 0) << "the first frame comes at once";
  const std::int64_t begin = fixture.manual_clock.ns;
  for (int i = 0; i < 601; i++) {
    fixture.wait_and_send();
    fixture.manual_clock.ns += i % 7 * std::int64_t{1'000'000};  // the loop was delayed
  }
  EXPECT_EQ(fixture.sent(), 601u);
  fixture.manual_clock.ns += fixture.streams.timeout().value();
  // 601 periods of 16 666 666 ns, regardless of the delays
  EXPECT_EQ(fixture.manual_clock.ns - begin, 601 * std::int64_t{16'666'666});
}

TEST(Streams, GateAppliesOnlyToSubscribers) {
  StreamsFixture fixture;
  std::size_t bytes = 0;
  int asked = 0;
  bool open = false;
  Streams streams(fixture.engine.link, kTestOffsets, fixture.clock,
                  [&](const Endpoint& to, std::size_t size, std::size_t) {
                    EXPECT_EQ(to, fixture.b.end());
                    bytes = size;
                    asked++;
                    return open;
                  });
  ResolvedTarget subscribed = fixture.target(fixture.b, 10);
  subscribed.subscribed = true;
  streams.set_targets({fixture.target(fixture.a, 10), subscribed});
  streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 1u);
  EXPECT_EQ(fixture.a.receive()->size(), bytes);
  open = true;
  fixture.manual_clock.advance(0.1);
  streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 3u);
  EXPECT_EQ(asked, 2) << "a frame that was withheld is left out";
}

TEST(Streams, SendsSlicesToSubscribersInTurn) {
  StreamsFixture fixture;
  const auto snapshot = fixture.engine.link.snapshots.acquire_buffer();
  std::vector<FakeBody> bodies;
  bodies.reserve(300);
  for (int i = 0; i < 300; i++) bodies.push_back({"body" + std::to_string(i), 17});
  *snapshot = test_world(bodies);
  fixture.engine.link.snapshots.publish(snapshot);
  std::vector<Endpoint> served;
  Streams streams(fixture.engine.link, kTestOffsets, fixture.clock, [&](const Endpoint& to, std::size_t, std::size_t) {
    served.push_back(to);
    return true;
  });
  std::vector<ResolvedTarget> targets;
  const std::array<Client, 6> clients;
  for (const Client& client : clients) {
    targets.push_back(fixture.target(client, 10));
    targets.back().subscribed = true;
  }
  streams.set_targets(targets);
  for (std::size_t call = 1; call <= 3; call++) {
    streams.send_due(fixture.sender);
    EXPECT_EQ(served.size(), 2 * call) << "two frames are more than a slice";
    EXPECT_EQ(streams.timeout() == 0, call < 3);
  }
  for (std::size_t i = 0; i < clients.size(); i++) EXPECT_EQ(served[i], clients[i].end());
}

TEST(Streams, SendsNothingEarly) {
  StreamsFixture fixture;
  fixture.streams.set_targets({fixture.target(fixture.a, 10)});
  fixture.streams.send_due(fixture.sender);
  fixture.manual_clock.advance(0.0999);
  fixture.streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 1u);
  fixture.manual_clock.advance(0.0001);
  fixture.streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 2u);
}

// The machine slept for two and a half periods: one frame is sent now, and the schedule is unchanged.
TEST(Streams, SkipsMissedFrames) {
  StreamsFixture fixture;
  fixture.streams.set_targets({fixture.target(fixture.a, 10)});
  fixture.streams.send_due(fixture.sender);
  fixture.manual_clock.advance(0.25);
  fixture.streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 2u);
  EXPECT_EQ(fixture.streams.timeout(), 50'000'000);
}

TEST(Streams, TargetsHaveSeparateRates) {
  StreamsFixture fixture;
  fixture.streams.set_targets({fixture.target(fixture.a, 100), fixture.target(fixture.b, 25)});
  for (int i = 0; i <= 100; i++) {
    fixture.streams.send_due(fixture.sender);
    fixture.manual_clock.advance(0.01);
  }
  int frames_a = 0;
  int frames_b = 0;
  while (fixture.a.receive(0)) frames_a++;
  while (fixture.b.receive(0)) frames_b++;
  EXPECT_EQ(frames_a, 101);
  EXPECT_EQ(frames_b, 26);
}

TEST(Streams, UnchangedTargetsKeepSchedule) {
  StreamsFixture fixture;
  fixture.streams.set_targets({fixture.target(fixture.a, 10)});
  fixture.streams.send_due(fixture.sender);
  fixture.manual_clock.advance(0.04);
  fixture.streams.set_targets({fixture.target(fixture.b, 1), fixture.target(fixture.a, 10)});
  EXPECT_EQ(fixture.streams.timeout(), 0) << "the new one begins at once";
  fixture.streams.send_due(fixture.sender);
  EXPECT_EQ(fixture.sent(), 2u);
  EXPECT_EQ(fixture.streams.timeout(), 60'000'000) << "the old one has 60 ms left";
  fixture.streams.set_targets({});
  EXPECT_FALSE(fixture.streams.timeout());
}

TEST(Streams, IgnoresTargetsWithoutStreams) {
  StreamsFixture fixture;
  ResolvedTarget t = fixture.target(fixture.a, 10);
  t.config.pos = false;
  fixture.streams.set_targets({t});
  EXPECT_FALSE(fixture.streams.timeout());
}

TEST(Streams, SendsNothingBeforeFirstSnapshot) {
  FakeEngine engine;
  const NetClock clock;
  const Client client;
  system::UdpSender sender = open_sender();
  Streams streams(engine.link, kTestOffsets, clock);
  streams.set_targets({{StreamTarget{}, client.end()}});
  streams.send_due(sender);
  EXPECT_EQ(engine.link.counters.sent, 0u);
}

// Datagrams of equal and unequal sizes arrive unchanged, whether the kernel or our code segments them.
TEST(UdpBatch, PreservesDatagrams) {
  system::UdpSender sender = open_sender();
  for (const bool segmentation : {true, false}) {
    const Client client;
    std::vector<std::string> given;
    std::string bytes;
    std::vector<std::uint32_t> sizes;
    for (int i = 0; i < 500; i++) {
      const std::size_t size = i % 100 < 80 ? 1184 : 400 + static_cast<std::size_t>(i % 5) * 4;
      given.emplace_back(size, static_cast<char>(i));
      bytes += given.back();
      sizes.push_back(static_cast<std::uint32_t>(size));
    }
    bool may_segment = segmentation;
    const system::BatchResult result = sender.send(client.end(), bytes, sizes, may_segment);
    EXPECT_EQ(result.sent, 500u);
    EXPECT_EQ(result.error, 0);
    std::size_t at = 0;
    for (; at < given.size(); at++) {
      const auto datagram = client.receive(0);
      if (!datagram) break;
      ASSERT_EQ(*datagram, given[at]) << at;
    }
    // all of them if the kernel grants the buffer, otherwise at least as many as its default holds
    EXPECT_GE(at, 100u);
  }
}

TEST(UdpBatch, ReportsErrors) {
  system::UdpSender sender = open_sender();
  bool segmentation = true;
  const std::string bytes(std::size_t{2} * 65508, 'x');  // larger than UDP carries
  const std::vector<std::uint32_t> sizes = {65508, 65508};
  const system::BatchResult result = sender.send({0x7f000001, 9}, bytes, sizes, segmentation);
  EXPECT_EQ(result.sent, 0u);
  EXPECT_EQ(result.error, EMSGSIZE);
}

}  // namespace
}  // namespace limber::osc
