// The streams' beat: deadlines do not drift, missed frames are left out, a paused world is still shown.
#include "osc/streams.h"

#include <gtest/gtest.h>

#include <array>

#include "base/system/udp_socket.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber {
namespace {

using namespace osc_test;

system::UdpSender open_sender() {
  system::UdpSender sender;
  EXPECT_TRUE(sender.open().ok());
  return sender;
}

struct StreamsDesk {
  StreamsDesk() {
    auto snapshot = engine.link.snapshots.spare();
    *snapshot = test_world({{"arm", 1}});
    engine.link.snapshots.publish(snapshot);
  }
  Target target(const Client& client, double rate) {
    StreamTarget wish;
    wish.rate = rate;
    wish.rot = wish.relrot = false;
    return {wish, client.end()};
  }
  std::uint64_t sent() const { return engine.link.counters.sent; }
  // sends what is due, as the loop does after its wait
  void wait_and_send() {
    hand.ns += streams.wait().value();
    streams.send_due(sender);
  }

  FakeEngine engine;
  HandClock hand;
  NetClock clock = hand.clock();
  system::UdpSender sender = open_sender();
  Streams streams{engine.link, kTestOffsets, clock};
  Client a, b;
};

TEST(Streams, OneFrameAPeriodWithoutDrift) {
  StreamsDesk desk;
  desk.streams.set_targets({desk.target(desk.a, 60)});
  EXPECT_EQ(desk.streams.wait(), 0) << "the first frame comes at once";
  const std::int64_t begin = desk.hand.ns;
  for (int i = 0; i < 601; i++) {
    desk.wait_and_send();
    desk.hand.ns += i % 7 * std::int64_t{1'000'000};  // the loop had other things to do
  }
  EXPECT_EQ(desk.sent(), 601u);
  desk.hand.ns += desk.streams.wait().value();
  // 601 periods of 16 666 666 ns, whatever happened in between
  EXPECT_EQ(desk.hand.ns - begin, 601 * std::int64_t{16'666'666});
}

TEST(Streams, SubscribersFramesPassTheGateAndOthersDoNot) {
  StreamsDesk desk;
  std::size_t bytes = 0;
  int asked = 0;
  bool open = false;
  Streams streams(desk.engine.link, kTestOffsets, desk.clock, [&](const Endpoint& to, std::size_t size, std::size_t) {
    EXPECT_EQ(to, desk.b.end());
    bytes = size;
    asked++;
    return open;
  });
  Target subscribed = desk.target(desk.b, 10);
  subscribed.subscribed = true;
  streams.set_targets({desk.target(desk.a, 10), subscribed});
  streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 1u);
  EXPECT_EQ(desk.a.receive()->size(), bytes);
  open = true;
  desk.hand.turn(0.1);
  streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 3u);
  EXPECT_EQ(asked, 2) << "a frame that was withheld is left out";
}

TEST(Streams, OneCallSendsASliceToSubscribersInTurn) {
  StreamsDesk desk;
  const auto snapshot = desk.engine.link.snapshots.spare();
  std::vector<FakeBody> bodies;
  bodies.reserve(300);
  for (int i = 0; i < 300; i++) bodies.push_back({"body" + std::to_string(i), 17});
  *snapshot = test_world(bodies);
  desk.engine.link.snapshots.publish(snapshot);
  std::vector<Endpoint> served;
  Streams streams(desk.engine.link, kTestOffsets, desk.clock, [&](const Endpoint& to, std::size_t, std::size_t) {
    served.push_back(to);
    return true;
  });
  std::vector<Target> targets;
  const std::array<Client, 6> clients;
  for (const Client& client : clients) {
    targets.push_back(desk.target(client, 10));
    targets.back().subscribed = true;
  }
  streams.set_targets(targets);
  for (std::size_t call = 1; call <= 3; call++) {
    streams.send_due(desk.sender);
    EXPECT_EQ(served.size(), 2 * call) << "two frames are more than a slice";
    EXPECT_EQ(streams.wait() == 0, call < 3);
  }
  for (std::size_t i = 0; i < clients.size(); i++) EXPECT_EQ(served[i], clients[i].end());
}

TEST(Streams, EarlySendsNothing) {
  StreamsDesk desk;
  desk.streams.set_targets({desk.target(desk.a, 10)});
  desk.streams.send_due(desk.sender);
  desk.hand.turn(0.0999);
  desk.streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 1u);
  desk.hand.turn(0.0001);
  desk.streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 2u);
}

// the machine slept for two and a half periods: one frame now, and the beat as before
TEST(Streams, MissedFramesAreLeftOut) {
  StreamsDesk desk;
  desk.streams.set_targets({desk.target(desk.a, 10)});
  desk.streams.send_due(desk.sender);
  desk.hand.turn(0.25);
  desk.streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 2u);
  EXPECT_EQ(desk.streams.wait(), 50'000'000);
}

TEST(Streams, EachTargetHasItsRate) {
  StreamsDesk desk;
  desk.streams.set_targets({desk.target(desk.a, 100), desk.target(desk.b, 25)});
  for (int i = 0; i <= 100; i++) {
    desk.streams.send_due(desk.sender);
    desk.hand.turn(0.01);
  }
  int frames_a = 0;
  int frames_b = 0;
  while (desk.a.receive(0)) frames_a++;
  while (desk.b.receive(0)) frames_b++;
  EXPECT_EQ(frames_a, 101);
  EXPECT_EQ(frames_b, 26);
}

TEST(Streams, OldTargetsKeepTheirBeat) {
  StreamsDesk desk;
  desk.streams.set_targets({desk.target(desk.a, 10)});
  desk.streams.send_due(desk.sender);
  desk.hand.turn(0.04);
  desk.streams.set_targets({desk.target(desk.b, 1), desk.target(desk.a, 10)});
  EXPECT_EQ(desk.streams.wait(), 0) << "the new one begins at once";
  desk.streams.send_due(desk.sender);
  EXPECT_EQ(desk.sent(), 2u);
  EXPECT_EQ(desk.streams.wait(), 60'000'000) << "the old one has 60 ms left";
  desk.streams.set_targets({});
  EXPECT_FALSE(desk.streams.wait());
}

TEST(Streams, TargetsWithoutStreamsCostNothing) {
  StreamsDesk desk;
  Target t = desk.target(desk.a, 10);
  t.wish.pos = false;
  desk.streams.set_targets({t});
  EXPECT_FALSE(desk.streams.wait());
}

TEST(Streams, BeforeTheFirstSnapshotNothingIsSent) {
  FakeEngine engine;
  const NetClock clock;
  const Client client;
  system::UdpSender sender = open_sender();
  Streams streams(engine.link, kTestOffsets, clock);
  streams.set_targets({{StreamTarget{}, client.end()}});
  streams.send_due(sender);
  EXPECT_EQ(engine.link.counters.sent, 0u);
}

// runs of equal and unequal sizes arrive as they were cut, whether the kernel cuts or we do
TEST(Batch, DatagramsArriveWhole) {
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
    // all of them where the kernel grants the buffer, and never fewer than its default holds
    EXPECT_GE(at, 100u);
  }
}

TEST(Batch, ErrorIsAnAnswer) {
  system::UdpSender sender = open_sender();
  bool segmentation = true;
  const std::string bytes(std::size_t{2} * 65508, 'x');  // larger than UDP carries
  const std::vector<std::uint32_t> sizes = {65508, 65508};
  const system::BatchResult result = sender.send({0x7f000001, 9}, bytes, sizes, segmentation);
  EXPECT_EQ(result.sent, 0u);
  EXPECT_EQ(result.error, EMSGSIZE);
}

}  // namespace
}  // namespace limber
